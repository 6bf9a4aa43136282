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
real4 stack_direction[STACK_ROOM]; // and state
uint stack_bounces[STACK_ROOM], stack_branch[STACK_ROOM];

// What an invocation keeps in memory, slot after slot; a slot of all invocations lies together. The first are for its work,
// see resume.glsl, the others for the stack.
layout(std430, set = 0, binding = 9) buffer SavedReals { real4 saved_reals[]; };
layout(std430, set = 0, binding = 10) buffer SavedWords { uint saved_words[]; };
int saved_place(int slot)
{
    uvec2 all = gl_NumWorkGroups.xy * gl_WorkGroupSize.xy;
    return int((uint(slot) * all.y + gl_GlobalInvocationID.y) * all.x + gl_GlobalInvocationID.x);
}

// A word of up to 29 bits as a real number, which is a normal one: denormal ones drivers may flush.
real real_of(uint word)
{
#ifdef DOUBLE
    return real(word);
#else
    return uintBitsToFloat(word | 0x40000000u);
#endif
}

uint word_of(real value)
{
#ifdef DOUBLE
    return uint(value);
#else
    return floatBitsToUint(value) & 0x3fffffffu;
#endif
}

// With a hierarchy surfaces need so many bits that bounces have a word of their own.
real path_state(Path path)
{
    uint leaves = uint(path.ray.surface + 1) << 1 | uint(path.ray.inward);
    return real_of(HIERARCHY ? leaves : leaves << 10 | uint(path.bounces));
}

void set_path(inout Path path, real4 origin_weight, real4 direction_state, uint bounces, uint branch)
{
    uint state = word_of(direction_state.w), leaves = HIERARCHY ? state : state >> 10;
    path.ray.origin = origin_weight.xyz;
    path.ray.direction = direction_state.xyz;
    path.ray.surface = int(leaves >> 1) - 1;
    path.ray.inward = (leaves & 1u) != 0u;
    path.weight = origin_weight.w;
    path.bounces = int(HIERARCHY ? bounces : state & 1023u);
    path.branch = branch;
}

// A path's place in memory is its number on the stack, from the bottom.
void save_path(int number, Path path)
{
    saved_reals[saved_place(WORK_REALS + 2 * number)] = real4(path.ray.origin, path.weight);
    saved_reals[saved_place(WORK_REALS + 2 * number + 1)] = real4(path.ray.direction, path_state(path));
    if (HIERARCHY)
        saved_words[saved_place(WORK_WORDS + 2 * number)] = uint(path.bounces);
    if (LIGHTS_TELL_BRANCHES)
        saved_words[saved_place(WORK_WORDS + 2 * number + 1)] = path.branch;
}

void load_path(int number, inout Path path)
{
    real4 origin_weight = saved_reals[saved_place(WORK_REALS + 2 * number)];
    real4 direction_state = saved_reals[saved_place(WORK_REALS + 2 * number + 1)];
    uint bounces = HIERARCHY ? saved_words[saved_place(WORK_WORDS + 2 * number)] : 0u;
    uint branch = LIGHTS_TELL_BRANCHES ? saved_words[saved_place(WORK_WORDS + 2 * number + 1)] : 0u;
    set_path(path, origin_weight, direction_state, bounces, branch);
}

void push(Path path, inout int pending)
{
    if (!STACK_IN_REGISTERS)
        save_path(pending, path);
    [[unroll]] for (int i = 0; i < STACK_ROOM; ++i)
        if (STACK_IN_REGISTERS && i == pending) {
            stack_origin[i] = real4(path.ray.origin, path.weight);
            stack_direction[i] = real4(path.ray.direction, path_state(path));
            stack_bounces[i] = uint(path.bounces);
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
            set_path(path, stack_origin[i], stack_direction[i], stack_bounces[i], stack_branch[i]);
}
