#include "bench/machine.h"

#include <stdio.h>
#include <string.h>
#include <sys/utsname.h>
#include <unistd.h>

/* The processor's name as Linux tells it, or else its architecture. */
static void name_processor(char *name, size_t size, const char *architecture)
{
    char line[256];
    FILE *file = fopen("/proc/cpuinfo", "re");
    snprintf(name, size, "%s", architecture);
    while (file && fgets(line, sizeof line, file)) {
        const char *value = strchr(line, ':');
        if (strncmp(line, "model name", strlen("model name")) != 0 || !value)
            continue;
        value += strspn(value, ": \t");
        snprintf(name, size, "%.*s", (int)strcspn(value, "\n"), value);
        break;
    }
    if (file)
        fclose(file);
}

json_t *machine_describe(const struct vulkan_context *context)
{
    struct utsname system = {.sysname = "unknown"};
    char processor[256], os[sizeof system.sysname + sizeof system.release + 1];
    uname(&system);
    name_processor(processor, sizeof processor, system.machine);
    snprintf(os, sizeof os, "%s %s", system.sysname, system.release);
    double memory = (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGE_SIZE);
    json_t *machine = json_pack("{s:s, s:i, s:f, s:s, s:s}", "processor", processor, "cores",
                                (int)sysconf(_SC_NPROCESSORS_ONLN), "memory_gib",
                                memory / (1024.0 * 1024 * 1024), "os", os, "compiler",
#ifdef __clang__
                                "clang " __clang_version__
#else
                                "gcc " __VERSION__
#endif
    );
    if (!context || !machine)
        return machine;
    char driver[sizeof context->driver.driverName + sizeof context->driver.driverInfo + 1], vulkan[32];
    uint32_t loader = VK_API_VERSION_1_0;
    vkEnumerateInstanceVersion(&loader);
    snprintf(driver, sizeof driver, "%s %s", context->driver.driverName, context->driver.driverInfo);
    snprintf(vulkan, sizeof vulkan, "%u.%u.%u", VK_API_VERSION_MAJOR(loader), VK_API_VERSION_MINOR(loader),
             VK_API_VERSION_PATCH(loader));
    json_t *device = json_pack("{s:s, s:s, s:s}", "device", context->properties.deviceName, "driver", driver,
                               "vulkan", vulkan);
    json_object_update(machine, device);
    json_decref(device);
    return machine;
}
