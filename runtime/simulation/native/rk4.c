/*
 * The classical Runge-Kutta method of order 4 with steps of one length, as it runs in real time: four
 * evaluations a step, whatever comes. What lies within a step is interpolated by the cubic through both of
 * its ends (Hermite), at no evaluations.
 *
 * A step that is too long makes what is fast grow, and says nothing of it. So before each step the largest
 * eigenvalue of its Jacobian is bounded, and a step that is not stable is refused. Rates may also jump to and
 * fro between the stages, as those of friction that sticks, where no Jacobian says so: that is seen by them.
 */
#include "fixed_step.h"
#include "worker.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/*
 * Whatever eigenvalue of a motion that does not grow, times the step, is below this, is stable: the radius of the
 * largest half disc in the region of stability, which is 2.785 long on the real axis and 2.828 on the other.
 */
#define STABLE 2.61

/* The bound is that of the power 2^8 of the matrix: some per cent above the largest eigenvalue at most. */
#define SQUARINGS 8

/*
 * Rates jump where a step times what their change between two stages has beyond the Jacobian is more than this
 * part of what has changed, and more than so many roundings.
 */
#define JUMP 0.5
#define ROUNDINGS 1.0e6

/* Halvings of the way between two stages, to find where rates are steepest. */
#define HALVINGS 30

typedef struct {
    kt_fixed fixed;
    double *memory;
    double *stage;                      /* a state; the rates at the begin are those of all stages, 4 x states */
    double *jacobian, *matrix, *square; /* states x states */
} method;

/* -- stability -------------------------------------------------------------------------------- */

/* Return the greatest sum of a row's magnitudes, by which all entries are divided. */
static double normalise(double *matrix, int n)
{
    double norm = 0.0;
    for (int i = 0; i < n; ++i) {
        double sum = 0.0;
        for (int j = 0; j < n; ++j) {
            sum += fabs(matrix[i * n + j]);
        }
        norm = fmax(norm, sum);
    }
    for (int i = 0; norm > 0.0 && i < n * n; ++i) {
        matrix[i] /= norm;
    }
    return norm;
}

static void square(method *m, int n)
{
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
            double sum = 0.0;
            for (int k = 0; k < n; ++k) {
                sum += m->matrix[i * n + k] * m->matrix[k * n + j];
            }
            m->square[i * n + j] = sum;
        }
    }
    double *other = m->matrix;
    m->matrix = m->square;
    m->square = other;
}

/*
 * Bound the magnitude of all eigenvalues times a step: the norm of a power of the matrix is not below that power
 * of any of them, and the root of the norm comes down to the largest as the power grows (Gelfand). Most
 * steps are known to be stable by the first or second power; no more is done for them.
 */
static double bound(worker *w, double step)
{
    method *m = w->own;
    int n = w->problem->state_count;
    double logarithm = log2(step), part = 1.0;
    memcpy(m->matrix, m->jacobian, (size_t)(n * n) * sizeof *m->matrix);
    for (int k = 0; k <= SQUARINGS; ++k, part *= 0.5) {
        if (k) {
            square(m, n);
        }
        logarithm += part * log2(normalise(m->matrix, n)); /* of zero: nothing moves */
        if (logarithm <= log2(STABLE)) {
            break;
        }
    }
    return exp2(logarithm);
}

/* See that a step is stable by the Jacobian of a state; note the longest one otherwise. */
static int check(worker *w, double time, const double *state, double step)
{
    method *m = w->own;
    ++m->fixed.counted.jacobians;
    if (kt_jacobian(w, time, state, m->jacobian)) {
        return KT_REFUSED;
    }
    double found = bound(w, step);
    if (found > STABLE) {
        w->result->longest_step = step * STABLE / found;
        return KT_UNSTABLE_STEP;
    }
    return 0;
}

/* -- a step ----------------------------------------------------------------------------------- */

/* Find the rates of the stages, and state and rates at the end; positive where the model refuses one. */
static int attempt(worker *w, double end, double step)
{
    static const double NODES[4] = {0.0, 0.5, 0.5, 1.0};
    method *m = w->own;
    int n = w->problem->state_count;
    for (int s = 1; s < 4; ++s) {
        for (int i = 0; i < n; ++i) {
            m->stage[i] = m->fixed.state[i] + NODES[s] * step * m->fixed.rates[(s - 1) * n + i];
        }
        double time = s == 3 ? end : m->fixed.times.time + 0.5 * step;
        if (kt_fixed_rates(w, time, m->stage, m->fixed.rates + s * n)) {
            return 1;
        }
    }
    for (int i = 0; i < n; ++i) {
        const double *k = m->fixed.rates + i;
        m->fixed.end_state[i] = m->fixed.state[i] + step / 6.0 * (k[0] + 2.0 * (k[n] + k[2 * n]) + k[3 * n]);
    }
    return kt_fixed_rates(w, end, m->fixed.end_state, m->fixed.end_rates);
}

static int prepare(worker *w, double step)
{
    const method *m = w->own;
    return check(w, m->fixed.times.time, m->fixed.state, fabs(step));
}

/* -- jumps ------------------------------------------------------------------------------------ */

