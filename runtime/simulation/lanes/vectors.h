/*
 * Vectors of numbers, one system in each lane, and what the emitted equations call for them.
 *
 * Vectors are those of GCC and Clang: every operation is that of each lane by itself, so that a lane has
 * the same bits whatever the width, and whatever is in the others.
 */
#ifndef KINTRAFO_VECTORS_H
#define KINTRAFO_VECTORS_H

#include <math.h>

/* How many lanes: 2 are in every processor of 64 bits, 4 in one with AVX2, 8 in one with AVX-512. */
#ifndef WIDTH
#define WIDTH 2
#endif

typedef double kt_real __attribute__((vector_size(8 * WIDTH)));
typedef kt_real real; /* which equations may call something of theirs */
typedef long long bits __attribute__((vector_size(8 * WIDTH)));
typedef unsigned long long digits __attribute__((vector_size(8 * WIDTH)));

#define INLINE static inline __attribute__((always_inline))

/* The same number in all lanes; nothing is changed by it, nor is a vector. */
#define SPREAD(x) ((x) - (kt_real){0.0})

/* The bits of numbers, and numbers of bits. */
#define BITS(x) ((bits)(x))
#define REAL(x) ((real)(x))

/* A vector, or the other one, lane by lane: a mask has all bits of a lane, or none. */
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

/* The compiler makes one instruction of each of these. */
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

/* Where a number is neither NaN nor infinite. */
INLINE bits is_finite(real x) { return x - x == 0.0; }

#endif
