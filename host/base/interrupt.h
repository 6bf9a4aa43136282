#ifndef VKWHITTED_BASE_INTERRUPT_H
#define VKWHITTED_BASE_INTERRUPT_H

#include <stdbool.h>

/* Ctrl-C and SIGTERM from now on only set a flag, which long work asks for; a second one ends the process,
 * even where a driver does not come back. */
void interrupt_catch(void);
bool interrupt_requested(void);

/* From now on the first one ends the process where it is, or not any more: for work that may take long and
 * leaves nothing behind, neither half a file nor a device at work. */
void interrupt_ends_process(bool at_once);

/* Ends the process as the caught signal would have. */
_Noreturn void interrupt_die(void);

#endif
