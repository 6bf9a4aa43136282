// What a dispatch leaves when it has used up its turns: the invocation's state, with which the next one goes on, and its
// stack, with its path on top.

layout(std430, set = 0, binding = 11) buffer Outcome { uint unfinished; }; // pixels

Work no_work()
{
    const real3 zero = real3(0);
    Path path = Path(Ray(zero, zero, -1, false), real(0), 0, 0u);
    Pixel pixel = Pixel(zero, zero, zero, real(0), real(0), real(0), real(0), 0u, Sequence(0u, 0u, 0u), 0u, Tally(0u, 0u, 0u));
    return Work(0u, 0u, false, false, 0, path, pixel, Lighting(0u, zero, real(0)));
}

bool is_done(Work work)
{
    return !work.busy && work.later == 0u;
}

void exchange(bool saves, int slot, inout real3 xyz, inout real w)
{
    if (saves) {
        saved_reals[saved_place(slot)] = real4(xyz, w);
    } else {
        real4 saved = saved_reals[saved_place(slot)];
        xyz = saved.xyz;
        w = saved.w;
    }
}

void exchange(bool saves, int slot, inout uint word)
{
    if (saves)
        saved_words[saved_place(slot)] = word;
    else
        word = saved_words[saved_place(slot)];
}

// Saves or loads what comes with a pixel, as far as the scene has a use for it.
void exchange(bool saves, inout Work work)
{
    if (GLASS || CHARGED)
        exchange(saves, 0, work.pixel.leaves, work.pixel.charge);
    if (GLASS || PRUNES)
        exchange(saves, 1, work.pixel.rounding, work.pixel.waiting);
    if (SAMPLES > 1)
        exchange(saves, 2, work.pixel.radiance, work.pixel.charges);
    if (LIGHTS_TAKE_TURNS)
        exchange(saves, 3, work.light.sum, work.light.quad_sum);
    if (PRUNES || HIERARCHY) {
        real3 room = real3(work.pixel.room, 0, 0);
        exchange(saves, 4, room, search.distance);
        work.pixel.room = room.x;
    }
    if (SAMPLES > 1)
        exchange(saves, 2, work.pixel.sample_index);
    if (LIGHTS_TAKE_TURNS)
        exchange(saves, 3, work.light.next);
    if (COUNTS) {
        exchange(saves, 4, work.pixel.tally.secondary_rays);
        exchange(saves, 5, work.pixel.tally.shadow_rays);
        exchange(saves, 6, work.pixel.tally.signature);
    }
    if (HIERARCHY) {
        uint at = uint(search.at), sphere = uint(search.sphere), blocker = uint(search.blocker);
        exchange(saves, 7, search.stage);
        exchange(saves, 8, at);
        exchange(saves, 9, sphere);
        if (RECORDS)
            exchange(saves, 10, blocker);
        search.at = int(at);
        search.sphere = int(sphere);
        search.blocker = int(blocker);
    }
}

void save(Work work)
{
    saved_words[saved_place(0)] = work.later;
    saved_words[saved_place(1)] = uint(work.pending) << 7 | work.column << 2 | uint(work.fresh) << 1 | uint(work.busy);
    if (is_done(work))
        return;
    atomicAdd(unfinished, uint(bitCount(work.later)) + uint(work.busy));
    exchange(true, work);
    PackedPath packed;
    pack(work.path, packed);
    save_path(work.pending, packed);
    while (GLASS && work.pending > sunk) { // lavapipe: a loop, lest it does all under a mask
        --work.pending;
        save_path(work.pending, in_registers(work.pending));
    }
}

void load(inout Work work, uvec2 first)
{
    uint place = saved_words[saved_place(1)];
    work.later = saved_words[saved_place(0)];
    int below = int(place >> 7);
    work.column = place >> 2 & 31u;
    work.fresh = (place & 2u) != 0u;
    work.busy = (place & 1u) != 0u;
    if (is_done(work))
        return;
    exchange(false, work);
    PackedPath packed;
    for (int i = 0; GLASS && !STACK_SINKS && i < below; ++i) {
        load_path(i, packed);
        put_in_registers(i, packed);
    }
    sunk = STACK_SINKS ? below : 0;
    work.pending = below;
    load_path(below, packed);
    unpack(packed, work.path);
    seed_pixel(work.pixel, tile_origin + place_of(first, work.column));
}
