/* Linked into every program of a sanitized build: leaks of the drivers and of the validation layer are
 * not ours. LeakSanitizer can tell whose a leak is only while the library is loaded. */
const char *__lsan_default_options(void);
const char *__lsan_default_suppressions(void);
int dlclose(void *library);

const char *__lsan_default_options(void)
{
    return "print_suppressions=0";
}

const char *__lsan_default_suppressions(void)
{
    return "leak:libvulkan_lvp\n"
           "leak:libLLVM\n"
           "leak:libstdc++\n" /* behind whose operator new no caller is seen; only libraries use it */
           "leak:libVkLayer_khronos_validation\n"
           "leak:libGLX_mesa\n"
           "leak:libX11\n"; /* what a call held when the display went away */
}

/* In place of the C library's: the Vulkan loader unloads nothing. */
int dlclose(void *library)
{
    (void)library;
    return 0;
}
