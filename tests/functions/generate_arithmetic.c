/* Operands and seeds. */
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

/* A normal number with so large an exponent, its digits random or few. */
static float random_operand(struct random *random, int largest_exponent)
{
    double significand = random_between(random, 1, 2);
    if (one_in(random, 4))
        significand = random_bool(random) ? 1 : 1 + (double)random_below(random, 64) / 64;
    significand *= random_sign(random);
    int exponent = (int)random_below(random, 2 * (unsigned)largest_exponent) - largest_exponent;
    float operand = (float)ldexp(significand, exponent);
    return one_in(random, 4) ? random_neighbour(random, operand) : operand;
}

/* The quotient is a normal number or 0. */
void generate_divide(struct random *random, divide_input *input)
{
    float dividend = random_operand(random, 62);
    float divisor = random_operand(random, 62);
    switch (random_below(random, 8)) {
    case 0:
        dividend = 0;
        break;
    case 1: /* about 1 */
        divisor = random_neighbour(random, dividend);
        break;
    case 2:
        dividend = 1;
        break;
    case 3: { /* the quotient is close to the middle between two floats */
        double middle = (double)random_operand(random, 30) * (1 + 0x1p-24);
        divisor = random_operand(random, 30);
        dividend = round_number((double)divisor * middle);
        break;
    }
    default:
        break;
    }
    *input = (divide_input){dividend, divisor};
}

void generate_root(struct random *random, root_input *input)
{
    float square = fabsf(random_operand(random, 120));
    switch (random_below(random, 8)) {
    case 0: /* a square but for rounding */
        square = fabsf(random_operand(random, 60));
        square = random_neighbour(random, square * square);
        break;
    case 1: { /* the root is close to the middle between two floats */
        double root = fabs((double)random_operand(random, 60)) * (1 + 0x1p-24);
        square = round_number(root * root);
        break;
    }
    case 2:
        square = 0;
        break;
    default:
        break;
    }
    input->square = square;
}

void generate_unit(struct random *random, unit_input *input)
{
    struct dvec3 direction = one_in(random, 8) ? random_axis(random) : random_direction(random);
    if (one_in(random, 8))
        direction.y *= random_scale(random, 1e-12, 1);
    input->vector = round_vector(dvec3_scale(random_scale(random, 1e-6, 1e6), direction));
}

void generate_hash(struct random *random, hash_input *input)
{
    input->number = random_word(random);
}

void generate_sobol_point(struct random *random, sobol_point_input *input)
{
    input->seed = random_word(random);
    input->index = random_word(random);
}
