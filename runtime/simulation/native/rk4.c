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
#include "polynomial.h"
#include "worker.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define TERMS 4

/*
 * Whatever eigenvalue of a motion that does not grow, times the step, is below this, is stable: the radius of the
 * largest half disc in the region of stability, which is 2.785 long on the real axis and 2.828 on the other.
 */
#define STABLE 2.61

/* The bound is that of the power 2^8 of the matrix: some per cent above the largest eigenvalue at most. */
#define SQUARINGS 8

/*
 * Rates jump where a step times what their change between two stages has beyond the Jacobian is more than this
 * part of what has changed, and more than so many roundings. So many steps of that kind, with never so many in
 * a row between them that are not, are more than one passing of a jump.
 */
#define JUMP 0.5
#define ROUNDINGS 1.0e6
#define OFTEN_JUMPS 15
#define OFTEN_CALM 6

/* Halvings of the way between two stages, to find where rates are steepest. */
#define HALVINGS 30

typedef struct {
    double *memory;
    double *state, *end_state, *stage;
    double *rates, *end_rates; /* of the stages, 4 x states; at the end, which are those of the next begin */
    double *terms;             /* TERMS x states */
    double *jacobian, *matrix, *square; /* states x states */
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
    m->memory = calloc((8 + TERMS + 3 * n) * n, sizeof *m->memory);
    if (!m->memory) {
        return KT_MEMORY;
    }
    m->state = m->memory;
    m->end_state = m->state + n;
    m->stage = m->end_state + n;
    m->rates = m->stage + n;
    m->end_rates = m->rates + 4 * n;
    m->terms = m->end_rates + n;
    m->jacobian = m->terms + TERMS * n;
    m->matrix = m->jacobian + n * n;
    m->square = m->matrix + n * n;
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
        free(m);
    }
}

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

/* See that a step is stable by the Jacobian of a state; tell the longest one otherwise. */
static int check(worker *w, double time, const double *state, double step)
{
    method *m = w->own;
    ++m->counted.jacobians;
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

static int rates_at(worker *w, double time, const double *state, double *out)
{
    method *m = w->own;
    ++m->counted.evaluations;
    return kt_rates(w, time, state, out);
}

/* Find the rates of the stages, and state and rates at the end; positive where the model refuses one. */
static int attempt(worker *w, double end, double step)
{
    static const double NODES[4] = {0.0, 0.5, 0.5, 1.0};
    method *m = w->own;
    int n = w->problem->state_count;
    for (int s = 1; s < 4; ++s) {
        for (int i = 0; i < n; ++i) {
            m->stage[i] = m->state[i] + NODES[s] * step * m->rates[(s - 1) * n + i];
        }
        double time = s == 3 ? end : m->steps.time + 0.5 * step;
        if (rates_at(w, time, m->stage, m->rates + s * n)) {
            return 1;
        }
    }
    for (int i = 0; i < n; ++i) {
        const double *k = m->rates + i;
        m->end_state[i] = m->state[i] + step / 6.0 * (k[0] + 2.0 * (k[n] + k[2 * n]) + k[3 * n]);
    }
    return rates_at(w, end, m->end_state, m->end_rates);
}

/* -- jumps ------------------------------------------------------------------------------------ */

/*
 * Tell whether rates jump between the second and the third stage, which are at one time. Rates of positions do
 * not; what the others change by is measured against all.
 */
static int jumps(const worker *w, double step)
{
    const method *m = w->own;
    int n = w->problem->state_count, positions = w->problem->position_count, others = n - positions;
    const double *a = m->rates, *b = a + n, *c = b + n;
    double beyond = 0.0, moved = 0.0, rounding = 0.0;
    for (int i = 0; i < others || i < positions; ++i) {
        double told = 0.0, faster = 0.0;
        if (i < others) {
            int row = positions + i;
            for (int j = 0; j < n; ++j) {
                double entry = m->jacobian[row * n + j];
                told += entry * 0.5 * step * (b[j] - a[j]);
                rounding += fabs(entry * m->state[j]);
            }
            beyond += fabs(c[row] - b[row] - told);
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

/* Find where rates are steepest between both stages, and tell the longest step that is stable there. */
static int refuse_jumps(worker *w, double step)
{
    method *m = w->own;
    int n = w->problem->state_count;
    double *low = m->terms, *high = low + n, *rates_low = high + n, *rates_high = rates_low + n;
    double time = m->steps.time + 0.5 * step;
    for (int i = 0; i < n; ++i) {
        low[i] = m->state[i] + 0.5 * step * m->rates[i];
        high[i] = m->state[i] + 0.5 * step * m->rates[n + i];
        rates_low[i] = m->rates[n + i];
        rates_high[i] = m->rates[2 * n + i];
    }
    for (int turn = 0; turn < HALVINGS; ++turn) {
        for (int i = 0; i < n; ++i) {
            m->stage[i] = 0.5 * (low[i] + high[i]);
        }
        if (rates_at(w, time, m->stage, m->rates)) {
            return KT_REFUSED;
        }
        int first = change(rates_low, m->rates, n) > change(m->rates, rates_high, n);
        memcpy(first ? high : low, m->stage, (size_t)n * sizeof *low);
        memcpy(first ? rates_high : rates_low, m->rates, (size_t)n * sizeof *low);
    }
    return check(w, time, m->stage, fabs(step));
}

/* Count the steps in which rates jump; refuse them where they do so again and again. */
static int see_jumps(worker *w, double step)
{
    method *m = w->own;
    int jumped = jumps(w, step);
    m->calm = jumped ? 0 : m->calm + 1;
    m->jumps = m->calm >= OFTEN_CALM ? 0 : m->jumps + jumped;
    return m->jumps >= OFTEN_JUMPS ? refuse_jumps(w, step) : 0;
}

/* -- all of a step ---------------------------------------------------------------------------- */

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

static int take_step(worker *w)
{
    method *m = w->own;
    int code = go_on(w);
    if (code) {
        return code;
    }
    double most = kt_longest_fixed(w), end = kt_end_of_step(&m->steps, most), step = end - m->steps.time;
    code = check(w, m->steps.time, m->state, fabs(step));
    if (!code && attempt(w, end, step)) {
        code = KT_REFUSED;
    }
    code = code ? code : see_jumps(w, step);
    if (code) {
        m->steps.next = fabs(step);
        return code;
    }
    ++m->counted.steps;
    kt_reach_end(&m->steps, end, most);
    return 0;
}

/* -- within the step -------------------------------------------------------------------------- */

/* Find the cubic that has state and rates of both ends of the last step. */
static void fit(worker *w)
{
    method *m = w->own;
    int n = w->problem->state_count;
    double step = m->steps.reached - m->steps.time;
    for (int i = 0; i < n; ++i) {
        double moved = m->end_state[i] - m->state[i];
        double begins = step * m->rates[i], ends = step * m->end_rates[i];
        m->terms[i] = m->state[i];
        m->terms[n + i] = begins;
        m->terms[2 * n + i] = 3.0 * moved - 2.0 * begins - ends;
        m->terms[3 * n + i] = begins + ends - 2.0 * moved;
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
    total->order = 4;
}

const kt_solver kt_rk4 = {
    open_method, close_method, step, set_stop, interpolate, begin_anew,
    next_step, count, KT_NO_TOLERANCES, 0,
};
