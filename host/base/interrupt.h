#ifndef VKWHITTED_BASE_INTERRUPT_H
#define VKWHITTED_BASE_INTERRUPT_H

#include <stdbool.h>

/* Ctrl-C and SIGTERM from now on only set a flag, which long work asks for; a second one ends the process,
 * even where a driver does not come back. */
void interrupt_catch(void);
bool interrupt_requested(void);

/* Ends the process as the caught signal would have. */
_Noreturn void interrupt_die(void);

#endif
