#ifndef VKWHITTED_BASE_INTERRUPT_H
#define VKWHITTED_BASE_INTERRUPT_H

#include <stdbool.h>
#include <sys/types.h>

/* From now on Ctrl-C, SIGTERM, SIGHUP, SIGPIPE and the like end the process by that signal at once, whatever
 * it is doing, after the files and the process below have been removed and ended. A signal that is ignored at
 * the start stays ignored (nohup). The caller's thread is the one that may use the other functions, too. */
void interrupt_catch(void);

/* A file that no interrupted process may leave behind: named before it is created, until it has been renamed
 * or removed. The path must stay where it is. False: there are too many. */
bool interrupt_removes(const char *path);
void interrupt_leaves(const char *path);

/* A process that is to end with this one; 0: none. */
void interrupt_ends(pid_t process);

#endif
