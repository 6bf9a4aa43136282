// The ray that is being traced, and the stack of those that wait for it.

const bool LIGHTS_TELL_BRANCHES = GLASS && QUAD_LIGHTS > NO_QUAD_LIGHTS;

// A ray, what it counts for in the pixel, and the bounces it has behind it.
struct Path {
    Ray ray;
    real weight;
    int bounces;
    uint branch; // of the binary ray tree that glass makes: 0 the root; of i, 2 i + 1 refracted, 2 i + 2 reflected
};

// A path as it waits. With a hierarchy surfaces need so many bits that bounces have a word of their own.
struct PackedPath {
    real4 origin_weight, direction_state; // the state: surface, inward, bounces
    uint bounces, branch;
};

// The stack of reflections still to be traced: at most one for every bounce count. A short one lies in registers: chosen
// by selects, they cost lavapipe less than memory, which it gathers and scatters lane by lane. Of a long one the upper part
// does, as a ring: what is pushed into a full one takes the place of the lowest, which goes to memory.
const int STACK_ROOM = !GLASS || MAX_BOUNCES == 0 ? 1 : MAX_BOUNCES <= MOST_IN_REGISTERS ? MAX_BOUNCES : 2;
const bool STACK_SINKS = GLASS && MAX_BOUNCES > STACK_ROOM;
PackedPath stack[STACK_ROOM];
int sunk = 0; // how many of those that wait are in memory

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

// (Members are assigned one by one: see bounce().)
void pack(Path path, out PackedPath packed)
{
    uint leaves = uint(path.ray.surface + 1) << 1 | uint(path.ray.inward);
    uint state = HIERARCHY ? leaves : leaves << 10 | uint(path.bounces);
    packed.origin_weight = real4(path.ray.origin, path.weight);
    packed.direction_state = real4(path.ray.direction, real_of(state));
    packed.bounces = uint(path.bounces);
    packed.branch = path.branch;
}

void unpack(PackedPath packed, inout Path path)
{
    uint state = word_of(packed.direction_state.w), leaves = HIERARCHY ? state : state >> 10;
    path.ray.origin = packed.origin_weight.xyz;
    path.ray.direction = packed.direction_state.xyz;
    path.ray.surface = int(leaves >> 1) - 1;
    path.ray.inward = (leaves & 1u) != 0u;
    path.weight = packed.origin_weight.w;
    path.bounces = int(HIERARCHY ? packed.bounces : state & 1023u);
    path.branch = packed.branch;
}

// Their places in memory are their numbers on the stack, from the bottom.
void save_path(int number, PackedPath packed)
{
    saved_reals[saved_place(WORK_REALS + 2 * number)] = packed.origin_weight;
    saved_reals[saved_place(WORK_REALS + 2 * number + 1)] = packed.direction_state;
    if (HIERARCHY)
        saved_words[saved_place(WORK_WORDS + 2 * number)] = packed.bounces;
    if (LIGHTS_TELL_BRANCHES)
        saved_words[saved_place(WORK_WORDS + 2 * number + 1)] = packed.branch;
}

void load_path(int number, out PackedPath packed)
{
    packed.origin_weight = saved_reals[saved_place(WORK_REALS + 2 * number)];
    packed.direction_state = saved_reals[saved_place(WORK_REALS + 2 * number + 1)];
    packed.bounces = HIERARCHY ? saved_words[saved_place(WORK_WORDS + 2 * number)] : 0u;
    packed.branch = LIGHTS_TELL_BRANCHES ? saved_words[saved_place(WORK_WORDS + 2 * number + 1)] : 0u;
}

int in_ring(int number)
{
    return STACK_SINKS ? number & (STACK_ROOM - 1) : number;
}

PackedPath in_registers(int number)
{
    PackedPath packed = stack[0];
    [[unroll]] for (int i = 1; i < STACK_ROOM; ++i)
        if (i == in_ring(number))
            packed = stack[i];
    return packed;
}

void put_in_registers(int number, PackedPath packed)
{
    [[unroll]] for (int i = 0; i < STACK_ROOM; ++i)
        if (i == in_ring(number))
            stack[i] = packed;
}

void push(Path path, inout int pending)
{
    if (STACK_SINKS && pending - sunk == STACK_ROOM) {
        save_path(sunk, in_registers(sunk));
        ++sunk;
    }
    PackedPath packed;
    pack(path, packed);
    put_in_registers(pending, packed);
    ++pending;
}

void pop(inout Path path, inout int pending)
{
    --pending;
    PackedPath packed = in_registers(pending);
    if (STACK_SINKS && pending < sunk) {
        load_path(pending, packed);
        --sunk;
    }
    unpack(packed, path);
}
