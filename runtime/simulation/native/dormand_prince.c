/*
 * Dormand and Prince's method of order 5, for a single system. Its free interpolant evaluates outputs and
 * finds events without further evaluations.
 */
#include "dormand_prince.h"
#include "number.h"
#include "polynomial.h"
#include "powers.h"
#include "worker.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Terms of the interpolant. */
#define TERMS 5

/* A code that is never returned: too small tolerances lead to too small steps. */
#define NEVER 1

typedef struct {
    double *memory;
    double *state, *end_state, *stage;
    double *rates;  /* stages x states */
    double *terms;  /* TERMS x states: powers of the part of the step */
    double sign;    /* direction of time */
    double time, reached; /* begin and end of the last step; equal before the first */
    double next;    /* planned length of the next step; 0: to be chosen */
    double error;   /* binary logarithm of the square of the error of the step before */
    double stop;
    int fresh;      /* the rates at `time` are not known */
    int fitted;     /* the terms are those of the last step */
    kt_statistics counted;
} method;

/* -- begin and end ---------------------------------------------------------------------------- */

static int restart(worker *w, double time, double length)
{
    method *m = w->own;
    size_t size = (size_t)w->problem->state_count * sizeof *m->state;
    memcpy(m->state, w->y, size);
    if (w->rates_known) {
        memcpy(m->rates, m->rates + (STAGES - 1) * w->problem->state_count, size);
    }
    memset(&m->counted, 0, sizeof m->counted);
    m->time = m->reached = time;
    m->next = fabs(length);
    m->error = 0.0;
    m->fresh = !w->rates_known;
    m->fitted = 0;
    return 0;
}

