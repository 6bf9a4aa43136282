// Whitted's recursion ("An Improved Illumination Model for Shaded Display", CACM 23(6), 1980), with an explicit stack that
// holds only what is pending. An invocation renders some pixels of a row: first the primary rays, then, in a
// loop that traces one ray a turn, the pixels that show a mirror or glass, one after the other.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require

#include "scene.glsl"
#include "arithmetic.glsl"
#include "events.glsl"
#include "sampling.glsl"
#include "tally.glsl"
#include "intersect.glsl"
#include "shade.glsl"
#include "dielectric.glsl"
#include "escape.glsl"

layout(local_size_x_id = 0, local_size_y_id = 1) in;
layout(push_constant) uniform TileBlock {
    uvec2 origin, size, image_size; // pixels
    uint goes_on;                   // not 0: with what the dispatch before has left
    uint most_turns;                // of the loop over rays
    uint threads;                   // that share the dispatch, each with groups that lie together
} tile;
uvec2 tile_origin, tile_size, image_size;

#include "pixel.glsl"
#include "path.glsl"

// What an invocation has to do, and where it is.
struct Work {
    uint later; // a bit for each column that is still to be begun
    uint column; // of the pixel that is being rendered
    bool busy;  // there is such a pixel
    bool fresh; // its next ray is a primary ray
    int pending; // rays on the stack
    Path path;
    Pixel pixel;
    Lighting light;
};

// The pixels of a group, and of its next columns, lie side by side: with an invocation's pixels one below the other every
// store of lavapipe's missed the caches, up to half of the time.
uvec2 place_of(uvec2 first, uint column)
{
    return uvec2(first.x + column * gl_WorkGroupSize.x, first.y);
}

#include "resume.glsl"

void begin_path(out Path path, uvec2 position, Pixel pixel)
{
    real sample_x = real(0.5), sample_y = real(0.5);
    if (SAMPLES > 1)
        sequence_point(pixel.sequence, shuffled(pixel.sequence, pixel.sample_index), sample_x, sample_y);
    exact real x = real(2 * int(position.x) - int(image_size.x)) + real(2) * sample_x;
    exact real y = real(2 * int(position.y) - int(image_size.y)) + real(2) * sample_y;
    exact real3 through =
        real3(hoisted_view.forward.xyz) + x * real3(hoisted_view.half_pixel_right.xyz) + y * real3(hoisted_view.half_pixel_down.xyz);
    path.ray.origin = real3(hoisted_view.position.xyz);
    path.ray.direction = unit(through);
    path.ray.surface = -1;
    path.ray.inward = false;
    path.weight = real(1);
    path.bounces = 0;
    path.branch = 0u;
}

Matte matte_of(Path path, Hit hit, real3 point, real3 normal)
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
    return matte;
}

// Adds what a ray sees that ends on a matte surface or nowhere. Whether its light takes another turn, unless it is known
// to come at once. Each branch draws light samples of its own, the same whichever others are traced.
bool end_path(bool at_once, inout Pixel pixel, inout Lighting light, Path path, Hit hit, real3 point, real3 normal)
{
    exact real3 seen = real3(hoisted_view.background.xyz);
    if (hit.surface >= 0) {
        Matte matte = matte_of(path, hit, point, normal);
        uint seed = hash(pixel.seed + path.branch * uint(QUAD_LIGHTS));
        if (LIGHTS_TAKE_TURNS && !at_once) {
            if (light_on(matte, pixel.sample_index, seed, light, pixel.tally))
                return true;
            seen = real3(hit.parameters.xyz) * light.sum;
            begin_light(light);
        } else {
            seen = real3(hit.parameters.xyz) * direct_light(matte, pixel.sample_index, seed, pixel.tally);
        }
    }
    exact real3 leaf = path.weight * seen;
    TELL(emit(EVENT_LEAF, ivec4(0), seen, leaf, real(0));)
    add_leaf(pixel, leaf);
    return false;
}

