#include "watch/display.h"

#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define GLFW_INCLUDE_VULKAN
#include <GLFW/glfw3.h>

#include "base/clock.h"
#include "base/interrupt.h"
#include "watch/swapchain.h"

/* Of one key press: picture heights, zoom steps. */
static const double arrow_step = 1.0 / 32, zoom_key_step = 1;

struct display {
    GLFWwindow *window;
    struct swapchain *swapchain;
    VkExtent2D picture;          /* its size; 0 before the first */
    bool stale;                  /* the window does not show the picture as it should */
    bool dragging, panning;      /* the left button is down; Shift was, when it went down */
    double pointer_x, pointer_y; /* where it was last */
    struct display_input input;
    bool has_input;
    char title[1024];
};

/* x and y in picture heights. */
static void drag(struct display *display, bool pan, double x, double y)
{
    struct display_input *input = &display->input;
    display->has_input = true;
    *(pan ? &input->pan_x : &input->orbit_x) += x;
    *(pan ? &input->pan_y : &input->orbit_y) += y;
}

static void on_framebuffer_size(GLFWwindow *window, int width, int height)
{
    struct display *display = glfwGetWindowUserPointer(window);
    (void)width;
    (void)height;
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
    if (display->dragging && display->picture.width > 0 && width > 0 && height > 0) {
        unsigned shown_height =
            fit_picture(display->picture, (VkExtent2D){(uint32_t)width, (uint32_t)height}).extent.height;
        drag(display, display->panning, (x - display->pointer_x) / shown_height,
             (y - display->pointer_y) / shown_height);
    }
    display->pointer_x = x;
    display->pointer_y = y;
}

static void on_scroll(GLFWwindow *window, double x, double y)
{
    (void)x;
    struct display *display = glfwGetWindowUserPointer(window);
    display->input.zoom += y;
    display->has_input = true;
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
    struct display *display = glfwGetWindowUserPointer(window);
    struct display_input *input = &display->input;
    bool pan = mods & GLFW_MOD_SHIFT, pressed = action == GLFW_PRESS;
    if (action == GLFW_RELEASE || (mods & (GLFW_MOD_CONTROL | GLFW_MOD_ALT | GLFW_MOD_SUPER)))
        return;
    int code = key_code(key, scancode);
    display->has_input = true;
    if (code == GLFW_KEY_LEFT || code == GLFW_KEY_RIGHT)
        drag(display, pan, code == GLFW_KEY_LEFT ? -arrow_step : arrow_step, 0);
    if (code == GLFW_KEY_UP || code == GLFW_KEY_DOWN)
        drag(display, pan, 0, code == GLFW_KEY_UP ? -arrow_step : arrow_step);
    if (code == '-' || code == '+' || code == '=') /* + with Shift on many keyboards */
        input->zoom += code == '-' ? -zoom_key_step : zoom_key_step;
    if (code == GLFW_KEY_ESCAPE)
        glfwSetWindowShouldClose(window, GLFW_TRUE);
    input->reset |= code == 'r';
    input->print_camera |= code == 'p' && pressed;
    input->save |= code == 's' && pressed;
    input->difference ^= code == 'd' && pressed; /* twice is back again */
}

static const char *glfw_reason(void)
{
    const char *reason;
    return glfwGetError(&reason) == GLFW_NO_ERROR ? "GLFW has no reason" : reason;
}

/* Whether the family of queues can scale a picture and show it. */
static int can_present(VkInstance instance, VkPhysicalDevice device, uint32_t family)
{
    VkQueueFamilyProperties families[16];
    uint32_t count = sizeof families / sizeof *families;
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families);
    return family < count && (families[family].queueFlags & VK_QUEUE_GRAPHICS_BIT) &&
           glfwGetPhysicalDevicePresentationSupport(instance, device, family);
}

enum status display_connect(struct vulkan_options *vulkan)
{
    if (!glfwInit()) {
        log_error("cannot open a window: %s", glfw_reason());
        return STATUS_UNABLE;
    }
    signal(SIGPIPE, SIG_IGN); /* it would keep Xlib from saying that the display has gone away */
    vulkan->instance_extensions = glfwGetRequiredInstanceExtensions(&vulkan->instance_extension_count);
    vulkan->can_present = can_present;
    if (vulkan->instance_extensions)
        return STATUS_DONE;
    log_error("no Vulkan driver here can show pictures in a window");
    glfwTerminate();
    return STATUS_UNABLE;
}

void display_disconnect(void)
{
    glfwTerminate();
}

static enum status create_window(struct display *display, unsigned width, unsigned height)
{
    const unsigned most = 16384; /* X11's sizes have 16 bits with sign */
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    glfwWindowHintString(GLFW_X11_CLASS_NAME, "vkwhitted");
    glfwWindowHintString(GLFW_X11_INSTANCE_NAME, "vkwhitted");
    display->window = glfwCreateWindow((int)(width < most ? width : most),
                                       (int)(height < most ? height : most), "vkwhitted", NULL, NULL);
    if (!display->window) {
        log_error("cannot open a window: %s", glfw_reason());
        return STATUS_UNABLE;
    }
    glfwSetWindowUserPointer(display->window, display);
    glfwSetFramebufferSizeCallback(display->window, on_framebuffer_size);
    glfwSetWindowRefreshCallback(display->window, on_refresh);
    glfwSetMouseButtonCallback(display->window, on_button);
    glfwSetCursorPosCallback(display->window, on_pointer);
    glfwSetScrollCallback(display->window, on_scroll);
    glfwSetKeyCallback(display->window, on_key);
    return STATUS_DONE;
}

enum status display_create(struct vulkan_context *context, unsigned width, unsigned height,
                           struct display **pointer)
{
    struct display *display = *pointer = calloc(1, sizeof *display);
    if (!display) {
        log_error("no memory for the window");
        return STATUS_UNABLE;
    }
    enum status status = create_window(display, width, height);
    if (status == STATUS_DONE)
        status = swapchain_create(context, display->window, &display->swapchain);
    if (status != STATUS_DONE)
        display_destroy(pointer);
    return status;
}

void display_destroy(struct display **pointer)
{
    struct display *display = *pointer;
    *pointer = NULL;
    if (!display)
        return;
    swapchain_destroy(&display->swapchain);
    if (display->window)
        glfwDestroyWindow(display->window);
    free(display);
}

unsigned char *display_picture(struct display *display, unsigned width, unsigned height)
{
    unsigned char *rgba = swapchain_picture(display->swapchain, width, height);
    display->picture = rgba ? (VkExtent2D){width, height} : (VkExtent2D){0};
    display->stale = true;
    return rgba;
}

enum status display_paint(struct display *display)
{
    bool shown;
    enum status status = swapchain_show(display->swapchain, &shown);
    display->stale = !shown;
    return status;
}

enum status display_wait(struct display *display, double seconds, struct display_input *input)
{
    const double longest_wait = 0.1; /* the driver may have read from the connection what GLFW waits for */
    const double end_ms = clock_ms() + seconds * 1e3;
    enum status status = STATUS_DONE;
    for (;;) {
        glfwPollEvents();
        if (display->stale && display->picture.width > 0)
            status = display_paint(display);
        double left = (end_ms - clock_ms()) / 1e3;
        display->input.closed = glfwWindowShouldClose(display->window);
        if (status != STATUS_DONE || left <= 0 || display->has_input || display->input.closed ||
            interrupt_requested())
            break;
        glfwWaitEventsTimeout(fmin(left, longest_wait));
    }
    *input = display->input;
    display->input = (struct display_input){0};
    display->has_input = false;
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
