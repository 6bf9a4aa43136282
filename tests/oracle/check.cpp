/* oracle [--pixels N] SCENE...: the exact radiance of N pixels of each scene's picture at 60x40 against the
 * reference's in float, double and binary128, which must be as near as the error analysis claims, and against
 * the values that the analysis itself judges by. Exit status 1 where one is not. */
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "oracle.h"

extern "C" {
#include "reference.h"
#include "scene/pack.h"
#include "scene/scene.h"
#include "tracer/reference_scene.h"
}

namespace
{

constexpr int width = 60, height = 40;
constexpr unsigned most_light_samples = 8;

enum { IN_FLOAT, IN_DOUBLE, IN_QUAD, JUDGED_BY, VALUES };

/* In units of float's: what one rounding may change, and so how near a decision must be to be taken wrongly.
 * Double lacks a little of that, since it puts directions back to length 1 by a Newton step; it is a judge,
 * whose errors must be a millionth of the bound. What a picture is judged by is put together in double. */
constexpr struct {
    const char *name;
    double unit;
} arithmetics[VALUES] = {{"float", 1}, {"double", 0x1p-20}, {"binary128", 0x1p-89}, {"judged by", 0x1p-29}};

struct Tally {
    int close = 0, ties = 0, undecided = 0, wrong = 0;
    long bits = 0;
    double worst[VALUES] = {};
};

/* The largest error of a channel in shares of what is claimed: the bound on float's error times the unit, and
 * the rounding to double; below SMALLEST_WEIGHT a value is 0. */
double share_of_claim(const double rgb[3], const Vector &exact, const double bound[3], double unit)
{
    const Ball *channels[] = {&exact.x, &exact.y, &exact.z};
    double worst = 0;
    for (int c = 0; c < 3; ++c) {
        const double error = (Ball(rgb[c]) - *channels[c]).largest();
        const double claim =
            unit * bound[c] + 0x1p-53 * std::fabs(rgb[c]) + SMALLEST_WEIGHT + 2 * channels[c]->radius();
        const double share = error / claim;
        worst = std::fmax(worst, std::isnan(share) ? INFINITY : share);
    }
    return worst;
}

void check_pixel(const char *path, const packed_scene &scene, const Oracle &oracle, int x, int y,
                 Tally &tally)
{
    const OraclePixel exact = oracle.trace(x, y);
    const reference_explanation explanation = reference_explain_quad(&scene, x, y, nullptr);
    double rgb[VALUES][3];
    std::copy(explanation.rgb, explanation.rgb + 3, rgb[JUDGED_BY]);
    reference_tracer *const tracers[] = {reference_trace_float, reference_trace_double, reference_trace_quad};
    for (int i = IN_FLOAT; i <= IN_QUAD; ++i) {
        const reference_pixel pixel = tracers[i](&scene, x, y, nullptr);
        std::copy(pixel.rgb, pixel.rgb + 3, rgb[i]);
    }

    tally.close += !(explanation.margin >= 1);
    tally.ties += exact.ties > 0;
    tally.undecided += exact.undecided > 0;
    tally.bits = std::max(tally.bits, exact.bits);
    for (int i = 0; i < VALUES; ++i) {
        const double decides = arithmetics[i == JUDGED_BY ? IN_QUAD : i].unit;
        /* The bound on float's error holds whatever float decides; the others must decide as is exact. */
        if (i != IN_FLOAT && !(explanation.margin >= decides))
            continue;
        const double share = share_of_claim(rgb[i], exact.radiance, explanation.bound, arithmetics[i].unit);
        tally.worst[i] = std::fmax(tally.worst[i], share);
        if (share <= 1)
            continue;
        ++tally.wrong;
        std::printf(
            "%s: pixel (%d, %d): %s: %.17g %.17g %.17g, off by %.3g of what is claimed; exactly %.17g "
            "%.17g %.17g\n",
            path, x, y, arithmetics[i].name, rgb[i][0], rgb[i][1], rgb[i][2], share,
            exact.radiance.x.middle(), exact.radiance.y.middle(), exact.radiance.z.middle());
    }
}

/* A third is drawn at random, a third has the closest decisions that float cannot get wrong, a third those
 * that it can. */
std::vector<int> choose_pixels(const packed_scene &scene, int count)
{
    std::vector<double> margins;
    std::vector<int> pixels;
    unsigned random = 1;
    for (int i = 0; i < width * height; ++i) {
        random = random * 1664525 + 1013904223; /* Knuth's, Numerical Recipes' ranqd1 */
        margins.push_back(reference_explain_double(&scene, i % width, i / width, nullptr).margin);
        pixels.push_back(i);
        std::swap(pixels[(size_t)i], pixels[(random >> 8) % pixels.size()]);
    }
    auto put_closest_first = [&](int from, bool certain) {
        auto rank = [&](int pixel) {
            const double margin = margins[(size_t)pixel];
            return certain && margin < 1 ? INFINITY : margin;
        };
        std::stable_sort(pixels.begin() + from, pixels.end(),
                         [&](int a, int b) { return rank(a) < rank(b); });
    };
    count = std::min(count, width * height);
    put_closest_first(count - count / 3 * 2, true);
    put_closest_first(count - count / 3, false);
    pixels.resize((size_t)count);
    return pixels;
}

bool check_packed(const char *path, const packed_scene &scene, int count)
{
    packed_scene with_tree;
    if (reference_scene(&scene, 1, &with_tree) != STATUS_DONE)
        return false;
    const Oracle oracle(scene);
    Tally tally;
    for (int pixel : choose_pixels(with_tree, count))
        check_pixel(path, with_tree, oracle, pixel % width, pixel / width, tally);
    std::printf(
        "%s: %d pixels, %d near a decision, %d with exact ties, %d with decisions that %ld bits cannot tell "
        "from ties; at most ",
        path, std::min(count, width * height), tally.close, tally.ties, tally.undecided, Precision::last);
    for (int i = 0; i < VALUES; ++i)
        std::printf("%s%.2g (%s)", i > 0 ? ", " : "", tally.worst[i], arithmetics[i].name);
    std::printf(" of what is claimed, %d beyond; up to %ld bits\n", tally.wrong, tally.bits);
    return tally.wrong == 0;
}

bool check_scene(const char *path, int count)
{
    struct scene scene;
    if (scene_read(path, &scene) != STATUS_DONE)
        return false;
    picture_settings settings = {};
    settings.width = width;
    settings.height = height;
    settings.max_bounces = scene.max_bounces;
    settings.samples = 1;
    settings.light_samples = std::min(scene.light_samples, most_light_samples);
    packed_scene packed;
    bool right = pack_scene(NULL, &scene, &settings, &packed) == STATUS_DONE;
    if (right) {
        right = check_packed(path, packed, count);
        pack_destroy(&packed);
    }
    scene_destroy(&scene);
    return right;
}

} // namespace

int main(int argc, char **argv)
{
    int count = 12, first = 1;
    if (argc > 2 && std::strcmp(argv[1], "--pixels") == 0) {
        count = std::atoi(argv[2]);
        first = 3;
    }
    bool right = first < argc && count > 0;
    for (int i = first; i < argc; ++i)
        right = check_scene(argv[i], count) && right;
    flint_cleanup();
    return right ? EXIT_SUCCESS : EXIT_FAILURE;
}
