/* Bounds of the eigenvalues of a matrix, and balancing of the matrix. */
#ifndef KINTRAFO_EIGENVALUES_H
#define KINTRAFO_EIGENVALUES_H

/*
 * Balance a matrix, n x n, row-major, and compute the weights: row i is multiplied by its weight and column i is
 * divided by it. A weight is zero if the element takes part in no eigenvalue except zero; its row and column are
 * then zero. Returns the Frobenius norm of the balanced matrix.
 */
double kt_balance(double *matrix, int n, double *weights);

/*
 * Return an upper bound of the magnitudes of all eigenvalues, or the first one found that is at most `enough`. Both
 * matrices, n x n, are overwritten.
 */
double kt_bound_eigenvalues(double *matrix, double *spare, int n, double enough);

#endif
