/* Vectors and seeds. */
#include "generate.h"

static int random_word(struct random *random)
{
    static const uint32_t edges[] = {0, 1, 2, 0x7fffffff, 0x80000000, 0xffffffff, 0x55555555, 0xaaaaaaaa};
    uint32_t word = (uint32_t)(random_bits(random) >> 32);
    switch (random_below(random, 8)) {
    case 0:
        return (int)edges[random_below(random, sizeof edges / sizeof *edges)];
    case 1:
        return (int)(UINT32_C(1) << (word & 31));
    case 2: /* as sample indices are */
    case 3:
        return (int)(word & 0xffff);
    default:
        return (int)word;
    }
}

void generate_unit(struct random *random, unit_input *input)
{
    struct dvec3 direction = one_in(random, 8) ? random_axis(random) : random_direction(random);
    if (one_in(random, 8))
        direction.y *= random_scale(random, 1e-12, 1);
    input->vector = round_vector(dvec3_scale(random_scale(random, 1e-6, 1e6), direction));
}

void generate_sobol_point(struct random *random, sobol_point_input *input)
{
    input->seed = random_word(random);
    input->index = random_word(random);
}
