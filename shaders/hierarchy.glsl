// The spheres that are not looped over, found by a hierarchy of boxes around them, in records of four words:
//   sphere: center and radius
//   box:    for each axis lower | upper << 16, planes of a grid; BOX_FLAG | the record that it leads to
// They come twice. First in pairs, the two children of a box side by side: a nearest hit is looked for in the nearer child
// first, with a short stack. Then as a stream, depth first: who misses a box goes on at the record that it leads to, others
// go on with the next; that needs no stack. It serves shadow rays, and the few rays whose nearest hit was a tie, whose stack
// overflowed, or which took more steps than a dispatch has. No box hides a hit: see SLACK.

#ifdef SCENE_IN_STORAGE
const bool HIERARCHY = ALL_SPHERES > SPHERES;
#else
const bool HIERARCHY = false;
#endif

const uint SEARCH_FRESH = 0u;
const uint SEARCH_IN_STREAM = 1u; // for the nearest sphere
const uint SEARCH_DONE = 2u;      // it is known; now for spheres in front of lights

// How far the search for the ray's nearest sphere has got, and after it that for one in front of a point of a light.
struct Search {
    uint stage;
    int at;        // record of the stream that is next
    int sphere;    // of those not looped over, the nearest so far; -1: none
    real distance; // of the nearest thing so far
    int blocker;   // the first of the file so far; only where events are recorded
};
Search search = Search(SEARCH_FRESH, 0, -1, real(0), -1);
uint steps = 0u;           // that the dispatch has left
bool out_of_steps = false; // in front of a light

#ifdef SCENE_IN_STORAGE

// Texel buffers: lavapipe gathers a texel of each lane without branches; from a storage buffer it takes a loop over lanes
// for each component.
layout(set = 0, binding = 5, rgba32ui) uniform readonly uimageBuffer records;
layout(set = 0, binding = 6, r32ui) uniform readonly uimageBuffer words;
layout(std430, set = 0, binding = 7) readonly buffer SurfaceBlock { PackedSurface surfaces[]; };

// Boxes are enlarged by this, times the sum of the largest coordinates of the ray's origin and of all boxes: 32 units in
// the last place; the errors of the box test and of a computed hit are less (NUMERICS.md, "the device's boxes").
const float SLACK = 1.9073486328125e-06; // 2^-19

const int PENDING = 12; // boxes that a search in pairs can put off

real3 grid_origin, grid_step;
real grid_largest;
int stream_begin, stream_end;

void begin_hierarchy()
{
    if (!HIERARCHY)
        return;
    vec4 origin = uintBitsToFloat(imageLoad(records, GRID_ORIGIN));
    grid_origin = real3(origin.xyz);
    grid_largest = real(origin.w);
    grid_step = real3(uintBitsToFloat(imageLoad(records, GRID_STEP)).xyz);
    ivec4 stream = ivec4(imageLoad(records, STREAM));
    stream_begin = stream.x;
    stream_end = stream.y;
}

int sphere_word(int sphere, int which)
{
    return int(imageLoad(words, stream_end + SPHERE_WORDS * sphere + which).x);
}

uint record_word(int record) { return imageLoad(words, record).x; }

int sphere_of(uint word) { return int(word & (HOLDS_LIGHTS_FLAG - 1u)); }

vec4 shape_of(int sphere) { return uintBitsToFloat(imageLoad(records, sphere_word(sphere, PLACE_IN_PAIRS))); }

bool is_box(uvec4 record) { return int(record.w) < 0; }

int link_of(uvec4 record) { return int(record.w & ~BOX_FLAG); }

// Not min and max: lavapipe makes four instructions of each, for NaN; of these one.
real smaller(real a, real b) { return a < b ? a : b; }
real larger(real a, real b) { return a > b ? a : b; }

// A ray meets plane q of the grid at q scale + lo, if it bounds a box below, or hi.
struct Slabs {
    real3 scale, lo, hi;
};

Slabs slabs_of(real3 origin, real3 direction)
{
    exact real slack = real(SLACK) * (larger(larger(abs(origin.x), abs(origin.y)), abs(origin.z)) + grid_largest);
    exact real3 inverse = real3(0);
    for (int a = 0; a < 3; ++a)
        inverse[a] = divide(real(1), abs(direction[a]) < real(1e-20) ? real(1e-20) : direction[a]);
    exact real3 scale = grid_step * inverse;
    exact real3 lo = (grid_origin - (origin + slack)) * inverse;
    exact real3 hi = (grid_origin - (origin - slack)) * inverse;
    return Slabs(scale, lo, hi);
}

// Whether the record is a box that the ray is in before it has gone farther than limit, and where it enters.
bool enters(uvec4 record, Slabs slabs, real limit, out real distance)
{
    exact real3 at_lo = real3(record.xyz & 0xffffu) * slabs.scale + slabs.lo;
    exact real3 at_hi = real3(record.xyz >> 16) * slabs.scale + slabs.hi;
    distance = larger(larger(smaller(at_lo.x, at_hi.x), smaller(at_lo.y, at_hi.y)),
                      larger(smaller(at_lo.z, at_hi.z), real(0)));
    real leaves = smaller(smaller(larger(at_lo.x, at_hi.x), larger(at_lo.y, at_hi.y)),
                          smaller(larger(at_lo.z, at_hi.z), limit));
    return is_box(record) && distance <= leaves;
}

