/* Makes the arrays of spheres that scenes name: make_spheres KIND NUMBER > FILE.npy
 *
 * A NumPy array of shape (N, 4): x, y, z, radius in metres, float32, little endian. Only square roots and
 * what is rounded once are used, so that everybody makes the same bytes. */
#include <errno.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct vector {
    double x, y, z;
};

static uint64_t random_state;

/* Within [0, 1), in steps of 2^-24; SplitMix64 (Steele, Lea and Flood, "Fast Splittable Pseudorandom Number
 * Generators", 2014). */
static double uniform(void)
{
    uint64_t bits = random_state += UINT64_C(0x9e3779b97f4a7c15);
    bits = (bits ^ bits >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    bits = (bits ^ bits >> 27) * UINT64_C(0x94d049bb133111eb);
    return (double)((bits ^ bits >> 31) >> 40) * 0x1p-24;
}

static double between(double least, double most)
{
    return least + (most - least) * uniform();
}

static struct vector in_cube(double half_side)
{
    struct vector v;
    v.x = between(-half_side, half_side); /* one after the other: the order of arguments is not fixed */
    v.y = between(-half_side, half_side);
    v.z = between(-half_side, half_side);
    return v;
}

/* Uniform on the sphere: what lies in a cube and not in a ball is drawn again. */
static struct vector direction(void)
{
    struct vector v;
    double squared;
    do {
        v = in_cube(1);
        squared = v.x * v.x + v.y * v.y + v.z * v.z;
    } while (squared > 1 || squared < 0.01);
    double length = sqrt(squared);
    return (struct vector){v.x / length, v.y / length, v.z / length};
}

static void put_float(double value)
{
    float single = (float)value;
    uint32_t bits;
    memcpy(&bits, &single, sizeof bits);
    for (int i = 0; i < 4; ++i)
        putchar((int)(bits >> 8 * i & 0xFF));
}

static void put_sphere(struct vector center, double radius)
{
    put_float(center.x);
    put_float(center.y);
    put_float(center.z);
    put_float(radius);
}

/* Format version 1.0, filled up to 128 bytes as NumPy does. */
static void put_header(unsigned long count)
{
    char dictionary[119];
    int length = snprintf(dictionary, sizeof dictionary,
                          "{'descr': '<f4', 'fortran_order': False, 'shape': (%lu, 4), }", count);
    fwrite("\x93NUMPY\1\0\x76\0", 1, 10, stdout);
    printf("%s%*s\n", dictionary, 117 - length, "");
}

static struct vector turn_about_z(struct vector v, double cosine, double sine)
{
    return (struct vector){cosine * v.x - sine * v.y, sine * v.x + cosine * v.y, v.z};
}

/* By the shortest way from +z to the axis. */
static struct vector turn_from_z(struct vector v, struct vector axis)
{
    if (axis.z <= -1)
        return (struct vector){-v.x, v.y, -v.z};
    double across = (axis.x * v.y - axis.y * v.x) / (1 + axis.z);
    return (struct vector){axis.z * v.x + axis.x * v.z - axis.y * across,
                           axis.z * v.y + axis.y * v.z + axis.x * across,
                           axis.z * v.z - axis.x * v.x - axis.y * v.y};
}

/* "Balls" of Eric Haines' Standard Procedural Databases ("A Proposal for Standard Graphics Environments",
 * IEEE Computer Graphics and Applications 7(11), 1987): nine spheres of a third of the radius touch their
 * parent, six around its equator and three above, as seen from where it touches its own. */
static void put_flake(struct vector center, double radius, struct vector axis, unsigned long level)
{
    const double up = sqrt(2.0 / 3), out = sqrt(1.0 / 6), far = (sqrt(6) + sqrt(2)) / 4,
                 near = (sqrt(6) - sqrt(2)) / 4, sine = sqrt(3) / 2;
    const struct vector trio[3] = {{out, out, up}, {far, near, 0}, {near, far, 0}};
    put_sphere(center, radius);
    for (int i = 0; i < 9 && level > 0; ++i) {
        struct vector way = trio[i % 3];
        if (i >= 3)
            way = turn_about_z(way, -0.5, i < 6 ? sine : -sine);
        way = turn_from_z(way, axis);
        const double distance = radius * 4 / 3;
        put_flake((struct vector){center.x + distance * way.x, center.y + distance * way.y,
                                  center.z + distance * way.z},
                  radius / 3, way, level - 1);
    }
}

static void make_flake(unsigned long level)
{
    unsigned long count = 1;
    for (unsigned long i = 0; i < level; ++i)
        count = 9 * count + 1;
    put_header(count);
    put_flake((struct vector){0, 0, 0}, 0.5, (struct vector){0, 0, 1}, level);
}

/* Four in each place of a lattice in which neighbours touch, layer by layer. */
static void make_coincident(unsigned long count)
{
    const unsigned long side = 10, places = (count + 3) / 4;
    put_header(count);
    for (unsigned long i = 0; i < count; ++i) {
        const unsigned long place = i % places;
        put_sphere((struct vector){(double)(place % side) - 4.5, (double)(place / (side * side)) + 0.5,
                                   (double)(place / side % side) - 4.5},
                   0.5);
    }
}

/* Radii over 30 octaves, which are nine decades, each at 8 to 24 radii from the origin. */
static void make_decades(unsigned long count)
{
    put_header(count);
    for (unsigned long i = 0; i < count; ++i) {
        const int exponent = (int)(30 * uniform()) - 15;
        const double radius = ldexp(1 + uniform(), exponent), radii = between(8, 24);
        const struct vector way = direction();
        put_sphere((struct vector){radii * radius * way.x, radii * radius * way.y, radii * radius * way.z},
                   radius);
    }
}

/* All centres at the same height, and all of the same size. */
static void make_plane(unsigned long count)
{
    put_header(count);
    for (unsigned long i = 0; i < count; ++i) {
        struct vector center = in_cube(16);
        center.y = 0.25;
        put_sphere(center, 0.25);
    }
}

static void make_cloud(unsigned long count)
{
    put_header(count);
    for (unsigned long i = 0; i < count; ++i) {
        const struct vector center = in_cube(8);
        put_sphere(center, between(0.125, 0.5));
    }
}

/* On top of a ball of radius 1000 around the origin, which they touch. */
static void make_grains(unsigned long count)
{
    put_header(count);
    for (unsigned long i = 0; i < count; ++i) {
        struct vector way = in_cube(0.03);
        const double radius = ldexp(1 + uniform(), -3);
        way.y = sqrt(1 - way.x * way.x - way.z * way.z);
        put_sphere((struct vector){(1000 + radius) * way.x, (1000 + radius) * way.y, (1000 + radius) * way.z},
                   radius);
    }
}

static const struct {
    const char *name, *number;
    unsigned long most;
    void (*make)(unsigned long number);
} kinds[] = {
    {"flake", "LEVEL", 7, make_flake},
    {"coincident", "COUNT", 16000000, make_coincident},
    {"decades", "COUNT", 16000000, make_decades},
    {"plane", "COUNT", 16000000, make_plane},
    {"cloud", "COUNT", 16000000, make_cloud},
    {"grains", "COUNT", 16000000, make_grains},
};

int main(int count, char **arguments)
{
    for (size_t i = 0; count == 3 && i < sizeof kinds / sizeof *kinds; ++i) {
        char *end;
        errno = 0;
        unsigned long number = strtoul(arguments[2], &end, 10);
        if (strcmp(arguments[1], kinds[i].name) != 0 || *arguments[2] < '0' || *arguments[2] > '9' || *end ||
            errno || number > kinds[i].most)
            continue;
        kinds[i].make(number);
        if (fflush(stdout) == 0 && !ferror(stdout))
            return 0;
        perror("make_spheres");
        return 3;
    }
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; ++i)
        fprintf(stderr, "%s make_spheres %s %s > FILE.npy (%s at most %lu)\n", i == 0 ? "usage:" : "      ",
                kinds[i].name, kinds[i].number, kinds[i].number, kinds[i].most);
    return 2;
}
