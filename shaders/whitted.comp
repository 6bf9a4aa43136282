// Whitted's recursion ("An Improved Illumination Model for Shaded Display", CACM 23(6), 1980), one invocation a
// pixel, with an explicit stack that holds only what is pending.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_KHR_shader_subgroup_arithmetic : require

#include "scene.glsl"
#include "arithmetic.glsl"
#include "events.glsl"
#include "sampling.glsl"
#include "tally.glsl"
#include "intersect.glsl"
#include "shade.glsl"
#include "dielectric.glsl"
#include "escape.glsl"
#include "path.glsl"

layout(local_size_x_id = 0, local_size_y_id = 1) in;
layout(std430, set = 0, binding = 5) buffer Picture { real picture[]; }; // the tile, RGB; sums until the last sample
layout(std430, set = 0, binding = 5) buffer Counts { uint counts[]; }; // the same memory, for outputs that are integers
layout(push_constant) uniform TileBlock {
    uvec2 origin, size, image_size; // pixels
    uint first_sample, end_sample;  // of SAMPLES, in this dispatch
    uint goes_on;                   // resumable: not 0 after the first dispatch of a sample
} tile;
uvec2 tile_origin, tile_size, image_size;
uint first_sample, end_sample;
bool sample_goes_on;

const bool INTEGERS = OUTPUT == OUTPUT_RAYS || OUTPUT == OUTPUT_SIGNATURE;
const bool CHARGES = PRUNES || OUTPUT == OUTPUT_TRUNCATION || RECORDS;

struct Pixel {
    real3 radiance; // sum over the samples
    real3 leaves, rounding; // of the sample: the rounded sum of what its rays see, and what rounding took from it
    real threshold; // of the sample: rays of smaller weight are left out
    real charge; // of the sample, for rays that are not traced, see ROUND_UP
    real cut_off; // what of that is for rays that MAX_BOUNCES cut off
    real charges; // of the samples before
    uint seed;
    uint sample_index;
    Tally tally;
};

#include "resume.glsl"

// Adds the most that a ray of this weight could have brought, rounded up.
real charge(real charges, real weight)
{
    exact real sum = (charges + weight * real(hoisted_view.truncation.RADIANCE_BOUND)) * real(ROUND_UP);
    return sum;
}

// Whether a ray of this weight is to be traced; where it is not, the sample has been charged for it.
bool is_traced(inout Pixel pixel, real weight)
{
    bool traced = weight > real(SMALLEST_WEIGHT) && !(PRUNES && weight < pixel.threshold);
    if (CHARGES)
        pixel.charge = traced ? pixel.charge : charge(pixel.charge, weight);
    return traced;
}

void begin_attempt(inout Pixel pixel, real threshold)
{
    pixel.threshold = threshold;
    pixel.leaves = real3(0);
    pixel.rounding = real3(0);
    pixel.charge = real(0);
    pixel.cut_off = real(0);
}

// Whether the finished sample has left out more than it may, and a lower threshold can help.
bool needs_another_attempt(Pixel pixel)
{
    real allowance = real(hoisted_view.truncation.ALLOWANCE);
    return PRUNES && pixel.threshold > real(0) && pixel.charge > allowance && pixel.cut_off <= allowance;
}

// What is left out falls about as the root of the threshold where rays multiply, and with it where they do not.
real next_threshold(Pixel pixel)
{
    exact real fits = real(hoisted_view.truncation.ALLOWANCE) - pixel.cut_off;
    exact real left_out = pixel.charge - pixel.cut_off;
    exact real ratio = divide(fits, left_out);
    exact real threshold = pixel.threshold * ratio * ratio * real(0.25);
    return threshold > real(SMALLEST_WEIGHT) ? threshold : real(0);
}

Path primary_path(uvec2 position, real sample_x, real sample_y)
{
    exact real x = real(2 * int(position.x) - int(image_size.x)) + real(2) * sample_x;
    exact real y = real(2 * int(position.y) - int(image_size.y)) + real(2) * sample_y;
    exact real3 through =
        real3(hoisted_view.forward.xyz) + x * real3(hoisted_view.half_pixel_right.xyz) + y * real3(hoisted_view.half_pixel_down.xyz);
    Path path;
    path.ray.origin = real3(hoisted_view.position.xyz);
    path.ray.direction = unit(through);
    path.ray.surface = -1;
    path.ray.inward = false;
    path.weight = real(1);
    path.bounces = 0;
    path.branch = 0u;
    return path;
}

