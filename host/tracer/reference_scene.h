#ifndef VKWHITTED_TRACER_REFERENCE_SCENE_H
#define VKWHITTED_TRACER_REFERENCE_SCENE_H

#include "base/status.h"
#include "packed_scene.h"

/* The packed scene as the reference wants it: with a tree of the spheres that are not looped over. The tree
 * is built where it is first wanted, on so many threads (0: one a processor), and belongs to the scene's
 * hierarchy, and the copy shares everything with the scene. STATUS_UNABLE (reported) without memory. */
enum status reference_scene(const struct packed_scene *packed, unsigned threads, struct packed_scene *scene);

/* As many threads as are asked for; 0: one a processor. */
int reference_threads(unsigned threads);

#endif
