// The ray that is being traced, and the stack of those that wait for it.

const bool LIGHTS_TELL_BRANCHES = GLASS && QUAD_LIGHTS > NO_QUAD_LIGHTS;

// A ray, what it counts for in the pixel, and the bounces it has behind it.
struct Path {
    Ray ray;
    real weight;
    int bounces;
    uint branch; // of the binary ray tree that glass makes: 0 the root; of i, 2 i + 1 refracted, 2 i + 2 reflected
};

// The reflections still to be traced: at most one for every bounce count.
const int STACK_ROOM = GLASS && MAX_BOUNCES > 0 ? MAX_BOUNCES : 1;
const bool STACK_IN_REGISTERS = STACK_ROOM <= 8; // selects cost less than indexed memory on lavapipe
real3 stack_origin[STACK_ROOM], stack_direction[STACK_ROOM];
real stack_weight[STACK_ROOM];
int stack_state[STACK_ROOM]; // (surface * 2 + inward) * 1024 + bounces
uint stack_branch[LIGHTS_TELL_BRANCHES ? STACK_ROOM : 1];

int path_state(Path path)
{
    return (path.ray.surface << 1 | int(path.ray.inward)) << 10 | path.bounces;
}

void set_path_state(inout Path path, int state)
{
    path.ray.surface = state >> 11;
    path.ray.inward = (state >> 10 & 1) != 0;
    path.bounces = state & 1023;
}

void store_pending(int i, Path path)
{
    stack_origin[i] = path.ray.origin;
    stack_direction[i] = path.ray.direction;
    stack_weight[i] = path.weight;
    stack_state[i] = path_state(path);
    if (LIGHTS_TELL_BRANCHES)
        stack_branch[i] = path.branch;
}

void load_pending(int i, inout Path path)
{
    path.ray.origin = stack_origin[i];
    path.ray.direction = stack_direction[i];
    path.weight = stack_weight[i];
    set_path_state(path, stack_state[i]);
    if (LIGHTS_TELL_BRANCHES)
        path.branch = stack_branch[i];
}

void push(Path path, inout int pending)
{
    if (STACK_IN_REGISTERS) {
        [[unroll]] for (int i = 0; i < STACK_ROOM; ++i)
            if (i == pending)
                store_pending(i, path);
    } else {
        store_pending(pending, path);
    }
    ++pending;
}

void pop(inout Path path, inout int pending)
{
    --pending;
    if (STACK_IN_REGISTERS) {
        [[unroll]] for (int i = 0; i < STACK_ROOM; ++i)
            if (i == pending)
                load_pending(i, path);
    } else {
        load_pending(pending, path);
    }
}
