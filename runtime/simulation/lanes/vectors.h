/*
 * Vectors of numbers, one system in each lane, and the functions of emitted equations for them.
 *
 * Vectors are those of GCC and Clang: every operation acts on each lane separately, so that the bits of a lane do
 * not depend on the width or on the other lanes.
 */
#ifndef KINTRAFO_VECTORS_H
#define KINTRAFO_VECTORS_H

#include <math.h>

/* Number of lanes: 2 for every processor of 64 bits, 4 with AVX2, 8 with AVX-512. */
#ifndef WIDTH
#define WIDTH 2
#endif

typedef double kt_real __attribute__((vector_size(8 * WIDTH)));
typedef kt_real real; /* equations may use these names */
typedef long long bits __attribute__((vector_size(8 * WIDTH)));
typedef unsigned long long digits __attribute__((vector_size(8 * WIDTH)));

#define INLINE static inline __attribute__((always_inline))

/* The same number in all lanes; a vector is unchanged. */
#define SPREAD(x) ((x) - (kt_real){0.0})

/* The bits of numbers, and numbers from bits. */
#define BITS(x) ((bits)(x))
#define REAL(x) ((real)(x))

/* The first or the second vector, by lane: a mask has all bits of a lane, or none. */
INLINE bits choose_bits(bits mask, bits one, bits other) { return (one & mask) | (other & ~mask); }

INLINE real choose(bits mask, real one, real other)
{
    return (real)choose_bits(mask, (bits)one, (bits)other);
}

INLINE int any(bits mask)
{
    long long found = 0;
    for (int i = 0; i < WIDTH; ++i) {
        found |= mask[i];
    }
    return found != 0;
}

INLINE real magnitude(real x) { return (real)((bits)x & 0x7fffffffffffffffLL); }

INLINE real with_sign_of(real x, real sign)
{
    return (real)((bits)magnitude(x) | ((bits)sign & ~0x7fffffffffffffffLL));
}

/* The compiler makes each of these one instruction. */
INLINE real greater(real x, real y)
{
    real z;
    for (int i = 0; i < WIDTH; ++i) {
        z[i] = x[i] < y[i] ? y[i] : x[i];
    }
    return z;
}

INLINE real lesser(real x, real y)
{
    real z;
    for (int i = 0; i < WIDTH; ++i) {
        z[i] = y[i] < x[i] ? y[i] : x[i];
    }
    return z;
}

INLINE real root(real x)
{
    real y;
    for (int i = 0; i < WIDTH; ++i) {
        y[i] = sqrt(x[i]);
    }
    return y;
}

/* Mask of the lanes with a finite number. */
INLINE bits is_finite(real x) { return x - x == 0.0; }

#endif
