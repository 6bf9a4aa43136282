#ifndef VKWHITTED_WATCH_CAMERA_MOTION_H
#define VKWHITTED_WATCH_CAMERA_MOTION_H

#include <stdio.h>

#include "scene/scene.h"

/* Moves a camera about the point it looks at, as a pointer dragged across the picture does. Distances in the
 * picture are in picture heights, x to the right and y down; up and the field of view stay.
 *
 * Whatever is asked for, the camera stays one that scene_read() accepts and that float resolves: a motion
 * stops one degree from the poles, and one that would lead to coordinates beyond 1e15, or so far out that
 * they no longer resolve the distance to look_at, is not made. */

/* Turns the camera about look_at, the axis of its azimuth being up; its distance stays. The scene follows the
 * pointer, half a turn a picture height. */
void camera_orbit(struct scene_camera *camera, double x, double y);

/* Shifts position and look_at in the image plane. What lies as far away as look_at follows the pointer. */
void camera_pan(struct scene_camera *camera, double x, double y);

/* Divides the distance to look_at by 1.1 a step; negative steps lead away from it. */
void camera_zoom(struct scene_camera *camera, double steps);

/* Writes the line of a scene file that gives this camera, with the fewest digits that read back to the same
 * doubles. Whether it was written, ferror() tells. */
void camera_print(FILE *stream, const struct scene_camera *camera);

#endif
