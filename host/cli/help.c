#include <limits.h>
#include <string.h>

#include "cli/option_table.h"

const struct command commands[COMMAND_COUNT] = {
    [COMMAND_RENDER] = {"render", "SCENE [-o FILE]...", "render a picture: .png, .exr or .pfm",
                        command_render},
    [COMMAND_JOIN] = {"join", "TILE... -o FILE", "one picture from the tiles of render --tile", command_join},
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

/* Two columns: "-h, --help", "-o FILE" or "--size WxH", and what it does. */
static void print_option(FILE *stream, const struct option_entry *option)
{
    char form[64];
    const char *line = option->help;
    snprintf(form, sizeof form, "%s%s%s%s%s%s%s", option->letter[0] ? "-" : "", option->letter,
             option->letter[0] && option->name[0] ? ", " : "", option->name[0] ? "--" : "", option->name,
             option->value ? " " : "", option->value ? option->value : "");
    for (size_t length; length = strcspn(line, "\n"), line[length]; line += length + 1, form[0] = '\0')
        fprintf(stream, "  %-23s  %.*s\n", form, (int)length, line);
    fprintf(stream, "  %-23s  %s", form, line);
    if (option->most > 0 && option->most < UINT_MAX)
        fprintf(stream, ", %u to %u", option->least, option->most);
    fputc('\n', stream);
}

void help_print(FILE *stream)
{
    unsigned section = 0;
    for (int i = 0; i < COMMAND_COUNT; ++i)
        fprintf(stream, "%s vkwhitted %s %-*s  %s\n", i == 0 ? "usage:" : "      ", commands[i].name,
                (int)(24 - strlen(commands[i].name)), commands[i].arguments, commands[i].summary);
    for (const struct option_entry *option = option_table; option->help; ++option) {
        char names[COMMAND_NAMES];
        if (option->commands != section)
            fprintf(stream, "\n%s:\n", command_names(option->commands, names));
        section = option->commands;
        print_option(stream, option);
    }
    fputs("\nexit status: 0 done, 1 a check or comparison found a difference, 2 bad usage or input,\n"
          "3 the machine could not do it\n",
          stream);
}

void help_print_version(void)
{
    puts("vkwhitted " VKWHITTED_VERSION);
}
