/*
 * A file of emitted equations, compiled for vectors: every double in it becomes a number of each lane. MODEL is
 * its name, in quotes.
 */
#define KINTRAFO_LANES

#include "vectors.h"

#include "elementary.h"

#include <stddef.h>

/* A status word for each lane. */
typedef bits status_word;

INLINE real at_least(real x, real least) { return greater(x, least); }

INLINE bits guard_bit(real quantity, real least, int bit) { return ~(quantity > least) & bit; }

INLINE bits finite_bit(const real *values, int count, int bit)
{
    bits found = {0};
    for (int i = 0; i < count; ++i) {
        found |= ~is_finite(values[i]);
    }
    return found & bit;
}

INLINE bits either(bits applies, int code, bits otherwise)
{
    return choose_bits(applies, (bits){0} + code, otherwise);
}

INLINE bits first_not_finite(const real *values, int count)
{
    bits found = {0};
    for (int i = count; i > 0; --i) {
        found = either(~is_finite(values[i - 1]), i, found);
    }
    return found;
}

/* Names in equations may be those of these headers, except these. */
INLINE real kt_root(real x) { return root(x); }

INLINE real kt_magnitude(real x) { return magnitude(x); }

INLINE real kt_with_sign_of(real x, real sign) { return with_sign_of(x, sign); }

INLINE real is_positive(real x) { return choose(x > 0.0, SPREAD(1.0), SPREAD(0.0)); }

/* Constant numbers stay numbers. */
#define number(x) SPREAD(x)
#define at_least(x, least) at_least(SPREAD(x), SPREAD(least))
#define is_positive(x) is_positive(SPREAD(x))
#define guard_bit(quantity, least, bit) guard_bit(quantity, SPREAD(least), bit)
#define copysign(x, sign) kt_with_sign_of(SPREAD(x), SPREAD(sign))
#define fabs(x) kt_magnitude(SPREAD(x))
#define sqrt(x) kt_root(SPREAD(x))
#define sin(x) kt_sine(SPREAD(x))
#define cos(x) kt_cosine(SPREAD(x))
#define asin(x) kt_arc_sine(SPREAD(x))
#define atan2(y, x) kt_arc_tangent(SPREAD(y), SPREAD(x))
#define exp(x) kt_exponential(SPREAD(x))
#define log(x) kt_logarithm(SPREAD(x))
#define double kt_real

#include MODEL
