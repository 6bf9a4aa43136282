// A case's words, read and written one after the other in the order of the harness's records.
uint next_input, next_output;

uint read_integer()
{
    return inputs[next_input++];
}

float read_real()
{
    return uintBitsToFloat(inputs[next_input++]);
}

vec3 read_vector()
{
    vec3 vector;
    vector.x = read_real();
    vector.y = read_real();
    vector.z = read_real();
    return vector;
}

vec4 read_vec4()
{
    vec4 vector;
    vector.xyz = read_vector();
    vector.w = read_real();
    return vector;
}

void write_integer(uint value)
{
    outputs[next_output++] = value;
}

void write_real(float value)
{
    outputs[next_output++] = floatBitsToUint(value);
}

void write_vector(vec3 value)
{
    write_real(value.x);
    write_real(value.y);
    write_real(value.z);
}

Ray read_ray()
{
    Ray ray;
    ray.origin = read_vector();
    ray.direction = read_vector();
    ray.surface = int(read_integer());
    ray.inward = read_integer() != 0u;
    return ray;
}

PackedSurface read_surface()
{
    PackedSurface surface;
    surface.parameters = vec4(0);
    surface.more_parameters = vec4(0);
    surface.tags.SURFACE_KIND = int(read_integer());
    surface.tags.FILE_ORDER = int(read_integer());
    surface.tags.HOLDS_RAYS = int(read_integer());
    surface.tags.HOLDS_LIGHTS = int(read_integer());
    return surface;
}

PackedSphere read_sphere()
{
    PackedSphere sphere;
    sphere.center_radius = read_vec4();
    sphere.surface = read_surface();
    return sphere;
}

PackedPlane read_plane()
{
    PackedPlane plane;
    plane.normal_offset = read_vec4();
    plane.surface = read_surface();
    return plane;
}

struct Segment {
    vec3 from, to, direction;
    float distance;
    int surface;
    bool inward;
};

Segment read_segment()
{
    Segment segment;
    segment.from = read_vector();
    segment.to = read_vector();
    segment.direction = read_vector();
    segment.distance = read_real();
    segment.surface = int(read_integer());
    segment.inward = read_integer() != 0u;
    return segment;
}

Matte read_matte()
{
    Matte matte;
    matte.point = read_vector();
    matte.normal = read_vector();
    matte.ray_direction = read_vector();
    matte.cos_out = read_real();
    matte.surface = int(read_integer());
    matte.inward = read_integer() != 0u;
    matte.a = read_real();
    matte.b = read_real();
    return matte;
}
