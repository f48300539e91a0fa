/* Polynomials that interpolate the states within a step. */
#ifndef KINTRAFO_POLYNOMIAL_H
#define KINTRAFO_POLYNOMIAL_H

/*
 * Evaluate a derivative of `count` polynomials at a part of a step. Their coefficients, `terms` x `count`, are
 * those of the powers of the part, the lowest first.
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