// What a ray is charged that would make more than MAX_BOUNCES.
void cut_off(inout Pixel pixel, Path path)
{
    if (!CHARGED)
        return;
    add_charge(pixel, path.weight);
    TELL(emit_untraced(UNTRACED_BOUNCES, path.weight, pixel.charge);)
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
        TELL(if (escaping) emit_untraced(UNTRACED_ESCAPES, path.weight, pixel.charge);)
        return !escaping;
    }

    real eta = real(hit.from_inside ? hit.parameters.ETA_EXITING : hit.parameters.ETA_ENTERING);
    real kappa = real(hit.from_inside ? hit.parameters.KAPPA_EXITING : hit.parameters.KAPPA_ENTERING);
    Refraction refraction = refracted(incident, normal, cos_in, eta, kappa);
    note(pixel.tally, uint(refraction.total));
    TELL(emit_split(cos_in, refraction);)
    if (refraction.total)
        return true;
    exact real reflected_weight = path.weight * refraction.reflectance;
    exact real refracted_weight = path.weight * (real(1) - refraction.reflectance);
    exact real reflected_root = root_of(reflected_weight);
    exact real refracted_root = root_of(refracted_weight);
    exact real open = pixel.waiting + reflected_root + refracted_root;
    exact real waiting = pixel.waiting + reflected_root;
    bool reflects = is_traced(pixel, reflected_weight, reflected_root, open);
    bool refracts = is_traced(pixel, refracted_weight, refracted_root, open);
    TELL(if (!reflects) emit_untraced(UNTRACED_REFLECTED, reflected_weight, pixel.charge);)
    TELL(if (!refracts) emit_untraced(UNTRACED_REFRACTED, refracted_weight, pixel.charge);)
    path.weight = reflected_weight;
    path.branch = 2u * path.branch + 2u;
    if (refracts) {
        if (reflects) {
            push(path, pending);
            pixel.waiting = waiting;
        }
        path.ray.direction = refraction.direction;
        path.ray.inward = !hit.from_inside;
        path.weight = refracted_weight;
        --path.branch;
    }
    return reflects || refracts;
}

void trace(Path path, out Hit hit, out real3 point, out real3 normal)
{
    hit = nearest_hit(path.ray);
    hit_point(path.ray, hit, point, normal);
}

bool bounces(Hit hit)
{
    return (MIRRORS || GLASS) && hit.surface >= 0 && hit.kind != KIND_MATTE;
}

// The primary rays of the columns that lie in the tile. The pixels that show a mirror or glass are left for later.
uint render_primary_rays(uvec2 first, uint columns)
{
    uint later = 0u;
    for (uint column = 0u; column < columns; ++column) {
        uvec2 in_tile = place_of(first, column);
        bool ends = true;
        Pixel pixel;
        Lighting light;
        begin_pixel(pixel, tile_origin + in_tile);
        for (;;) { // lavapipe runs the body of any other loop once more, masked
            Path path;
            Hit hit;
            real3 point, normal;
            begin_path(path, tile_origin + in_tile, pixel);
            trace(path, hit, point, normal);
            note(pixel.tally, uint(hit.surface + 1) * 2u + uint(hit.from_inside));
            ends = ends && !(SECONDARY_RAYS && bounces(hit));
            if (bounces(hit))
                cut_off(pixel, path);
            else
                end_path(true, pixel, light, path, hit, point, normal);
            if (end_sample(pixel))
                break;
        }
        if (ends)
            store(in_tile.y * tile_size.x + in_tile.x, pixel);
        later |= ends ? 0u : 1u << column;
    }
    return later;
}

