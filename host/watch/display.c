#include "watch/display.h"

#include <stdlib.h>
#include <string.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "base/clock.h"
#include "base/interrupt.h"
#include "watch/swapchain.h"
#include "watch/window_system.h"

/* Of one key press: picture heights, zoom steps. */
static const double arrow_step = 1.0 / 32, zoom_key_step = 1;

struct display {
    GLFWwindow *window;
    struct swapchain *swapchain;
    struct rgba_picture picture; /* rgba is NULL before the first */
    bool stale;                  /* the window does not show the picture as it should */
    bool dragging, panning;      /* the left button is down; Shift was, when it went down */
    double pointer_x, pointer_y; /* where it was last */
    bool loss_reported;
    struct display_input input;
};

static bool has_input(const struct display_input *input)
{
    return input->closed || input->resized || input->orbit_x != 0 || input->orbit_y != 0 ||
           input->pan_x != 0 || input->pan_y != 0 || input->zoom != 0 || input->reset ||
           input->print_camera || input->save || input->difference;
}

/* x and y in picture heights. */
static void drag(struct display *display, bool pan, double x, double y)
{
    struct display_input *input = &display->input;
    *(pan ? &input->pan_x : &input->orbit_x) += x;
    *(pan ? &input->pan_y : &input->orbit_y) += y;
}

static void on_close(GLFWwindow *window)
{
    ((struct display *)glfwGetWindowUserPointer(window))->input.closed = true;
}

static void on_framebuffer_size(GLFWwindow *window, int width, int height)
{
    struct display *display = glfwGetWindowUserPointer(window);
    (void)width;
    (void)height;
    display->input.resized = true;
    display->stale = true;
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
    int width, height;
    glfwGetWindowSize(window, &width, &height);
    if (display->dragging && display->picture.rgba && width > 0 && height > 0) {
        unsigned shown_height = fit_picture(&display->picture, (unsigned)width, (unsigned)height).height;
        drag(display, display->panning, (x - display->pointer_x) / shown_height,
             (y - display->pointer_y) / shown_height);
    }
    display->pointer_x = x;
    display->pointer_y = y;
}

static void on_scroll(GLFWwindow *window, double x, double y)
{
    (void)x;
    ((struct display *)glfwGetWindowUserPointer(window))->input.zoom += y;
}

/* The character on a key, or where that is none of ASCII, the one that a US keyboard has there; 0: none. */
static char key_character(int key, int scancode)
{
    const char *name = glfwGetKeyName(key, scancode);
    if (name && name[0] > 0 && name[1] == '\0')
        return name[0] >= 'A' && name[0] <= 'Z' ? (char)(name[0] - 'A' + 'a') : name[0];
    return key >= GLFW_KEY_A && key <= GLFW_KEY_Z ? (char)(key - GLFW_KEY_A + 'a') : '\0';
}

static void on_character_key(struct display_input *input, char character, bool repeated)
{
    switch (character) {
    case '+':
    case '=': /* + with Shift on many keyboards */
        input->zoom += zoom_key_step;
        break;
    case '-':
        input->zoom -= zoom_key_step;
        break;
    case 'r':
        input->reset = true;
        break;
    case 'p':
        input->print_camera = input->print_camera || !repeated;
        break;
    case 's':
        input->save = input->save || !repeated;
        break;
    case 'd':
        input->difference = input->difference != !repeated; /* twice is back again */
        break;
    default:
        break;
    }
}

static void on_key(GLFWwindow *window, int key, int scancode, int action, int mods)
{
    struct display *display = glfwGetWindowUserPointer(window);
    bool pan = mods & GLFW_MOD_SHIFT;
    if (action == GLFW_RELEASE || (mods & (GLFW_MOD_CONTROL | GLFW_MOD_ALT | GLFW_MOD_SUPER)))
        return;
    switch (key) {
    case GLFW_KEY_ESCAPE:
        display->input.closed = true;
        break;
    case GLFW_KEY_LEFT:
        drag(display, pan, -arrow_step, 0);
        break;
    case GLFW_KEY_RIGHT:
        drag(display, pan, arrow_step, 0);
        break;
    case GLFW_KEY_UP:
        drag(display, pan, 0, -arrow_step);
        break;
    case GLFW_KEY_DOWN:
        drag(display, pan, 0, arrow_step);
        break;
    default:
        on_character_key(&display->input, key_character(key, scancode), action == GLFW_REPEAT);
        break;
    }
}

struct window_request {
    struct display *display;
    int width, height;
};

