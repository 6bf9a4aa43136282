#ifndef VKWHITTED_BASE_CLOCK_H
#define VKWHITTED_BASE_CLOCK_H

/* Monotonic milliseconds. */
double clock_ms(void);

#endif
