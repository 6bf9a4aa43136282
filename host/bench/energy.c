#include "bench/energy.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

static bool read_counter(const char *path, uint64_t *value)
{
    FILE *file = fopen(path, "re");
    if (!file)
        return false;
    bool read = fscanf(file, "%" SCNu64, value) == 1;
    fclose(file);
    return read;
}

/* Zones like core and dram are parts of a package; psys is the whole platform. */
static bool is_package(const char *zone)
{
    char path[96], name[32] = "";
    snprintf(path, sizeof path, "%s/name", zone);
    FILE *file = fopen(path, "re");
    if (!file)
        return false;
    bool read = fscanf(file, "%31s", name) == 1;
    fclose(file);
    return read && strncmp(name, "package", strlen("package")) == 0;
}

void energy_meter_open(struct energy_meter *meter, const char *folder)
{
    *meter = (struct energy_meter){0};
    for (int i = 0; i < (int)(sizeof meter->counters / sizeof *meter->counters); ++i) {
        char zone[64], range[96];
        char *path = meter->counters[meter->count].path;
        snprintf(zone, sizeof zone, "%.40s/intel-rapl:%d", folder, i);
        snprintf(path, sizeof meter->counters->path, "%s/energy_uj", zone);
        snprintf(range, sizeof range, "%s/max_energy_range_uj", zone);
        if (is_package(zone) && read_counter(path, &meter->counters[meter->count].last) &&
            read_counter(range, &meter->counters[meter->count].range))
            ++meter->count;
    }
}

bool energy_meter_read(struct energy_meter *meter, double *joules)
{
    for (int i = 0; i < meter->count; ++i) {
        uint64_t now, last = meter->counters[i].last;
        if (!read_counter(meter->counters[i].path, &now))
            return false;
        meter->joules += 1e-6 * (double)(now >= last ? now - last : meter->counters[i].range - last + now);
        meter->counters[i].last = now;
    }
    *joules = meter->joules;
    return meter->count > 0;
}
