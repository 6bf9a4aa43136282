#ifndef VKWHITTED_WATCH_WINDOW_SYSTEM_H
#define VKWHITTED_WATCH_WINDOW_SYSTEM_H

#include "vulkan/context.h"

/* The program's one connection to a display, by GLFW. A display that goes away does not end the process, as
 * libX11 would have it: it is lost from then on, for good, and GLFW is not called any more.
 *
 * For the main thread, except where it says otherwise. */

/* Opens the display, and asks for a Vulkan context that can show pictures there. STATUS_UNABLE (reported)
 * where there is no display. From here on the process ignores SIGPIPE. */
enum status window_system_open(struct vulkan_options *vulkan);
void window_system_close(void);

/* Whether the display has gone away. For any thread. */
bool window_system_lost(void);

/* Runs call(argument): whatever talks to the display by GLFW does so in here. If the display is lost
 * meanwhile, the call ends where it stands, so it must own nothing. Returns whether it ran to its end; once
 * the display is lost it is not run. */
bool window_system_call(void (*call)(void *argument), void *argument);

/* Has GLFW handle the events that have come. */
void window_system_poll(void);

/* Waits until an event comes, or a signal, or the time is over; at most 0.1 seconds, since not every event is
 * noticed. Handles nothing. Returns whether window_system_wake() was called since the last time. */
bool window_system_wait(double seconds);
void window_system_wake(void); /* for any thread */

#endif
