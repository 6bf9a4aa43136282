#include "watch/display.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <GLFW/glfw3.h>

struct display {
    GLFWwindow *window;
    struct extent picture;       /* its size; 0 before the first */
    unsigned char *rgb;          /* the picture */
    bool stale;                  /* the window does not show the picture as it should */
    bool dragging, panning;      /* the left button is down; Shift was, when it went down */
    double pointer_x, pointer_y; /* where it was last */
    struct display_input input;
    char title[1024];
};

/* a b / c, rounded to nearest, at least 1. */
static unsigned scale(unsigned a, unsigned b, unsigned c)
{
    unsigned scaled = (unsigned)(((uint64_t)a * b + c / 2) / c);
    return scaled > 0 ? scaled : 1;
}

struct area fit_picture(struct extent picture, struct extent window)
{
    struct extent fit = window;
    if (window.width == 0 || window.height == 0)
        return (struct area){0};
    if ((uint64_t)window.width * picture.height <= (uint64_t)window.height * picture.width)
        fit.height = scale(picture.height, window.width, picture.width);
    else
        fit.width = scale(picture.width, window.height, picture.height);
    return (struct area){(window.width - fit.width) / 2, (window.height - fit.height) / 2, fit.width,
                         fit.height};
}

static void on_framebuffer_size(GLFWwindow *window, int width, int height)
{
    (void)width;
    (void)height;
    ((struct display *)glfwGetWindowUserPointer(window))->stale = true;
}

static void on_refresh(GLFWwindow *window)
{
    ((struct display *)glfwGetWindowUserPointer(window))->stale = true;
}

static void on_button(GLFWwindow *window, int button, int action, int mods)
{
    struct display *display = glfwGetWindowUserPointer(window);
    if (button != GLFW_MOUSE_BUTTON_LEFT)
        return;
    display->dragging = action == GLFW_PRESS;
    display->panning = mods & GLFW_MOD_SHIFT;
}

static void on_pointer(GLFWwindow *window, double x, double y)
{
    struct display *display = glfwGetWindowUserPointer(window);
    struct display_input *input = &display->input;
    int width, height;
    glfwGetWindowSize(window, &width, &height);
    if (display->dragging && display->picture.width > 0 && width > 0 && height > 0) {
        unsigned shown_height =
            fit_picture(display->picture, (struct extent){(unsigned)width, (unsigned)height}).height;
        *(display->panning ? &input->pan_x : &input->orbit_x) += (x - display->pointer_x) / shown_height;
        *(display->panning ? &input->pan_y : &input->orbit_y) += (y - display->pointer_y) / shown_height;
    }
    display->pointer_x = x;
    display->pointer_y = y;
}

static void on_scroll(GLFWwindow *window, double x, double y)
{
    (void)x;
    ((struct display *)glfwGetWindowUserPointer(window))->input.zoom += y;
}

/* The character on a key, or where that is none of ASCII, GLFW's number for it: of a letter key, the letter
 * that a US keyboard has there. */
static int key_code(int key, int scancode)
{
    const char *name = glfwGetKeyName(key, scancode);
    int code = name && name[0] > 0 && name[1] == 0 ? name[0] : key;
    return code >= 'A' && code <= 'Z' ? code - 'A' + 'a' : code;
}

static void on_key(GLFWwindow *window, int key, int scancode, int action, int mods)
{
    struct display_input *input = &((struct display *)glfwGetWindowUserPointer(window))->input;
    if (action != GLFW_PRESS || (mods & (GLFW_MOD_CONTROL | GLFW_MOD_ALT | GLFW_MOD_SUPER)))
        return;
    int code = key_code(key, scancode);
    if (code == GLFW_KEY_ESCAPE)
        glfwSetWindowShouldClose(window, GLFW_TRUE);
    input->reset |= code == 'r';
    input->print_camera |= code == 'p';
    input->save |= code == 's';
    input->difference ^= code == 'd'; /* twice is back again */
}

static const char *glfw_reason(void)
{
    const char *reason;
    return glfwGetError(&reason) == GLFW_NO_ERROR ? "GLFW has no reason" : reason;
}

enum status display_connect(void)
{
    if (!glfwInit()) {
        log_error("cannot open a window: %s", glfw_reason());
        return STATUS_UNABLE;
    }
    signal(SIGPIPE, SIG_IGN); /* it would keep Xlib from saying that the display has gone away */
    return STATUS_DONE;
}

