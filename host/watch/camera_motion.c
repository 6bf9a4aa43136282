#include "watch/camera_motion.h"

#include "base/number.h"
#include "scene/vector.h"

static const double pi = 3.14159265358979323846;

#define MOST_COORDINATE 1e15 /* what a scene file may say */
#define LEAST_DISTANCE 1e-15 /* metres */
#define ZOOM_STEP 1.1

/* Distance to look_at over the largest coordinate: coordinates of 53 bits give the direction in 24 bits. */
#define LEAST_RESOLVED 0x1p-28

/* The reader refuses a sine of 1e-6 or less between up and the view. */
#define LEAST_POLE_DISTANCE (pi / 180)
#define LEAST_SINE 2e-6

static void store(struct dvec3 v, double out[3])
{
    out[0] = v.x;
    out[1] = v.y;
    out[2] = v.z;
}

static struct dvec3 view_offset(const struct scene_camera *camera)
{
    return dvec3_subtract(dvec3_of(camera->position), dvec3_of(camera->look_at));
}

/* Not so for a camera with a NaN. */
static bool is_valid(const struct scene_camera *camera)
{
    for (int i = 0; i < 3; ++i)
        if (!(fabs(camera->position[i]) <= MOST_COORDINATE && fabs(camera->look_at[i]) <= MOST_COORDINATE))
            return false;
    struct dvec3 offset = view_offset(camera);
    double size = fmax(dvec3_largest(dvec3_of(camera->position)), dvec3_largest(dvec3_of(camera->look_at)));
    if (!(dvec3_length(offset) >= fmax(LEAST_DISTANCE, LEAST_RESOLVED * size)))
        return false;
    struct dvec3 sine = dvec3_cross(dvec3_unit(offset), dvec3_unit(dvec3_of(camera->up)));
    return dvec3_length(sine) >= LEAST_SINE;
}

static void move_to(struct scene_camera *camera, struct dvec3 position, struct dvec3 look_at)
{
    struct scene_camera moved = *camera;
    store(position, moved.position);
    store(look_at, moved.look_at);
    if (is_valid(&moved))
        *camera = moved;
}

void camera_orbit(struct scene_camera *camera, double x, double y)
{
    struct dvec3 look_at = dvec3_of(camera->look_at), up = dvec3_unit(dvec3_of(camera->up));
    struct dvec3 offset = view_offset(camera), outward = dvec3_unit(offset);
    struct dvec3 right = dvec3_unit(dvec3_cross(up, outward)), ahead = dvec3_cross(right, up);

    /* A camera that the scene file puts nearer to a pole is not pushed away from it. */
    double polar = atan2(dvec3_length(dvec3_cross(outward, up)), dvec3_dot(outward, up)),
           least = fmin(polar, LEAST_POLE_DISTANCE), most = fmax(polar, pi - LEAST_POLE_DISTANCE),
           turned = polar - pi * y;
    double new_polar = turned < least ? least : turned > most ? most : turned;
    double azimuth = pi * fmod(-x, 2);
    struct dvec3 level = dvec3_add(dvec3_scale(cos(azimuth), ahead), dvec3_scale(sin(azimuth), right));
    struct dvec3 direction = dvec3_add(dvec3_scale(sin(new_polar), level), dvec3_scale(cos(new_polar), up));
    move_to(camera, dvec3_add(look_at, dvec3_scale(dvec3_length(offset), dvec3_unit(direction))), look_at);
}

void camera_pan(struct scene_camera *camera, double x, double y)
{
    struct dvec3 offset = view_offset(camera), outward = dvec3_unit(offset);
    struct dvec3 right = dvec3_unit(dvec3_cross(dvec3_unit(dvec3_of(camera->up)), outward));
    struct dvec3 picture_up = dvec3_cross(outward, right);
    double picture_height = 2 * dvec3_length(offset) * tan(camera->fov_y_degrees / 180 * pi / 2);
    struct dvec3 shift =
        dvec3_add(dvec3_scale(-x * picture_height, right), dvec3_scale(y * picture_height, picture_up));
    move_to(camera, dvec3_add(dvec3_of(camera->position), shift),
            dvec3_add(dvec3_of(camera->look_at), shift));
}

void camera_zoom(struct scene_camera *camera, double steps)
{
    struct dvec3 look_at = dvec3_of(camera->look_at), offset = view_offset(camera);
    double distance = dvec3_length(offset) * pow(ZOOM_STEP, -steps);
    move_to(camera, dvec3_add(look_at, dvec3_scale(distance, dvec3_unit(offset))), look_at);
}

static void print_vector(FILE *stream, const char *key, const double v[3])
{
    char x[NUMBER_TEXT], y[NUMBER_TEXT], z[NUMBER_TEXT];
    fprintf(stream, "%s: [%s, %s, %s], ", key, format_double(v[0], x), format_double(v[1], y),
            format_double(v[2], z));
}

void camera_print(FILE *stream, const struct scene_camera *camera)
{
    char fov_y[NUMBER_TEXT];
    fputs("camera: { ", stream);
    print_vector(stream, "position", camera->position);
    print_vector(stream, "look_at", camera->look_at);
    print_vector(stream, "up", camera->up);
    fprintf(stream, "fov_y: %s }\n", format_double(camera->fov_y_degrees, fov_y));
}