// Whether the record is a sphere other than the ray's own that the ray meets, and where; as meet_sphere().
bool meets(uvec4 record, int place, int own_place, Ray ray, out real distance)
{
    vec4 shape = uintBitsToFloat(record);
    real radius = real(shape.w);
    exact real3 to_center = real3(shape.xyz) - ray.origin;
    Approach approach = approach_sphere(to_center, ray.direction, radius);
    exact real half_chord = half_chord_of(approach);
    exact real near_end = approach.along - half_chord;
    bool met = approach.along > real(0) && approach.half_chord_squared > real(0);
    distance = near_end;
    if (SPHERES_HOLD_RAYS) {
        bool inside = (record_word(place) & HOLDS_RAYS_FLAG) != 0u && lies_inside(to_center, radius);
        exact real far_end = approach.along + half_chord;
        met = met || inside;
        distance = inside ? larger(far_end, real(0)) : near_end;
    }
    return met && !is_box(record) && place != own_place;
}

// The place of the sphere that a ray leaves; -1: it leaves another surface.
int place_of(int surface, int which)
{
    bool other = surface >= SPHERES && surface < ALL_SPHERES;
    int place = sphere_word(other ? surface - SPHERES : 0, which);
    return other ? place : -1;
}

// Of two at the same distance.
bool comes_before(int sphere, Hit looped)
{
    return search.sphere >= 0 ? sphere < search.sphere : looped.surface >= 0 && sphere < looped.others_before;
}

// A ray that runs inside its sphere meets it after a whole chord.
void begin_search(Ray ray, Hit looped)
{
    search.distance = looped.distance;
    search.sphere = -1;
    if (ray.inward && ray.surface >= SPHERES && ray.surface < ALL_SPHERES) {
        int own = ray.surface - SPHERES;
        vec4 shape = shape_of(own);
        exact real3 to_center = real3(shape.xyz) - ray.origin;
        exact real along = dot3(to_center, ray.direction);
        exact real chord = along > real(0) ? real(2) * along : real(0);
        if (chord < looped.distance || (chord == looped.distance && comes_before(own, looped))) {
            search.distance = chord;
            search.sphere = own;
        }
    }
}

// The nearest sphere of the pairs so far.
struct Found {
    real distance;
    int place;
    bool tied; // with another, or with what is looped over
};

void take_nearer(uvec4 record, int place, int own_place, Ray ray, inout Found found)
{
    real distance;
    bool met = meets(record, place, own_place, ray, distance);
    bool closer = met && distance < found.distance;
    found.tied = !closer && (found.tied || (met && distance == found.distance));
    found.distance = closer ? distance : found.distance;
    found.place = closer ? place : found.place;
}

// Looks for the nearest sphere in the pairs. Whether it is found; otherwise the stream is left.
bool search_pairs(Ray ray)
{
    Slabs slabs = slabs_of(ray.origin, ray.direction);
    int own_place = place_of(ray.surface, PLACE_IN_PAIRS);
    Found found = Found(search.distance, -1, false);
    int at = int(HEAD_RECORDS);
    bool lost = false;
    int pending[PENDING + 1]; // all entries move, so that they stay in registers
    [[unroll]] for (int i = 0; i <= PENDING; ++i)
        pending[i] = -1;
    while (at >= 0 && steps > 0u) {
        uvec4 left = imageLoad(records, at), right = imageLoad(records, at + 1);
        real cut = larger(found.distance, real(0)), left_entry, right_entry;
        bool left_entered = enters(left, slabs, cut, left_entry), right_entered = enters(right, slabs, cut, right_entry);
        take_nearer(left, at, own_place, ray, found);
        take_nearer(right, at + 1, own_place, ray, found);

        bool both = left_entered && right_entered, right_first = right_entry < left_entry;
        int next = (both ? right_first : right_entered) ? link_of(right) : link_of(left);
        int put_off = right_first ? link_of(left) : link_of(right);
        at = left_entered || right_entered ? next : pending[0];
        [[unroll]] for (int i = 0; i < PENDING; ++i) {
            int entry = pending[i];
            pending[i] = both ? put_off : left_entered || right_entered ? entry : pending[i + 1];
            put_off = entry;
        }
        lost = lost || (both && put_off >= 0);
        --steps;
    }
    search.distance = found.distance;
    search.sphere = found.place >= 0 ? sphere_of(record_word(found.place)) : search.sphere;
    return !found.tied && !lost && at < 0;
}