// One turn of the loop: traces a ray of the tree.
void turn(inout Work work, uvec2 first)
{
    if (!work.busy) {
        work.column = uint(findLSB(work.later));
        work.later &= work.later - 1u;
    }
    uvec2 in_tile = place_of(first, work.column);
    uint place = in_tile.y * tile_size.x + in_tile.x;
    TELL(records_pixel = in_tile == uvec2(0);)
    if (!work.busy) {
        begin_pixel(work.pixel, tile_origin + in_tile);
        work.busy = true;
        work.fresh = true;
    }
    if (work.fresh)
        begin_path(work.path, tile_origin + in_tile, work.pixel);
    work.fresh = false;

    Hit hit;
    real3 point, normal;
    bool goes_on, lights_on = false;
    do { // with a hierarchy until the light at a matte point is wanted: looking for what blocks it is dear, also for lanes that wait
        bool ray_is_known = HIERARCHY ? search.stage != SEARCH_FRESH : LIGHTS_TAKE_TURNS && work.light.next > 0u;
        bool hit_is_known = HIERARCHY ? search.stage == SEARCH_DONE : ray_is_known;
        TELL(emit_ray(!ray_is_known, work.pixel.sample_index, work.path))
        trace(work.path, hit, point, normal);
        if (HIERARCHY && search.stage != SEARCH_DONE)
            return;
        TELL(if (!hit_is_known) emit_hit(hit, point, normal);)
        if (!hit_is_known)
            note(work.pixel.tally, uint(hit.surface + 1) * 2u + uint(hit.from_inside));
        goes_on = false;
        if (bounces(hit)) {
            if (SECONDARY_RAYS && work.path.bounces < MAX_BOUNCES)
                goes_on = bounce(work.path, work.pending, work.pixel, hit, point, normal);
            else
                cut_off(work.pixel, work.path);
        }
        if (goes_on) {
            ++work.pixel.tally.secondary_rays;
            search.stage = SEARCH_FRESH;
        }
    } while (HIERARCHY && goes_on);
    if (!bounces(hit))
        lights_on = end_path(false, work.pixel, work.light, work.path, hit, point, normal);
    if (GLASS && !goes_on && !lights_on && work.pending > 0) {
        pop(work.path, work.pending);
        exact real waiting = work.pixel.waiting - root_of(work.path.weight);
        work.pixel.waiting = waiting;
        ++work.pixel.tally.secondary_rays;
        goes_on = true;
    }
    if (!lights_on)
        search.stage = SEARCH_FRESH;
    if (!goes_on && !lights_on) {
        work.fresh = true;
        if (end_sample(work.pixel)) {
            store(place, work.pixel);
            work.busy = false;
        }
    }
}

// How many of the columns lie in the tile.
uint columns_inside(uvec2 first)
{
    uint columns = all(lessThan(first, tile_size)) ? (tile_size.x - 1u - first.x) / gl_WorkGroupSize.x + 1u : 0u;
    return min(columns, COLUMNS);
}

void main()
{
    hoist_scene();
    begin_hierarchy();
    steps = MOST_STEPS;
    tile_origin = tile.origin;
    tile_size = tile.size;
    image_size = tile.image_size;
    uint most_turns = tile.most_turns;
    bool goes_on = RESUMABLE && tile.goes_on != 0u;
    TELL(if (!goes_on && gl_GlobalInvocationID == uvec3(0)) event_count = 0u;)
    // lavapipe gives each thread groups that lie together: dealt out in turn, all get their share of what is dear
    uint share = gl_NumWorkGroups.y / tile.threads;
    uint group_y = gl_WorkGroupID.y % share * tile.threads + gl_WorkGroupID.y / share;
    uvec2 first = uvec2(gl_WorkGroupID.x * COLUMNS, group_y) * gl_WorkGroupSize.xy + gl_LocalInvocationID.xy;
    Work work = no_work();
    uint columns = columns_inside(first);
    if (PRIMARY_RAYS_FIRST)
        work.later = render_primary_rays(first, goes_on ? 0u : columns);
    else
        work.later = columns < 32u ? (1u << columns) - 1u : ~0u;
    if (PRIMARY_RAYS_FIRST && !SECONDARY_RAYS)
        return;
    if (goes_on)
        load(work, first);
    for (uint turns = 0u; !is_done(work) && (!RESUMABLE || turns < most_turns) && (!HIERARCHY || steps > 0u); ++turns)
        turn(work, first);
    if (RESUMABLE)
        save(work);
}
