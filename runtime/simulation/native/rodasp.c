/*
 * A linearly implicit method with a fixed step, for stiff equations: each step evaluates the rates six times and the
 * exact Jacobian once, and solves linear equations six times by one factorisation. It is L-stable, so that motions
 * too fast for a step decay, and its last stage is its result (stiffly accurate).
 *
 * The derivative of the rates with respect to time, by varying inputs, is a central difference along the polynomials
 * of the inputs.
 *
 * A Jacobian does not show a jump of the rates ahead. If rates alternate from step to step, such as those of friction
 * that sticks, the last two stages show it, and such steps are refused.
 */
#include "rodasp.h"
#include "fixed_step.h"
#include "worker.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/*
 * Part of a step for the central difference. Its error is a millionth of the square of the step, and its rounding
 * error a thousand times that of rates.
 */
#define LAPSE (1.0 / 1024.0)

/*
 * Rates jump if their change between the last two stages that the Jacobian does not explain would move the end of the
 * step by more than this part of the difference of both stages, and that difference is more than this number of
 * roundings. The part is below a tenth for smooth motions, and above a half where a step passes over friction.
 */
#define JUMP 0.2
#define ROUNDINGS 1.0e6

typedef struct {
    kt_fixed fixed;
    double *by_time;
    double *stages;            /* STAGES x states: the k of the method */
    double *point, *found, *before; /* the point of a stage; rates of the last two stages */
    double *jacobian, *matrix; /* states x states; the latter is factorised */
    int *order;                /* of the rows of the matrix */
} method;

/* -- linear equations ------------------------------------------------------------------------- */

/* Exchange rows for the largest entry of a column as pivot; return whether there is one. */
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

/* Factorise I / (step GAMMA) - J by rows, with partial pivoting; return whether it is regular. */
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
    ++m->fixed.counted.factorisations;
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

/* Return a weighted sum of the first stages, of one element of the state. */
static double combined(const method *m, int n, const double *weights, int count, int element)
{
    double sum = 0.0;
    for (int j = 0; j < count; ++j) {
        sum += weights[j] * m->stages[j * n + element];
    }
    return sum;
}

/* Compute one stage from the rates at its point, which are in `found`. */
static void find_stage(method *m, int n, int stage, double step)
{
    double *right = m->point; /* it has been evaluated */
    for (int i = 0; i < n; ++i) {
        right[i] = m->found[i] + combined(m, n, C[stage], stage, i) / step
            + BY_TIME[stage] * step * m->by_time[i];
    }
    solve(m, n, right, m->stages + stage * n);
}

/* Compute all stages, and state and rates at the end, unless the model refuses a state. */
static int attempt(worker *w, double end, double step)
{
    method *m = w->own;
    int n = w->problem->state_count;
    size_t size = (size_t)n * sizeof *m->fixed.rates;
    memcpy(m->found, m->fixed.rates, size);
    find_stage(m, n, 0, step);
    for (int s = 1; s < STAGES; ++s) {
        memcpy(m->before, m->found, size);
        for (int i = 0; i < n; ++i) {
            m->point[i] = m->fixed.end_state[i] = m->fixed.state[i] + combined(m, n, A[s], s, i);
        }
        double time = NODES[s] < 1.0 ? m->fixed.times.time + NODES[s] * step : end;
        if (kt_fixed_rates(w, time, m->point, m->found)) {
            return KT_REFUSED;
        }
        find_stage(m, n, s, step);
    }
    for (int i = 0; i < n; ++i) {
        m->fixed.end_state[i] += m->stages[(STAGES - 1) * n + i]; /* to the point of the last stage */
    }
    return kt_fixed_rates(w, end, m->fixed.end_state, m->fixed.end_rates) ? KT_REFUSED : 0;
}

/* Return whether rates jump between the points of the last two stages, which are at one time. */
static int jumped(worker *w, double step)
{
    (void)step;
    method *m = w->own;
    int n = w->problem->state_count;
    const double *between = m->stages + (STAGES - 2) * n;
    double differ = 0.0, size = 0.0, beyond = 0.0;
    for (int i = 0; i < n; ++i) {
        double change = 0.0;
        for (int j = 0; j < n; ++j) {
            change += m->jacobian[i * n + j] * between[j];
        }
        m->point[i] = m->found[i] - m->before[i] - change;
        differ += fabs(between[i]);
        size += fabs(m->fixed.state[i]);
    }
    solve(m, n, m->point, m->found);
    for (int i = 0; i < n; ++i) {
        beyond += fabs(m->found[i]);
    }
    return beyond > JUMP * differ && differ > ROUNDINGS * DBL_EPSILON * size;
}

static int refuse_jumps(worker *w, double step)
{
    (void)w, (void)step;
    return KT_JUMPING_RATES;
}

/* Compute the common terms of all stages: the factorised matrix, and the derivative of rates by time. */
static int prepare(worker *w, double step)
{
    method *m = w->own;
    double time = m->fixed.times.time;
    ++m->fixed.counted.jacobians;
    if (kt_jacobian(w, time, m->fixed.state, m->jacobian)) {
        return KT_REFUSED;
    }
    if (!factorise(m, w->problem->state_count, step)) {
        return KT_SINGULAR_MATRIX;
    }
    if (w->problem->spline_count) {
        m->fixed.counted.evaluations += 2;
        if (kt_rates_by_time(w, time, m->fixed.state, LAPSE * step, m->by_time, m->point)) {
            return KT_REFUSED;
        }
    }
    return 0;
}

/* -- within the step -------------------------------------------------------------------------- */

/* Compute the polynomial that interpolates the states within the last step. */
static void fit(worker *w)
{
    method *m = w->own;
    int n = w->problem->state_count;
    for (int i = 0; i < n; ++i) {
        double first = combined(m, n, DENSE[0], STAGES - 1, i);
        double second = combined(m, n, DENSE[1], STAGES - 1, i);
        m->fixed.terms[i] = m->fixed.state[i];
        m->fixed.terms[n + i] = m->fixed.end_state[i] - m->fixed.state[i] + first;
        m->fixed.terms[2 * n + i] = second - first;
        m->fixed.terms[3 * n + i] = -second;
    }
}

/* -- begin and end ---------------------------------------------------------------------------- */

static const kt_fixed_method METHOD = {
    .size = sizeof(method), .stages = 1, .vectors = 4 + STAGES, .matrices = 2,
    .prepare = prepare, .attempt = attempt, .jumped = jumped, .refuse_jumps = refuse_jumps, .fit = fit,
};

static int open_method(worker *w, double start)
{
    size_t n = (size_t)w->problem->state_count;
    double *arrays = kt_fixed_open(w, &METHOD, start);
    method *m = w->own;
    if (!arrays || !(m->order = calloc(n, sizeof *m->order))) {
        return KT_MEMORY;
    }
    m->by_time = arrays;
    m->point = m->by_time + n;
    m->found = m->point + n;
    m->before = m->found + n;
    m->stages = m->before + n;
    m->jacobian = m->stages + STAGES * n;
    m->matrix = m->jacobian + n * n;
    return KT_DONE;
}

static void close_method(worker *w)
{
    method *m = w->own;
    if (m) {
        free(m->order);
    }
    kt_fixed_close(w);
}

const kt_solver kt_rodasp = {
    open_method, close_method, kt_fixed_step, kt_fixed_set_stop, kt_fixed_interpolate, kt_fixed_begin,
    kt_fixed_next, kt_fixed_count, KT_NO_TOLERANCES, 0,
};
