#include "integrate.h"
#include "margins.h"
#include "pieces.h"
#include "versions.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

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
    kt_margins margins;
    double *moved;       /* a state a short time later */
    double start, end;   /* of the whole time */
    double longest_step; /* so far */
    int stuck;           /* very short steps in a row */
    clock_t asked;       /* when the caller was asked last whether to go on */
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

static void evaluate_inputs(worker *w, double time)
{
    for (int i = 0; i < w->problem->spline_count; ++i) {
        const kt_spline *s = &w->problem->splines[i];
        int piece = w->piece[i] = kt_find_piece(s->breaks, s->pieces, w->piece[i], time);
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
    double sign = w->end > w->start ? 1.0 : -1.0;
    int bad = CVodeInit(w->solver, call_rhs, start, w->y)
        || CVodeSetUserData(w->solver, w)
        || CVodeSVtolerances(w->solver, o->rtol, w->tolerance)
        || CVodeSetLinearSolver(w->solver, w->linear, w->matrix)
        || CVodeSetJacFn(w->solver, call_jacobian)
        || CVodeSetMaxNumSteps(w->solver, -1)
        || (o->first_step > 0.0 && CVodeSetInitStep(w->solver, sign * o->first_step))
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
    double sign = w->end > w->start ? 1.0 : -1.0;
    int bad = ARKodeSetUserData(w->solver, w)
        || (exact && ARKodeSetInterpolantDegree(w->solver, 3))
        || ARKodeSVtolerances(w->solver, o->rtol, w->tolerance)
        || ARKodeSetMaxNumSteps(w->solver, -1)
        || (o->first_step > 0.0 && ARKodeSetInitStep(w->solver, sign * o->first_step))
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
    w->moved = calloc(n, sizeof *w->moved);
    if (!kt_open_margins(&w->margins, p->guard_count, p->guards, p->usual_margins) || !w->moved
        || !r->state || !r->refused_state || !w->inputs || !w->jacobian || !w->signals || !w->piece
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
    free(w->moved);
    kt_close_margins(&w->margins);
}

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

/* Length of the step that the solver tries next, or has tried last without success. */
static double current_step(worker *w)
{
    double step = 0.0;
    if (w->runge_kutta) {
        ARKodeGetCurrentStep(w->solver, &step);
    } else {
        CVodeGetCurrentStep(w->solver, &step);
    }
    return fabs(step);
}

/* Time that the solver has reached inside; it is past a root that it has returned. */
static double current_time(worker *w)
{
    double time = 0.0;
    if (w->runge_kutta) {
        ARKodeGetCurrentTime(w->solver, &time);
    } else {
        CVodeGetCurrentTime(w->solver, &time);
    }
    return time;
}

/* Add what the solver has counted since it began, or began anew. */
static void add_statistics(worker *w)
{
    kt_statistics *s = &w->result->statistics;
    long steps = 0, evaluations = 0, jacobians = 0, factorisations = 0, failures = 0;
    int order = w->order;
    if (!w->solver) {
        return;
    }
    if (w->runge_kutta) {
        ARKodeGetNumSteps(w->solver, &steps);
        ARKodeGetNumRhsEvals(w->solver, 0, &evaluations);
        ARKodeGetNumErrTestFails(w->solver, &failures);
    } else {
        CVodeGetNumSteps(w->solver, &steps);
        CVodeGetNumRhsEvals(w->solver, &evaluations);
        CVodeGetNumJacEvals(w->solver, &jacobians);
        CVodeGetNumLinSolvSetups(w->solver, &factorisations);
        CVodeGetNumErrTestFails(w->solver, &failures);
        CVodeGetLastOrder(w->solver, &order);
    }
    s->steps += steps;
    s->evaluations += evaluations;
    s->jacobians += jacobians;
    s->factorisations += factorisations;
    s->error_test_failures += failures;
    s->order = order;
}

/* Begin anew with a step of this length. */
static int begin_anew(worker *w, double time, double step)
{
    double signed_step = w->end > w->start ? step : -step;
    add_statistics(w);
    memcpy(N_VGetArrayPointer(w->y), w->result->state,
           (size_t)w->problem->state_count * sizeof(double));
    return w->runge_kutta ? ERKStepReInit(w->solver, call_rhs, time, w->y)
                                || ARKodeSetInitStep(w->solver, signed_step)
                          : CVodeReInit(w->solver, time, w->y)
                                || CVodeSetInitStep(w->solver, signed_step);
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

/* -- margins ---------------------------------------------------------------------------------- */

static void evaluate_margins(worker *w, double time, const double *state, double *out)
{
    evaluate_inputs(w, time);
    w->problem->margins(w->problem->constants, state, w->inputs, out);
}

/* Evaluate the margins of what is a short time ahead of a state on its way. */
static void look_ahead(worker *w, double time, const double *state, double lapse)
{
    int n = w->problem->state_count, half = n / 2;
    double signed_lapse = w->end > w->start ? lapse : -lapse;
    for (int i = 0; i < half; ++i) {
        w->moved[i] = state[i] + signed_lapse * state[half + i];
        w->moved[half + i] = state[half + i];
    }
    evaluate_margins(w, time + signed_lapse, w->moved, w->margins.ahead);
}

static double smallest_step(const worker *w)
{
    double of_time = KT_SMALLEST_OF_TIME * fabs(w->end - w->start);
    double of_step = KT_SMALLEST_OF_STEP * w->longest_step;
    return of_step > 0.0 && of_step < of_time ? of_step : of_time;
}

/* End at the dead point of a guard, a time after the state that was reached. */
static int end_at(worker *w, int guard, double left)
{
    kt_result *r = w->result;
    r->refused_guard = guard;
    r->refused_time = r->time + (w->end > w->start ? left : -left);
    memcpy(r->refused_state, r->state, (size_t)w->problem->state_count * sizeof *r->state);
    return KT_STATE;
}

/* Go back to the state that was reached and try a shorter step; KT_STATE when it is too short. */
static int shorten(worker *w, double step)
{
    step *= KT_SHORTER;
    if (!(step >= smallest_step(w))) { /* nor a NaN */
        return KT_STATE;
    }
    w->result->refused_status = 0;
    return begin_anew(w, w->result->time, step) ? KT_FAILED : KT_DONE;
}

/* -- running ---------------------------------------------------------------------------------- */

/* In place of a guard, or of an outcome. */
enum { KT_NONE = -1, KT_NO_MEMORY = -2, KT_AGAIN = -3 };

typedef struct {
    const double *times;
    long count, next; /* `next` is the first time that is still to come */
    int every_step;
    double sign;    /* of the time's direction */
    double trusted; /* no longer step may be taken */
    long milestone; /* the first that is still to come */
} course;

/* Put out all times up to the one reached; return a guard that does not let one be evaluated. */
static int put_out(worker *w, course *c, double reached)
{
    int n = w->problem->state_count;
    for (; c->next < c->count && c->sign * (c->times[c->next] - reached) <= 0.0; ++c->next) {
        double time = c->times[c->next];
        const double *row = N_VGetArrayPointer(w->y);
        if (time != reached) {
            interpolate(w, time, 0, w->scratch); /* cannot fail within the step */
            row = N_VGetArrayPointer(w->scratch);
            evaluate_margins(w, time, row, w->margins.between);
            int guard = kt_crossed(&w->margins, w->margins.between);
            if (guard != KT_NONE) {
                return guard;
            }
        }
        if (append_state(&w->result->output, time, row, n)) {
            return KT_NO_MEMORY;
        }
    }
    return KT_NONE;
}

/*
 * Return a guard that says that a step is not to be believed; else what it covers is put out. `looked`
 * tells whether the margins ahead had to be looked at.
 */
static int doubt(worker *w, course *c, double reached, double step, int *looked)
{
    const double *state = N_VGetArrayPointer(w->y);
    evaluate_margins(w, reached, state, w->margins.now);
    int guard = kt_crossed(&w->margins, w->margins.now);
    *looked = kt_changes(&w->margins, current_step(w) / step);
    if (guard == KT_NONE && *looked) {
        look_ahead(w, reached, state, KT_LAPSE * step);
        guard = kt_reflected(&w->margins, KT_LAPSE * step, step);
    }
    if (guard != KT_NONE) {
        return guard;
    }
    if (c->every_step) {
        return append_state(&w->result->output, reached, state, w->problem->state_count)
            ? KT_NO_MEMORY : KT_NONE;
    }
    return put_out(w, c, reached);
}

/*
 * Limit the next step by the margins ahead; tell whether this is a dead point. It is one also
 * where rounding, not the margin, has made the solver's own steps so short that they lead nowhere.
 */
static int limit(worker *w, course *c, double lapse)
{
    int nearest = KT_NONE, over = 0;
    c->trusted = kt_longest_step(&w->margins, lapse, &nearest, &over);
    int stuck = lapse < KT_LAPSE * smallest_step(w) && c->trusted < KT_NEAR * w->longest_step;
    w->stuck = stuck ? w->stuck + 1 : 0;
    over = over || w->stuck >= KT_MOST_STUCK || c->trusted < KT_SMALLEST_PART * fabs(w->result->time);
    return over ? end_at(w, nearest, KT_LEFT * c->trusted) : KT_DONE;
}

/* Make the end of a step the state that is reached, or take it back. */
static int accept(worker *w, course *c, double reached)
{
    kt_result *r = w->result;
    long rows = r->output.rows, next = c->next;
    double step = fabs(reached - r->time);
    int looked = 0, guard = doubt(w, c, reached, step, &looked);
    if (guard == KT_NO_MEMORY
        || (guard == KT_NONE && w->options->dense && keep_polynomial(w, r->time, reached))) {
        return KT_MEMORY;
    }
    if (guard != KT_NONE) {
        r->output.rows = rows;
        c->next = next;
        int outcome = shorten(w, step);
        return outcome == KT_STATE ? end_at(w, guard, 0.0) : outcome ? outcome : KT_AGAIN;
    }
    r->time = reached;
    memcpy(r->state, N_VGetArrayPointer(w->y), (size_t)w->problem->state_count * sizeof(double));
    w->longest_step = fmax(w->longest_step, step);
    kt_reach(&w->margins);
    c->trusted = INFINITY;
    int outcome = looked ? limit(w, c, KT_LAPSE * step) : KT_DONE;
    return outcome;
}

/* Return the goal, or the next milestone if that comes before it. */
static double sooner(const worker *w, course *c, double goal)
{
    const kt_problem *p = w->problem;
    long *next = &c->milestone;
    while (*next < p->milestone_count && c->sign * (p->milestones[*next] - w->result->time) <= 0.0) {
        ++*next;
    }
    return *next < p->milestone_count && c->sign * (p->milestones[*next] - goal) < 0.0
        ? p->milestones[*next] : goal;
}

/* Return up to where the solver may step: it must not be told a time that it has passed inside. */
static double stop_of(worker *w, const course *c, double goal)
{
    double time = w->result->time, stop = time + c->sign * c->trusted;
    int limits = c->sign * (goal - stop) > 0.0 && c->sign * (stop - current_time(w)) > 0.0;
    return limits ? stop : goal;
}

/* Ask the caller every so many steps, and seconds, whether to go on. */
#define STEPS_BETWEEN 16
#define SECONDS_BETWEEN 0.05

static int interrupted(worker *w, long tried)
{
    if (!w->problem->interrupted || tried % STEPS_BETWEEN) {
        return 0;
    }
    clock_t now = clock();
    if ((double)(now - w->asked) < SECONDS_BETWEEN * CLOCKS_PER_SEC) {
        return 0;
    }
    w->asked = now;
    return w->problem->interrupted(w->problem->interrupted_data);
}

/* Take a step; KT_AGAIN where it came to nothing and a shorter one is to be tried. */
static int advance(worker *w, course *c, int *root)
{
    kt_result *r = w->result;
    double goal = c->times[w->options->stop_at_outputs ? c->next : c->count - 1], reached = r->time;
    goal = sooner(w, c, goal);
    if (set_stop(w, stop_of(w, c, goal))) {
        return KT_FAILED;
    }
    int code = one_step(w, goal, &reached);
    *root = is_root(w, code);
    if (code < 0) {
        int outcome = explain(w, code);
        if (outcome == KT_STATE) {
            outcome = shorten(w, current_step(w));
            return outcome ? outcome : KT_AGAIN;
        }
        return outcome;
    }
    /* Steps that shrink towards a refused state would go on for ever. */
    if (r->refused_status && fabs(reached - r->time) < smallest_step(w)) {
        return KT_STATE;
    }
    r->refused_status = 0; /* a smaller step has got past it */
    return accept(w, c, reached);
}

static int run(worker *w, const double *times, long count, int every_step)
{
    kt_result *r = w->result;
    course c = {times, count, 1, every_step, w->end > w->start ? 1.0 : -1.0, INFINITY, 0};
    double lapse = KT_SMALLEST_OF_STEP * fabs(w->end - w->start);
    if (append_state(&r->output, times[0], r->state, w->problem->state_count)) {
        return KT_MEMORY;
    }
    evaluate_margins(w, r->time, r->state, w->margins.now);
    look_ahead(w, r->time, r->state, lapse);
    kt_reach(&w->margins);
    int outcome = limit(w, &c, lapse), root = 0;
    for (long tried = 0; outcome == KT_DONE && c.sign * (w->end - r->time) > 0.0; ++tried) {
        if (tried >= w->options->max_steps) {
            return KT_TOO_MANY_STEPS;
        }
        if (interrupted(w, tried)) {
            return KT_CALLER;
        }
        outcome = advance(w, &c, &root);
        if (outcome == KT_DONE && root) {
            int terminal = note_events(w, r->time);
            outcome = terminal < 0 ? KT_MEMORY : terminal ? KT_EVENT : KT_DONE;
        } else if (outcome == KT_AGAIN) {
            outcome = KT_DONE;
        }
    }
    return outcome;
}

int kt_integrate(const kt_problem *problem, const kt_options *options, const double *state,
                 const double *times, long count, int every_step, kt_result *result)
{
    worker w = {.problem = problem, .options = options, .result = result,
                .start = times[0], .end = times[count - 1], .asked = clock()};
    memset(result, 0, sizeof *result);
    result->refused_guard = KT_NONE;
    int outcome = set_up(&w, state, times[0]);
    if (outcome == KT_DONE) {
        outcome = run(&w, times, count, every_step);
    }
    add_statistics(&w);
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