// Looks for the nearest sphere in the stream, and of equally near ones for the first of the file.
void search_stream(Ray ray, Hit looped)
{
    Slabs slabs = slabs_of(ray.origin, ray.direction);
    int own_place = place_of(ray.surface, PLACE_IN_STREAM);
    while (search.at < stream_end && steps > 0u) {
        uvec4 record = imageLoad(records, search.at);
        real distance, entry;
        bool entered = enters(record, slabs, larger(search.distance, real(0)), entry);
        bool met = meets(record, search.at, own_place, ray, distance) && distance <= search.distance;
        int sphere = met ? sphere_of(record_word(search.at)) : 0;
        bool closer = met && (distance < search.distance || comes_before(sphere, looped));
        search.distance = closer ? distance : search.distance;
        search.sphere = closer ? sphere : search.sphere;
        search.at = is_box(record) && !entered ? link_of(record) : search.at + 1;
        --steps;
    }
}

// Takes up the search for the nearest sphere. When it is done and a sphere is nearer than what is looped over, nearest
// becomes that.
void search_nearest(Ray ray, inout Hit nearest)
{
    if (search.stage == SEARCH_FRESH) {
        begin_search(ray, nearest);
        search.stage = search_pairs(ray) ? SEARCH_DONE : SEARCH_IN_STREAM;
        search.at = stream_begin;
    }
    if (search.stage == SEARCH_IN_STREAM) {
        search_stream(ray, nearest);
        if (search.at == stream_end) {
            search.stage = SEARCH_DONE;
            search.at = stream_begin;
        }
    }
    if (search.stage != SEARCH_DONE || search.sphere < 0)
        return;
    vec4 shape = shape_of(search.sphere);
    uint word = record_word(sphere_word(search.sphere, PLACE_IN_PAIRS));
    exact real3 to_center = real3(shape.xyz) - ray.origin;
    Approach approach = approach_sphere(to_center, ray.direction, real(shape.w));
    bool own = ray.surface == SPHERES + search.sphere;
    bool inside = own || (SPHERES_HOLD_RAYS && (word & HOLDS_RAYS_FLAG) != 0u && lies_inside(to_center, real(shape.w)));
    take(true, nearest, search.distance, SPHERES + search.sphere, inside, shape,
         surfaces[sphere_word(search.sphere, SPHERE_SURFACE)], 0);
    nearest.center_offset = approach.center_offset;
    nearest.half_chord = half_chord_of(approach);
}

// Whether a sphere is between the point and the light, as sphere_shadows(); unless out_of_steps.
bool search_blocker(real3 point, int surface, bool inward, real3 to_light, real distance, real3 light)
{
    Slabs slabs = slabs_of(point, to_light);
    int own_place = place_of(surface, PLACE_IN_STREAM);
    bool blocked = RECORDS && search.blocker >= 0;
    if (own_place >= 0 && inward && search.at == stream_begin) {
        vec4 shape = uintBitsToFloat(imageLoad(records, own_place));
        exact real3 light_to_center = real3(shape.xyz) - light;
        bool holds_light = (record_word(own_place) & HOLDS_LIGHTS_FLAG) != 0u && lies_inside(light_to_center, real(shape.w));
        blocked = !holds_light;
        search.blocker = blocked ? surface - SPHERES : -1;
    }
    while (search.at < stream_end && (RECORDS || !blocked) && steps > 0u) {
        uvec4 record = imageLoad(records, search.at);
        vec4 shape = uintBitsToFloat(record);
        exact real3 to_center = real3(shape.xyz) - point;
        Approach approach = approach_sphere(to_center, to_light, real(shape.w));
        bool met = approach.along > real(0) && approach.half_chord_squared > real(0) && approach.along < distance;
        if (SPHERES_HOLD_RAYS || SPHERES_HOLD_LIGHTS) {
            uint word = record_word(search.at);
            exact real3 light_to_center = real3(shape.xyz) - light;
            bool point_inside = (word & HOLDS_RAYS_FLAG) != 0u && lies_inside(to_center, real(shape.w));
            bool light_inside = (word & HOLDS_LIGHTS_FLAG) != 0u && lies_inside(light_to_center, real(shape.w));
            met = point_inside || light_inside ? point_inside != light_inside : met;
        }
        met = met && !is_box(record) && search.at != own_place;
        blocked = blocked || met;
        if (RECORDS && met) {
            int sphere = sphere_of(record_word(search.at));
            search.blocker = search.blocker < 0 || sphere < search.blocker ? sphere : search.blocker;
        }
        real entry;
        search.at = is_box(record) && !enters(record, slabs, distance, entry) ? link_of(record) : search.at + 1;
        --steps;
    }
    out_of_steps = search.at < stream_end && (RECORDS || !blocked);
    if (!out_of_steps) {
        TELL(note_blocker(SPHERES + search.blocker, search.blocker >= 0);)
        search.at = stream_begin;
        search.blocker = -1;
    }
    return blocked;
}

#else
void begin_hierarchy() {}
void search_nearest(Ray ray, inout Hit nearest) {}
bool search_blocker(real3 point, int surface, bool inward, real3 to_light, real distance, real3 light) { return false; }
#endif
