// Rays that escape: reflected between parallel mirrors for ever. Seen along the mirrors' normal, such a ray runs straight
// on; where that line leads away from all matte planes and past all spheres, the ray ends nowhere, and brings nothing.

bool escapes(Ray ray)
{
    real3 normal = real3(hoisted_view.between_mirrors.xyz);
    real towards_mirror = dot3(ray.direction, normal);
    bool escaping = towards_mirror > real(MIRROR_DRIFT) || towards_mirror < -real(MIRROR_DRIFT);
    for (int i = 0; i < PLANES; ++i) {
        PackedPlane plane = get_plane(i);
        real away = dot3(ray.direction, real3(plane.normal_offset.xyz));
        escaping = escaping && (plane.surface.tags.SURFACE_KIND == KIND_MIRROR || away > real(MIRROR_DRIFT));
    }
    exact real3 line = ray.direction - towards_mirror * normal;
    if (SPHERES > 0) // lavapipe runs the body of an empty loop once, masked
        for (int i = 0; i < SPHERES; ++i) {
            vec4 sphere = get_sphere(i).center_radius;
            exact real3 to_center = real3(sphere.xyz) - ray.origin;
            exact real3 apart = to_center - dot3(to_center, normal) * normal;
            exact real reach = real(sphere.w) + real(MIRROR_DRIFT) * (abs(apart.x) + abs(apart.y) + abs(apart.z) + real(1));
            real along = dot3(apart, line);
            real line_squared = dot3(line, line);
            real apart_squared = dot3(apart, apart);
            exact real reach_squared = reach * reach;
            exact real reach_on_line = reach_squared * line_squared;
            exact real beside = apart_squared * line_squared - along * along;
            escaping = escaping && (along > real(0) ? beside > reach_on_line : apart_squared > reach_squared);
        }
    return escaping;
}
