// Giants: spheres so large beside where the camera is that float has no digits of a place there relative to their centre.
// They are stored and met as planes that curve, see PackedSphere.

bool is_giant(int i)
{
    return GIANTS != 0u && (GIANTS >> i & 1u) != 0u;
}

// Near the surface the distance from it, negative inside.
real giant_height(vec4 shape, real curvature, real3 point)
{
    exact real3 mean_gradient = real3(shape.xyz) + (real(0.5) * curvature) * point; // of the origin and the point
    exact real height = dot3(mean_gradient, point) - real(shape.w);
    return height;
}

real3 giant_gradient(vec4 shape, real curvature, real3 point)
{
    exact real3 gradient = real3(shape.xyz) + curvature * point;
    return gradient;
}

// Along a line the height is height + slope t + curvature / 2 t^2; where that is 0, the slope is the root, or minus it.
struct Passage {
    real height, slope, root_squared;
    bool crosses; // the surface, at more of a slope than 2^-50
};

Passage pass_giant(vec4 shape, real curvature, real3 origin, real3 direction, bool may_be_inside)
{
    exact real height = giant_height(shape, curvature, origin);
    height = may_be_inside || height > real(0) ? height : real(0);
    exact real slope = dot3(giant_gradient(shape, curvature, origin), direction);
    exact real root_squared = slope * slope - curvature * (real(2) * height);
    return Passage(height, slope, root_squared, root_squared > real(PARALLEL));
}

void meet_giant(Ray ray, int i, inout Hit nearest)
{
    vec4 shape = get_sphere(i).center_radius;
    ivec4 tags = get_sphere(i).tags;
    real curvature = real(get_surface(i).more_parameters.CURVATURE);
    bool own = ray.surface == i;
    Passage line = pass_giant(shape, curvature, ray.origin, ray.direction, SPHERES_HOLD_RAYS && tags.HOLDS_RAYS != 0);
    exact real root = square_root(line.crosses ? line.root_squared : real(0));
    exact real doubled = real(2) * line.height;
    exact real below = root - line.slope;
    // The distance is a quotient: from outside 2 height / (root - slope).
    real dividend = doubled, divisor = below;
    bool met = !own && line.slope < real(0) && line.crosses;
    bool from_inside = false;
    if (RAYS_ENTER_SPHERES) {
        bool through = own && ray.inward, inside = !own && line.height < real(0);
        bool rising = line.slope > real(0);
        exact real chord = line.slope < real(0) ? real(-2) * line.slope : real(0);
        exact real above = line.slope + root;
        dividend = through ? chord : inside ? (rising ? -doubled : below) : doubled;
        divisor = through || (inside && !rising) ? curvature : inside ? above : below;
        from_inside = through || inside;
        met = met || from_inside;
    }
    exact real distance = divide(dividend, divisor);
    bool closer = met && comes_first(distance, tags.FILE_ORDER, nearest);
    take(closer, nearest, distance, i, from_inside, shape, get_surface(i), tags.FILE_ORDER);
    nearest.curvature = closer ? curvature : nearest.curvature;
}

// As sphere_shadows().
bool giant_shadows(int i, real3 point, int surface, bool inward, real3 to_light, real distance, real3 light)
{
    vec4 shape = get_sphere(i).center_radius;
    ivec4 tags = get_sphere(i).tags;
    real curvature = real(get_surface(i).more_parameters.CURVATURE);
    Passage line = pass_giant(shape, curvature, point, to_light, SPHERES_HOLD_RAYS && tags.HOLDS_RAYS != 0);
    bool own = surface == i;
    exact real bend = curvature * distance; // what the slope grows by on the way
    bool point_inside = own ? inward : line.height < real(0);
    bool light_inside =
        SPHERES_HOLD_LIGHTS && tags.HOLDS_LIGHTS != 0 && giant_height(shape, curvature, light) < real(0);
    exact real descent = -line.slope;
    bool between = line.slope < real(0) && line.crosses && descent < bend;
    return !(own && !inward) && (point_inside || light_inside ? point_inside != light_inside : between);
}
