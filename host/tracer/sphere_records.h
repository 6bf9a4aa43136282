#ifndef VKWHITTED_TRACER_SPHERE_RECORDS_H
#define VKWHITTED_TRACER_SPHERE_RECORDS_H

#include <stdint.h>

#include "packed_scene.h"

/* What the device has of the spheres that are not looped over: records of four words and single words, laid
 * out as shaders/hierarchy.glsl says. */
struct sphere_records {
    const struct packed_scene *scene; /* with or without such spheres */
    uint32_t pairs, stream;           /* records */
};

struct sphere_records sphere_records_plan(const struct packed_scene *scene);

/* How many there are of both, at least one. */
uint64_t sphere_record_count(const struct sphere_records *records);
uint64_t sphere_word_count(const struct sphere_records *records);

/* Fills the device's memory. */
void sphere_records_write(const struct sphere_records *records, uint32_t (*to_records)[4],
                          uint32_t *to_words);

#endif
