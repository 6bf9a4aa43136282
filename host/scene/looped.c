#include "scene/looped.h"

#include "scene/body.h"

/* Keeps the largest spheres; of equally large ones the first of the file. */
static void consider(const struct scene *scene, size_t sphere, struct looped *looped)
{
    const double radius = body_numbered(scene, sphere).number;
    size_t place = looped->large_count;
    while (place > 0 && radius > body_numbered(scene, looped->large[place - 1]).number)
        --place;
    if (place == MOST_LARGE)
        return;
    if (looped->large_count < MOST_LARGE)
        ++looped->large_count;
    for (size_t i = looped->large_count - 1; i > place; --i)
        looped->large[i] = looped->large[i - 1];
    looped->large[place] = sphere;
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

struct looped looped_choose(const struct scene *scene)
{
    struct looped looped = {.sphere_count = 0};
    struct extent extent = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (size_t i = 0; i < scene->body_count; ++i)
        if (body_numbered(scene, i).is_ball) {
            ++looped.sphere_count;
            consider(scene, i, &looped);
        }
    if (looped.sphere_count <= MOST_LOOPED)
        return looped;
    for (size_t i = 0; i < scene->body_count; ++i)
        if (body_numbered(scene, i).is_ball && !is_large(&looped, i))
            include(&extent, body_numbered(scene, i));
    for (; looped.large_count > 0; --looped.large_count) { /* the smallest first: if it is one, all are */
        const struct body body = body_numbered(scene, looped.large[looped.large_count - 1]);
        if (2 * body.number > longest_side(&extent) / 2)
            break;
        include(&extent, body);
    }
    return looped;
}
