// Whitted's recursion ("An Improved Illumination Model for Shaded Display", CACM 23(6), 1980), one invocation a
// pixel, with an explicit stack that holds only what is pending.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "arithmetic.glsl"
#include "sampling.glsl"
#include "scene.glsl"
#include "intersect.glsl"
#include "shade.glsl"
#include "dielectric.glsl"

layout(local_size_x_id = 0, local_size_y_id = 1) in;
layout(std430, set = 0, binding = 5) writeonly buffer Picture { real picture[]; }; // the tile, RGB
layout(push_constant) uniform Tile {
    uvec2 tile_origin, tile_size, image_size; // pixels
};

struct Pixel {
    real3 radiance;
    uint seed;
    uint sample_index;
    uint shaded; // matte points so far: each draws light samples of its own
    uint secondary_rays, shadow_rays;
};

Ray primary_ray(uvec2 position, real sample_x, real sample_y)
{
    exact real x = real(2 * int(position.x) - int(image_size.x)) + real(2) * sample_x;
    exact real y = real(2 * int(position.y) - int(image_size.y)) + real(2) * sample_y;
    exact real3 through =
        real3(view.forward.xyz) + x * real3(view.half_pixel_right.xyz) + y * real3(view.half_pixel_down.xyz);
    return Ray(real3(view.position.xyz), unit(through), -1, false);
}

void add_matte(inout Pixel pixel, Ray ray, Hit hit, real3 point, real3 normal, real weight)
{
    exact real cos_out = -dot3(normal, ray.direction);
    Matte matte = Matte(point, normal, ray.direction, cos_out, hit.surface, hit.leaving, real(hit.parameters.w),
                        real(hit.oren_nayar_b));
    uint seed = hash(pixel.seed + pixel.shaded * uint(QUAD_LIGHTS));
    exact real3 light = direct_light(matte, pixel.sample_index, seed, pixel.shadow_rays);
    exact real3 reflected_light = real3(hit.parameters.xyz) * light;
    exact real3 radiance = pixel.radiance + weight * reflected_light;
    pixel.radiance = radiance;
    ++pixel.shaded;
}

void trace(inout Pixel pixel, Ray ray)
{
    // Reflections still to be traced: at most one for every bounce count. Arrays and members stand alone,
    // because glslang 12 crashes where `precise` follows a value through a struct constructor in a loop.
    const int room = GLASS && MAX_BOUNCES > 0 ? MAX_BOUNCES : 1;
    real3 stack_origin[room], stack_direction[room];
    real stack_weight[room];
    int stack_surface[room], stack_bounces[room];
    bool stack_inward[room];
    int pending = 0;
    exact real weight = real(1);
    int bounces = 0;
    for (;;) {
        bool goes_on = false;
        Hit hit = nearest_hit(ray);
        if (hit.surface < 0) {
            exact real3 radiance = pixel.radiance + weight * real3(view.background.xyz);
            pixel.radiance = radiance;
        } else {
            real3 point, normal;
            hit_point(ray, hit, point, normal);
            if (hit.kind == KIND_MATTE) {
                add_matte(pixel, ray, hit, point, normal, weight);
            } else if (SECONDARY_RAYS && bounces < MAX_BOUNCES) {
                ++bounces;
                exact real cos_in = -dot3(normal, ray.direction);
                cos_in = cos_in > real(0) ? cos_in : real(0);
                Ray reflection;
                reflection.origin = point;
                reflection.direction = reflected(ray.direction, normal, cos_in);
                reflection.surface = hit.surface;
                reflection.inward = hit.leaving;
                goes_on = true;
                if (GLASS && hit.kind == KIND_TRANSPARENT) {
                    Refraction refraction =
                        refracted(ray.direction, normal, cos_in, real(hit.leaving ? hit.parameters.z : hit.parameters.x),
                                  real(hit.leaving ? hit.parameters.w : hit.parameters.y));
                    if (refraction.total) {
                        ray = reflection;
                    } else {
                        exact real reflected_weight = weight * refraction.reflectance;
                        exact real refracted_weight = weight * (real(1) - refraction.reflectance);
                        bool refracts = refracted_weight > real(SMALLEST_WEIGHT);
                        bool reflects = reflected_weight > real(SMALLEST_WEIGHT);
                        if (refracts && reflects) {
                            stack_origin[pending] = reflection.origin;
                            stack_direction[pending] = reflection.direction;
                            stack_surface[pending] = reflection.surface;
                            stack_inward[pending] = reflection.inward;
                            stack_weight[pending] = reflected_weight;
                            stack_bounces[pending] = bounces;
                            ++pending;
                        }
                        ray = reflection;
                        weight = reflected_weight;
                        if (refracts) {
                            ray.direction = refraction.direction;
                            ray.inward = !hit.leaving;
                            weight = refracted_weight;
                        }
                        goes_on = refracts || reflects;
                    }
                } else {
                    ray = reflection;
                }
                if (COUNT_RAYS && goes_on)
                    ++pixel.secondary_rays;
            }
        }
        if (!SECONDARY_RAYS)
            return;
        if (!goes_on) {
            if (!GLASS || pending == 0)
                return;
            --pending;
            ray.origin = stack_origin[pending];
            ray.direction = stack_direction[pending];
            ray.surface = stack_surface[pending];
            ray.inward = stack_inward[pending];
            weight = stack_weight[pending];
            bounces = stack_bounces[pending];
            if (COUNT_RAYS)
                ++pixel.secondary_rays;
        }
    }
}

void main()
{
    uvec2 in_tile = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(in_tile, tile_size)))
        return;
    uvec2 position = tile_origin + in_tile;

    Pixel pixel = Pixel(real3(0), 0u, 0u, 0u, 0u, 0u);
    if (SAMPLES > 1 || QUAD_LIGHTS > 0)
        pixel.seed = hash(hash(position.x) + position.y);
    if (SAMPLES == 1) {
        trace(pixel, primary_ray(position, real(0.5), real(0.5)));
    } else {
        Sequence sequence = sequence_of(pixel.seed);
        for (int k = 0; k < SAMPLES; ++k) {
            pixel.sample_index = uint(k);
            pixel.shaded = 0u;
            real x, y;
            sequence_point(sequence, uint(k), x, y);
            trace(pixel, primary_ray(position, x, y));
        }
        exact real3 mean = pixel.radiance / real(SAMPLES);
        pixel.radiance = mean;
    }

    real3 value = pixel.radiance;
    if (COUNT_RAYS)
        value = real3(real(SAMPLES), real(pixel.secondary_rays), real(pixel.shadow_rays));
    uint base = (in_tile.y * tile_size.x + in_tile.x) * 3u;
    for (uint c = 0u; c < 3u; ++c)
        picture[base + c] = value[c] > real(SMALLEST_WEIGHT) ? value[c] : real(0);
}