// Each branch draws light samples of its own, the same whichever others are traced.
real3 matte_radiance(inout Pixel pixel, Path path, Hit hit, real3 point, real3 normal)
{
    exact real cos_out = -dot3(normal, path.ray.direction);
    Matte matte;
    matte.point = point;
    matte.normal = normal;
    matte.ray_direction = path.ray.direction;
    matte.cos_out = cos_out;
    matte.surface = hit.surface;
    matte.inward = hit.from_inside;
    matte.a = real(ONE_ROUGHNESS ? hoisted_view.matte.SHARED_A : hit.parameters.OREN_NAYAR_A);
    matte.b = real(ONE_ROUGHNESS ? hoisted_view.matte.SHARED_B : hit.oren_nayar_b);
    uint seed = hash(pixel.seed + path.branch * uint(QUAD_LIGHTS));
    exact real3 radiance =
        real3(hit.parameters.xyz) * direct_light(matte, pixel.sample_index, seed, pixel.tally);
    return radiance;
}

// Gives the ray of a mirror or glass hit its next direction; where glass splits it, the reflection is put on the
// stack and the refraction goes on. False where nothing goes on.
// (Members are assigned one by one, because glslang 12 crashes where `precise` has to follow a value through a
// struct constructor in a loop.)
bool bounce(inout Path path, inout int pending, inout Pixel pixel, Hit hit, real3 point, real3 normal)
{
    exact real cos_in = -dot3(normal, path.ray.direction);
    cos_in = cos_in > real(0) ? cos_in : real(0);
    real3 incident = path.ray.direction;
    ++path.bounces;
    path.ray.origin = point;
    path.ray.direction = reflected(incident, normal, cos_in);
    path.ray.surface = hit.surface;
    path.ray.inward = hit.from_inside;
    if (!GLASS || hit.kind != KIND_TRANSPARENT) {
        bool escaping = RAYS_ESCAPE && escapes(path.ray);
        emit_untraced(escaping, UNTRACED_ESCAPES, path.weight, pixel.charge);
        return !escaping;
    }

    real eta = real(hit.from_inside ? hit.parameters.ETA_EXITING : hit.parameters.ETA_ENTERING);
    real kappa = real(hit.from_inside ? hit.parameters.KAPPA_EXITING : hit.parameters.KAPPA_ENTERING);
    Refraction refraction = refracted(incident, normal, cos_in, eta, kappa);
    note(pixel.tally, uint(refraction.total));
    emit_split(cos_in, refraction);
    if (refraction.total)
        return true;
    exact real reflected_weight = path.weight * refraction.reflectance;
    exact real refracted_weight = path.weight * (real(1) - refraction.reflectance);
    bool reflects = is_traced(pixel, reflected_weight);
    bool refracts = is_traced(pixel, refracted_weight);
    emit_untraced(!reflects, UNTRACED_REFLECTED, reflected_weight, pixel.charge);
    emit_untraced(!refracts, UNTRACED_REFRACTED, refracted_weight, pixel.charge);
    path.weight = reflected_weight;
    path.branch = 2u * path.branch + 2u;
    if (refracts) {
        if (reflects)
            push(path, pending);
        path.ray.direction = refraction.direction;
        path.ray.inward = !hit.from_inside;
        path.weight = refracted_weight;
        --path.branch;
    }
    return reflects || refracts;
}

