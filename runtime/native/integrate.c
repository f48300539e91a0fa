#include "integrate.h"
#include "versions.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

/* What a call works with. The solver is CVODE for the multistep methods, ERKStep for the others. */
typedef struct {
    const kt_problem *problem;
    const kt_options *options;
    kt_result *result;
    SUNContext context;
    N_Vector y, tolerance, scratch;
    SUNMatrix matrix;
    SUNLinearSolver linear;
    void *solver;
    int runge_kutta, order; /* of the Runge-Kutta method */
    double *inputs, *jacobian, *signals;
    int *piece;        /* of each spline: where it was evaluated last */
    int *crossings;    /* of each event */
    int *found;        /* root information of the solver */
    int caller_failed;
} worker;

const char *kt_version(void) { return SUNDIALS_VERSION; }

/* -- tables ----------------------------------------------------------------------------------- */

static double *append(kt_table *table)
{
    if (table->rows == table->capacity) {
        long capacity = table->capacity ? 2 * table->capacity : 256;
        double *data = realloc(table->data, (size_t)capacity * table->width * sizeof *data);
        if (!data) {
            return NULL;
        }
        table->data = data;
        table->capacity = capacity;
    }
    return table->data + table->width * table->rows++;
}

static int append_state(kt_table *table, double time, const double *state, int count)
{
    double *row = append(table);
    if (!row) {
        return KT_MEMORY;
    }
    row[0] = time;
    memcpy(row + 1, state, (size_t)count * sizeof *state);
    return KT_DONE;
}

/* -- inputs ----------------------------------------------------------------------------------- */

/* Steps go forward, so the piece of the last evaluation, or a near one, is the right one. */
static int find_piece(const kt_spline *spline, int piece, double time)
{
    while (piece > 0 && time < spline->breaks[piece]) {
        --piece;
    }
    while (piece < spline->pieces - 1 && time >= spline->breaks[piece + 1]) {
        ++piece;
    }
    return piece;
}

static void evaluate_inputs(worker *w, double time)
{
    for (int i = 0; i < w->problem->spline_count; ++i) {
        const kt_spline *s = &w->problem->splines[i];
        int piece = w->piece[i] = find_piece(s, w->piece[i], time);
        double x = time - s->breaks[piece];
        const double *c = s->coefficients + piece;
        double a = c[0], b = c[s->pieces], d = c[2 * s->pieces], e = c[3 * s->pieces];
        const double values[3] = {
            ((a * x + b) * x + d) * x + e,
            (3.0 * a * x + 2.0 * b) * x + d,
            6.0 * a * x + 2.0 * b,
        };
        for (int k = 0; k < 3; ++k) {
            if (s->target[k] >= 0) {
                w->inputs[s->target[k]] = values[k];
            }
        }
    }
}

/* -- callbacks -------------------------------------------------------------------------------- */

/* A refused state is recoverable: the solver tries a smaller step, and gives up by itself. */
static int refuse(worker *w, int status, double time, const double *state)
{
    kt_result *r = w->result;
    r->refused_status = status;
    r->refused_time = time;
    memcpy(r->refused_state, state, (size_t)w->problem->state_count * sizeof *state);
    return 1;
}

static int call_rhs(sunrealtype time, N_Vector y, N_Vector derivative, void *data)
{
    worker *w = data;
    const double *state = N_VGetArrayPointer(y);
    evaluate_inputs(w, time);
    int status = w->problem->rhs(w->problem->constants, state, w->inputs,
                                 N_VGetArrayPointer(derivative));
    return status ? refuse(w, status, time, state) : 0;
}

static int call_jacobian(sunrealtype time, N_Vector y, N_Vector derivative, SUNMatrix matrix,
                         void *data, N_Vector t1, N_Vector t2, N_Vector t3)
{
    (void)derivative, (void)t1, (void)t2, (void)t3;
    worker *w = data;
    int n = w->problem->state_count;
    const double *state = N_VGetArrayPointer(y);
    evaluate_inputs(w, time);
    int status = w->problem->jacobian(w->problem->constants, state, w->inputs, w->jacobian);
    if (status) {
        return refuse(w, status, time, state);
    }
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
            SM_ELEMENT_D(matrix, i, j) = w->jacobian[n * i + j]; /* SUNDIALS is column-major */
        }
    }
    return 0;
}

