/*
 * A linearly implicit method with steps of one length, for stiff equations: each step evaluates the rates six
 * times and the exact Jacobian once, and solves linear equations six times by one factorisation. It is
 * L-stable, so that motions too fast for a step decay, and its last stage is its result (stiffly accurate).
 *
 * How rates change with time, by inputs that move, is a central difference along their polynomials.
 *
 * A Jacobian does not show a jump of the rates that is ahead. Where they jump to and fro from step to step, as
 * those of friction that sticks, the last two stages show it, and such steps are refused.
 */
#include "rodasp.h"
#include "fixed_step.h"
#include "polynomial.h"
#include "worker.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define TERMS 4

/*
 * Part of a step over which the difference by time is taken. Its error is of the step's square, a millionth of
 * it; its rounding is that of rates, a thousand times.
 */
#define LAPSE (1.0 / 1024.0)

/*
 * Rates jump where what their change between the last two stages has beyond the Jacobian would move the step's
 * end by more than this part of what both differ by, and that is more than so many roundings. Smooth motions
 * have less than a tenth, and friction that is passed over more than a half. So many steps of that kind, with
 * never so many in a row between them that are not, are more than one passing of a jump.
 */
#define JUMP 0.2
#define ROUNDINGS 1.0e6
#define OFTEN_JUMPS 15
#define OFTEN_CALM 6

typedef struct {
    double *memory;
    double *state, *end_state;
    double *rates, *end_rates; /* at the begin, and at the end, which are those of the next begin */
    double *by_time;
    double *stages;            /* STAGES x states: the k of the method */
    double *terms;             /* TERMS x states */
    double *point, *found, *before; /* where a stage is evaluated; rates of the last two stages */
    double *jacobian, *matrix; /* states x states; the latter is factorised */
    int *order;                /* of the rows of the matrix */
    kt_fixed_steps steps;
    int jumps, calm;           /* steps in which rates have jumped, and those in a row in which not */
    int fresh, fitted;         /* the rates at `time` are not known; the terms are those of the last step */
    kt_statistics counted;
} method;

/* -- begin and end ---------------------------------------------------------------------------- */

static int begin_anew(worker *w, double time, double length)
{
    method *m = w->own;
    memcpy(m->state, w->y, (size_t)w->problem->state_count * sizeof *m->state);
    memset(&m->counted, 0, sizeof m->counted);
    kt_begin_steps(&m->steps, time, length);
    m->fresh = 1;
    m->fitted = 0;
    return 0;
}

static int open_method(worker *w, double start)
{
    size_t n = (size_t)w->problem->state_count;
    method *m = w->own = calloc(1, sizeof *m);
    if (!m) {
        return KT_MEMORY;
    }
    m->memory = calloc((8 + STAGES + TERMS + 2 * n) * n, sizeof *m->memory);
    m->order = calloc(n, sizeof *m->order);
    if (!m->memory || !m->order) {
        return KT_MEMORY;
    }
    double **const rows[] = {
        &m->state, &m->end_state, &m->rates, &m->end_rates, &m->by_time, &m->point, &m->found, &m->before,
    };
    double *next = m->memory;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i, next += n) {
        *rows[i] = next;
    }
    m->stages = next;
    m->terms = m->stages + STAGES * n;
    m->jacobian = m->terms + TERMS * n;
    m->matrix = m->jacobian + n * n;
    m->steps.sign = w->end > w->start ? 1.0 : -1.0;
    m->steps.stop = w->end;
    begin_anew(w, start, kt_longest_fixed(w));
    return KT_DONE;
}

static void close_method(worker *w)
{
    method *m = w->own;
    if (m) {
        free(m->memory);
        free(m->order);
        free(m);
    }
}

/* -- linear equations ------------------------------------------------------------------------- */

/* Bring the row with the largest entry of a column to its place; return whether there is one. */
static int choose_pivot(method *m, int n, int column)
{
    int best = column;
    for (int i = column + 1; i < n; ++i) {
        if (fabs(m->matrix[i * n + column]) > fabs(m->matrix[best * n + column])) {
            best = i;
        }
    }
    for (int j = 0; best != column && j < n; ++j) {
        double moved = m->matrix[column * n + j];
        m->matrix[column * n + j] = m->matrix[best * n + j];
        m->matrix[best * n + j] = moved;
    }
    int moved = m->order[column];
    m->order[column] = m->order[best];
    m->order[best] = moved;
    double pivot = fabs(m->matrix[column * n + column]);
    return pivot > 0.0 && pivot <= DBL_MAX; /* nor a NaN */
}

