// Rays against spheres and planes, without any tolerance: a ray knows which surface it leaves and to which
// side, and a point is known to lie on that surface and outside everything it cannot have entered.

struct Ray {
    real3 origin, direction; // direction of length 1
    int surface;             // the object the ray leaves, -1 for the camera; spheres first, then planes
    bool inward;             // it leaves that surface towards the inside of a sphere
};

// Where a line passes a sphere (Haines et al., "Precision Improvements for Ray/Sphere Intersection", Ray
// Tracing Gems, chapter 7): all terms are of the sphere's size, however far away it is.
struct Approach {
    real along;              // from the origin to the closest approach, the line's point nearest to the centre
    real3 center_offset;     // from the closest approach to the centre
    real half_chord_squared; // negative: it misses
};

Approach approach_sphere(real3 to_center, real3 direction, real radius)
{
    exact real along = dot3(to_center, direction);
    exact real3 center_offset = to_center - along * direction;
    exact real half_chord_squared = radius * radius - dot3(center_offset, center_offset);
    return Approach(along, center_offset, half_chord_squared);
}

real half_chord_of(Approach approach)
{
    exact real half_chord = square_root(approach.half_chord_squared > real(0) ? approach.half_chord_squared : real(0));
    return half_chord;
}

bool lies_inside(real3 to_center, real radius)
{
    exact real radius_squared = radius * radius;
    return dot3(to_center, to_center) < radius_squared;
}

struct Hit {
    real distance;
    int surface;  // -1: none
    bool from_inside; // met from the inside of a sphere, or from the glass side of a transparent plane
    vec4 shape;   // center_radius or normal_offset
    vec4 parameters;
    float oren_nayar_b;
    int kind;
    int file_order;
    int others_before; // see OTHERS_BEFORE
    real3 center_offset; // sphere: see Approach
    real half_chord;
    real curvature; // of giants; of others 0
};

// Of surfaces at the same distance the first of the scene file counts.
bool comes_first(real distance, int file_order, Hit nearest)
{
    if (MIXED_ORDER)
        return distance < nearest.distance || (distance == nearest.distance && file_order < nearest.file_order);
    return distance < nearest.distance;
}

void take(bool closer, inout Hit nearest, real distance, int surface, bool from_inside, vec4 shape,
          PackedSurface material, int file_order)
{
    nearest.distance = closer ? distance : nearest.distance;
    nearest.surface = closer ? surface : nearest.surface;
    nearest.from_inside = closer ? from_inside : nearest.from_inside;
    nearest.shape = closer ? shape : nearest.shape;
    nearest.parameters = closer ? material.parameters : nearest.parameters;
    nearest.oren_nayar_b = closer ? material.more_parameters.OREN_NAYAR_B : nearest.oren_nayar_b;
    nearest.kind = closer ? material.tags.SURFACE_KIND : nearest.kind;
    nearest.file_order = closer ? file_order : nearest.file_order;
    nearest.others_before = closer ? material.tags.OTHERS_BEFORE : nearest.others_before;
    nearest.curvature = closer ? real(0) : nearest.curvature;
}

void meet_sphere(Ray ray, int i, inout Hit nearest)
{
    vec4 shape = get_sphere(i).center_radius;
    ivec4 tags = get_sphere(i).tags;
    real radius = real(shape.w);
    exact real3 to_center = real3(shape.xyz) - ray.origin;
    Approach approach = approach_sphere(to_center, ray.direction, radius);
    bool own = ray.surface == i;

    // From outside: the near end of the chord.
    exact real half_chord = half_chord_of(approach);
    exact real distance = approach.along - half_chord;
    bool met = !own && approach.along > real(0) && approach.half_chord_squared > real(0);
    bool from_inside = false;
    if (RAYS_ENTER_SPHERES) {
        // From the surface inward the way is a whole chord: it is certain to end on the sphere.
        bool through = own && ray.inward;
        exact real chord = approach.along > real(0) ? real(2) * approach.along : real(0);
        bool inside = false;
        if (SPHERES_HOLD_RAYS)
            inside = !own && tags.HOLDS_RAYS != 0 && lies_inside(to_center, radius);
        exact real far_end = approach.along + half_chord;
        far_end = far_end > real(0) ? far_end : real(0);
        from_inside = through || inside;
        met = met || from_inside;
        distance = through ? chord : (inside ? far_end : distance);
    }
    bool closer = met && comes_first(distance, tags.FILE_ORDER, nearest);
    take(closer, nearest, distance, i, from_inside, shape, get_surface(i), tags.FILE_ORDER);
    nearest.center_offset = closer ? approach.center_offset : nearest.center_offset;
    nearest.half_chord = closer ? half_chord : nearest.half_chord;
}

