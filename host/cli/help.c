#include "cli/help.h"

static const char help_text[] =
    "usage: vkwhitted render SCENE [-o FILE]...  render a picture: .png, .exr or .pfm\n"
    "       vkwhitted check SCENE...             compare device and reference, pixel by pixel\n"
    "       vkwhitted watch SCENE [-o FILE]...   render again when the scene or a shader is saved\n"
    "       vkwhitted bench SCENE...             measure speed and error of many settings\n"
    "       vkwhitted pixel SCENE X Y            one pixel's ray tree, device and reference side by side\n"
    "       vkwhitted devices                    list the Vulkan devices\n"
    "\n"
    "picture (render, check, watch; pixel without --crop; bench takes the first):\n"
    "  --size WxH               pixels, instead of the scene's\n"
    "  --crop X,Y,W,H           only this part, in pixels from the top left\n"
    "  --max-bounces N          0 to 1000, instead of the scene's\n"
    "  --samples N              samples a pixel, 1 to 65536 (default 1: the pixel's centre)\n"
    "  --light-samples N        samples a quad light, 1 to 65536, instead of the scene's\n"
    "  --max-error E            leave out rays that together change no pixel by more than E\n"
    "  --precision float|double|quad   double on a device that has it, quad on the CPU\n"
    "\n"
    "backend (render, check):\n"
    "  --backend vulkan|cpu     cpu: the plain-C reference (check: with --against; also bench)\n"
    "  --fast                   contraction and built-in functions allowed on the device\n"
    "  --threads N              of the CPU reference (default: all processors)\n"
    "\n"
    "device (all commands):\n"
    "  --device N|NAME          the device with this number, or with this in its name\n"
    "  --validate               with the Khronos validation layer; any message is an error\n"
    "\n"
    "render, watch:\n"
    "  -o FILE                  write the picture; repeat for several files\n"
    "  --transfer srgb|linear   of 8-bit files (default srgb)\n"
    "\n"
    "render:\n"
    "  --stats FILE             times, rays and device as JSON\n"
    "  --repeat N               render N more times, for the median of the warm times\n"
    "\n"
    "check:\n"
    "  --tolerance ABS[,REL]    values may differ by ABS + REL * value (default: not in a bit)\n"
    "  --allow N                so many pixels may differ\n"
    "  --against double|quad    judge the picture by the exact one: errors, and pixels\n"
    "                           that the error analysis does not explain\n"
    "  --heatmap FILE.png       where they differ, as a picture\n"
    "  --json FILE              the result for machines\n"
    "\n"
    "watch:\n"
    "  --shaders DIR            the folder of whitted.comp (default: the program's)\n"
    "  --window                 show it in a window (default, unless -o is given); drag, Shift-drag\n"
    "                           and wheel move the camera, R resets it, P prints it, S saves the\n"
    "                           picture, D shows its difference to the reference, Esc ends\n"
    "  --check                  compare each picture with the reference in the background\n"
    "\n"
    "bench:\n"
    "  --quick                  a minute's worth\n"
    "  --report FILE.html       all of it on one page, with charts\n"
    "  --json FILE, --csv FILE  the measurements\n"
    "  --compare OLD.json       what became faster, slower or less accurate beyond noise\n"
    "\n"
    "pixel:\n"
    "  --against double|quad    each quantity's error, its bound, and the margins of decisions\n"
    "  --json FILE              the tree for machines; -v: all light samples\n"
    "\n"
    "  -q, -v                   quiet, verbose\n"
    "  -h, --help  --version\n"
    "\n"
    "exit status: 0 done, 1 a check or comparison found a difference, 2 bad usage or input,\n"
    "3 the machine could not do it\n";

static enum status finish(FILE *stream)
{
    if (fflush(stream) == 0)
        return STATUS_DONE;
    log_error("cannot write to standard output");
    return STATUS_UNABLE;
}

enum status help_print(FILE *stream)
{
    fputs(help_text, stream);
    return finish(stream);
}

enum status help_print_version(void)
{
    puts("vkwhitted " VKWHITTED_VERSION);
    return finish(stdout);
}
