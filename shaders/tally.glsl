// What is counted and noted on the way; compiled away where it is not asked for.

struct Tally {
    uint secondary_rays, shadow_rays;
    uint signature;
};

// Adds a decision to the path's signature.
void note(inout Tally tally, uint decision)
{
    if (COUNTS)
        tally.signature = hash(tally.signature + decision);
}
