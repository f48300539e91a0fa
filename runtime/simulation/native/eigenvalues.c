/* Bounds of eigenvalues from the norms of powers, and balancing. */
#include "eigenvalues.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

/* The last bound is that of the power 2^8 of the matrix: at most some per cent above the largest eigenvalue. */
#define SQUARINGS 8

/* Sweeps of balancing; a row and its column are scaled if that reduces their sum below this part. */
#define SWEEPS 8
#define WORTHWHILE 0.95

/* -- powers ----------------------------------------------------------------------------------- */

/* Return the greatest sum of magnitudes in a row, and divide all entries by it. */
static double normalise(double *matrix, int n)
{
    double norm = 0.0;
    for (int i = 0; i < n; ++i) {
        double sum = 0.0;
        for (int j = 0; j < n; ++j) {
            sum += fabs(matrix[i * n + j]);
        }
        norm = fmax(norm, sum);
    }
    for (int i = 0; norm > 0.0 && i < n * n; ++i) {
        matrix[i] /= norm;
    }
    return norm;
}

static void square(const double *matrix, int n, double *out)
{
    memset(out, 0, (size_t)(n * n) * sizeof *out);
    for (int i = 0; i < n; ++i) {
        double *restrict row = out + i * n;
        for (int k = 0; k < n; ++k) {
            double factor = matrix[i * n + k];
            for (int j = 0; factor != 0.0 && j < n; ++j) { /* many entries are zero */
                row[j] += factor * matrix[k * n + j];
            }
        }
    }
}

/*
 * The norm of a power of the matrix is at least that power of every eigenvalue, and the root of the norm
 * converges to the largest eigenvalue as the power grows (Gelfand).
 */
double kt_bound_eigenvalues(double *matrix, double *spare, int n, double enough)
{
    double logarithm = 0.0, part = 1.0;
    for (int k = 0; k <= SQUARINGS; ++k, part *= 0.5) {
        if (k) {
            square(matrix, n, spare);
            double *other = matrix;
            matrix = spare;
            spare = other;
        }
        logarithm += part * log2(normalise(matrix, n)); /* the zero matrix */
        if (logarithm <= log2(enough)) {
            break;
        }
    }
    return exp2(logarithm);
}

/* -- balancing -------------------------------------------------------------------------------- */

/* Multiply a row by a weight, and divide its column by it; a weight of zero makes both zero. */
static void weigh(double *matrix, int n, int element, double weight)
{
    double inverse = weight > 0.0 ? 1.0 / weight : 0.0;
    for (int i = 0; i < n; ++i) {
        if (i != element) {
            matrix[element * n + i] *= weight;
            matrix[i * n + element] *= inverse;
        }
    }
}

/* Scale a row and its column to equal size; return whether that reduced their sum. */
static int balance_element(double *matrix, int n, int element, double *weight)
{
    double own = fabs(matrix[element * n + element]), row = 0.0, column = 0.0;
    for (int i = 0; i < n; ++i) {
        row += i == element ? 0.0 : fabs(matrix[element * n + i]);
        column += i == element ? 0.0 : fabs(matrix[i * n + element]);
    }
    int alone = row == 0.0 || column == 0.0;
    if (alone && own == 0.0) {
        weigh(matrix, n, element, 0.0);
        int was = *weight != 0.0;
        *weight = 0.0;
        return was;
    }
    /* a sum is at least the diagonal element */
    double by = sqrt(fmax(column, own) / fmax(row, own));
    if (!(row * by + column / by < WORTHWHILE * (row + column))) {
        return 0;
    }
    weigh(matrix, n, element, by);
    *weight *= by;
    return 1;
}

/* Osborne, On pre-conditioning of matrices, Journal of the ACM 7, 1960. */
double kt_balance(double *matrix, int n, double *weights)
{
    for (int i = 0; i < n; ++i) {
        weights[i] = 1.0;
    }
    int goes_on = 1;
    for (int sweep = 0; goes_on && sweep < SWEEPS; ++sweep) {
        goes_on = 0;
        for (int i = 0; i < n; ++i) {
            goes_on |= balance_element(matrix, n, i, weights + i);
        }
    }
    double sum = 0.0;
    for (int i = 0; i < n * n; ++i) {
        sum += matrix[i] * matrix[i];
    }
    return sqrt(sum);
}
