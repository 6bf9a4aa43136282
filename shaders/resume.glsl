// What a dispatch leaves when it has used up its turns: the invocation's state, with which the next one goes on.

struct SavedWork {
    real4 origin_weight, direction_state; // of the path
    real4 radiance_charges, leaves_charge, rounding_cut_off;
    real4 lit, threshold; // lit: the light so far, and what one quad light has brought; threshold: in x
    uvec4 work;  // later, row, flags, pending
    uvec4 pixel; // sample_index, branch, next light point, signature
    uvec4 rays; // secondary, shadow
};
layout(std430, set = 0, binding = 6) buffer SavedWorks { SavedWork saved_works[]; };
layout(std430, set = 0, binding = 9) buffer Outcome { uint unfinished; }; // not 0: some invocation is

Work no_work()
{
    const real3 zero = real3(0);
    Path path = Path(Ray(zero, zero, -1, false), real(0), 0, 0u);
    Pixel pixel = Pixel(zero, zero, zero, real(0), real(0), real(0), real(0), 0u, 0u, Tally(0u, 0u, 0u));
    return Work(0u, 0u, false, false, 0, path, pixel, Lighting(0u, zero, real(0)));
}

bool is_done(Work work)
{
    return !work.busy && work.later == 0u;
}

void save(Work work)
{
    uint i = invocation();
    saved_works[i].work = uvec4(work.later, work.row, uint(work.busy) | uint(work.fresh) << 1, uint(work.pending));
    if (is_done(work))
        return;
    atomicOr(unfinished, 1u);
    saved_works[i].origin_weight = real4(work.path.ray.origin, work.path.weight);
    saved_works[i].direction_state = real4(work.path.ray.direction, packed_state(work.path));
    saved_works[i].radiance_charges = real4(work.pixel.radiance, work.pixel.charges);
    saved_works[i].leaves_charge = real4(work.pixel.leaves, work.pixel.charge);
    saved_works[i].rounding_cut_off = real4(work.pixel.rounding, work.pixel.cut_off);
    saved_works[i].lit = real4(work.light.sum, work.light.quad_sum);
    saved_works[i].threshold.x = work.pixel.threshold;
    saved_works[i].pixel = uvec4(work.pixel.sample_index, work.path.branch, work.light.next, work.pixel.tally.signature);
    saved_works[i].rays = uvec4(work.pixel.tally.secondary_rays, work.pixel.tally.shadow_rays, 0, 0);
}

void load(out Work work, uint first_row)
{
    uint i = invocation();
    SavedWork saved = saved_works[i];
    set_path(work.path, saved.origin_weight, saved.direction_state, saved.pixel.y);
    work.later = saved.work.x;
    work.row = saved.work.y;
    work.busy = (saved.work.z & 1u) != 0u;
    work.fresh = (saved.work.z & 2u) != 0u;
    work.pending = int(saved.work.w);
    work.light.sum = saved.lit.xyz;
    work.light.quad_sum = saved.lit.w;
    work.light.next = saved.pixel.z;
    work.pixel.radiance = saved.radiance_charges.xyz;
    work.pixel.charges = saved.radiance_charges.w;
    work.pixel.leaves = saved.leaves_charge.xyz;
    work.pixel.charge = saved.leaves_charge.w;
    work.pixel.rounding = saved.rounding_cut_off.xyz;
    work.pixel.cut_off = saved.rounding_cut_off.w;
    work.pixel.threshold = saved.threshold.x;
    work.pixel.seed = pixel_seed(tile_origin + uvec2(gl_GlobalInvocationID.x, first_row + work.row));
    work.pixel.sample_index = saved.pixel.x;
    work.pixel.tally = Tally(saved.rays.x, saved.rays.y, saved.pixel.w);
}
