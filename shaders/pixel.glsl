// A pixel, sample after sample: what its rays bring, what it is charged for those that are not traced, and its values in
// the picture.

// What a pixel's four values are: radiance and what the pixel is charged for rays that were not traced, summed over its
// samples (0 unless wanted); or with COUNTS, in the same memory, the numbers of secondary and shadow rays, the path
// signature (a hash of every decision of the ray tree) and 0.
layout(std430, set = 0, binding = 8) buffer Picture { real4 picture[]; };
layout(std430, set = 0, binding = 8) buffer Counts { uvec4 counts[]; };

const bool CHARGED = CHARGES || PRUNES || RECORDS;

struct Pixel {
    real3 radiance; // sum over the samples
    real3 leaves, rounding; // of the sample: the rounded sum of what its rays see, and what rounding took from it
    real charge; // of the sample: the weight of rays that are not traced, see ROUND_UP
    real room; // of the sample: what is left of the allowance
    real waiting; // roots of the weights on the stack, summed
    real charges; // of the samples before
    uint seed;
    Sequence sequence; // of its samples' places
    uint sample_index;
    Tally tally;
};

// Charges, rounded up, and a ray of this weight.
real charge(real charges, real weight)
{
    exact real sum = (charges + weight) * real(ROUND_UP);
    return sum;
}

// For a ray that is not traced. Where MAX_BOUNCES cuts off more than the allowance, the room is for the others.
void add_charge(inout Pixel pixel, real weight)
{
    real allowance = real(hoisted_view.truncation.ALLOWANCE);
    exact real room = (pixel.room - weight) * real(ROUND_DOWN);
    exact real least = allowance * real(LEAST_ROOM);
    if (PRUNES && weight <= pixel.room)
        pixel.room = room >= least ? room : real(0);
    if (CHARGED)
        pixel.charge = charge(pixel.charge, weight);
}

// What stands for a ray's share in what will be left out; see NUMERICS.md.
real root_of(real weight)
{
    real root = real(0);
    if (PRUNES)
        root = square_root(weight);
    return weight > real(SMALLEST_WEIGHT) ? root : real(0);
}

// Whether a ray of this weight and root is to be traced, of the rays that are still to be traced, whose roots come to
// `open`; where it is not, the sample has been charged for it.
bool is_traced(inout Pixel pixel, real weight, real root, real open)
{
    real allowance = real(hoisted_view.truncation.ALLOWANCE);
    real charged = charge(pixel.charge, weight);
    bool fits = weight <= pixel.room && (charged <= allowance || pixel.charge > allowance);
    exact real spent = root * open * open;
    exact real to_spend = pixel.room * (pixel.room * real(hoisted_view.truncation.SPENDING));
    bool traced = weight > real(SMALLEST_WEIGHT) && !(PRUNES && fits && spent <= to_spend);
    if (!traced)
        add_charge(pixel, weight);
    return traced;
}

// A leaf of the ray tree: what a ray sees that ends there. The exact rounding error of each sum is kept (Knuth, TAOCP 2,
// 4.2.2), so that leaving out rays changes the picture by what they would have brought, and not by how the others
// round.
void add_leaf(inout Pixel pixel, real3 leaf)
{
    if (!GLASS) { // the sample's only leaf
        pixel.leaves = leaf;
        return;
    }
    exact real3 sum = pixel.leaves + leaf;
    exact real3 added = sum - pixel.leaves;
    exact real3 rounding = pixel.rounding + ((pixel.leaves - (sum - added)) + (leaf - added));
    pixel.leaves = sum;
    pixel.rounding = rounding;
}

void begin_sample(inout Pixel pixel)
{
    pixel.leaves = real3(0);
    pixel.rounding = real3(0);
    pixel.charge = real(0);
    pixel.room = real(hoisted_view.truncation.ALLOWANCE);
    pixel.waiting = real(0);
}

void seed_pixel(inout Pixel pixel, uvec2 position)
{
    pixel.seed = SAMPLES > 1 || QUAD_LIGHTS > 0 ? hash(hash(position.x) + position.y) : 0u;
    pixel.sequence = sequence_of(pixel.seed);
}

void begin_pixel(out Pixel pixel, uvec2 position)
{
    pixel.radiance = real3(0);
    pixel.charges = real(0);
    pixel.sample_index = 0u;
    pixel.tally = Tally(0u, 0u, 0u);
    seed_pixel(pixel, position);
    begin_sample(pixel);
}

// Adds the sample whose ray tree has been traced to the pixel. Whether the pixel has no samples left.
bool end_sample(inout Pixel pixel)
{
    exact real3 sample_radiance = pixel.leaves + pixel.rounding;
    exact real3 radiance = pixel.radiance + sample_radiance;
    exact real charges = (pixel.charges + pixel.charge) * real(ROUND_UP);
    TELL(emit(EVENT_SAMPLE, ivec4(0), sample_radiance, real3(0), pixel.charge);)
    pixel.radiance = radiance;
    pixel.charges = charges;
    ++pixel.sample_index;
    if (pixel.sample_index < uint(SAMPLES))
        begin_sample(pixel);
    return pixel.sample_index >= uint(SAMPLES);
}

void store(uint place, Pixel pixel)
{
    if (COUNTS) {
        counts[place] = uvec4(pixel.tally.secondary_rays, pixel.tally.shadow_rays, pixel.tally.signature, 0u);
        return;
    }
    exact real3 value = pixel.radiance;
    for (int c = 0; c < 3; ++c) {
        value[c] = SAMPLES > 1 ? divide(value[c], real(SAMPLES)) : value[c];
        value[c] = value[c] < real(SMALLEST_WEIGHT) ? real(0) : value[c]; // a NaN stays to be seen
    }
    TELL(emit(EVENT_PIXEL, ivec4(0), value, real3(0), real(0));)
    picture[place] = real4(value, CHARGED ? pixel.charges : real(0));
}