/*
 * Return whether rates jump between the second and the third stage, which are at one time. Rates of positions do
 * not; what the others change by is measured against all.
 */
static int jumped(worker *w, double step)
{
    const method *m = w->own;
    int n = w->problem->state_count, positions = w->problem->position_count, others = n - positions;
    const double *a = m->fixed.rates, *b = a + n, *c = b + n;
    double beyond = 0.0, moved = 0.0, rounding = 0.0;
    for (int i = 0; i < others || i < positions; ++i) {
        double linear = 0.0, faster = 0.0;
        if (i < others) {
            int row = positions + i;
            for (int j = 0; j < n; ++j) {
                double entry = m->jacobian[row * n + j];
                linear += entry * 0.5 * step * (b[j] - a[j]);
                rounding += fabs(entry * m->fixed.state[j]);
            }
            beyond += fabs(c[row] - b[row] - linear);
            faster = fabs(step * (b[row] - a[row]));
            rounding += fabs(b[row]);
        }
        moved += 0.5 * (faster + (i < positions ? fabs(b[i] - a[i]) : 0.0));
    }
    return fabs(step) * beyond > JUMP * moved && beyond > ROUNDINGS * DBL_EPSILON * rounding;
}

static double change(const double *from, const double *to, int count)
{
    double sum = 0.0;
    for (int i = 0; i < count; ++i) {
        sum += fabs(to[i] - from[i]);
    }
    return sum;
}

/* Find where rates are steepest between both stages, and note the longest step that is stable there. */
static int refuse_jumps(worker *w, double step)
{
    method *m = w->own;
    int n = w->problem->state_count;
    double *low = m->fixed.terms, *high = low + n, *rates_low = high + n, *rates_high = rates_low + n;
    double time = m->fixed.times.time + 0.5 * step;
    for (int i = 0; i < n; ++i) {
        low[i] = m->fixed.state[i] + 0.5 * step * m->fixed.rates[i];
        high[i] = m->fixed.state[i] + 0.5 * step * m->fixed.rates[n + i];
        rates_low[i] = m->fixed.rates[n + i];
        rates_high[i] = m->fixed.rates[2 * n + i];
    }
    for (int turn = 0; turn < HALVINGS; ++turn) {
        for (int i = 0; i < n; ++i) {
            m->stage[i] = 0.5 * (low[i] + high[i]);
        }
        if (kt_fixed_rates(w, time, m->stage, m->fixed.rates)) {
            return KT_REFUSED;
        }
        int first = change(rates_low, m->fixed.rates, n) > change(m->fixed.rates, rates_high, n);
        memcpy(first ? high : low, m->stage, (size_t)n * sizeof *low);
        memcpy(first ? rates_high : rates_low, m->fixed.rates, (size_t)n * sizeof *low);
    }
    return check(w, time, m->stage, fabs(step));
}

/* -- within the step -------------------------------------------------------------------------- */

/* Find the cubic that has state and rates of both ends of the last step. */
static void fit(worker *w)
{
    method *m = w->own;
    int n = w->problem->state_count;
    double step = m->fixed.times.reached - m->fixed.times.time;
    for (int i = 0; i < n; ++i) {
        double moved = m->fixed.end_state[i] - m->fixed.state[i];
        double begins = step * m->fixed.rates[i], ends = step * m->fixed.end_rates[i];
        m->fixed.terms[i] = m->fixed.state[i];
        m->fixed.terms[n + i] = begins;
        m->fixed.terms[2 * n + i] = 3.0 * moved - 2.0 * begins - ends;
        m->fixed.terms[3 * n + i] = begins + ends - 2.0 * moved;
    }
}

/* -- begin and end ---------------------------------------------------------------------------- */

static const kt_fixed_method METHOD = {prepare, attempt, jumped, refuse_jumps, fit};

static int open_method(worker *w, double start)
{
    size_t n = (size_t)w->problem->state_count;
    method *m = w->own = calloc(1, sizeof *m);
    if (!m) {
        return KT_MEMORY;
    }
    m->memory = calloc((8 + KT_TERMS + 3 * n) * n, sizeof *m->memory);
    if (!m->memory) {
        return KT_MEMORY;
    }
    m->fixed.state = m->memory;
    m->fixed.end_state = m->fixed.state + n;
    m->stage = m->fixed.end_state + n;
    m->fixed.rates = m->stage + n;
    m->fixed.end_rates = m->fixed.rates + 4 * n;
    m->fixed.terms = m->fixed.end_rates + n;
    m->jacobian = m->fixed.terms + KT_TERMS * n;
    m->matrix = m->jacobian + n * n;
    m->square = m->matrix + n * n;
    kt_fixed_open(w, &METHOD, start);
    return KT_DONE;
}

static void close_method(worker *w)
{
    method *m = w->own;
    if (m) {
        free(m->memory);
        free(m);
    }
}

const kt_solver kt_rk4 = {
    open_method, close_method, kt_fixed_step, kt_fixed_set_stop, kt_fixed_interpolate, kt_fixed_begin,
    kt_fixed_next, kt_fixed_count, KT_NO_TOLERANCES, 0,
};
