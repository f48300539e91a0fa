/* Gear's formulas and Adams', with CVODE of SUNDIALS. */
#include "sundials.h"

#include <cvode/cvode.h>
#include <stdlib.h>
#include <string.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

typedef struct {
    kt_vectors vectors;
    SUNMatrix matrix;
    SUNLinearSolver linear;
    double *jacobian;
    void *memory;
} multistep;

static int call_jacobian(sunrealtype time, N_Vector y, N_Vector derivative, SUNMatrix matrix,
                         void *data, N_Vector t1, N_Vector t2, N_Vector t3)
{
    (void)derivative, (void)t1, (void)t2, (void)t3;
    worker *w = data;
    multistep *m = w->own;
    int n = w->problem->state_count, refused = kt_jacobian(w, time, N_VGetArrayPointer(y), m->jacobian);
    for (int i = 0; i < n && !refused; ++i) {
        for (int j = 0; j < n; ++j) {
            SM_ELEMENT_D(matrix, i, j) = m->jacobian[n * i + j]; /* SUNDIALS is column-major */
        }
    }
    return refused;
}

static int open_cvode(worker *w, double start)
{
    const kt_options *o = w->options;
    int n = w->problem->state_count;
    multistep *m = w->own = calloc(1, sizeof *m);
    if (!m || kt_open_vectors(&m->vectors, w)) {
        return KT_MEMORY;
    }
    SUNContext context = m->vectors.context;
    m->jacobian = calloc((size_t)n * n, sizeof *m->jacobian);
    m->memory = CVodeCreate(o->method == KT_BDF ? CV_BDF : CV_ADAMS, context);
    m->matrix = SUNDenseMatrix(n, n, context);
    m->linear = m->matrix ? SUNLinSol_Dense(m->vectors.y, m->matrix, context) : NULL;
    if (!m->jacobian || !m->memory || !m->linear) {
        return KT_MEMORY;
    }
    silence_cvode(m->memory);
    double sign = w->end > w->start ? 1.0 : -1.0;
    int bad = CVodeInit(m->memory, kt_call_rates, start, m->vectors.y)
        || CVodeSetUserData(m->memory, w)
        || CVodeSVtolerances(m->memory, o->rtol, m->vectors.tolerance)
        || CVodeSetLinearSolver(m->memory, m->linear, m->matrix)
        || CVodeSetJacFn(m->memory, call_jacobian)
        || CVodeSetMaxNumSteps(m->memory, -1)
        || (o->first_step > 0.0 && CVodeSetInitStep(m->memory, sign * o->first_step))
        || (o->max_step > 0.0 && CVodeSetMaxStep(m->memory, o->max_step));
    return bad ? KT_FAILED : KT_DONE;
}

static void close_cvode(worker *w)
{
    multistep *m = w->own;
    if (!m) {
        return;
    }
    if (m->memory) {
        CVodeFree(&m->memory);
    }
    if (m->linear) {
        SUNLinSolFree(m->linear);
    }
    if (m->matrix) {
        SUNMatDestroy(m->matrix);
    }
    kt_close_vectors(&m->vectors);
    free(m->jacobian);
    free(m);
}

static int step(worker *w, double goal, double *time)
{
    multistep *m = w->own;
    int code = CVode(m->memory, goal, m->vectors.y, time, CV_ONE_STEP);
    return code < 0 ? code : 0;
}

static int set_stop(worker *w, double time)
{
    multistep *m = w->own;
    return CVodeSetStopTime(m->memory, time);
}

static int interpolate(worker *w, double time, int derivative, double *out)
{
    multistep *m = w->own;
    int order = 0;
    CVodeGetLastOrder(m->memory, &order);
    if (derivative > order || CVodeGetDky(m->memory, time, derivative, m->vectors.scratch)) {
        return 1;
    }
    memcpy(out, N_VGetArrayPointer(m->vectors.scratch), (size_t)w->problem->state_count * sizeof *out);
    return 0;
}

static int restart(worker *w, double time, double length)
{
    multistep *m = w->own;
    return CVodeReInit(m->memory, time, m->vectors.y) || CVodeSetInitStep(m->memory, length);
}

static double next_step(worker *w)
{
    multistep *m = w->own;
    double length = 0.0;
    CVodeGetCurrentStep(m->memory, &length);
    return length < 0.0 ? -length : length;
}

static void count(worker *w, kt_statistics *total)
{
    multistep *m = w->own;
    long steps = 0, evaluations = 0, jacobians = 0, factorisations = 0, failures = 0;
    int order = 0;
    CVodeGetNumSteps(m->memory, &steps);
    CVodeGetNumRhsEvals(m->memory, &evaluations);
    CVodeGetNumJacEvals(m->memory, &jacobians);
    CVodeGetNumLinSolvSetups(m->memory, &factorisations);
    CVodeGetNumErrTestFails(m->memory, &failures);
    CVodeGetLastOrder(m->memory, &order);
    total->steps += steps;
    total->evaluations += evaluations;
    total->jacobians += jacobians;
    total->factorisations += factorisations;
    total->error_test_failures += failures;
    total->order = order;
}

const kt_solver kt_cvode = {
    open_cvode, close_cvode, step, set_stop, interpolate, restart,
    next_step, count, CV_TOO_MUCH_ACC, 0,
};
