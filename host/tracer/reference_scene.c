#include "tracer/reference_scene.h"

#include <unistd.h>

#include "base/progress.h"
#include "scene/hierarchy.h"
#include "sphere_tree.h"

int reference_threads(unsigned threads)
{
    return threads ? (int)threads : (int)sysconf(_SC_NPROCESSORS_ONLN);
}

static void advance(void *progress, uint32_t spheres)
{
    progress_advance(progress, spheres);
}

static struct sphere_tree *build_tree(const struct packed_scene *packed, unsigned threads)
{
    struct progress progress;
    progress_start(&progress, "reference's tree", (uint64_t)(packed->sphere_count - packed->looped_spheres),
                   false);
    struct sphere_tree *tree =
        sphere_tree_create(packed->spheres, packed->looped_spheres, packed->sphere_count,
                           reference_threads(threads), advance, &progress);
    progress_end(&progress);
    return tree;
}

enum status reference_scene(const struct packed_scene *packed, unsigned threads, struct packed_scene *scene)
{
    struct hierarchy *hierarchy = packed->hierarchy;
    *scene = *packed;
    if (!hierarchy)
        return STATUS_DONE;
    if (!hierarchy->tree)
        hierarchy->tree = build_tree(packed, threads);
    scene->tree = hierarchy->tree;
    if (scene->tree)
        return STATUS_DONE;
    log_error("no memory for the reference's tree of %d spheres",
              packed->sphere_count - packed->looped_spheres);
    return STATUS_UNABLE;
}
