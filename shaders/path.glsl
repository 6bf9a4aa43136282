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

// All entries of a depth lie together, one for each invocation.
struct SavedPath {
    real4 origin_weight, direction_state;
};
layout(std430, set = 0, binding = 7) buffer Stacks { SavedPath stacks[]; };
layout(std430, set = 0, binding = 8) buffer StackBranches { uint stack_branches[]; };

uint invocations() { return gl_NumWorkGroups.x * gl_WorkGroupSize.x * gl_NumWorkGroups.y * gl_WorkGroupSize.y; }

uint invocation()
{
    return gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x + gl_GlobalInvocationID.x;
}

int path_state(Path path)
{
    return (path.ray.surface << 1 | int(path.ray.inward)) << 10 | path.bounces;
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
    path.ray.surface = state >> 11;
    path.ray.inward = (state >> 10 & 1) != 0;
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
        uint entry = uint(pending) * invocations() + invocation();
        stacks[entry].origin_weight = origin_weight;
        stacks[entry].direction_state = direction_state;
        if (LIGHTS_TELL_BRANCHES)
            stack_branches[entry] = path.branch;
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
        uint entry = uint(pending) * invocations() + invocation();
        set_path(path, stacks[entry].origin_weight, stacks[entry].direction_state,
                 LIGHTS_TELL_BRANCHES ? stack_branches[entry] : 0u);
    }
}
