/* Bounds of the eigenvalues of a matrix, and weights that bring its norm near them. */
#ifndef KINTRAFO_EIGENVALUES_H
#define KINTRAFO_EIGENVALUES_H

/*
 * Balance a matrix, n x n, row-major, and find the weights of the elements of a vector that do so: row i is
 * multiplied by its weight and column i is divided by it. A weight is zero where the element has no part in any
 * eigenvalue but zero; its row and column are then zero. Returns the Frobenius norm of the balanced matrix.
 */
double kt_balance(double *matrix, int n, double *weights);

/*
 * Return a bound of the magnitudes of all eigenvalues, or the first one found that is not above `enough`. Both
 * matrices, n x n, are overwritten.
 */
double kt_bound_eigenvalues(double *matrix, double *spare, int n, double enough);

#endif
