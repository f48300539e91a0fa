/* Explicit Runge-Kutta methods with ERKStep of SUNDIALS, by their tables. */
#include "sundials.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
    kt_vectors vectors;
    int order;
    void *memory;
} runge_kutta;

/*
 * ERKStep of SUNDIALS 6.4 assumes that a last stage at the end of the step is the first stage of the next
 * step. For a method without that property, a stage at the end with a weight of zero is added. The method
 * stays the same, and has as many evaluations.
 */
static ARKodeButcherTable table_of(const char *name)
{
    ARKodeButcherTable short_one = ARKodeButcherTable_LoadERKByName(name), table;
    if (!short_one) {
        return NULL;
    }
    int n = short_one->stages, same = fabs(short_one->c[n - 1] - 1.0) < 1e-12;
    for (int i = 0; i < n; ++i) {
        same = same && fabs(short_one->A[n - 1][i] - short_one->b[i]) < 1e-12;
    }
    if (same) {
        return short_one;
    }
    table = ARKodeButcherTable_Alloc(n + 1, SUNTRUE);
    if (table) {
        table->q = short_one->q;
        table->p = short_one->p;
        for (int i = 0; i < n; ++i) {
            table->c[i] = short_one->c[i];
            table->A[n][i] = table->b[i] = short_one->b[i];
            table->d[i] = short_one->d[i];
            for (int j = 0; j < n; ++j) {
                table->A[i][j] = short_one->A[i][j];
            }
        }
        table->c[n] = 1.0;
    }
    ARKodeButcherTable_Free(short_one);
    return table;
}

static int open_erk(worker *w, double start)
{
    const kt_options *o = w->options;
    runge_kutta *m = w->own = calloc(1, sizeof *m);
    if (!m || kt_open_vectors(&m->vectors, w)) {
        return KT_MEMORY;
    }
    m->memory = ERKStepCreate(kt_call_rates, start, m->vectors.y, m->vectors.context);
    if (!m->memory) {
        return KT_MEMORY;
    }
    silence_arkode(m->memory);
    ARKodeButcherTable table = table_of(o->table);
    int unknown = !table || ERKStepSetTable(m->memory, table); /* copies it */
    m->order = unknown ? 0 : table->q;
    ARKodeButcherTable_Free(table);
    if (unknown) {
        return KT_BAD_TABLE;
    }
    /* Without interpolation a cubic suffices, which needs no evaluations of its own. */
    int exact = o->stop_at_outputs && !o->dense && !kt_root_count(w);
    double sign = w->end > w->start ? 1.0 : -1.0;
    int bad = ARKodeSetUserData(m->memory, w)
        || (exact && ARKodeSetInterpolantDegree(m->memory, 3))
        || ARKodeSVtolerances(m->memory, o->rtol, m->vectors.tolerance)
        || ARKodeSetMaxNumSteps(m->memory, -1)
        || (o->first_step > 0.0 && ARKodeSetInitStep(m->memory, sign * o->first_step))
        || (o->max_step > 0.0 && ARKodeSetMaxStep(m->memory, o->max_step));
    return bad ? KT_FAILED : KT_DONE;
}

static void close_erk(worker *w)
{
    runge_kutta *m = w->own;
    if (!m) {
        return;
    }
    if (m->memory) {
        ARKodeFree(&m->memory);
    }
    kt_close_vectors(&m->vectors);
    free(m);
}

static int step(worker *w, double goal, double *time)
{
    runge_kutta *m = w->own;
    int code = ARKodeEvolve(m->memory, goal, m->vectors.y, time, ARK_ONE_STEP);
    return code < 0 ? code : 0;
}

static int set_stop(worker *w, double time)
{
    runge_kutta *m = w->own;
    return ARKodeSetStopTime(m->memory, time);
}

static int interpolate(worker *w, double time, int derivative, double *out)
{
    runge_kutta *m = w->own;
    /* the interpolant is of degree 5 */
    if (derivative > 5 || ARKodeGetDky(m->memory, time, derivative, m->vectors.scratch)) {
        return 1;
    }
    memcpy(out, N_VGetArrayPointer(m->vectors.scratch), (size_t)w->problem->state_count * sizeof *out);
    return 0;
}

static int restart(worker *w, double time, double length)
{
    runge_kutta *m = w->own;
    return ERKStepReInit(m->memory, kt_call_rates, time, m->vectors.y)
        || ARKodeSetInitStep(m->memory, length);
}

static double next_step(worker *w)
{
    runge_kutta *m = w->own;
    double length = 0.0;
    ARKodeGetCurrentStep(m->memory, &length);
    return fabs(length);
}

static void count(worker *w, kt_statistics *total)
{
    runge_kutta *m = w->own;
    long steps = 0, evaluations = 0, failures = 0;
    ARKodeGetNumSteps(m->memory, &steps);
    ARKodeGetNumRhsEvals(m->memory, 0, &evaluations);
    ARKodeGetNumErrTestFails(m->memory, &failures);
    total->steps += steps;
    total->evaluations += evaluations;
    total->error_test_failures += failures;
    total->order = m->order;
}

const kt_solver kt_erk = {
    open_erk, close_erk, step, set_stop, interpolate, restart,
    next_step, count, ARK_TOO_MUCH_ACC, 0,
};
