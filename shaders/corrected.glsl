// Division and square root of floats, correctly rounded (to nearest, ties to even) on any device. Vulkan promises
// division to 2.5 ulp and leaves sqrt to the worse of 1 / inversesqrt, but integers are exact everywhere.
//
// The native operation on operands scaled to [1, 4) only estimates the 24-bit integer result q. From 16 below the
// estimate, q is found by binary search on its remainder, which is computed modulo 2^32 and small enough to be
// true. That bears 8 ulp, which count twice in q where the estimate reaches 2. No loops: lavapipe ends all loops of
// an invocation after 65535 turns. Normal results have no ties: the middle between two floats has an odd factor of
// 25 bits, so that neither its square nor its product with a float is a float. Denormal quotients do, and round to
// even.
//
// Denormal operands count as what they are, denormal quotients come out, and a NaN is 0x7fc00000.

const uint SIGN_BIT = 0x80000000u;
const uint INFINITY_BITS = 0x7f800000u;
const uint NAN_BITS = 0x7fc00000u;
const uint ONE_BITS = 0x3f800000u;
const uint TWO_BITS = 0x40000000u;
const uint IMPLICIT_BIT = 0x00800000u;
const uint FRACTION_BITS = 0x007fffffu;
const int EXPONENT_SHIFT = 23;

// The positive finite number of these bits is mantissa * 2^(exponent - 150) with 2^23 <= mantissa < 2^24.
void take_apart(uint bits, out uint mantissa, out int exponent)
{
    exponent = int(bits >> EXPONENT_SHIFT);
    mantissa = bits & FRACTION_BITS;
    if (exponent == 0) {
        int shift = EXPONENT_SHIFT - findMSB(mantissa);
        mantissa <<= shift;
        exponent = 1 - shift;
    } else {
        mantissa |= IMPLICIT_BIT;
    }
}

// mantissa / 2^23, or twice that.
real scaled(uint mantissa, bool doubled)
{
    return uintBitsToFloat((doubled ? TWO_BITS : ONE_BITS) | (mantissa & FRACTION_BITS));
}

// The 24-bit integer near 2^23 x for x about 1 to 2.
uint estimate_of(real x)
{
    exact real integer = x * real(8388608);
    return uint(integer);
}

// a / b where that is infinite, 0 or NaN because an operand is; all without signs.
bool special_quotient(uint a, uint b, out uint quotient)
{
    quotient = b == INFINITY_BITS ? 0u : INFINITY_BITS; // of a finite a by infinity, or of infinity or by 0
    if (a == 0u)
        quotient = 0u;
    if (a > INFINITY_BITS || b > INFINITY_BITS || (a == b && (a == 0u || a == INFINITY_BITS)))
        quotient = NAN_BITS;
    return a == 0u || b == 0u || a >= INFINITY_BITS || b >= INFINITY_BITS;
}

// quotient / 2^shift, rounded to even; inexact: there is more behind the quotient's last bit.
uint rounded_denormal(uint quotient, int shift, bool inexact)
{
    uint lost = quotient & ((1u << shift) - 1u);
    uint middle = 1u << (shift - 1);
    uint kept = quotient >> shift;
    bool up = lost > middle || (lost == middle && (inexact || (kept & 1u) != 0u));
    return up ? kept + 1u : kept;
}

// By `step`, if that is not too much.
void raise_quotient(uint step, uint divisor, inout uint quotient, inout uint remainder)
{
    uint less = step * divisor;
    bool fits = remainder >= less;
    quotient += fits ? step : 0u;
    remainder -= fits ? less : 0u;
}

void raise_root(uint step, inout uint root, inout uint remainder)
{
    uint less = step * (2u * root + step);
    bool fits = remainder >= less;
    root += fits ? step : 0u;
    remainder -= fits ? less : 0u;
}

real corrected_quotient(real a, real b)
{
    uint bits_a = floatBitsToUint(a);
    uint bits_b = floatBitsToUint(b);
    uint sign = (bits_a ^ bits_b) & SIGN_BIT;
    bits_a &= ~SIGN_BIT;
    bits_b &= ~SIGN_BIT;
    uint special;
    if (special_quotient(bits_a, bits_b, special))
        return uintBitsToFloat(sign | special);

    uint dividend, divisor;
    int exponent_a, exponent_b;
    take_apart(bits_a, dividend, exponent_a);
    take_apart(bits_b, divisor, exponent_b);
    int exponent = exponent_a - exponent_b + 127;
    bool doubled = dividend < divisor; // the dividend, so that 1 <= dividend / divisor < 2
    real scaled_a = scaled(dividend, doubled);
    real scaled_b = scaled(divisor, false);
    if (doubled) {
        dividend <<= 1;
        --exponent;
    }

    uint quotient = estimate_of(native_quotient(scaled_a, scaled_b)) - 16u;
    uint remainder = (dividend << EXPONENT_SHIFT) - quotient * divisor;
    raise_quotient(16u, divisor, quotient, remainder);
    raise_quotient(8u, divisor, quotient, remainder);
    raise_quotient(4u, divisor, quotient, remainder);
    raise_quotient(2u, divisor, quotient, remainder);
    raise_quotient(1u, divisor, quotient, remainder);

    if (exponent >= 255)
        return uintBitsToFloat(sign | INFINITY_BITS);
    if (exponent <= 0)
        return uintBitsToFloat(sign | rounded_denormal(quotient, min(1 - exponent, 25), remainder != 0u));
    if (2u * remainder > divisor)
        ++quotient;
    return uintBitsToFloat(sign | ((uint(exponent - 1) << EXPONENT_SHIFT) + quotient)); // a carry is welcome
}

real corrected_root(real a)
{
    uint bits = floatBitsToUint(a);
    if ((bits & ~SIGN_BIT) == 0u || bits == INFINITY_BITS)
        return a;
    if (bits > INFINITY_BITS) // negative or NaN
        return uintBitsToFloat(NAN_BITS);

    uint mantissa;
    int exponent;
    take_apart(bits, mantissa, exponent);
    // The root of mantissa * 2^23 or, where the power of two would be odd, of mantissa * 2^24.
    bool doubled = (exponent & 1) == 0;
    uint square = mantissa << (doubled ? 24 : 23); // modulo 2^32

    uint root = estimate_of(native_root(scaled(mantissa, doubled))) - 16u;
    uint remainder = square - root * root;
    raise_root(16u, root, remainder);
    raise_root(8u, root, remainder);
    raise_root(4u, root, remainder);
    raise_root(2u, root, remainder);
    raise_root(1u, root, remainder);
    if (remainder > root) // above (root + 1/2)^2 = root^2 + root + 1/4
        ++root;

    uint biased = uint((exponent + 127) >> 1);
    return uintBitsToFloat(((biased - 1u) << EXPONENT_SHIFT) + root);
}
