#include "sundials.h"

#include <string.h>

/*
 * The sum of products with which every stage of a Runge-Kutta method begins, in the order of SUNDIALS and
 * so with the same bits. SUNDIALS keeps the sums in memory, and Debian's package of it is not optimised.
 */
static int combine(int count, sunrealtype *factors, N_Vector *vectors, N_Vector out)
{
    for (sunindextype j = 0; j < NV_LENGTH_S(out); ++j) {
        sunrealtype sum = factors[0] * NV_Ith_S(vectors[0], j);
        for (int i = 1; i < count; ++i) {
            sum += factors[i] * NV_Ith_S(vectors[i], j);
        }
        NV_Ith_S(out, j) = sum;
    }
    return 0;
}

int kt_open_vectors(kt_vectors *v, worker *w)
{
    sunindextype n = w->problem->state_count;
    if (open_silent_context(&v->context)) {
        return 1;
    }
    v->y = N_VMake_Serial(n, w->y, v->context);
    if (!v->y) {
        return 1;
    }
    /* clones have the same operations */
    N_VEnableFusedOps_Serial(v->y, SUNTRUE);
    v->y->ops->nvlinearcombination = combine;
    v->tolerance = N_VClone(v->y);
    v->scratch = N_VClone(v->y);
    if (!v->tolerance || !v->scratch) {
        return 1;
    }
    memcpy(N_VGetArrayPointer(v->tolerance), w->options->atol, (size_t)n * sizeof(double));
    return 0;
}

void kt_close_vectors(kt_vectors *v)
{
    N_Vector vectors[] = {v->scratch, v->tolerance, v->y};
    for (int i = 0; i < 3; ++i) {
        if (vectors[i]) {
            N_VDestroy(vectors[i]);
        }
    }
    if (v->context) {
        SUNContext_Free(&v->context);
    }
}

int kt_call_rates(sunrealtype time, N_Vector y, N_Vector out, void *data)
{
    return kt_rates(data, time, N_VGetArrayPointer(y), N_VGetArrayPointer(out));
}