// Adds a leaf of the ray tree to the sample: what a ray sees that ends here. The exact rounding error of each sum is kept (Knuth, TAOCP 2,
// 4.2.2), so that leaving out rays changes the picture by what they would have brought, and not by how the others
// round.
void add_leaf(inout Pixel pixel, Path path, Hit hit, real3 point, real3 normal)
{
    exact real3 seen = real3(hoisted_view.background.xyz);
    if (hit.surface >= 0) {
        exact real3 black = real3(0);
        seen = hit.kind == KIND_MATTE ? matte_radiance(pixel, path, hit, point, normal) : black;
    }
    exact real3 leaf = path.weight * seen;
    emit_leaf(seen, leaf);
    if (!GLASS) { // the sample's only leaf
        pixel.leaves = leaf;
        return;
    }
    exact real3 sum = pixel.leaves + leaf;
    exact real3 added = sum - pixel.leaves;
    exact real3 rounding = pixel.rounding + ((pixel.leaves - (sum - added)) + (leaf - added));
    pixel.leaves = sum;
    pixel.rounding = rounding;
}

// One turn of the loop traces one ray of the tree. Whether a resumable pipeline has left some of the tree.
bool trace(inout Pixel pixel, inout Path path, inout int pending, Path primary)
{
    bool goes_on = true;
    uint rays = 0u, leaves = 0u;
    while (goes_on && (!RESUMABLE || rays < PORTION)) {
        ++rays;
        emit_ray(pixel.sample_index, path);
        Hit hit = nearest_hit(path.ray);
        note(pixel.tally, uint(hit.surface + 1) * 2u + uint(hit.from_inside));
        real3 point, normal;
        hit_point(path.ray, hit, point, normal);
        emit_hit(hit, point, normal);
        goes_on = false;
        if ((MIRRORS || GLASS) && hit.surface >= 0 && hit.kind != KIND_MATTE) {
            if (SECONDARY_RAYS && path.bounces < MAX_BOUNCES)
                goes_on = bounce(path, pending, pixel, hit, point, normal);
            else if (CHARGES) {
                pixel.charge = charge(pixel.charge, path.weight);
                pixel.cut_off = charge(pixel.cut_off, path.weight);
                emit_untraced(true, UNTRACED_BOUNCES, path.weight, pixel.charge);
            }
        } else {
            ++leaves;
            add_leaf(pixel, path, hit, point, normal);
        }
        if (GLASS && SECONDARY_RAYS && !goes_on && pending > 0) {
            pop(path, pending);
            goes_on = true;
        }
        if (PRUNES && !goes_on && needs_another_attempt(pixel)) {
            begin_attempt(pixel, next_threshold(pixel));
            begin_attempt_events();
            path = primary;
            goes_on = true;
        }
        if (goes_on)
            ++pixel.tally.secondary_rays;
    }
    most_rays = max(most_rays, rays);
    most_leaves = max(most_leaves, leaves);
    return RESUMABLE && goes_on;
}

// Whether the sample is finished, that is, added to the pixel.
bool render_sample(inout Pixel pixel, Path primary, uint place)
{
    Path path = primary;
    int pending = 0;
    begin_attempt(pixel, PRUNES ? real(hoisted_view.truncation.FIRST_THRESHOLD) : real(0));
    begin_sample_events();
    if (RESUMABLE && sample_goes_on)
        load(place, pixel, path, pending);
    if (trace(pixel, path, pending, primary)) {
        save(place, pixel, path, pending);
        return false;
    }
    exact real3 sample_radiance = pixel.leaves + pixel.rounding;
    exact real3 radiance = pixel.radiance + sample_radiance;
    pixel.radiance = radiance;
    exact real charges = (pixel.charges + pixel.charge) * real(ROUND_UP);
    pixel.charges = charges;
    emit_sample(sample_radiance, pixel.charge);
    return true;
}

// What an earlier dispatch has left of the pixel.
real3 stored(uint place)
{
    if (INTEGERS)
        return real3(int(counts[3u * place]));
    return real3(picture[3u * place], picture[3u * place + 1u], picture[3u * place + 2u]);
}

// Of a pixel without values yet.
void store_mark(uint place, real mark)
{
    if (INTEGERS)
        counts[3u * place] = uint(int(mark));
    else
        picture[3u * place] = mark;
}

// The values of the pixel or, of integers, the mark in value.x and the tally.
void store(uint place, real3 value, Tally tally)
{
    store_mark(place, value.x);
    if (INTEGERS) {
        counts[3u * place + 1u] = OUTPUT == OUTPUT_RAYS ? tally.secondary_rays : tally.signature;
        counts[3u * place + 2u] = tally.shadow_rays;
    } else {
        picture[3u * place + 1u] = value.y;
        picture[3u * place + 2u] = value.z;
    }
}

