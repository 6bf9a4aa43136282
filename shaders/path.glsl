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
// selects, they cost lavapipe less than memory. A large one lies in a buffer, and one that the next dispatch may need.
const int STACK_ROOM = GLASS && MAX_BOUNCES > 0 ? MAX_BOUNCES : 1;
const bool STACK_IN_REGISTERS = (RESUMABLE ? MAX_BOUNCES + 9 : STACK_ROOM) <= 8;
const int REGISTERS = STACK_IN_REGISTERS ? STACK_ROOM : 1;
real4 stack_origin[REGISTERS], stack_direction[REGISTERS];
uint stack_branch[REGISTERS];

// What an invocation keeps in memory, slot after slot; a slot of all invocations lies together. The first are for its work,
// see resume.glsl, the others for the stack.
layout(std430, set = 0, binding = 9) buffer SavedReals { real4 saved_reals[]; };
layout(std430, set = 0, binding = 10) buffer SavedWords { uint saved_words[]; };
const int STACK_REALS = RESUMABLE ? WORK_REALS : 0;
const int STACK_WORDS = RESUMABLE ? WORK_WORDS : 0;

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

// The state in a real number, of which only the bits count.
real packed_state(Path path)
{
#ifdef DOUBLE
    return real(path_state(path));
#else
    return intBitsToFloat(path_state(path));
#endif
}

void set_path(inout Path path, real4 origin_weight, real4 direction_state, uint branch)
{
#ifdef DOUBLE
    int state = int(direction_state.w);
#else
    int state = floatBitsToInt(direction_state.w);
#endif
    path.ray.origin = origin_weight.xyz;
    path.ray.direction = direction_state.xyz;
    path.ray.surface = HIERARCHY ? state >> 1 : state >> 11;
    path.ray.inward = ((HIERARCHY ? state : state >> 10) & 1) != 0;
    path.weight = origin_weight.w;
    path.bounces = state & 1023;
    path.branch = branch;
}

void push(Path path, inout int pending)
{
    real4 origin_weight = real4(path.ray.origin, path.weight);
    real4 direction_state = real4(path.ray.direction, packed_state(path));
    if (STACK_IN_REGISTERS) {
        [[unroll]] for (int i = 0; i < STACK_ROOM; ++i)
            if (i == pending) {
                stack_origin[i] = origin_weight;
                stack_direction[i] = direction_state;
                stack_branch[i] = path.branch;
            }
    } else {
        saved_reals[saved_place(STACK_REALS + 2 * pending)] = origin_weight;
        saved_reals[saved_place(STACK_REALS + 2 * pending + 1)] = direction_state;
        if (LIGHTS_TELL_BRANCHES)
            saved_words[saved_place(STACK_WORDS + 2 * pending)] = path.branch;
        if (HIERARCHY)
            saved_words[saved_place(STACK_WORDS + 2 * pending + 1)] = uint(path.bounces);
    }
    ++pending;
}

void pop(inout Path path, inout int pending)
{
    --pending;
    if (STACK_IN_REGISTERS) {
        [[unroll]] for (int i = 0; i < STACK_ROOM; ++i)
            if (i == pending)
                set_path(path, stack_origin[i], stack_direction[i], stack_branch[i]);
    } else {
        real4 origin_weight = saved_reals[saved_place(STACK_REALS + 2 * pending)];
        real4 direction_state = saved_reals[saved_place(STACK_REALS + 2 * pending + 1)];
        set_path(path, origin_weight, direction_state,
                 LIGHTS_TELL_BRANCHES ? saved_words[saved_place(STACK_WORDS + 2 * pending)] : 0u);
        if (HIERARCHY)
            path.bounces = int(saved_words[saved_place(STACK_WORDS + 2 * pending + 1)]);
    }
}
