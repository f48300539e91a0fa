/*
 * One file of emitted equations, read as one about vectors: every number that it calls a double is one of
 * each lane. MODEL is its name, in quotes.
 */
#include "elementary.h"

#include <math.h>
#include <stddef.h>

#define KINTRAFO_LANES

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

/* Numbers that depend on nothing are written as such, and come here as such. */
#define number(x) SPREAD(x)
#define at_least(x, least) at_least(SPREAD(x), SPREAD(least))
#define is_positive(x) choose(SPREAD(x) > 0.0, SPREAD(1.0), SPREAD(0.0))
#define guard_bit(quantity, least, bit) guard_bit(quantity, SPREAD(least), bit)
#define copysign(x, sign) with_sign_of(SPREAD(x), SPREAD(sign))
#define fabs(x) magnitude(SPREAD(x))
#define sqrt(x) root(SPREAD(x))
#define sin(x) sine(SPREAD(x))
#define cos(x) cosine(SPREAD(x))
#define asin(x) arc_sine(SPREAD(x))
#define atan2(y, x) arc_tangent(SPREAD(y), SPREAD(x))
#define double real

#include MODEL
