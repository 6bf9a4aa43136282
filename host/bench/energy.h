#ifndef VKWHITTED_BENCH_ENERGY_H
#define VKWHITTED_BENCH_ENERGY_H

#include <stdbool.h>
#include <stdint.h>

/* What the processor packages have used, by the counters of Linux's powercap (RAPL). */
struct energy_meter {
    int count; /* of readable counters; 0: the machine does not tell */
    struct {
        char path[96];
        uint64_t last, range; /* microjoules; the counter starts again after range */
    } counters[8];
    double joules; /* since the meter was opened */
};

/* Looks for counters in the folder, /sys/class/powercap on a real machine. */
void energy_meter_open(struct energy_meter *meter, const char *folder);

/* Joules since the meter was opened; false where the machine does not tell. To be read more often than the
 * counters start again, which is once in minutes. */
bool energy_meter_read(struct energy_meter *meter, double *joules);

#endif
