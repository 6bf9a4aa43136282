#include "watch/window_system.h"

#include <dlfcn.h>
#include <math.h>
#include <poll.h>
#include <setjmp.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdint.h>
#include <sys/eventfd.h>
#include <unistd.h>

#define GLFW_INCLUDE_VULKAN
#include <GLFW/glfw3.h>

static atomic_bool lost;
static int wake_fd = -1, connection_fd = -1;
static _Thread_local jmp_buf *recovery; /* of the running call */

/* In place of libX11's, which prints a message. Where it returns, libX11 ends the process; and kept from that
 * with XSetIOErrorExitHandler(), it crashes in the next request. So the running call must not go on. */
static int on_io_error(void *x_display)
{
    (void)x_display;
    lost = true;
    if (recovery)
        longjmp(*recovery, 1);
    return 0;
}

bool window_system_lost(void)
{
    struct pollfd connection = {.fd = connection_fd, .events = POLLRDHUP};
    if (connection_fd >= 0 && poll(&connection, 1, 0) > 0)
        lost = true;
    return lost;
}

/* libX11 is GLFW's affair, and a GLFW for Wayland has none: its functions are looked up, not linked. */
static void prepare_x11(void)
{
    void *(*get_display)(void);
    int (*connection_number)(void *display);
    void (*set_io_error_handler)(int (*handler)(void *display));

    void *x11 = dlopen("libX11.so.6", RTLD_LAZY | RTLD_NOLOAD);
    if (!x11)
        return;
    *(void **)&get_display = dlsym(RTLD_DEFAULT, "glfwGetX11Display");
    *(void **)&connection_number = dlsym(x11, "XConnectionNumber");
    *(void **)&set_io_error_handler = dlsym(x11, "XSetIOErrorHandler");
    void *display = get_display ? get_display() : NULL;
    if (display && connection_number && set_io_error_handler) {
        set_io_error_handler(on_io_error);
        connection_fd = connection_number(display);
    }
    dlclose(x11);
}

enum status window_system_open(struct vulkan_options *vulkan)
{
    const char *reason = "the display has gone away";
    if (lost || !glfwInit()) {
        if (!lost && glfwGetError(&reason) == GLFW_NO_ERROR)
            reason = "GLFW has no reason";
        log_error("cannot open a window: %s", reason);
        return STATUS_UNABLE;
    }
    prepare_x11();
    signal(SIGPIPE, SIG_IGN); /* libxcb's writes raise it when the display has just gone away */
    wake_fd = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
    vulkan->instance_extensions = glfwGetRequiredInstanceExtensions(&vulkan->instance_extension_count);
    vulkan->can_present = glfwGetPhysicalDevicePresentationSupport;
    if (wake_fd >= 0 && vulkan->instance_extensions)
        return STATUS_DONE;
    log_error(wake_fd < 0 ? "cannot open a window: no file descriptor is free"
                          : "no Vulkan driver here can show pictures in a window");
    window_system_close();
    return STATUS_UNABLE;
}

static void terminate(void *unused)
{
    (void)unused;
    glfwTerminate();
}

void window_system_close(void)
{
    window_system_call(terminate, NULL);
    if (wake_fd >= 0)
        close(wake_fd);
    wake_fd = connection_fd = -1;
}

bool window_system_call(void (*call)(void *argument), void *argument)
{
    jmp_buf here;
    if (window_system_lost())
        return false;
    if (setjmp(here) == 0) {
        recovery = &here;
        call(argument);
    }
    recovery = NULL;
    return !lost;
}

static void poll_events(void *unused)
{
    (void)unused;
    glfwPollEvents();
}

void window_system_poll(void)
{
    window_system_call(poll_events, NULL);
}

bool window_system_wait(double seconds)
{
    /* The driver's threads read from the connection, too, and what they read is not there to be waited for.
     * Without a connection to wait for there is but the time. */
    double longest_ms = connection_fd >= 0 ? 100 : 10;
    struct pollfd fds[] = {{.fd = connection_fd, .events = POLLIN}, {.fd = wake_fd, .events = POLLIN}};
    poll(fds, sizeof fds / sizeof *fds, (int)ceil(fmin(seconds * 1e3, longest_ms)));
    uint64_t count;
    return read(wake_fd, &count, sizeof count) == sizeof count;
}

void window_system_wake(void)
{
    const uint64_t one = 1;
    ssize_t written = write(wake_fd, &one, sizeof one); /* fails only where 2^64 - 2 others went before */
    (void)written;
}