static int call_roots(sunrealtype time, N_Vector y, sunrealtype *out, void *data)
{
    worker *w = data;
    const kt_problem *p = w->problem;
    const double *state = N_VGetArrayPointer(y);
    if (p->event_count) {
        evaluate_inputs(w, time);
        int status = p->signals(p->constants, state, w->inputs, w->signals);
        if (status) {
            refuse(w, status, time, state);
            return -1;
        }
        for (int i = 0; i < p->event_count; ++i) {
            out[i] = w->signals[p->events[i].signal] - p->events[i].level;
        }
    }
    if (p->root_count && p->roots(time, state, out + p->event_count, p->root_data)) {
        w->caller_failed = 1;
        return -1;
    }
    return 0;
}

/* -- vectors ---------------------------------------------------------------------------------- */

/*
 * The sum of products that every stage of a Runge-Kutta method begins with, in the order of SUNDIALS and
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

/* Return a new vector; its clones have the same operations. */
static N_Vector new_vector(sunindextype length, SUNContext context)
{
    N_Vector vector = N_VNew_Serial(length, context);
    if (vector) {
        N_VEnableFusedOps_Serial(vector, SUNTRUE);
        vector->ops->nvlinearcombination = combine;
    }
    return vector;
}

/* -- setting up ------------------------------------------------------------------------------- */

static int set_up_cvode(worker *w, double start)
{
    const kt_options *o = w->options;
    w->solver = CVodeCreate(o->method == KT_BDF ? CV_BDF : CV_ADAMS, w->context);
    if (!w->solver) {
        return KT_MEMORY;
    }
    silence_cvode(w->solver);
    int n = w->problem->state_count, roots = w->problem->event_count + w->problem->root_count;
    w->matrix = SUNDenseMatrix(n, n, w->context);
    w->linear = w->matrix ? SUNLinSol_Dense(w->y, w->matrix, w->context) : NULL;
    if (!w->linear) {
        return KT_MEMORY;
    }
    int bad = CVodeInit(w->solver, call_rhs, start, w->y)
        || CVodeSetUserData(w->solver, w)
        || CVodeSVtolerances(w->solver, o->rtol, w->tolerance)
        || CVodeSetLinearSolver(w->solver, w->linear, w->matrix)
        || CVodeSetJacFn(w->solver, call_jacobian)
        || CVodeSetMaxNumSteps(w->solver, -1)
        || (o->first_step > 0.0 && CVodeSetInitStep(w->solver, o->first_step))
        || (o->max_step > 0.0 && CVodeSetMaxStep(w->solver, o->max_step))
        || (roots && CVodeRootInit(w->solver, roots, call_roots))
        || (roots && CVodeSetRootDirection(w->solver, (int *)w->problem->directions))
        || (roots && CVodeSetNoInactiveRootWarn(w->solver));
    return bad ? KT_FAILED : KT_DONE;
}