/* Factorise I / (step GAMMA) - J by rows, with partial pivoting; return whether that can be done. */
static int factorise(method *m, int n, double step)
{
    double *a = m->matrix;
    for (int i = 0; i < n * n; ++i) {
        a[i] = -m->jacobian[i];
    }
    for (int i = 0; i < n; ++i) {
        a[i * n + i] += 1.0 / (step * GAMMA);
        m->order[i] = i;
    }
    ++m->counted.factorisations;
    for (int k = 0; k < n; ++k) {
        if (!choose_pivot(m, n, k)) {
            return 0;
        }
        const double *pivot = a + k * n;
        for (int i = k + 1; i < n; ++i) {
            double *restrict row = a + i * n;
            double factor = row[k] /= pivot[k];
            for (int j = k + 1; factor != 0.0 && j < n; ++j) { /* many entries are zero in every step */
                row[j] -= factor * pivot[j];
            }
        }
    }
    return 1;
}

static void solve(const method *m, int n, const double *right, double *restrict out)
{
    const double *a = m->matrix;
    for (int i = 0; i < n; ++i) {
        double sum = right[m->order[i]];
        for (int j = 0; j < i; ++j) {
            sum -= a[i * n + j] * out[j];
        }
        out[i] = sum;
    }
    for (int i = n - 1; i >= 0; --i) {
        double sum = out[i];
        for (int j = i + 1; j < n; ++j) {
            sum -= a[i * n + j] * out[j];
        }
        out[i] = sum / a[i * n + i];
    }
}

/* -- a step ----------------------------------------------------------------------------------- */

static int rates_at(worker *w, double time, const double *state, double *out)
{
    method *m = w->own;
    ++m->counted.evaluations;
    return kt_rates(w, time, state, out);
}

/* Return a weighted sum of the first stages, of one element of the state. */
static double combined(const method *m, int n, const double *weights, int count, int element)
{
    double sum = 0.0;
    for (int j = 0; j < count; ++j) {
        sum += weights[j] * m->stages[j * n + element];
    }
    return sum;
}

/* Find one stage by the rates at its point, which are in `found`. */
static void find_stage(method *m, int n, int stage, double step)
{
    double *right = m->point; /* which has been evaluated */
    for (int i = 0; i < n; ++i) {
        right[i] = m->found[i] + combined(m, n, C[stage], stage, i) / step
            + BY_TIME[stage] * step * m->by_time[i];
    }
    solve(m, n, right, m->stages + stage * n);
}

/* Find all stages, and state and rates at the end; positive where the model refuses one. */
static int attempt(worker *w, double end, double step)
{
    method *m = w->own;
    int n = w->problem->state_count;
    size_t size = (size_t)n * sizeof *m->rates;
    memcpy(m->found, m->rates, size);
    find_stage(m, n, 0, step);
    for (int s = 1; s < STAGES; ++s) {
        memcpy(m->before, m->found, size);
        for (int i = 0; i < n; ++i) {
            m->point[i] = m->end_state[i] = m->state[i] + combined(m, n, A[s], s, i);
        }
        double time = NODES[s] < 1.0 ? m->steps.time + NODES[s] * step : end;
        if (rates_at(w, time, m->point, m->found)) {
            return 1;
        }
        find_stage(m, n, s, step);
    }
    for (int i = 0; i < n; ++i) {
        m->end_state[i] += m->stages[(STAGES - 1) * n + i]; /* to the point of the last stage */
    }
    return rates_at(w, end, m->end_state, m->end_rates);
}

/* Return whether rates jump between the points of the last two stages, which are at one time. */
static int jumps(method *m, int n)
{
    const double *between = m->stages + (STAGES - 2) * n;
    double differ = 0.0, size = 0.0, beyond = 0.0;
    for (int i = 0; i < n; ++i) {
        double change = 0.0;
        for (int j = 0; j < n; ++j) {
            change += m->jacobian[i * n + j] * between[j];
        }
        m->point[i] = m->found[i] - m->before[i] - change;
        differ += fabs(between[i]);
        size += fabs(m->state[i]);
    }
    solve(m, n, m->point, m->found);
    for (int i = 0; i < n; ++i) {
        beyond += fabs(m->found[i]);
    }
    return beyond > JUMP * differ && differ > ROUNDINGS * DBL_EPSILON * size;
}

