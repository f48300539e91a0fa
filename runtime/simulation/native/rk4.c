/*
 * The classical Runge-Kutta method of order 4 with a fixed step, for real time: four evaluations a step for any
 * motion. States within a step are interpolated by the cubic through both of its ends (Hermite), without further
 * evaluations.
 *
 * If the step is too long, fast motions grow, and no error estimate detects it. So the largest eigenvalue of the
 * exact Jacobian is bounded, and a step that is not stable is refused. The Jacobian costs more than the step; it is
 * evaluated at the first step, at one in many, and at each step whose rates differ by more than the last Jacobian
 * explains. A growing motion appears in these differences long before it appears in the state.
 *
 * Rates may also alternate between the stages, such as those of friction that sticks. No Jacobian shows that, but
 * the rates of the stages do.
 */
#include "eigenvalues.h"
#include "fixed_step.h"
#include "worker.h"

#include <float.h>
#include <math.h>
#include <string.h>

/*
 * A step is stable if its length times each eigenvalue, of motions that do not grow, is below this: the radius of the
 * largest half disc in the region of stability, which is 2.785 long on the real axis and 2.828 on the other.
 */
#define STABLE 2.61

/* A difference of rates is small if the step times it is below this part of the difference of states. */
#define LITTLE 0.25

/* The same near the limit of stability, where each step has its own Jacobian. */
#define NEAR (0.5 * STABLE)

/* Most steps that share one Jacobian. */
#define STEPS_OF_ONE 128

/*
 * Rates jump if the step, times the change of rates between two stages that the Jacobian does not explain, is more
 * than this part of the change of the state, and more than this number of roundings.
 */
#define JUMP 0.5
#define ROUNDINGS 1.0e6

/* Bisections between two stages, to find the steepest rates. */
#define HALVINGS 30

typedef struct {
    kt_fixed fixed;
    double *stage;                      /* the state of a stage */
    double *jacobian, *matrix, *square; /* states x states */
    double *weights; /* weights of the states with which the Jacobian is balanced */
    double *most;    /* largest differences of each state since the last Jacobian: between stages at one time; at two */
    double norm;     /* of the balanced Jacobian */
    double length;   /* of the step that was stable by the Jacobian */
    int due;         /* the next step has a Jacobian of its own */
    int here;        /* the Jacobian is of the begin of this step */
    int steps;       /* since the Jacobian */
} method;

/* -- stability -------------------------------------------------------------------------------- */

/* Refuse a step that is not stable by the Jacobian of a state, and note the longest stable one. */
static int check(worker *w, double time, const double *state, double step)
{
    method *m = w->own;
    int n = w->problem->state_count;
    ++m->fixed.counted.jacobians;
    m->due = 1;
    if (kt_jacobian(w, time, state, m->jacobian)) {
        return KT_REFUSED;
    }
    memcpy(m->matrix, m->jacobian, (size_t)(n * n) * sizeof *m->matrix);
    m->norm = kt_balance(m->matrix, n, m->weights);
    double found = step * kt_bound_eigenvalues(m->matrix, m->square, n, STABLE / step);
    if (found > STABLE) {
        w->result->longest_step = step * STABLE / found;
        return KT_UNSTABLE_STEP;
    }
    m->length = step;
    m->due = m->steps = 0;
    memset(m->most, 0, 2 * (size_t)n * sizeof *m->most);
    return 0;
}

/* The same by the Jacobian at the beginning of the step, unless that has been evaluated. */
static int check_here(worker *w, double step)
{
    method *m = w->own;
    int code = m->here ? 0 : check(w, m->fixed.times.time, m->fixed.state, fabs(step));
    m->here = !code;
    m->fixed.elsewhere = 0;
    return code;
}

/* Return the Euclidean norm of a vector whose elements have weights. */
static double weighed(const method *m, int n, const double *vector)
{
    double sum = 0.0;
    for (int i = 0; i < n; ++i) {
        double element = m->weights[i] * vector[i];
        sum += element * element;
    }
    return sqrt(sum);
}

/* Return whether the difference of a rate from the last Jacobian is within rounding. */
static int rounded(const method *m, int n, int row, double beyond)
{
    double size = fabs(m->fixed.rates[row]);
    for (int j = 0; j < n; ++j) {
        size += fabs(m->jacobian[row * n + j] * m->fixed.state[j]);
    }
    return beyond <= ROUNDINGS * DBL_EPSILON * size; /* false for NaN */
}

/*
 * Return whether the last Jacobian explains the difference of each rate up to a small part, relative to the difference
 * of its state and to the terms of the Jacobian. This test is independent of units, and is also valid for states that
 * took part only in eigenvalues of zero, such as those of a body that falls onto a stiff one.
 */
static int rows_explained(const method *m, int n, double *most, const double *states, const double *rates)
{
    for (int i = 0; i < n; ++i) {
        double linear = 0.0, size = 0.0;
        for (int j = 0; j < n; ++j) {
            double term = m->jacobian[i * n + j] * states[j];
            linear += term;
            size += fabs(term);
        }
        double beyond = fabs(rates[i] - linear);
        most[i] = fmax(most[i], fabs(states[i]));
        if (!(m->length * beyond <= LITTLE * (most[i] + m->length * size)) && !rounded(m, n, i, beyond)) {
            return 0;
        }
    }
    return 1;
}

/*
 * Return whether the difference of the rates at two states of one time is that of a stable step: small, or explained
 * by the last Jacobian. Both differences are overwritten. The next step may be longer than this one.
 */