/*
 * ERKStep of SUNDIALS 6.4 takes every method whose last stage is at the end of the step for one whose
 * last stage is the first of the next step. Where that is not so, an added stage makes it so: it
 * is at the step's end, with no weight. The method stays the same, and evaluates as often.
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

static int set_up_runge_kutta(worker *w, double start)
{
    const kt_options *o = w->options;
    w->solver = ERKStepCreate(call_rhs, start, w->y, w->context);
    if (!w->solver) {
        return KT_MEMORY;
    }
    silence_arkode(w->solver);
    ARKodeButcherTable table = table_of(o->table);
    int unknown = !table || ERKStepSetTable(w->solver, table); /* copies it */
    w->order = unknown ? 0 : table->q;
    ARKodeButcherTable_Free(table);
    if (unknown) {
        return KT_BAD_TABLE;
    }
    int roots = w->problem->event_count + w->problem->root_count;
    /* Nothing is interpolated then, and a cubic needs no evaluations of its own. */
    int exact = o->stop_at_outputs && !o->dense && !roots;
    int bad = ARKodeSetUserData(w->solver, w)
        || (exact && ARKodeSetInterpolantDegree(w->solver, 3))
        || ARKodeSVtolerances(w->solver, o->rtol, w->tolerance)
        || ARKodeSetMaxNumSteps(w->solver, -1)
        || (o->first_step > 0.0 && ARKodeSetInitStep(w->solver, o->first_step))
        || (o->max_step > 0.0 && ARKodeSetMaxStep(w->solver, o->max_step))
        || (roots && ARKodeRootInit(w->solver, roots, call_roots))
        || (roots && ARKodeSetRootDirection(w->solver, (int *)w->problem->directions))
        || (roots && ARKodeSetNoInactiveRootWarn(w->solver));
    return bad ? KT_FAILED : KT_DONE;
}

static int set_up(worker *w, const double *state, double start)
{
    const kt_problem *p = w->problem;
    kt_result *r = w->result;
    size_t n = (size_t)p->state_count, events = (size_t)(p->event_count + p->root_count);
    r->output.width = (int)n + 1;
    r->events.width = (int)n + 2;
    r->dense.width = 3 + (KT_MAX_ORDER + 1) * (int)n;
    r->state = calloc(n, sizeof *r->state);
    r->refused_state = calloc(n, sizeof *r->refused_state);
    w->inputs = calloc((size_t)p->input_count + 1, sizeof *w->inputs);
    w->jacobian = calloc(n * n, sizeof *w->jacobian);
    w->signals = calloc((size_t)p->signal_count + 1, sizeof *w->signals);
    w->piece = calloc((size_t)p->spline_count + 1, sizeof *w->piece);
    w->crossings = calloc(events + 1, sizeof *w->crossings);
    w->found = calloc(events + 1, sizeof *w->found);
    if (!r->state || !r->refused_state || !w->inputs || !w->jacobian || !w->signals || !w->piece
        || !w->crossings || !w->found || open_silent_context(&w->context)) {
        return KT_MEMORY;
    }
    memcpy(w->inputs, p->inputs, (size_t)p->input_count * sizeof *w->inputs);
    w->y = new_vector((sunindextype)n, w->context);
    w->tolerance = w->y ? N_VClone(w->y) : NULL;
    w->scratch = w->y ? N_VClone(w->y) : NULL;
    if (!w->tolerance || !w->scratch) {
        return KT_MEMORY;
    }
    memcpy(N_VGetArrayPointer(w->y), state, n * sizeof *state);
    memcpy(N_VGetArrayPointer(w->tolerance), w->options->atol, n * sizeof *state);
    memcpy(r->state, state, n * sizeof *state);
    r->time = start;
    w->runge_kutta = w->options->method == KT_RUNGE_KUTTA;
    return w->runge_kutta ? set_up_runge_kutta(w, start) : set_up_cvode(w, start);
}

static void tear_down(worker *w)
{
    if (w->solver) {
        if (w->runge_kutta) {
            ARKodeFree(&w->solver);
        } else {
            CVodeFree(&w->solver);
        }
    }
    if (w->linear) {
        SUNLinSolFree(w->linear);
    }
    if (w->matrix) {
        SUNMatDestroy(w->matrix);
    }
    if (w->scratch) {
        N_VDestroy(w->scratch);
    }
    if (w->tolerance) {
        N_VDestroy(w->tolerance);
    }
    if (w->y) {
        N_VDestroy(w->y);
    }
    if (w->context) {
        SUNContext_Free(&w->context);
    }
    free(w->inputs);
    free(w->jacobian);
    free(w->signals);
    free(w->piece);
    free(w->crossings);
    free(w->found);
}

