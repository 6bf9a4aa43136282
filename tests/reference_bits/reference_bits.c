/* reference_bits FILE: a hash of all that the reference makes of each packed scene in the file, at each
 * precision: radiance, path signatures and counted rays, and of the error analysis. No libraries but libc and
 * libm, so that it is easily built elsewhere. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "reference.h"
#include "scene_bytes.h"

/* FNV-1a over bytes; both architectures are little-endian. */
static uint64_t hash_bytes(uint64_t hash, const void *bytes, size_t size)
{
    for (const unsigned char *byte = bytes, *end = byte + size; byte != end; ++byte)
        hash = (hash ^ *byte) * UINT64_C(0x100000001b3);
    return hash;
}

static const uint64_t hash_start = UINT64_C(0xcbf29ce484222325);

static void *read_items(FILE *file, size_t size, int count)
{
    void *items = calloc((size_t)count + 1, size);
    if (!items || fread(items, size, (size_t)count, file) != (size_t)count) {
        fputs("reference_bits: the scenes cannot be read\n", stderr);
        exit(EXIT_FAILURE);
    }
    return items;
}

static void print_picture(const char *name, const char *precision, reference_tracer *trace,
                          const struct packed_scene *scene)
{
    struct reference_rays rays = {0};
    uint64_t hash = hash_start;
    for (int i = 0; i < scene->width * scene->height; ++i) {
        struct reference_pixel pixel = trace(scene, i % scene->width, i / scene->width, NULL);
        hash = hash_bytes(hash, pixel.rgb, sizeof pixel.rgb);
        hash = hash_bytes(hash, &pixel.charges, sizeof pixel.charges);
        hash = hash_bytes(hash, &pixel.signature, sizeof pixel.signature);
        rays_add(&rays, pixel.rays);
    }
    hash = hash_bytes(hash, &rays, sizeof rays);
    printf("%s %s %016" PRIx64 "\n", name, precision, hash);
}

/* x86-64 and aarch64 make NaN of opposite signs. */
static uint64_t hash_number(uint64_t hash, double number)
{
    return isnan(number) ? hash_bytes(hash, "nan", 3) : hash_bytes(hash, &number, sizeof number);
}

static void print_explanation(const char *name, const char *precision, reference_explainer *explain,
                              const struct packed_scene *scene)
{
    uint64_t hash = hash_start;
    for (int i = 0; i < scene->width * scene->height; ++i) {
        struct reference_explanation pixel = explain(scene, i % scene->width, i / scene->width, NULL);
        for (int c = 0; c < 3; ++c)
            hash = hash_number(hash_number(hash, pixel.rgb[c]), pixel.bound[c]);
        hash = hash_number(hash, pixel.margin);
        hash = hash_bytes(hash, &pixel.signature, sizeof pixel.signature);
    }
    printf("%s explained by %s %016" PRIx64 "\n", name, precision, hash);
}

int main(int count, char **arguments)
{
    FILE *file = count == 2 ? fopen(arguments[1], "rb") : NULL;
    if (!file)
        return EXIT_FAILURE;
    struct scene_bytes bytes;
    while (fread(&bytes, sizeof bytes, 1, file) == 1) {
        struct packed_scene *scene = &bytes.scene;
        scene->spheres = read_items(file, sizeof *scene->spheres, scene->sphere_count);
        scene->surfaces = read_items(file, sizeof *scene->surfaces, scene->surface_count);
        scene->planes = read_items(file, sizeof *scene->planes, scene->plane_count);
        scene->point_lights = read_items(file, sizeof *scene->point_lights, scene->point_light_count);
        scene->quad_lights = read_items(file, sizeof *scene->quad_lights, scene->quad_light_count);
        scene->tree = NULL;
        print_picture(bytes.name, "float", reference_trace_float, scene);
        print_picture(bytes.name, "double", reference_trace_double, scene);
        print_picture(bytes.name, "quad", reference_trace_quad, scene);
        print_explanation(bytes.name, "double", reference_explain_double, scene);
        print_explanation(bytes.name, "quad", reference_explain_quad, scene);
        free(scene->spheres);
        free(scene->surfaces);
        free(scene->planes);
        free(scene->point_lights);
        free(scene->quad_lights);
    }
    fclose(file);
    return EXIT_SUCCESS;
}
