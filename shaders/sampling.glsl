// Low-discrepancy points in integers: the first two dimensions of Sobol's sequence, shuffled and
// Owen-scrambled by hashing (Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020).

// A bijection of 32 bits (C. Wellons, "Prospecting for hash functions", lowbias32).
uint hash(uint x)
{
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    x ^= x >> 16;
    return x;
}

// Owen scrambling of a number whose bits stand in reverse: each bit flips by a function of the lower
// ones (constants: N. Vegdahl, "Building a Better LK Hash", 2021).
uint scramble_reversed(uint x, uint seed)
{
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

// Sobol's second dimension with the bits in reverse: bit j is the parity of the bits k of index with
// C(k, j) odd, that is, with j a subset of k (Lucas).
uint sobol_second_reversed(uint index)
{
    index ^= (index >> 1) & 0x55555555u;
    index ^= (index >> 2) & 0x33333333u;
    index ^= (index >> 4) & 0x0f0f0f0fu;
    index ^= (index >> 8) & 0x00ff00ffu;
    index ^= (index >> 16) & 0x0000ffffu;
    return index;
}

// The upper 24 bits as a fraction in [0, 1), exactly.
real fraction(uint bits)
{
    exact real value = real(bits >> 8) * real(5.9604644775390625e-8);
    return value;
}

struct Sequence {
    uint shuffle, scramble_u, scramble_v;
};

Sequence sequence_of(uint seed)
{
    uint shuffle = hash(seed);
    uint scramble_u = hash(shuffle + 1u);
    uint scramble_v = hash(shuffle + 2u);
    return Sequence(shuffle, scramble_u, scramble_v);
}

// Point number `index` of the sequence in u, v in [0, 1).
void sequence_point(Sequence sequence, uint index, out real u, out real v)
{
    u = fraction(bitfieldReverse(scramble_reversed(index, sequence.scramble_u)));
    v = fraction(bitfieldReverse(scramble_reversed(sobol_second_reversed(index), sequence.scramble_v)));
}

// Keeps blocks of numbers together whose sizes are powers of two.
uint shuffled(Sequence sequence, uint number)
{
    return bitfieldReverse(scramble_reversed(bitfieldReverse(number), sequence.shuffle));
}
