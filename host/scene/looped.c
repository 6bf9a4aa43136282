#include "scene/looped.h"

#include "scene/body.h"

struct candidate {
    struct body body;
    size_t sphere;
};

/* The largest spheres, the largest first; of equally large ones the first of the file. */
struct largest {
    size_t count;
    struct candidate candidates[MOST_LARGE];
};

static void consider(struct largest *largest, struct body body, size_t sphere)
{
    size_t place = largest->count;
    while (place > 0 && body.number > largest->candidates[place - 1].body.number)
        --place;
    if (place == MOST_LARGE)
        return;
    if (largest->count < MOST_LARGE)
        ++largest->count;
    for (size_t i = largest->count - 1; i > place; --i)
        largest->candidates[i] = largest->candidates[i - 1];
    largest->candidates[place] = (struct candidate){body, sphere};
}

static size_t find_largest(const struct scene *scene, struct largest *largest)
{
    size_t sphere = 0;
    for (size_t i = 0; i < scene->object_count; ++i)
        for (size_t row = 0; row < object_body_count(&scene->objects[i]); ++row)
            if (scene->objects[i].type != OBJECT_PLANE)
                consider(largest, body_of(&scene->objects[i], row), sphere++);
    return sphere;
}

static bool is_among(const struct largest *largest, size_t sphere)
{
    bool among = false;
    for (size_t i = 0; i < largest->count; ++i)
        among |= largest->candidates[i].sphere == sphere;
    return among;
}

struct extent {
    double lo[3], hi[3];
};

static void include(struct extent *extent, struct body ball)
{
    const double center[3] = {ball.vector.x, ball.vector.y, ball.vector.z};
    for (int a = 0; a < 3; ++a) {
        const double lo = center[a] - ball.number, hi = center[a] + ball.number;
        extent->lo[a] = lo < extent->lo[a] ? lo : extent->lo[a];
        extent->hi[a] = hi > extent->hi[a] ? hi : extent->hi[a];
    }
}

static double longest_side(const struct extent *extent)
{
    return dvec3_largest(dvec3_subtract(dvec3_of(extent->hi), dvec3_of(extent->lo)));
}

static struct extent extent_without(const struct scene *scene, const struct largest *largest)
{
    struct extent extent = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    size_t sphere = 0;
    for (size_t i = 0; i < scene->object_count; ++i)
        for (size_t row = 0; row < object_body_count(&scene->objects[i]); ++row)
            if (scene->objects[i].type != OBJECT_PLANE && !is_among(largest, sphere++))
                include(&extent, body_of(&scene->objects[i], row));
    return extent;
}

struct looped looped_choose(const struct scene *scene)
{
    struct largest largest = {.count = 0};
    struct looped looped = {.sphere_count = find_largest(scene, &largest)};
    if (looped.sphere_count <= MOST_LOOPED)
        return looped;
    struct extent extent = extent_without(scene, &largest);
    looped.large_count = MOST_LARGE;
    for (; looped.large_count > 0; --looped.large_count) { /* the smallest first: if it is one, all are */
        const struct body body = largest.candidates[looped.large_count - 1].body;
        if (2 * body.number > longest_side(&extent) / 2)
            break;
        include(&extent, body);
    }
    for (size_t i = 0; i < looped.large_count; ++i)
        looped.large[i] = largest.candidates[i].sphere;
    return looped;
}
