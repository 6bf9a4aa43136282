// Light that a matte point sends back along the ray: Oren-Nayar, point and quad lights, shadow rays.

struct Matte {
    real3 point, normal; // normal of length 1, facing the ray
    real3 ray_direction;
    real cos_out;
    int surface;
    bool inward;
    real a, b; // Oren-Nayar's A and B
};

// The Oren-Nayar factor A + B max(0, cos(phi_i - phi_o)) sin(alpha) tan(beta) times cos_in (Oren and Nayar,
// "Generalization of Lambert's Reflectance Model", SIGGRAPH 1994, without trigonometry).
real matte_factor(Matte matte, real3 to_light, real cos_in)
{
    if (!ROUGH) {
        exact real lambert = matte.a * cos_in;
        return lambert;
    }
    exact real in_plane = -dot3(to_light, matte.ray_direction) - cos_in * matte.cos_out;
    exact real larger = cos_in > matte.cos_out ? cos_in : matte.cos_out;
    exact real sin_tan = in_plane > real(0) ? divide(in_plane, larger) : real(0);
    exact real factor = (matte.a + matte.b * sin_tan) * cos_in;
    return factor;
}

// What `light` at its point gives per unit of intensity: factor cos / distance^2, or 0 in shadow.
// to_light comes back as well, for lights that do not shine to all sides.
real point_irradiance(Matte matte, real3 light, out real3 to_light, inout Tally tally)
{
    exact real3 way = light - matte.point;
    exact real distance_squared = dot3(way, way);
    exact real distance = square_root(distance_squared);
    exact real inverse = divide(real(1), distance);
    exact real3 direction = way * inverse;
    to_light = direction;
    exact real cos_in = dot3(matte.normal, direction);
    exact real irradiance = real(0);
    bool faces = cos_in > real(0) && distance_squared > real(NEAREST_LIGHT_SQUARED);
    if ((PROCESSOR && !HIERARCHY) || faces) {
        tally.shadow_rays += uint(faces);
        bool lit = !in_shadow(matte.point, matte.surface, matte.inward, direction, distance, light);
        exact real unshadowed = matte_factor(matte, direction, cos_in) * (inverse * inverse);
        irradiance = faces && lit ? unshadowed : real(0);
    }
    TELL(note_light(distance_squared, distance, cos_in, irradiance);)
    return irradiance;
}

real3 quad_point(int i, Sequence sequence, uint index)
{
    real u, v;
    sequence_point(sequence, index, u, v);
    exact real3 point = real3(get_quad_light(i).corner.xyz) + u * real3(get_quad_light(i).edge_u.xyz) +
                        v * real3(get_quad_light(i).edge_v.xyz);
    return point;
}

// What a point of a quad light, its k-th, gives: its irradiance times the area that the matte point sees.
real quad_irradiance(Matte matte, int i, real3 light, int k, inout Tally tally)
{
    real3 to_light;
    real irradiance = point_irradiance(matte, light, to_light, tally);
    exact real projected_area = dot3(real3(get_quad_light(i).area_normal.xyz), to_light);
    bool lit = irradiance > real(0) && projected_area > real(0);
    note(tally, lit ? 1u : 0u);
    TELL(if (!out_of_steps) emit_light(POINT_LIGHTS + i, k, light, projected_area);)
    exact real seen = lit ? irradiance * projected_area : real(0);
    return seen;
}

// The points that go with a sample of the pixel begin a block of the sequence.
uint first_point(Sequence sequence, uint sample_index)
{
    return shuffled(sequence, sample_index) << (findMSB(LIGHT_SAMPLES - 1) + 1);
}

real3 quad_radiance(Matte matte, int i, uint sample_index, uint seed, inout Tally tally)
{
    Sequence sequence = sequence_of(seed);
    uint first = first_point(sequence, sample_index);
    exact real sum = real(0);
    real3 light = quad_point(i, sequence, first);
    for (int k = 0; k < LIGHT_SAMPLES; ++k) {
        // found while the processor waits for this one's root
        real3 next = quad_point(i, sequence, first + uint(k) + 1u);
        sum = sum + quad_irradiance(matte, i, light, k, tally);
        light = next;
    }
    exact real3 total = real3(get_quad_light(i).radiance.xyz) * sum;
    return total;
}

real3 point_light_radiance(Matte matte, int i, inout Tally tally)
{
    real3 to_light;
    real irradiance = point_irradiance(matte, real3(get_point_light(i).position.xyz), to_light, tally);
    note(tally, irradiance > real(0) ? 1u : 0u);
    TELL(if (!out_of_steps) emit_light(i, 0, real3(get_point_light(i).position.xyz), real(1));)
    exact real3 radiance = irradiance * real3(get_point_light(i).intensity.xyz);
    return radiance;
}

// Radiance per unit of albedo / pi.
real3 direct_light(Matte matte, uint sample_index, uint seed, inout Tally tally)
{
    exact real3 sum = real3(0);
    if (POINT_LIGHTS > 0) // lavapipe runs the body of an empty loop once, masked
        for (int i = 0; i < POINT_LIGHTS; ++i)
            sum = sum + point_light_radiance(matte, i, tally);
    if (QUAD_LIGHTS > 0)
        for (int i = 0; i < QUAD_LIGHTS; ++i)
            sum = sum + quad_radiance(matte, i, sample_index, seed + uint(i), tally);
    return sum;
}

// So many points of lights that a matte point takes several turns.
const uint LIGHT_POINTS = uint(POINT_LIGHTS) + uint(QUAD_LIGHTS) * uint(LIGHT_SAMPLES);
const bool LIGHTS_TAKE_TURNS = HIERARCHY || LIGHT_POINTS > LIGHT_POINTS_A_TURN;

// How far a matte point has got.
struct Lighting {
    uint next;     // point, of all lights
    real3 sum;
    real quad_sum; // of the quad light whose points are being added
};

void begin_light(out Lighting light)
{
    light.next = 0u;
    light.sum = real3(0);
    light.quad_sum = real(0);
}

// Adds the next points. Whether there are more.
bool light_on(Matte matte, uint sample_index, uint seed, inout Lighting light, inout Tally tally)
{
    out_of_steps = false;
    for (uint turn = 0u; turn < min(LIGHT_POINTS_A_TURN, LIGHT_POINTS) && !out_of_steps; ++turn) {
        int point = int(light.next) - POINT_LIGHTS;
        Tally before = tally;
        if (point < 0) {
            exact real3 sum = light.sum + point_light_radiance(matte, int(light.next), tally);
            light.sum = out_of_steps ? light.sum : sum;
        } else if (light.next < LIGHT_POINTS) {
            int i = point / LIGHT_SAMPLES, k = point % LIGHT_SAMPLES;
            Sequence sequence = sequence_of(seed + uint(i));
            uint first = first_point(sequence, sample_index);
            real3 on_light = quad_point(i, sequence, first + uint(k));
            exact real quad_sum = light.quad_sum + quad_irradiance(matte, i, on_light, k, tally);
            exact real3 sum = light.sum + real3(get_quad_light(i).radiance.xyz) * quad_sum;
            bool last = k + 1 == LIGHT_SAMPLES;
            light.sum = last && !out_of_steps ? sum : light.sum;
            light.quad_sum = out_of_steps ? light.quad_sum : last ? real(0) : quad_sum;
        }
        if (out_of_steps)
            tally = before;
        else
            light.next = min(light.next + 1u, LIGHT_POINTS);
    }
    return light.next < LIGHT_POINTS;
}
