#ifndef VKWHITTED_ORACLE_BALL_H
#define VKWHITTED_ORACLE_BALL_H

#include <arb.h>

/* Numbers with rigorous error bounds: a ball holds the exact result of every operation (Johansson, "Arb:
 * efficient arbitrary-precision midpoint-radius interval arithmetic", IEEE Transactions on Computers 66(8),
 * 2017). */

/* A decision that the working precision cannot take. */
struct Undecided {
};

/* What all balls are computed with. */
struct Precision {
    static constexpr long first = 128, last = 2048; /* bits */
    static inline long bits = first;
    static inline int undecided = 0; /* decisions that even the last one cannot tell from an exact tie */
};

class Ball
{
    arb_t value;

  public:
    Ball(double exact = 0)
    {
        arb_init(value);
        arb_set_d(value, exact);
    }
    Ball(const Ball &other)
    {
        arb_init(value);
        arb_set(value, other.value);
    }
    Ball(Ball &&other) noexcept
    {
        arb_init(value);
        arb_swap(value, other.value);
    }
    Ball &operator=(Ball other)
    {
        arb_swap(value, other.value);
        return *this;
    }
    ~Ball()
    {
        arb_clear(value);
    }

    friend Ball operator+(const Ball &a, const Ball &b)
    {
        return of(arb_add, a, b);
    }
    friend Ball operator-(const Ball &a, const Ball &b)
    {
        return of(arb_sub, a, b);
    }
    friend Ball operator*(const Ball &a, const Ball &b)
    {
        return of(arb_mul, a, b);
    }
    friend Ball operator/(const Ball &a, const Ball &b)
    {
        return of(arb_div, a, b);
    }
    friend Ball larger(const Ball &a, const Ball &b)
    {
        return of(arb_max, a, b);
    }
    Ball operator-() const
    {
        return 0.0 - *this;
    }

    friend Ball square_root(const Ball &a)
    {
        Ball root;
        arb_sqrt(root.value, a.value, Precision::bits);
        return root;
    }

    /* Whether a > 0. Throws Undecided where a better precision may tell. A number that the last precision
     * cannot tell from 0 is taken to be 0. */
    friend bool positive(const Ball &a)
    {
        if (arb_is_positive(a.value) || arb_is_nonpositive(a.value))
            return arb_is_positive(a.value);
        if (Precision::bits < Precision::last)
            throw Undecided();
        ++Precision::undecided;
        return false;
    }
    friend bool negative(const Ball &a)
    {
        return positive(-a);
    }

    bool is_zero() const
    {
        return arb_is_zero(value);
    }
    double middle() const
    {
        return arf_get_d(arb_midref(value), ARF_RND_NEAR);
    }
    double radius() const
    {
        return mag_get_d(arb_radref(value));
    }

    /* The largest of the ball's absolute values, rounded up. */
    double largest() const
    {
        mag_t bound;
        mag_init(bound);
        arb_get_mag(bound, value);
        const double result = mag_get_d(bound);
        mag_clear(bound);
        return result;
    }

  private:
    static Ball of(void (*operation)(arb_t, const arb_t, const arb_t, slong), const Ball &a, const Ball &b)
    {
        Ball result;
        operation(result.value, a.value, b.value, Precision::bits);
        return result;
    }
};

struct Vector {
    Ball x, y, z;
};

inline Vector operator+(const Vector &a, const Vector &b)
{
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vector operator-(const Vector &a, const Vector &b)
{
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vector operator*(const Ball &s, const Vector &a)
{
    return {s * a.x, s * a.y, s * a.z};
}
inline Vector product(const Vector &a, const Vector &b)
{
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}
inline Ball dot(const Vector &a, const Vector &b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Ball length(const Vector &a)
{
    return square_root(dot(a, a));
}
inline Vector unit(const Vector &a)
{
    return 1.0 / length(a) * a;
}

#endif
