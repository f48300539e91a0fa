/* Polynomials by which the states within a step are interpolated. */
#ifndef KINTRAFO_POLYNOMIAL_H
#define KINTRAFO_POLYNOMIAL_H

/*
 * Evaluate a derivative of `count` polynomials at a part of a step. Their terms, `terms` x `count`, belong to
 * the powers of the part, the lowest first.
 */
static inline void kt_interpolate(const double *terms, int term_count, int count, double part,
                                  double step, int derivative, double *restrict out)
{
    for (int i = 0; i < count; ++i) {
        out[i] = 0.0;
    }
    for (int k = term_count - 1; k >= derivative; --k) {
        double factor = 1.0;
        for (int j = 0; j < derivative; ++j) {
            factor *= (k - j) / step;
        }
        for (int i = 0; i < count; ++i) {
            out[i] = out[i] * part + factor * terms[k * count + i];
        }
    }
}

#endif
