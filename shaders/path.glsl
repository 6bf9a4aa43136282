// The ray that is being traced, and the stack of those that wait for it.

const bool LIGHTS_TELL_BRANCHES = GLASS && QUAD_LIGHTS > NO_QUAD_LIGHTS;

// A ray, what it counts for in the pixel, and the bounces it has behind it.
struct Path {
    Ray ray;
    real weight;
    int bounces;
    uint branch; // of the binary ray tree that glass makes: 0 the root; of i, 2 i + 1 refracted, 2 i + 2 reflected
};

// The reflections still to be traced: at most one for every bounce count. A small stack lies in registers: chosen by
// selects, they cost lavapipe less than memory, which it gathers and scatters at every turn. (To keep the upper part of
// a deep one in registers and to leave the loop where they are full was 3 times slower with thousands of rays a pixel.)
const bool STACK_IN_REGISTERS = MAX_BOUNCES <= 8;
const int STACK_ROOM = GLASS && MAX_BOUNCES > 0 && STACK_IN_REGISTERS ? MAX_BOUNCES : 1;
real4 stack_origin[STACK_ROOM]; // and weight
real3 stack_direction[STACK_ROOM];
int stack_state[STACK_ROOM], stack_bounces[STACK_ROOM];
uint stack_branch[STACK_ROOM];

// What an invocation keeps in memory, slot after slot; a slot of all invocations lies together. The first are for its work,
// see resume.glsl, the others for the stack.
layout(std430, set = 0, binding = 9) buffer SavedReals { real4 saved_reals[]; };
layout(std430, set = 0, binding = 10) buffer SavedWords { uint saved_words[]; };
int saved_place(int slot)
{
    uvec2 all = gl_NumWorkGroups.xy * gl_WorkGroupSize.xy;
    return int((uint(slot) * all.y + gl_GlobalInvocationID.y) * all.x + gl_GlobalInvocationID.x);
}

// With a hierarchy surfaces need so many bits that bounces have a word of their own.
int path_state(Path path)
{
    int leaves = path.ray.surface << 1 | int(path.ray.inward);
    return HIERARCHY ? leaves : leaves << 10 | path.bounces;
}

void set_path(inout Path path, real4 origin_weight, real3 direction, int state, int bounces, uint branch)
{
    path.ray.origin = origin_weight.xyz;
    path.ray.direction = direction;
    path.ray.surface = HIERARCHY ? state >> 1 : state >> 11;
    path.ray.inward = ((HIERARCHY ? state : state >> 10) & 1) != 0;
    path.weight = origin_weight.w;
    path.bounces = HIERARCHY ? bounces : state & 1023;
    path.branch = branch;
}

// A path's place in memory is its number on the stack, from the bottom.
void save_path(int number, Path path)
{
    saved_reals[saved_place(WORK_REALS + 2 * number)] = real4(path.ray.origin, path.weight);
    saved_reals[saved_place(WORK_REALS + 2 * number + 1)] = real4(path.ray.direction, real(0));
    saved_words[saved_place(WORK_WORDS + 3 * number)] = uint(path_state(path));
    if (HIERARCHY)
        saved_words[saved_place(WORK_WORDS + 3 * number + 1)] = uint(path.bounces);
    if (LIGHTS_TELL_BRANCHES)
        saved_words[saved_place(WORK_WORDS + 3 * number + 2)] = path.branch;
}

void load_path(int number, inout Path path)
{
    real4 origin_weight = saved_reals[saved_place(WORK_REALS + 2 * number)];
    real3 direction = saved_reals[saved_place(WORK_REALS + 2 * number + 1)].xyz;
    int state = int(saved_words[saved_place(WORK_WORDS + 3 * number)]);
    int bounces = HIERARCHY ? int(saved_words[saved_place(WORK_WORDS + 3 * number + 1)]) : 0;
    uint branch = LIGHTS_TELL_BRANCHES ? saved_words[saved_place(WORK_WORDS + 3 * number + 2)] : 0u;
    set_path(path, origin_weight, direction, state, bounces, branch);
}

void push(Path path, inout int pending)
{
    if (!STACK_IN_REGISTERS)
        save_path(pending, path);
    [[unroll]] for (int i = 0; i < STACK_ROOM; ++i)
        if (STACK_IN_REGISTERS && i == pending) {
            stack_origin[i] = real4(path.ray.origin, path.weight);
            stack_direction[i] = path.ray.direction;
            stack_state[i] = path_state(path);
            stack_bounces[i] = path.bounces;
            stack_branch[i] = path.branch;
        }
    ++pending;
}

void pop(inout Path path, inout int pending)
{
    --pending;
    if (!STACK_IN_REGISTERS)
        load_path(pending, path);
    [[unroll]] for (int i = 0; i < STACK_ROOM; ++i)
        if (STACK_IN_REGISTERS && i == pending)
            set_path(path, stack_origin[i], stack_direction[i], stack_state[i], stack_bounces[i], stack_branch[i]);
}
