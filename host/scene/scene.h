#ifndef VKWHITTED_SCENE_SCENE_H
#define VKWHITTED_SCENE_SCENE_H

#include <stddef.h>

#include "base/status.h"

/* A scene as the user wrote it: lengths in metres, angles in degrees except roughness (radians),
 * linear RGB. Everything here has passed the checks of scene_read(): finite, in range, consistent. */

/* Where in the file something is written; both from 1. */
struct scene_place {
    int line, column;
};

enum material_type { MATERIAL_MATTE, MATERIAL_MIRROR, MATERIAL_TRANSPARENT };

struct scene_material {
    char *name;
    enum material_type type;
    double color[3];  /* matte */
    double roughness; /* matte: Oren-Nayar's sigma, radians */
    double ior;       /* transparent: index of refraction against vacuum */
};

enum object_type { OBJECT_SPHERE, OBJECT_PLANE, OBJECT_SPHERES };

struct scene_object {
    char *name;
    enum object_type type;
    size_t material; /* index into scene.materials */
    size_t first;    /* the number of its first body */
    union {
        struct {
            double center[3], radius;
        } sphere;
        struct {
            double point[3], normal[3]; /* normal of any length but 0 */
        } plane;
        struct {
            float (*rows)[4]; /* center, radius */
            size_t count;     /* perhaps 0 */
        } spheres;
    };
    struct scene_place place;
};

enum light_type { LIGHT_POINT, LIGHT_QUAD };

struct scene_light {
    enum light_type type;
    double color[3];
    double power;
    union {
        struct {
            double position[3];
        } point;
        struct {
            double corner[3], u[3], v[3];
        } quad;
    };
    struct scene_place place;
};

struct scene_camera {
    double position[3], look_at[3], up[3];
    double fov_y_degrees; /* vertical, in (0, 180) */
};

struct scene {
    char *path; /* as given, for messages */
    struct scene_camera camera;
    unsigned width, height; /* pixels */
    double background[3];
    unsigned max_bounces, light_samples;
    size_t material_count, object_count, light_count;
    size_t body_count; /* bodies are objects, and rows of a file with spheres, in the order of the file */
    struct scene_material *materials;
    struct scene_object *objects;
    struct scene_light *lights;
};

enum {
    SCENE_MAX_SIZE = 65536, /* pixels a side */
    SCENE_MAX_BOUNCES = 1000,
    SCENE_MAX_SAMPLES = 65536,      /* light samples a point, and samples a pixel */
    SCENE_MAX_FILE_SIZE = 16 << 20, /* bytes; a thousand objects take a tenth of one MiB */
    SCENE_MAX_SPHERES = 16000000,   /* in all: 48 bytes each, and what finds them */
};

/* Reads and checks the YAML scene file at path, and the files with spheres that it names. On STATUS_DONE the
 * caller owns *scene and frees it with scene_destroy(). Otherwise *scene is empty, and everything wrong that
 * could be found has been reported on standard error as "path:line:column: error: ..." with the line and a
 * caret: STATUS_REFUSED for a file that is not a scene, STATUS_UNABLE where the machine cannot
 * read it. */
enum status scene_read(const char *path, struct scene *scene);

/* Reports why text_file_read() could not read a scene file; the status that comes of it. */
enum status scene_refuse_file(const char *path, int error);

/* The same as scene_read() for a scene file's content in memory; path is for the messages, for scene->path,
 * and for the folder in which the files with spheres are looked for. */
enum status scene_read_text(const char *path, const char *text, size_t length, struct scene *scene);

/* The paths of the files with spheres that a scene file's content names, whether they and the rest are right
 * or not: "path\0path\0", with a 0 behind the last, to be freed by the caller. NULL: none, or no memory. */
char *scene_list_files(const char *path, const char *text, size_t length);

/* Frees what the scene owns and empties it. An empty scene is fine. */
void scene_destroy(struct scene *scene);

#endif
