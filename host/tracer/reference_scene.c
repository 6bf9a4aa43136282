#include "tracer/reference_scene.h"

#include <unistd.h>

int reference_threads(unsigned threads)
{
    return threads ? (int)threads : (int)sysconf(_SC_NPROCESSORS_ONLN);
}

enum status reference_scene_create(const struct packed_scene *packed, unsigned threads,
                                   struct reference_scene *scene)
{
    const int many = packed->sphere_count - packed->looped_spheres;
    *scene = (struct reference_scene){.packed = *packed};
    if (many <= 0 || packed->tree)
        return STATUS_DONE;
    scene->built = sphere_tree_create(packed->spheres, packed->looped_spheres, packed->sphere_count,
                                      reference_threads(threads));
    scene->packed.tree = scene->built;
    if (scene->built)
        return STATUS_DONE;
    log_error("no memory for the reference's tree of %d spheres", many);
    *scene = (struct reference_scene){.built = NULL};
    return STATUS_UNABLE;
}

void reference_scene_destroy(struct reference_scene *scene)
{
    sphere_tree_destroy(&scene->built);
    *scene = (struct reference_scene){.built = NULL};
}
