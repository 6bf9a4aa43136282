#ifndef VKWHITTED_TRACER_REFERENCE_SCENE_H
#define VKWHITTED_TRACER_REFERENCE_SCENE_H

#include "base/status.h"
#include "sphere_tree.h"

/* A packed scene as the reference wants it: with a tree of the spheres that are not looped over. */
struct reference_scene {
    struct packed_scene packed; /* shares all it points to with the one it is made of */
    struct sphere_tree *built;  /* NULL: there are no such spheres, or a tree was there */
};

/* On so many threads; 0: one a processor. On STATUS_DONE the caller frees it with reference_scene_destroy();
 * otherwise it is empty: STATUS_UNABLE (reported) without memory. */
enum status reference_scene_create(const struct packed_scene *packed, unsigned threads,
                                   struct reference_scene *scene);
void reference_scene_destroy(struct reference_scene *scene);

/* As many threads as are asked for; 0: one a processor. */
int reference_threads(unsigned threads);

#endif