/* Part of the whole time: a step below it, next to a refused state, is the end. */
#define SMALLEST_STEP 1.0e-9

/* -- stepping --------------------------------------------------------------------------------- */

static int one_step(worker *w, double end, double *time)
{
    return w->runge_kutta ? ARKodeEvolve(w->solver, end, w->y, time, ARK_ONE_STEP)
                          : CVode(w->solver, end, w->y, time, CV_ONE_STEP);
}

static int set_stop(worker *w, double end)
{
    return w->runge_kutta ? ARKodeSetStopTime(w->solver, end) : CVodeSetStopTime(w->solver, end);
}

static int interpolate(worker *w, double time, int derivative, N_Vector out)
{
    return w->runge_kutta ? ARKodeGetDky(w->solver, time, derivative, out)
                          : CVodeGetDky(w->solver, time, derivative, out);
}

static double last_step(worker *w)
{
    double step = 0.0;
    if (w->runge_kutta) {
        ARKodeGetLastStep(w->solver, &step);
    } else {
        CVodeGetLastStep(w->solver, &step);
    }
    return fabs(step);
}

static int is_root(const worker *w, int code)
{
    return code == (w->runge_kutta ? ARK_ROOT_RETURN : CV_ROOT_RETURN);
}

/* Translate the solver's way of giving up. */
static int explain(worker *w, int code)
{
    kt_result *r = w->result;
    r->code = code;
    if (w->caller_failed) {
        return KT_CALLER;
    }
    int too_accurate = w->runge_kutta ? ARK_TOO_MUCH_ACC : CV_TOO_MUCH_ACC;
    if (code == too_accurate) {
        return KT_TOO_ACCURATE;
    }
    return r->refused_status ? KT_STATE : KT_FAILED;
}

/* Note the crossings at the present root; tell whether one of them ends the integration. */
static int note_events(worker *w, double time)
{
    const kt_problem *p = w->problem;
    int count = p->event_count + p->root_count, stop = 0;
    if (w->runge_kutta) {
        ARKodeGetRootInfo(w->solver, w->found);
    } else {
        CVodeGetRootInfo(w->solver, w->found);
    }
    for (int i = 0; i < count; ++i) {
        if (!w->found[i]) {
            continue;
        }
        double *row = append(&w->result->events);
        if (!row) {
            return -1;
        }
        row[0] = i;
        row[1] = time;
        memcpy(row + 2, N_VGetArrayPointer(w->y), (size_t)p->state_count * sizeof *row);
        stop |= p->terminal[i] && ++w->crossings[i] >= p->terminal[i];
    }
    return stop;
}

/* Keep the derivatives of the step's polynomial at its end. */
static int keep_polynomial(worker *w, double from, double to)
{
    int n = w->problem->state_count, order = 5;
    if (!w->runge_kutta) {
        CVodeGetLastOrder(w->solver, &order);
    }
    double *row = append(&w->result->dense);
    if (!row) {
        return KT_MEMORY;
    }
    memset(row, 0, (size_t)w->result->dense.width * sizeof *row);
    row[0] = from;
    row[1] = to;
    for (int k = 0; k <= order; ++k) {
        if (interpolate(w, to, k, w->scratch)) {
            break; /* the polynomial has no more derivatives */
        }
        memcpy(row + 3 + k * n, N_VGetArrayPointer(w->scratch), (size_t)n * sizeof *row);
        row[2] = k;
    }
    return KT_DONE;
}

/* Put out all times up to the one reached; `next` is the first that is still to come. */
static int put_out(worker *w, const double *times, long count, double reached, double sign,
                   long *next)
{
    int n = w->problem->state_count;
    while (*next < count && sign * (times[*next] - reached) <= 0.0) {
        const double *row = N_VGetArrayPointer(w->y);
        if (times[*next] != reached) {
            if (interpolate(w, times[*next], 0, w->scratch)) {
                return KT_FAILED;
            }
            row = N_VGetArrayPointer(w->scratch);
        }
        if (append_state(&w->result->output, times[*next], row, n)) {
            return KT_MEMORY;
        }
        ++*next;
    }
    return KT_DONE;
}

