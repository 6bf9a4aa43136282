/* pack_scenes FILE WxH SCENE...: packs the scenes at this size, with 4 samples a quad light and 8 bounces,
 * into the file. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/pack.h"
#include "scene_bytes.h"

static bool write_all(FILE *file, const void *items, size_t size, int count)
{
    return fwrite(items, size, (size_t)count, file) == (size_t)count;
}

static bool write_scene(FILE *file, const char *path, const struct packed_scene *packed)
{
    struct scene_bytes bytes = {.scene = *packed};
    const char *slash = strrchr(path, '/');
    snprintf(bytes.name, sizeof bytes.name, "%s", slash ? slash + 1 : path);
    return write_all(file, &bytes, sizeof bytes, 1) &&
           write_all(file, packed->spheres, sizeof *packed->spheres, packed->sphere_count) &&
           write_all(file, packed->surfaces, sizeof *packed->surfaces, packed->surface_count) &&
           write_all(file, packed->planes, sizeof *packed->planes, packed->plane_count) &&
           write_all(file, packed->point_lights, sizeof *packed->point_lights, packed->point_light_count) &&
           write_all(file, packed->quad_lights, sizeof *packed->quad_lights, packed->quad_light_count);
}

static bool pack(FILE *file, const char *path, struct picture_settings settings)
{
    struct scene scene;
    struct packed_scene packed;
    if (scene_read(path, &scene) != STATUS_DONE)
        return false;
    bool packs = pack_scene(NULL, &scene, &settings, &packed) == STATUS_DONE;
    bool written = packs && write_scene(file, path, &packed);
    if (packs)
        pack_destroy(&packed);
    scene_destroy(&scene);
    return written;
}

int main(int count, char **arguments)
{
    struct picture_settings settings = {.max_bounces = 8, .samples = 1, .light_samples = 4};
    FILE *file = count > 3 ? fopen(arguments[1], "wb") : NULL;
    if (!file || sscanf(arguments[2], "%ux%u", &settings.width, &settings.height) != 2)
        return EXIT_FAILURE;
    bool written = true;
    for (int i = 3; i < count && written; ++i)
        written = pack(file, arguments[i], settings);
    return fclose(file) == 0 && written ? EXIT_SUCCESS : EXIT_FAILURE;
}
