/*
 * Logarithm and power of two, accurate enough for the choice of a step (1e-4), with the same bits on every
 * machine. The including file defines whether a `real` is a number or a vector.
 */
#ifndef KINTRAFO_POWERS_H
#define KINTRAFO_POWERS_H

/* Added to a number and subtracted again, it rounds the number to an integer. */
#define WHOLE 6755399441055744.0

/* Of a normal positive number. Polynomials through Chebyshev's nodes, here between 1 and 2. */
INLINE real logarithm(real x)
{
    const real two_52 = SPREAD(4503599627370496.0);
    bits exponent = (bits)((digits)BITS(x) >> 52);
    real whole = REAL(exponent | BITS(two_52)) - two_52 - 1023.0;
    real m = REAL((BITS(x) & 0x000fffffffffffffLL) | 0x3ff0000000000000LL);
    return whole + (-2.49835315 + m * (4.02921139 + m * (-2.07833517 + m * (0.62603218
        - m * 0.07844068))));
}

/* For exponents of magnitude below 1000. */
INLINE real exponential(real x)
{
    real moved = x + WHOLE, part = x - (moved - WHOLE);
    real m = 0.99992456 + part * (0.69313673 + part * (0.24263948 + part * 0.05583828));
    return REAL((bits)((digits)BITS(m) + ((digits)BITS(moved) << 52)));
}

/* A logarithm that is finite for zero, infinity and NaN, too. */
INLINE real bounded_logarithm(real x)
{
    x = choose(x < 1.0e60, x, SPREAD(1.0e60));
    return logarithm(choose(x > 1.0e-60, x, SPREAD(1.0e-60)));
}

#endif
