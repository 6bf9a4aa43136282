#ifndef VKWHITTED_XVFB_H
#define VKWHITTED_XVFB_H

#include <fcntl.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

/* An X server with a screen in memory, on a display of its own, which is DISPLAY from then on. */

/* The server's process; it ends with this one. -1: it did not start. */
static inline pid_t xvfb_start(void)
{
    int ends[2];
    if (pipe(ends) != 0)
        return -1;
    pid_t parent = getpid(), server = fork();
    if (server == 0) {
        char number[16];
        int nowhere = open("/dev/null", O_WRONLY);
        snprintf(number, sizeof number, "%d", ends[1]);
        close(ends[0]);
        dup2(nowhere, STDOUT_FILENO);
        dup2(nowhere, STDERR_FILENO);
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        if (getppid() == parent)
            execlp("Xvfb", "Xvfb", "-displayfd", number, "-screen", "0", "3200x2400x24", "-nolisten", "tcp",
                   "-noreset", (char *)NULL);
        _exit(127);
    }
    close(ends[1]);
    char name[16] = ":";
    ssize_t length = 0, got;
    while ((got = read(ends[0], name + 1 + length, sizeof name - 2 - (size_t)length)) > 0) {
        length += got;
        if (name[length] == '\n')
            break;
    }
    close(ends[0]);
    if (length < 2)
        return -1;
    name[length] = '\0';
    /* some versions of GLFW try Wayland first */
    bool set = setenv("DISPLAY", name, 1) == 0 && setenv("XDG_RUNTIME_DIR", "/tmp", 1) == 0 &&
               unsetenv("WAYLAND_DISPLAY") == 0 && unsetenv("XDG_SESSION_TYPE") == 0;
    return set ? server : -1;
}

static inline void xvfb_kill(pid_t server)
{
    if (server > 0) {
        kill(server, SIGKILL);
        waitpid(server, NULL, 0);
    }
}

#endif