static int explained(const method *m, int n, double *states, double *rates)
{
    double step = m->length;
    if (!rows_explained(m, n, m->most, states, rates)) {
        return 0;
    }
    double by_states = weighed(m, n, states), by_rates = step * weighed(m, n, rates);
    double rounding = step * m->norm * weighed(m, n, m->fixed.state);
    if (by_rates <= LITTLE * by_states || by_rates <= ROUNDINGS * DBL_EPSILON * rounding) {
        return 1;
    }
    if (!(by_rates <= NEAR * by_states)) { /* nor a NaN */
        return 0;
    }
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
            rates[i] -= m->jacobian[i * n + j] * states[j];
        }
    }
    return step * weighed(m, n, rates) <= LITTLE * by_states;
}

/* The same of the second and third stage. */
static int middle_explained(const worker *w, double step)
{
    const method *m = w->own;
    int n = w->problem->state_count;
    const double *k = m->fixed.rates;
    for (int i = 0; i < n; ++i) {
        m->matrix[i] = 0.5 * step * (k[n + i] - k[i]);
        m->square[i] = k[2 * n + i] - k[n + i];
    }
    return explained(m, n, m->matrix, m->square);
}

/* The same of the fourth stage and the end. */
static int end_explained(const worker *w, double step)
{
    const method *m = w->own;
    int n = w->problem->state_count;
    const double *k = m->fixed.rates;
    for (int i = 0; i < n; ++i) {
        m->matrix[i] = step / 6.0 * (k[i] + 2.0 * k[n + i] - 4.0 * k[2 * n + i] + k[3 * n + i]);
        m->square[i] = m->fixed.end_rates[i] - k[3 * n + i];
    }
    return explained(m, n, m->matrix, m->square);
}

/* The same of the third stage and one of another time, the first or the fourth, by the test of each rate only. */
static int other_explained(const worker *w, double step, int stage)
{
    const method *m = w->own;
    int n = w->problem->state_count;
    const double *k = m->fixed.rates;
    for (int i = 0; i < n; ++i) {
        double there = stage ? step * k[2 * n + i] : 0.0;
        m->matrix[i] = there - 0.5 * step * k[n + i];
        m->square[i] = k[stage * n + i] - k[2 * n + i];
    }
    return rows_explained(m, n, m->most + n, m->matrix, m->square);
}

/* -- a step ----------------------------------------------------------------------------------- */

/* Compute the rates of the stages, and state and rates at the end; positive if the model refuses a state. */
static int find_end(worker *w, double end, double step)
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

/* Compute the end. If the model refuses a state, the cause may be a step that is not stable. */
static int attempt(worker *w, double end, double step)
{
    if (!find_end(w, end, step)) {
        return 0;
    }
    int code = check_here(w, step);
    return code ? code : KT_REFUSED;
}

static int prepare(worker *w, double step)
{
    method *m = w->own;
    m->here = 0;
    m->due |= m->fixed.elsewhere || ++m->steps > STEPS_OF_ONE
        || fabs(step) > m->length * (1.0 + ROUNDINGS * DBL_EPSILON);
    return m->due ? check_here(w, step) : 0;
}

/* -- jumps ------------------------------------------------------------------------------------ */

/*
 * Return whether rates jump between the second and the third stage, which are at one time. Rates of positions do not
 * jump; the change of the others is compared with that of all.
 */
static int jump(const worker *w, double step)
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

/* The same, only if the last Jacobian does not explain the rates; a code if the step is not stable with that here. */
static int jumped(worker *w, double step)
{
    method *m = w->own;
    int known = middle_explained(w, step);
    int code = known ? 0 : check_here(w, step);
    m->due = !known || !other_explained(w, step, 0) || !other_explained(w, step, 3) || !end_explained(w, step);
    return code ? code : !known && jump(w, step);
}

static double change(const double *from, const double *to, int count)
{
    double sum = 0.0;
    for (int i = 0; i < count; ++i) {
        sum += fabs(to[i] - from[i]);
    }
    return sum;
}

/* Find the state with the steepest rates between both stages, and note the longest stable step there. */
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
    int code = check(w, time, m->stage, fabs(step));
    m->due = 1; /* no step begins here */
    return code;
}

/* -- within the step -------------------------------------------------------------------------- */

/* Compute the cubic with state and rates of both ends of the last step. */
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

static const kt_fixed_method METHOD = {
    .size = sizeof(method), .stages = 4, .vectors = 4, .matrices = 3,
    .prepare = prepare, .attempt = attempt, .jumped = jumped, .refuse_jumps = refuse_jumps, .fit = fit,
};

static int open_method(worker *w, double start)
{
    size_t n = (size_t)w->problem->state_count;
    double *arrays = kt_fixed_open(w, &METHOD, start);
    method *m = w->own;
    if (!arrays) {
        return KT_MEMORY;
    }
    m->stage = arrays;
    m->weights = m->stage + n;
    m->most = m->weights + n;
    m->jacobian = m->most + 2 * n;
    m->matrix = m->jacobian + n * n;
    m->square = m->matrix + n * n;
    return KT_DONE;
}

const kt_solver kt_rk4 = {
    open_method, kt_fixed_close, kt_fixed_step, kt_fixed_set_stop, kt_fixed_interpolate, kt_fixed_begin,
    kt_fixed_next, kt_fixed_count, KT_NO_TOLERANCES, 0,
};