static void create_window_call(void *argument)
{
    struct window_request *request = argument;
    struct display *display = request->display;
    glfwDefaultWindowHints();
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    glfwWindowHintString(GLFW_X11_CLASS_NAME, "vkwhitted");
    glfwWindowHintString(GLFW_X11_INSTANCE_NAME, "vkwhitted");
    display->window = glfwCreateWindow(request->width, request->height, "vkwhitted", NULL, NULL);
    if (!display->window)
        return;
    glfwSetWindowUserPointer(display->window, display);
    glfwSetWindowCloseCallback(display->window, on_close);
    glfwSetFramebufferSizeCallback(display->window, on_framebuffer_size);
    glfwSetWindowRefreshCallback(display->window, on_refresh);
    glfwSetMouseButtonCallback(display->window, on_button);
    glfwSetCursorPosCallback(display->window, on_pointer);
    glfwSetScrollCallback(display->window, on_scroll);
    glfwSetKeyCallback(display->window, on_key);
}

static enum status create_window(struct display *display, unsigned width, unsigned height)
{
    const unsigned most = 16384; /* X11's sizes have 16 bits with sign */
    struct window_request request = {display, (int)(width < most ? width : most),
                                     (int)(height < most ? height : most)};
    if (window_system_call(create_window_call, &request) && !display->window) {
        const char *reason;
        log_error("cannot open a window: %s",
                  glfwGetError(&reason) == GLFW_NO_ERROR ? "GLFW has no reason" : reason);
    }
    return display->window ? STATUS_DONE : STATUS_UNABLE;
}

/* Passes a status on, and reports a display gone away, once. */
static enum status check_loss(struct display *display, enum status status)
{
    if (!window_system_lost())
        return status;
    if (!display->loss_reported)
        log_error("the display has gone away");
    display->loss_reported = true;
    return STATUS_UNABLE;
}

enum status display_create(struct vulkan_context *context, unsigned width, unsigned height,
                           struct display **display)
{
    *display = calloc(1, sizeof **display);
    if (!*display) {
        log_error("no memory for the window");
        return STATUS_UNABLE;
    }
    enum status status = create_window(*display, width, height);
    if (status == STATUS_DONE)
        status = swapchain_create(context, (*display)->window, &(*display)->swapchain);
    status = check_loss(*display, status);
    if (status != STATUS_DONE)
        display_destroy(display);
    return status;
}

/* Brings the window up to date. */
static enum status paint(struct display *display)
{
    enum status status = STATUS_DONE;
    bool shown = false;
    if (display->stale && display->picture.rgba)
        status = swapchain_show(display->swapchain, &display->picture, &shown);
    display->stale = display->stale && !shown;
    return check_loss(display, status);
}

enum status display_show(struct display *display, const unsigned char *rgba, unsigned width, unsigned height)
{
    size_t size = 4 * (size_t)width * height;
    unsigned char *copy = realloc(display->picture.rgba, size);
    if (!copy) {
        log_error("no memory for a picture of %u x %u in the window", width, height);
        return STATUS_UNABLE;
    }
    memcpy(copy, rgba, size);
    display->picture = (struct rgba_picture){width, height, copy};
    display->stale = true;
    return paint(display);
}

struct title_request {
    GLFWwindow *window;
    const char *title;
};

static void set_title(void *argument)
{
    const struct title_request *request = argument;
    glfwSetWindowTitle(request->window, request->title);
}

void display_set_title(struct display *display, const char *title)
{
    window_system_call(set_title, &(struct title_request){display->window, title});
}

enum status display_wait(struct display *display, double seconds, struct display_input *input)
{
    const double end_ms = clock_ms() + seconds * 1e3;
    enum status status;
    bool woken = false, over;
    do {
        window_system_poll();
        status = paint(display);
        double left_ms = end_ms - clock_ms();
        over = woken || status != STATUS_DONE || left_ms <= 0 || has_input(&display->input) ||
               interrupt_requested();
        if (!over)
            woken = window_system_wait(left_ms / 1e3);
    } while (!over);
    *input = display->input;
    display->input = (struct display_input){0};
    return status;
}

void display_wake(void)
{
    window_system_wake();
}

static void destroy_window(void *window)
{
    glfwDestroyWindow(window);
}

void display_destroy(struct display **pointer)
{
    struct display *display = *pointer;
    *pointer = NULL;
    if (!display)
        return;
    swapchain_destroy(&display->swapchain);
    if (display->window)
        window_system_call(destroy_window, display->window);
    free(display->picture.rgba);
    free(display);
}