// normal . v for plane i. Along an axis the other two products are zeros, which change no bit.
real dot_normal(int i, real3 normal, real3 v)
{
    uint axis = i < 16 ? PLANE_AXES >> (2 * i) & 3u : 0u;
    exact real along_x = normal.x * v.x;
    exact real along_y = normal.y * v.y;
    exact real along_z = normal.z * v.z;
    exact real general = dot3(normal, v);
    return axis == 1u ? along_x : axis == 2u ? along_y : axis == 3u ? along_z : general;
}

void meet_plane(Ray ray, int i, inout Hit nearest)
{
    vec4 shape = get_plane(i).normal_offset;
    PackedSurface material = get_plane(i).surface;
    real3 normal = real3(shape.xyz);
    exact real slope = dot_normal(i, normal, ray.direction);
    exact real height = dot_normal(i, normal, ray.origin) - real(shape.w);
    bool met = slope < -real(PARALLEL);
    bool from_inside = false;
    bool transparent = GLASS_PLANES && material.tags.SURFACE_KIND == KIND_TRANSPARENT;
    if (transparent) {
        from_inside = slope > real(0);
        met = from_inside ? slope > real(PARALLEL) && height < real(0) : met && height > real(0);
    } else {
        height = height > real(0) ? height : real(0); // an opaque plane is never behind the ray's origin
    }
    exact real distance = divide(height, -slope);
    bool closer = met && ray.surface != ALL_SPHERES + i && comes_first(distance, material.tags.FILE_ORDER, nearest);
    take(closer, nearest, distance, ALL_SPHERES + i, from_inside, shape, material, material.tags.FILE_ORDER);
}

Hit no_hit()
{
    Hit none;
    none.distance = real(FARTHEST_HIT);
    none.surface = -1;
    none.from_inside = false;
    none.shape = vec4(0);
    none.parameters = vec4(0);
    none.oren_nayar_b = 0.0;
    none.kind = KIND_MATTE;
    none.file_order = 0;
    none.others_before = 0;
    none.center_offset = real3(0);
    none.half_chord = real(0);
    none.curvature = real(0);
    return none;
}

#include "giant.glsl"
#include "hierarchy.glsl"

// With a hierarchy, if search.stage is SEARCH_DONE.
Hit nearest_hit(Ray ray)
{
    Hit nearest = no_hit();
    for (int i = 0; i < SPHERES; ++i) {
        if (is_giant(i))
            meet_giant(ray, i, nearest);
        else
            meet_sphere(ray, i, nearest);
    }
    for (int i = 0; i < PLANES; ++i)
        meet_plane(ray, i, nearest);
    if (HIERARCHY)
        search_nearest(ray, nearest);
    return nearest;
}

