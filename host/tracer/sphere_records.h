#ifndef VKWHITTED_TRACER_SPHERE_RECORDS_H
#define VKWHITTED_TRACER_SPHERE_RECORDS_H

#include <stdint.h>

#include "packed_scene.h"

/* What the device has of the spheres that are not looped over: records of four words and single words, laid
 * out as shaders/hierarchy.glsl says. There is room for so many, at least one, whatever the hierarchy over so
 * many spheres. */
uint64_t sphere_record_count(const struct packed_scene *scene);
uint64_t sphere_word_count(const struct packed_scene *scene);

/* Fills the device's memory. */
void sphere_records_write(const struct packed_scene *scene, uint32_t (*records)[4], uint32_t *words);

#endif