void display_disconnect(void)
{
    glfwTerminate();
}

enum status display_create(unsigned width, unsigned height, struct display **pointer)
{
    const unsigned most = 16384; /* X11's sizes have 16 bits with sign */
    struct display *display = *pointer = calloc(1, sizeof *display);
    if (display)
        display->window = glfwCreateWindow((int)(width < most ? width : most),
                                           (int)(height < most ? height : most), "vkwhitted", NULL, NULL);
    if (!display || !display->window) {
        log_error("cannot open a window: %s", display ? glfw_reason() : "no memory");
        display_destroy(pointer);
        return STATUS_UNABLE;
    }
    glfwMakeContextCurrent(display->window);
    glfwSetWindowUserPointer(display->window, display);
    glfwSetFramebufferSizeCallback(display->window, on_framebuffer_size);
    glfwSetWindowRefreshCallback(display->window, on_refresh);
    glfwSetMouseButtonCallback(display->window, on_button);
    glfwSetCursorPosCallback(display->window, on_pointer);
    glfwSetScrollCallback(display->window, on_scroll);
    glfwSetKeyCallback(display->window, on_key);
    return STATUS_DONE;
}

void display_destroy(struct display **pointer)
{
    struct display *display = *pointer;
    *pointer = NULL;
    if (!display)
        return;
    glfwDestroyWindow(display->window);
    free(display->rgb);
    free(display);
}

unsigned char *display_picture(struct display *display, unsigned width, unsigned height)
{
    GLint most;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
    free(display->rgb);
    display->rgb = NULL;
    if (width > (unsigned)most || height > (unsigned)most)
        log_error("a window shows pictures of up to %dx%d pixels, not %ux%u", most, most, width, height);
    else if (!(display->rgb = malloc((size_t)width * height * 3)))
        log_error("no memory for the picture in the window");
    display->picture = display->rgb ? (struct extent){width, height} : (struct extent){0};
    display->stale = true;
    return display->rgb;
}

enum status display_paint(struct display *display)
{
    static const float corners[] = {
        /* s t, x y z */ 0, 0, -1, 1, 0, 1, 0, 1, 1, 0, 1, 1, 1, -1, 0, 0, 1, -1, -1, 0};
    const struct extent picture = display->picture;
    int width, height;
    if (picture.width == 0)
        return STATUS_DONE;
    glfwGetFramebufferSize(display->window, &width, &height);
    const struct area fit = fit_picture(picture, (struct extent){(unsigned)width, (unsigned)height});
    int filter = fit.width >= picture.width && fit.height >= picture.height ? GL_NEAREST : GL_LINEAR;
    display->stale = fit.width == 0;
    if (display->stale)
        return STATUS_DONE;
    glClear(GL_COLOR_BUFFER_BIT);
    glViewport((int)fit.x, height - (int)(fit.y + fit.height), (int)fit.width, (int)fit.height);
    glEnable(GL_TEXTURE_2D);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, (int)picture.width, (int)picture.height, 0, GL_RGB,
                 GL_UNSIGNED_BYTE, display->rgb);
    glInterleavedArrays(GL_T2F_V3F, 0, corners);
    glDrawArrays(GL_QUADS, 0, 4);
    glfwSwapBuffers(display->window);
    GLenum error = glGetError();
    if (error == GL_NO_ERROR)
        return STATUS_DONE;
    log_error("showing a picture: OpenGL error 0x%x", error);
    return STATUS_UNABLE;
}

enum status display_wait(struct display *display, double seconds, struct display_input *input)
{
    enum status status = STATUS_DONE;
    if (seconds > 0)
        glfwWaitEventsTimeout(seconds);
    else
        glfwPollEvents();
    if (display->stale && display->picture.width > 0)
        status = display_paint(display);
    *input = display->input;
    input->closed = glfwWindowShouldClose(display->window);
    display->input = (struct display_input){0};
    glfwSetWindowShouldClose(display->window, GLFW_FALSE);
    return status;
}

void display_set_title(struct display *display, const char *title)
{
    if (strcmp(title, display->title) == 0)
        return;
    snprintf(display->title, sizeof display->title, "%s", title);
    glfwSetWindowTitle(display->window, title);
}
