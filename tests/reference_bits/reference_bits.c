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

typedef void render_function(const struct packed_scene *, struct reference_window, int,
                             struct reference_picture *);
typedef void explain_function(const struct packed_scene *, struct reference_window, int,
                              struct reference_explanation *);

static void print_picture(const char *name, const char *precision, render_function *render,
                          const struct packed_scene *scene)
{
    size_t pixels = (size_t)scene->width * (size_t)scene->height;
    struct reference_picture picture = {
        .rgb = calloc(3 * pixels, sizeof *picture.rgb),
        .signatures = calloc(pixels, sizeof *picture.signatures),
        .charges = calloc(pixels, sizeof *picture.charges),
    };
    if (!picture.rgb || !picture.signatures || !picture.charges)
        exit(EXIT_FAILURE);
    render(scene, (struct reference_window){0, 0, scene->width, scene->height}, 2, &picture);
    uint64_t hash = hash_bytes(hash_start, picture.rgb, 3 * pixels * sizeof *picture.rgb);
    hash = hash_bytes(hash, picture.signatures, pixels * sizeof *picture.signatures);
    hash = hash_bytes(hash, picture.charges, pixels * sizeof *picture.charges);
    hash = hash_bytes(hash, &picture.rays, sizeof picture.rays);
    printf("%s %s %016" PRIx64 "\n", name, precision, hash);
    free(picture.charges);
    free(picture.signatures);
    free(picture.rgb);
}

/* x86-64 and aarch64 make NaN of opposite signs. */
static uint64_t hash_number(uint64_t hash, double number)
{
    return isnan(number) ? hash_bytes(hash, "nan", 3) : hash_bytes(hash, &number, sizeof number);
}

static void print_explanation(const char *name, const char *precision, explain_function *explain,
                              const struct packed_scene *scene)
{
    size_t pixels = (size_t)scene->width * (size_t)scene->height;
    struct reference_explanation *explanations = calloc(pixels, sizeof *explanations);
    if (!explanations)
        exit(EXIT_FAILURE);
    explain(scene, (struct reference_window){0, 0, scene->width, scene->height}, 2, explanations);
    uint64_t hash = hash_start;
    for (size_t i = 0; i < pixels; ++i) {
        const struct reference_explanation *explanation = &explanations[i];
        for (int c = 0; c < 3; ++c)
            hash = hash_number(hash_number(hash, explanation->rgb[c]), explanation->bound[c]);
        hash = hash_number(hash, explanation->margin);
        hash = hash_bytes(hash, &explanation->signature, sizeof explanation->signature);
    }
    printf("%s explained by %s %016" PRIx64 "\n", name, precision, hash);
    free(explanations);
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
        print_picture(bytes.name, "float", reference_render_float, scene);
        print_picture(bytes.name, "double", reference_render_double, scene);
        print_picture(bytes.name, "quad", reference_render_quad, scene);
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
