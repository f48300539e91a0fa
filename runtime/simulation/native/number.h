/*
 * A number, for code that is shared with lanes, where a `real` is a vector of numbers (../lanes/vectors.h).
 * The header of emitted equations, elementary.h, has its own definitions, since these are used separately.
 */
#ifndef KINTRAFO_NUMBER_H
#define KINTRAFO_NUMBER_H

#include <stdint.h>
#include <string.h>

typedef double real;
typedef int64_t bits;
typedef uint64_t digits;

#define INLINE static inline
#define SPREAD(x) (x)

INLINE bits BITS(real x)
{
    bits found;
    memcpy(&found, &x, sizeof found);
    return found;
}

INLINE real REAL(bits x)
{
    real found;
    memcpy(&found, &x, sizeof found);
    return found;
}

INLINE real choose(bits either, real one, real other) { return either ? one : other; }

/* One instruction each; fmax and fmin may be calls. */
INLINE real greater(real x, real y) { return x < y ? y : x; }

INLINE real lesser(real x, real y) { return y < x ? y : x; }

#endif
