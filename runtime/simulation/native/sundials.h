/* Common parts of the two solvers of SUNDIALS: a context, and vectors over our own arrays. */
#ifndef KINTRAFO_SUNDIALS_H
#define KINTRAFO_SUNDIALS_H

#include "versions.h"
#include "worker.h"

#include <nvector/nvector_serial.h>

typedef struct {
    SUNContext context;
    N_Vector y, tolerance, scratch; /* y is over the worker's array */
} kt_vectors;

/* Returns 0, or another number without memory. */
int kt_open_vectors(kt_vectors *v, worker *w);

void kt_close_vectors(kt_vectors *v);

/* Evaluate the right-hand side for SUNDIALS; `data` is the worker. */
int kt_call_rates(sunrealtype time, N_Vector y, N_Vector out, void *data);

#endif
