#include "cli/commands.h"

#include <stdio.h>
#include <string.h>

const struct command commands[COMMAND_COUNT] = {
    [COMMAND_RENDER] = {"render", "SCENE [-o FILE]...", "render a picture: .png, .exr or .pfm",
                        command_render},
    [COMMAND_CHECK] = {"check", "SCENE...", "compare device and reference, pixel by pixel", command_check},
    [COMMAND_WATCH] = {"watch", "SCENE [-o FILE]...", "render again when the scene or a shader is saved",
                       command_watch},
    [COMMAND_BENCH] = {"bench", "SCENE...", "measure speed and error of many settings", command_bench},
    [COMMAND_PIXEL] = {"pixel", "SCENE X Y", "one pixel's ray tree, device and reference side by side",
                       command_pixel},
    [COMMAND_DEVICES] = {"devices", "", "list the Vulkan devices", command_devices},
};

const char *command_names(unsigned set, char names[static COMMAND_NAMES])
{
    size_t length = 0;
    names[0] = '\0';
    for (int i = 0; i < COMMAND_COUNT && length < COMMAND_NAMES; ++i)
        if (set >> i & 1)
            length += (size_t)snprintf(names + length, COMMAND_NAMES - length, "%s%s", length > 0 ? ", " : "",
                                       commands[i].name);
    return names;
}
