#ifndef VKWHITTED_SCENE_TRUNCATION_H
#define VKWHITTED_SCENE_TRUNCATION_H

#include "packed_scene.h"

/* What a picture lacks of the one with all bounces: rays cut off by max_bounces, and rays left out on
 * purpose. cpu_reference/NUMERICS.md derives the bounds. */

/* Writes the scene's view.truncation and view.between_mirrors for pixels that may differ by max_error from
 * the picture with all bounces; max_error < 0: no ray is left out. The lights, surfaces and samples of the
 * scene are final. */
void truncation_pack(struct packed_scene *scene, double max_error);

/* How far a pixel is from the picture with all bounces at most, both as computed, given the pixel's charges
 * (struct image of the tracer); perhaps INFINITY. */
double truncation_bound(const struct packed_scene *scene, double charges);

#endif