/* Count the steps in which rates jump; refuse them where they do so again and again. */
static int see_jumps(worker *w)
{
    method *m = w->own;
    int jumped = jumps(m, w->problem->state_count);
    m->calm = jumped ? 0 : m->calm + 1;
    m->jumps = m->calm >= OFTEN_CALM ? 0 : m->jumps + jumped;
    return m->jumps >= OFTEN_JUMPS ? KT_JUMPING_RATES : 0;
}

/* Let the end of the last step be the begin of the next one, and see that its rates are known. */
static int go_on(worker *w)
{
    method *m = w->own;
    size_t size = (size_t)w->problem->state_count * sizeof *m->state;
    if (m->steps.reached != m->steps.time) {
        memcpy(m->state, m->end_state, size);
        memcpy(m->rates, m->end_rates, size);
        m->steps.time = m->steps.reached;
        m->fitted = 0;
    }
    if (m->fresh && rates_at(w, m->steps.time, m->state, m->rates)) {
        return KT_REFUSED;
    }
    m->fresh = 0;
    return 0;
}

/* Find what the stages have in common: the factorised matrix, and what inputs do by time. */
static int prepare(worker *w, double step)
{
    method *m = w->own;
    double time = m->steps.time;
    ++m->counted.jacobians;
    if (kt_jacobian(w, time, m->state, m->jacobian)) {
        return KT_REFUSED;
    }
    if (!factorise(m, w->problem->state_count, step)) {
        return KT_SINGULAR_MATRIX;
    }
    if (w->problem->spline_count) {
        m->counted.evaluations += 2;
        if (kt_rates_by_time(w, time, m->state, LAPSE * step, m->by_time, m->point)) {
            return KT_REFUSED;
        }
    }
    return 0;
}

static int take_step(worker *w)
{
    method *m = w->own;
    int code = go_on(w);
    if (code) {
        return code;
    }
    double most = kt_longest_fixed(w), end = kt_end_of_step(&m->steps, most), step = end - m->steps.time;
    code = prepare(w, step);
    if (!code && attempt(w, end, step)) {
        code = KT_REFUSED;
    }
    code = code ? code : see_jumps(w);
    if (code) {
        m->steps.next = fabs(step);
        return code;
    }
    ++m->counted.steps;
    kt_reach_end(&m->steps, end, most);
    return 0;
}

/* -- within the step -------------------------------------------------------------------------- */

/* Find the powers by which the states within the last step are interpolated. */
static void fit(worker *w)
{
    method *m = w->own;
    int n = w->problem->state_count;
    for (int i = 0; i < n; ++i) {
        double first = combined(m, n, DENSE[0], STAGES - 1, i);
        double second = combined(m, n, DENSE[1], STAGES - 1, i);
        m->terms[i] = m->state[i];
        m->terms[n + i] = m->end_state[i] - m->state[i] + first;
        m->terms[2 * n + i] = second - first;
        m->terms[3 * n + i] = -second;
    }
    m->fitted = 1;
}

static int interpolate(worker *w, double time, int derivative, double *out)
{
    method *m = w->own;
    int n = w->problem->state_count;
    double step = m->steps.reached - m->steps.time;
    if (derivative >= TERMS) {
        return 1;
    }
    if (derivative == 0 && time == m->steps.reached) {
        memcpy(out, m->end_state, (size_t)n * sizeof *out);
        return 0;
    }
    if (!m->fitted) {
        fit(w);
    }
    kt_interpolate(m->terms, TERMS, n, (time - m->steps.time) / step, step, derivative, out);
    return 0;
}

/* -- what `integrate.c` calls ----------------------------------------------------------------- */

static int step(worker *w, double goal, double *time)
{
    (void)goal;
    method *m = w->own;
    int code = take_step(w);
    if (!code) {
        *time = m->steps.reached;
        memcpy(w->y, m->end_state, (size_t)w->problem->state_count * sizeof *w->y);
    }
    return code;
}

static int set_stop(worker *w, double time)
{
    method *m = w->own;
    m->steps.stop = time;
    return 0;
}

static double next_step(worker *w)
{
    method *m = w->own;
    return m->steps.next;
}

static void count(worker *w, kt_statistics *total)
{
    method *m = w->own;
    total->steps += m->counted.steps;
    total->evaluations += m->counted.evaluations;
    total->jacobians += m->counted.jacobians;
    total->factorisations += m->counted.factorisations;
    total->order = 4;
}

const kt_solver kt_rodasp = {
    open_method, close_method, step, set_stop, interpolate, begin_anew,
    next_step, count, KT_NO_TOLERANCES, 0,
};
