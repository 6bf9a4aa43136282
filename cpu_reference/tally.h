/* What is counted and noted on the way of a pixel. */
#ifndef REFERENCE_TALLY_H
#define REFERENCE_TALLY_H

#include "reference.h"
#include "sobol.h"

struct tally {
    struct reference_rays rays;
    uint32_t signature; /* hash of every decision of the ray tree */
};

static inline void note(struct tally *tally, uint32_t decision)
{
    tally->signature = hash32(tally->signature + decision);
}

#endif