/* Return the stop, or the next milestone if that comes before it. */
static double sooner(const kt_problem *p, long *next, double time, double stop, double sign)
{
    while (*next < p->milestone_count && sign * (p->milestones[*next] - time) <= 0.0) {
        ++*next;
    }
    return *next < p->milestone_count && sign * (p->milestones[*next] - stop) < 0.0
        ? p->milestones[*next] : stop;
}

static int run(worker *w, const double *times, long count, int every_step)
{
    kt_result *r = w->result;
    const kt_options *o = w->options;
    int n = w->problem->state_count, outcome;
    double end = times[count - 1], sign = end > times[0] ? 1.0 : -1.0, time = times[0];
    long next = 1, milestone = 0;
    if (append_state(&r->output, times[0], r->state, n)) {
        return KT_MEMORY;
    }
    while (sign * (end - time) > 0.0) {
        double stop = o->stop_at_outputs ? times[next] : end, before = time;
        stop = sooner(w->problem, &milestone, time, stop, sign);
        if (set_stop(w, stop)) {
            return KT_FAILED;
        }
        if (r->statistics.steps++ >= o->max_steps) {
            return KT_TOO_MANY_STEPS;
        }
        int code = one_step(w, stop, &time);
        if (code < 0) {
            return explain(w, code);
        }
        /* Steps that shrink towards a refused state would go on for ever. */
        if (r->refused_status && last_step(w) < SMALLEST_STEP * fabs(end - times[0])) {
            return KT_STATE;
        }
        r->refused_status = 0; /* a smaller step has got past it */
        r->time = time;
        memcpy(r->state, N_VGetArrayPointer(w->y), (size_t)n * sizeof *r->state);
        if (o->dense && (outcome = keep_polynomial(w, before, time))) {
            return outcome;
        }
        outcome = every_step ? append_state(&r->output, time, r->state, n)
                             : put_out(w, times, count, time, sign, &next);
        if (outcome) {
            return outcome;
        }
        if (is_root(w, code)) {
            int terminal = note_events(w, time);
            if (terminal) {
                return terminal < 0 ? KT_MEMORY : KT_EVENT;
            }
        }
    }
    return KT_DONE;
}

static void read_statistics(worker *w)
{
    kt_statistics *s = &w->result->statistics;
    int order = w->order;
    if (!w->solver) {
        return;
    }
    if (w->runge_kutta) {
        ARKodeGetNumSteps(w->solver, &s->steps);
        ERKStepGetNumRhsEvals(w->solver, &s->evaluations);
        ARKodeGetNumErrTestFails(w->solver, &s->error_test_failures);
    } else {
        CVodeGetNumSteps(w->solver, &s->steps);
        CVodeGetNumRhsEvals(w->solver, &s->evaluations);
        CVodeGetNumJacEvals(w->solver, &s->jacobians);
        CVodeGetNumLinSolvSetups(w->solver, &s->factorisations);
        CVodeGetNumErrTestFails(w->solver, &s->error_test_failures);
        CVodeGetLastOrder(w->solver, &order);
    }
    s->order = order;
}

int kt_integrate(const kt_problem *problem, const kt_options *options, const double *state,
                 const double *times, long count, int every_step, kt_result *result)
{
    worker w = {.problem = problem, .options = options, .result = result};
    memset(result, 0, sizeof *result);
    int outcome = set_up(&w, state, times[0]);
    if (outcome == KT_DONE) {
        outcome = run(&w, times, count, every_step);
    }
    read_statistics(&w);
    tear_down(&w);
    return outcome;
}

void kt_free(kt_result *result)
{
    free(result->output.data);
    free(result->events.data);
    free(result->dense.data);
    free(result->state);
    free(result->refused_state);
    memset(result, 0, sizeof *result);
}
