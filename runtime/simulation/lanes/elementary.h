/*
 * Sine, cosine and arc tangent in lanes, from sums, products and one quotient: the same bits everywhere.
 *
 * Polynomials and constants are those of Sun's fdlibm ("Developed at SunPro, a Sun Microsystems, Inc.
 * business. Permission to use, copy, modify, and distribute this software is freely granted, provided
 * that this notice is preserved."), without its branches, and in parts that are summed side by side.
 */
#ifndef KINTRAFO_ELEMENTARY_H
#define KINTRAFO_ELEMENTARY_H

#include "vectors.h"

/* Greatest angle of a sine or cosine [rad]: 2^20 quarter turns and products with them are exact. */
#define GREATEST_ANGLE 1.0e6

/* Added to a number, it leaves a whole one in the last digits; taken away again, it has rounded. */
#define ROUNDER 6755399441055744.0

/* The rounding error of a difference. */
INLINE real lost(real x, real y, real difference)
{
    real part = difference - x;
    return (x - (difference - part)) - (y + part);
}

typedef struct {
    real high, low; /* of the angle from the nearest quarter turn on */
    bits quarters;
} turned;

/*
 * Take away quarter turns. Each part of pi/2 but the last has 33 digits, so that its products with up to
 * 2^20 are exact; all four together have 151.
 *
 * The equations wait for a sine as for nothing else: so neither the angle nor the polynomials of it wait
 * for its low part, and their terms are summed in pairs.
 */
INLINE turned reduced(real angle)
{
    bits possible = magnitude(angle) <= GREATEST_ANGLE;
    real moved = angle * 6.36619772367581382433e-01 + ROUNDER, count = moved - ROUNDER;
    real first = angle - count * 1.57079632673412561417e+00;
    real second = count * 6.07710050630396597660e-11, third = count * 2.02226624871116645580e-21;
    real middle = first - second, last = middle - third;
    real rest = lost(first, second, middle) - count * 8.47842766036889956997e-32
        + lost(middle, third, last);
    /* what is no angle, or too great, has a result that is NaN through its rest */
    return (turned){last, choose(possible, rest, SPREAD(NAN)), (bits)moved};
}

INLINE real sine_of_small(real x, real low)
{
    real z = x * x, w = z * z;
    real first = z * 8.33333333332248946124e-03 - 1.66666666666666324348e-01;
    real second = z * 2.75573137070700676789e-06 - 1.98412698298579493134e-04;
    real third = z * 1.58969099521155010221e-10 - 2.50507602534068634195e-08;
    return x + (z * x * (first + w * second + w * w * third) + low * (1.0 - 0.5 * z));
}

INLINE real cosine_of_small(real x, real low)
{
    real z = x * x, w = z * z;
    real first = z * -1.38888888888741095749e-03 + 4.16666666666666019037e-02;
    real second = z * -2.75573143513906633035e-07 + 2.48015872894767294178e-05;
    real third = z * -1.13596475577881948265e-11 + 2.08757232129817482790e-09;
    real half = 0.5 * z, most = 1.0 - half;
    return most + (((1.0 - most) - half) + (w * (first + w * second + w * w * third) - x * low));
}

/* Sine or cosine, whichever a number of quarter turns asks for; two of them turn the sign. */
INLINE real of_quarters(turned t, bits quarters)
{
    real small = choose(-(quarters & 1), cosine_of_small(t.high, t.low),
                        sine_of_small(t.high, t.low));
    return (real)((bits)small ^ ((quarters & 2) << 62));
}

/* At most 1 unit of the last place from the truth. */
INLINE real sine(real angle)
{
    turned t = reduced(angle);
    return of_quarters(t, t.quarters);
}

/* At most 1 unit of the last place from the truth. */
INLINE real cosine(real angle)
{
    turned t = reduced(angle);
    return of_quarters(t, t.quarters + 1);
}

INLINE real arc_of_small(real x)
{
    real z = x * x, w = z * z;
    real odd = z * (3.33333333333329318027e-01
        + w * (1.42857142725034663711e-01
        + w * (9.09088713343650656196e-02
        + w * (6.66107313738753120669e-02
        + w * (4.97687799461593236017e-02 + w * 1.62858201153657823623e-02)))));
    real even = w * (1.99999999998764832476e-01
        + w * (1.11111104054623557880e-01
        + w * (7.69187620504482999495e-02
        + w * (5.83357013379057348645e-02 + w * 3.65315727442169155270e-02))));
    return x * (odd - even);
}

/* At most 2 units of the last place from the truth; zero of twice zero. */
INLINE real arc_tangent(real y, real x)
{
    real width = magnitude(x), height = magnitude(y);
    bits steep = height > width, left = (bits)x < 0;
    real less = choose(steep, width, height), more = choose(steep, height, width);
    /* over half of a right angle's half it is measured from the diagonal */
    bits diagonal = less > 0.4375 * more;
    real above = choose(diagonal, less - more, less), below = choose(diagonal, less + more, more);
    real t = above / choose(below == 0.0, SPREAD(1.0), below);
    /* high and low part of the quarters of a turn's half that are gone already */
    real high = choose(diagonal, SPREAD(7.85398163397448278999e-01), SPREAD(0.0));
    real low = choose(diagonal, SPREAD(3.06161699786838301793e-17), SPREAD(0.0));
    real sense = choose(steep, SPREAD(-1.0), SPREAD(1.0));
    high = choose(steep, 1.57079632679489655800e+00 - high, high);
    low = choose(steep, 6.12323399573676603587e-17 - low, low);
    sense = choose(left, -sense, sense);
    high = choose(left, 3.14159265358979311600e+00 - high, high);
    low = choose(left, 1.22464679914735320717e-16 - low, low);
    return with_sign_of(high + (sense * t - (sense * arc_of_small(t) - low)), y);
}

/* At most 3 units of the last place from the truth; NaN where there is none. */
INLINE real arc_sine(real x) { return arc_tangent(x, root((1.0 - x) * (1.0 + x))); }

#endif
