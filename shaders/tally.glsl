// What is counted and noted on the way, for outputs other than radiance; compiled away where it is not asked for.

struct Tally {
    uint secondary_rays, shadow_rays;
    uint signature;
};

// Adds a decision to the path's signature.
void note(inout Tally tally, uint decision)
{
    if (OUTPUT == OUTPUT_SIGNATURE)
        tally.signature = hash(tally.signature + decision);
}