// The hit's point, put on the surface, and the unit normal that faces the ray.
void hit_point(Ray ray, Hit hit, out real3 point, out real3 facing_normal)
{
    real3 shape = real3(hit.shape.xyz);
    real w = real(hit.shape.w);
    exact real3 from_center = -(hit.center_offset + (hit.from_inside ? -hit.half_chord : hit.half_chord) * ray.direction);
    exact real3 sphere_normal = unit(from_center);
    exact real3 on_sphere = shape + w * sphere_normal;
    exact real3 position = ray.origin + hit.distance * ray.direction;
    exact real off = dot3(shape, position) - w;
    exact real3 on_plane = position - off * shape;
    bool sphere = hit.surface < ALL_SPHERES;
    point = sphere ? on_sphere : on_plane;
    exact real3 normal = sphere ? sphere_normal : shape;
    if (GIANTS != 0u) {
        exact real3 gradient = giant_gradient(hit.shape, hit.curvature, position);
        exact real3 on_giant = position - giant_height(hit.shape, hit.curvature, position) * gradient;
        exact real3 giant_normal = unit(gradient);
        point = hit.curvature > real(0) ? on_giant : point;
        normal = hit.curvature > real(0) ? giant_normal : normal;
    }
    facing_normal = hit.from_inside ? -normal : normal;
}

// Whether sphere i stands between a point on `surface` (its inner side if `inward`) and a light point at
// `distance` in unit direction `to_light`.
bool sphere_shadows(int i, real3 point, int surface, bool inward, real3 to_light, real distance, real3 light)
{
    real3 center = real3(get_sphere(i).center_radius.xyz);
    real radius = real(get_sphere(i).center_radius.w);
    exact real3 to_center = center - point;
    Approach approach = approach_sphere(to_center, to_light, radius);
    bool own = surface == i;
    bool shadows = approach.along > real(0) && approach.half_chord_squared > real(0) && approach.along < distance;
    if (RAYS_ENTER_SPHERES || SPHERES_HOLD_LIGHTS) {
        bool point_inside = own && inward;
        bool light_inside = false;
        if (SPHERES_HOLD_RAYS && get_sphere(i).tags.HOLDS_RAYS != 0 && !own)
            point_inside = lies_inside(to_center, radius);
        if (SPHERES_HOLD_LIGHTS && get_sphere(i).tags.HOLDS_LIGHTS != 0) {
            exact real3 light_to_center = center - light;
            light_inside = lies_inside(light_to_center, radius);
        }
        if (point_inside || light_inside)
            shadows = point_inside != light_inside;
    }
    return shadows && !(own && !inward);
}

// A segment crosses a plane exactly when its ends lie on different sides. The point is known to lie on the
// front of every opaque plane.
bool plane_shadows(int i, real3 point, int surface, real3 light)
{
    if (get_plane(i).surface.tags.CASTS_SHADOWS == 0)
        return false;
    real3 normal = real3(get_plane(i).normal_offset.xyz);
    real offset = real(get_plane(i).normal_offset.w);
    exact real light_height = dot3(normal, light) - offset;
    if (!(GLASS_PLANES && get_plane(i).surface.tags.SURFACE_KIND == KIND_TRANSPARENT))
        return light_height < real(0);
    exact real point_height = dot3(normal, point) - offset;
    return surface != ALL_SPHERES + i && ((light_height < real(0)) != (point_height < real(0)));
}

// Unless out_of_steps.
bool in_shadow(real3 point, int surface, bool inward, real3 to_light, real distance, real3 light)
{
    bool shadowed = false;
    TELL(light_blocker = -1;)
    for (int i = 0; i < SPHERES; ++i) {
        bool shadows;
        if (is_giant(i))
            shadows = giant_shadows(i, point, surface, inward, to_light, distance, light);
        else
            shadows = sphere_shadows(i, point, surface, inward, to_light, distance, light);
        shadowed = shadows || shadowed;
        TELL(note_blocker(i, shadowed);)
        if (!PROCESSOR && shadowed) // lavapipe only masks what is skipped
            return true;
    }
    if (HIERARCHY && !shadowed)
        shadowed = search_blocker(point, surface, inward, to_light, distance, light);
    if (PLANES_SHADOW)
        for (int i = 0; i < PLANES; ++i) {
            shadowed = plane_shadows(i, point, surface, light) || shadowed;
            TELL(note_blocker(ALL_SPHERES + i, shadowed);)
            if (!PROCESSOR && shadowed)
                return true;
        }
    return shadowed;
}
