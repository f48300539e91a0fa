/* What the two solvers of SUNDIALS share: a context, and vectors over arrays of one's own. */
#ifndef KINTRAFO_SUNDIALS_H
#define KINTRAFO_SUNDIALS_H

#include "versions.h"
#include "worker.h"

#include <nvector/nvector_serial.h>

typedef struct {
    SUNContext context;
    N_Vector y, tolerance, scratch; /* y is about the worker's */
} kt_vectors;

/* Returns 0, or another number where there is no memory. */
int kt_open_vectors(kt_vectors *v, worker *w);

void kt_close_vectors(kt_vectors *v);

/* Evaluate the right-hand side, as SUNDIALS calls it; `data` is the worker. */
int kt_call_rates(sunrealtype time, N_Vector y, N_Vector out, void *data);

#endif