static int open_method(worker *w, double start)
{
    int n = w->problem->state_count;
    method *m = w->own = calloc(1, sizeof *m);
    if (!m) {
        return KT_MEMORY;
    }
    m->memory = calloc((size_t)(3 + STAGES + TERMS) * n, sizeof *m->memory);
    if (!m->memory) {
        return KT_MEMORY;
    }
    m->state = m->memory;
    m->end_state = m->state + n;
    m->stage = m->end_state + n;
    m->rates = m->stage + n;
    m->terms = m->rates + STAGES * n;
    m->sign = w->end > w->start ? 1.0 : -1.0;
    m->stop = w->end;
    restart(w, start, w->options->first_step);
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

/* -- a step ----------------------------------------------------------------------------------- */

static int rates_at(worker *w, double time, const double *state, double *out)
{
    method *m = w->own;
    ++m->counted.evaluations;
    return kt_rates(w, time, state, out);
}

/* Return the mean square of some numbers, each divided by its tolerance. */
static double mean_square(const worker *w, const double *numbers, const double *other)
{
    const method *m = w->own;
    int n = w->problem->state_count;
    double sum = 0.0;
    for (int i = 0; i < n; ++i) {
        double largest = greater(fabs(m->state[i]), fabs(other[i]));
        double measured = numbers[i] / (w->options->atol[i] + w->options->rtol * largest);
        sum += measured * measured;
    }
    return sum / n;
}

/* Return the length of the first step, from the size of the state and of its rates. */
static double first_step(const worker *w)
{
    const method *m = w->own;
    double size = mean_square(w, m->state, m->state);
    double rate = bounded_logarithm(mean_square(w, m->rates, m->state));
    double step = exponential(0.2 * (LOG2_FIRST - 0.5 * rate));
    double of_state = exponential(0.5 * (bounded_logarithm(size) - rate));
    return lesser(step, size > 1.0e-10 ? of_state : 1.0e-4);
}

/* Return the length of the next step, as planned unless a time limits it, and that time. */
static double planned(worker *w, double *goal)
{
    const method *m = w->own;
    double most = lesser(m->next, w->trusted);
    most = w->options->max_step > 0.0 ? lesser(most, w->options->max_step) : most;
    double far = lesser(m->sign * m->stop, m->sign * m->time + 2.0 * most);
    *goal = kt_next_turn(w, m->time, m->sign * far, most);
    *goal = *goal == m->sign * far ? m->stop : *goal;
    double left = m->sign * (*goal - m->time);
    /* two equal steps instead of one and a short remainder */
    return left <= most ? left : left < 2.0 * most ? 0.5 * left : most;
}

/* Compute the rates of all stages and the state at the end of a step; positive if a state is refused. */
static int attempt(worker *w, double step)
{
    method *m = w->own;
    int n = w->problem->state_count;
    for (int s = 1; s < STAGES; ++s) {
        double *stage = s == STAGES - 1 ? m->end_state : m->stage;
        for (int i = 0; i < n; ++i) {
            double sum = TABLE[s][0] * m->rates[i];
            for (int k = 1; k < s; ++k) {
                sum += TABLE[s][k] * m->rates[k * n + i];
            }
            stage[i] = m->state[i] + step * sum;
        }
        if (rates_at(w, m->time + NODES[s] * step, stage, m->rates + s * n)) {
            return 1;
        }
    }
    return 0;
}

static double error_of(const worker *w, double step)
{
    const method *m = w->own;
    int n = w->problem->state_count;
    for (int i = 0; i < n; ++i) {
        double sum = ERROR[0] * m->rates[i];
        for (int s = 2; s < STAGES; ++s) {
            sum += ERROR[s] * m->rates[s * n + i];
        }
        m->stage[i] = step * sum;
    }
    return mean_square(w, m->stage, m->end_state);
}

/* Start the next step at the end of the last one, and ensure that its rates are known. */
static int go_on(worker *w)
{
    method *m = w->own;
    int n = w->problem->state_count;
    if (m->reached != m->time) {
        memcpy(m->state, m->end_state, (size_t)n * sizeof *m->state);
        memcpy(m->rates, m->rates + (STAGES - 1) * n, (size_t)n * sizeof *m->rates);
        m->time = m->reached;
        m->fitted = 0;
    }
    if (m->fresh) {
        if (rates_at(w, m->time, m->state, m->rates)) {
            return KT_REFUSED;
        }
        m->fresh = 0;
    }
    if (m->next == 0.0) {
        m->next = fmin(first_step(w), fabs(w->end - w->start));
    }
    return 0;
}

/* Take a step whose length its error permits. */
static int take_step(worker *w)
{
    method *m = w->own;
    double least = ROUNDING * fmax(fabs(m->time), fabs(w->end - w->start)), length, error, goal;
    int code = go_on(w), again = 0;
    if (code) {
        return code;
    }
    for (;;) {
        double plan = m->next;
        length = planned(w, &goal);
        if (attempt(w, m->sign * length)) {
            m->next = length;
            return KT_REFUSED;
        }
        double square = error_of(w, m->sign * length);
        error = bounded_logarithm(square);
        double factor = SAFE * exponential(0.5 * (OF_ERROR_BEFORE * m->error - OF_ERROR * error));
        factor = lesser(greater(factor, MOST_SHORTER), MOST_LONGER);
        int good = square <= 1.0;
        m->next = length * (again || !good ? lesser(factor, 1.0) : factor);
        if (good) {
            /* a step that was shortened to reach its goal does not reduce the planned length */
            m->next = !again && length < plan ? greater(m->next, plan) : m->next;
            break;
        }
        again = 1;
        ++m->counted.error_test_failures;
        if (!(m->next >= least)) { /* also for NaN */
            return KT_TOO_SMALL;
        }
    }
    ++m->counted.steps;
    m->error = greater(error, LOG2_LEAST_SQUARE);
    m->reached = length == m->sign * (goal - m->time) ? goal : m->time + m->sign * length;
    return 0;
}

/* -- within the step -------------------------------------------------------------------------- */

/* Compute the polynomial that interpolates the states within the last step. */
static void fit(worker *w)
{
    method *m = w->own;
    int n = w->problem->state_count;
    double step = m->reached - m->time;
    for (int i = 0; i < n; ++i) {
        double moved = m->end_state[i] - m->state[i], sum = DENSE[0] * m->rates[i];
        for (int s = 2; s < STAGES; ++s) {
            sum += DENSE[s] * m->rates[s * n + i];
        }
        double bent = step * m->rates[i] - moved, last = step * sum;
        double back = moved - step * m->rates[(STAGES - 1) * n + i] - bent;
        const double powers[TERMS] = {
            m->state[i], moved + bent, back + last - bent, -(back + 2.0 * last), last,
        };
        for (int k = 0; k < TERMS; ++k) {
            m->terms[k * n + i] = powers[k];
        }
    }
    m->fitted = 1;
}

static int interpolate(worker *w, double time, int derivative, double *out)
{
    method *m = w->own;
    int n = w->problem->state_count;
    double step = m->reached - m->time, part = (time - m->time) / step;
    if (derivative >= TERMS) {
        return 1;
    }
    if (derivative == 0 && time == m->reached) {
        memcpy(out, m->end_state, (size_t)n * sizeof *out);
        return 0;
    }
    if (!m->fitted) {
        fit(w);
    }
    kt_interpolate(m->terms, TERMS, n, part, step, derivative, out);
    return 0;
}

/* -- called by `integrate.c` ------------------------------------------------------------------ */

static int step(worker *w, double goal, double *time)
{
    (void)goal;
    method *m = w->own;
    int code = take_step(w);
    if (!code) {
        *time = m->reached;
        memcpy(w->y, m->end_state, (size_t)w->problem->state_count * sizeof *w->y);
    }
    return code;
}


static int set_stop(worker *w, double time)
{
    method *m = w->own;
    m->stop = time;
    return 0;
}

static double next_step(worker *w)
{
    method *m = w->own;
    return m->next;
}

static void count(worker *w, kt_statistics *total)
{
    method *m = w->own;
    total->steps += m->counted.steps;
    total->evaluations += m->counted.evaluations;
    total->error_test_failures += m->counted.error_test_failures;
    total->order = 5;
}

const kt_solver kt_dormand_prince = {
    open_method, close_method, step, set_stop, interpolate, restart,
    next_step, count, NEVER, 1,
};