// The pixel's three values; the first is UNFINISHED where it is not done. Of integers only the first: they are in the
// tally.
real3 render_pixel(uvec2 position, uint place, out Tally tally)
{
    Pixel pixel = Pixel(real3(0), real3(0), real3(0), real(0), real(0), real(0), real(0), 0u, 0u, Tally(0u, 0u, 0u));
    real3 left = real3(0);
    if (SAMPLES > 1 || RESUMABLE)
        left = stored(place);
    // a signature goes through all samples; rays are counted by the dispatch
    if (OUTPUT == OUTPUT_SIGNATURE && (first_sample > 0u || sample_goes_on))
        pixel.tally.signature = counts[3u * place + 1u];
    tally = pixel.tally;
    if (RESUMABLE && sample_goes_on && left.x != real(UNFINISHED))
        return left;
    if (SAMPLES > 1 || QUAD_LIGHTS > 0)
        pixel.seed = hash(hash(position.x) + position.y);
    bool finished = true;
    Sequence sequence;
    if (SAMPLES > 1) {
        sequence = sequence_of(pixel.seed);
        if (OUTPUT == OUTPUT_RADIANCE && first_sample > 0u)
            pixel.radiance = left;
        if (OUTPUT == OUTPUT_TRUNCATION && first_sample > 0u)
            pixel.charges = left.x;
    }
    // One call for both cases: each call is another copy of the tracer, which costs lavapipe 100 ms.
    for (uint k = SAMPLES > 1 ? first_sample : 0u; k < (SAMPLES > 1 ? end_sample : 1u); ++k) {
        pixel.sample_index = k;
        real x = real(0.5), y = real(0.5);
        if (SAMPLES > 1)
            sequence_point(sequence, k, x, y);
        finished = render_sample(pixel, primary_path(position, x, y), place);
    }
    tally = pixel.tally;
    if (RESUMABLE && !finished)
        return real3(UNFINISHED);
    if (INTEGERS)
        return real3(0);
    if (OUTPUT == OUTPUT_TRUNCATION)
        return real3(pixel.charges, real(0), real(0));
    if (end_sample < uint(SAMPLES))
        return pixel.radiance;
    if (SAMPLES > 1) {
        exact real3 mean;
        for (int c = 0; c < 3; ++c)
            mean[c] = divide(pixel.radiance[c], real(SAMPLES));
        pixel.radiance = mean;
    }
    exact real3 value = pixel.radiance;
    for (int c = 0; c < 3; ++c)
        value[c] = value[c] < real(SMALLEST_WEIGHT) ? real(0) : value[c]; // a NaN stays to be seen
    emit_pixel(value);
    return value;
}

void main()
{
    hoist_scene();
    tile_origin = tile.origin;
    tile_size = tile.size;
    image_size = tile.image_size;
    first_sample = tile.first_sample;
    end_sample = tile.end_sample;
    sample_goes_on = tile.goes_on != 0u;
    begin_events(first_sample == 0u && !sample_goes_on);
    for (uint row = 0u; row < ROWS; ++row) {
        uvec2 in_tile = uvec2(gl_GlobalInvocationID.x, gl_GlobalInvocationID.y * ROWS + row);
        bool inside = all(lessThan(in_tile, tile_size));
        begin_pixel_events(in_tile);
        uint place = inside ? in_tile.y * tile_size.x + in_tile.x : 0u;
        real3 value = real3(0);
        Tally tally;
        if (!RESUMABLE || inside)
            value = render_pixel(tile_origin + in_tile, place, tally);
        if (inside)
            store(place, value, tally);
    }
    uvec2 first = uvec2(gl_GlobalInvocationID.x, gl_GlobalInvocationID.y * ROWS);
    if (too_many_turns(end_sample - first_sample) && all(lessThan(first, tile_size)))
        store_mark(first.y * tile_size.x + first.x, real(TOO_LONG));
}
