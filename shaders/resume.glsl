// Ray trees too large for one dispatch. Lavapipe runs an invocation in each lane of a vector. It ends all loops of a
// vector after 65535 turns, counted together, and reports nothing; so turns are counted here. A resumable pipeline
// traces a sample for some turns and saves the rest of its tree in buffers, for the next dispatch.

uint most_rays = 0u, most_leaves = 0u; // of a sample, in this lane

// Turns of loops. Lavapipe unrolls those over objects and lights where there are 19 of them, and no longer where there
// are 24; agreement/many_turns holds it to 10.
const bool UNROLLED = SPHERES + PLANES + POINT_LIGHTS + QUAD_LIGHTS <= 10;
const uint TURNS_OVER_OBJECTS = UNROLLED ? 0u : uint(SPHERES + PLANES);
const uint TURNS_OF_A_RAY = 1u + (RAYS_ESCAPE ? 2u : 1u) * TURNS_OVER_OBJECTS;
const uint TURNS_OF_A_LIGHT_POINT = 1u + TURNS_OVER_OBJECTS;
const uint TURNS_OF_A_LEAF = (UNROLLED ? 0u : uint(POINT_LIGHTS)) * TURNS_OF_A_LIGHT_POINT +
                             uint(QUAD_LIGHTS) * (1u + uint(LIGHT_SAMPLES) * TURNS_OF_A_LIGHT_POINT);
const uint TURNS_OF_A_SAMPLE = 2u + (RESUMABLE ? 2u * uint(STACK_ROOM) : 0u); // and of a row
// Rays of a sample after which a resumable dispatch traces no more.
const uint PORTION = 1u + 32768u / (TURNS_OF_A_RAY + TURNS_OF_A_LEAF);

// Whether the driver may have ended loops of this vector. Lanes trace their rays side by side, but shade one after the
// other where they do it at different turns.
bool too_many_turns(uint samples)
{
    if (TURN_LIMIT == ~0u)
        return false;
    uint rays = subgroupMax(most_rays), leaves = min(rays, subgroupAdd(most_leaves));
    exact float turns = float(TURNS_OF_A_SAMPLE) + float(rays) * float(TURNS_OF_A_RAY) + float(leaves) * float(TURNS_OF_A_LEAF);
    exact float all_turns = turns * float(ROWS * samples);
    return all_turns >= float(TURN_LIMIT);
}

struct SavedPath {
    real3 origin;
    real weight;
    real3 direction;
    int state;
    uint branch;
};

struct SavedPixel {
    SavedPath path;
    real3 radiance, leaves, rounding;
    real threshold, charge, cut_off, charges;
    int pending;
};

layout(std430, set = 0, binding = 6) buffer SavedPixels { SavedPixel saved_pixels[]; };
layout(std430, set = 0, binding = 7) buffer SavedStacks { SavedPath saved_stacks[]; }; // STACK_ROOM a pixel

void save(uint place, Pixel pixel, Path path, int pending)
{
    saved_pixels[place].path.origin = path.ray.origin;
    saved_pixels[place].path.weight = path.weight;
    saved_pixels[place].path.direction = path.ray.direction;
    saved_pixels[place].path.state = path_state(path);
    saved_pixels[place].path.branch = path.branch;
    saved_pixels[place].radiance = pixel.radiance;
    saved_pixels[place].leaves = pixel.leaves;
    saved_pixels[place].rounding = pixel.rounding;
    saved_pixels[place].threshold = pixel.threshold;
    saved_pixels[place].charge = pixel.charge;
    saved_pixels[place].cut_off = pixel.cut_off;
    saved_pixels[place].charges = pixel.charges;
    saved_pixels[place].pending = pending;
    for (int i = 0; i < pending; ++i) {
        uint entry = place * uint(STACK_ROOM) + uint(i);
        saved_stacks[entry].origin = stack_origin[i];
        saved_stacks[entry].weight = stack_weight[i];
        saved_stacks[entry].direction = stack_direction[i];
        saved_stacks[entry].state = stack_state[i];
        saved_stacks[entry].branch = LIGHTS_TELL_BRANCHES ? stack_branch[i] : 0u;
    }
}

void load(uint place, inout Pixel pixel, inout Path path, inout int pending)
{
    path.ray.origin = saved_pixels[place].path.origin;
    path.ray.direction = saved_pixels[place].path.direction;
    path.weight = saved_pixels[place].path.weight;
    set_path_state(path, saved_pixels[place].path.state);
    path.branch = saved_pixels[place].path.branch;
    pixel.radiance = saved_pixels[place].radiance;
    pixel.leaves = saved_pixels[place].leaves;
    pixel.rounding = saved_pixels[place].rounding;
    pixel.threshold = saved_pixels[place].threshold;
    pixel.charge = saved_pixels[place].charge;
    pixel.cut_off = saved_pixels[place].cut_off;
    pixel.charges = saved_pixels[place].charges;
    pending = saved_pixels[place].pending;
    for (int i = 0; i < pending; ++i) {
        uint entry = place * uint(STACK_ROOM) + uint(i);
        stack_origin[i] = saved_stacks[entry].origin;
        stack_weight[i] = saved_stacks[entry].weight;
        stack_direction[i] = saved_stacks[entry].direction;
        stack_state[i] = saved_stacks[entry].state;
        if (LIGHTS_TELL_BRANCHES)
            stack_branch[i] = saved_stacks[entry].branch;
    }
}
