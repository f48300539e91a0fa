/* Methods with a fixed step. */
#include "fixed_step.h"
#include "polynomial.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A time span below this part of a step is a rounding error. */
#define SLIVER 1.0e-9

/*
 * Rates alternate if they jump in the first number of steps, with fewer than the second number of consecutive steps
 * without a jump between them.
 */
#define OFTEN_JUMPS 15
#define OFTEN_CALM 6

/* -- ends of steps ---------------------------------------------------------------------------- */

static double longest(const worker *w)
{
    return w->options->max_step > 0.0 ? w->options->max_step : fabs(w->end - w->start);
}

static int is_whole(const kt_fixed_times *t, double most) { return t->next >= most; }

static int lands(const kt_fixed_times *t, double most)
{
    return t->sign * (t->stop - t->time) <= fmin(t->next, most) * (1.0 + SLIVER);
}

/* Return the time at which the next step ends. */
static double end_of_step(const kt_fixed_times *t, double most)
{
    if (lands(t, most)) {
        return t->stop;
    }
    return is_whole(t, most) ? t->origin + t->sign * (double)(t->since + 1) * most : t->time + t->sign * t->next;
}

/* Note that the step to this time was taken. */
static void reach(kt_fixed_times *t, double end, double most)
{
    int restarted = lands(t, most) || !is_whole(t, most);
    t->reached = end;
    t->next = fmin(2.0 * t->next, most);
    t->since = restarted ? 0 : t->since + 1;
    t->origin = restarted ? end : t->origin;
}

/* -- begin ------------------------------------------------------------------------------------ */

int kt_fixed_begin(worker *w, double time, double length)
{
    kt_fixed *m = w->own;
    size_t size = (size_t)w->problem->state_count * sizeof *m->state;
    m->elsewhere = memcmp(m->end_state, w->y, size) != 0;
    memcpy(m->state, w->y, size);
    if (w->rates_known) {
        memcpy(m->rates, m->end_rates, size);
    }
    memset(&m->counted, 0, sizeof m->counted);
    m->times.time = m->times.reached = m->times.origin = time;
    m->times.since = 0;
    m->times.next = fabs(length);
    m->fresh = !w->rates_known;
    m->fitted = 0;
    return 0;
}

double *kt_fixed_open(worker *w, const kt_fixed_method *method, double start)
{
    size_t n = (size_t)w->problem->state_count, stages = (size_t)method->stages;
    kt_fixed *m = w->own = calloc(1, method->size);
    if (!m) {
        return NULL;
    }
    size_t vectors = 3 + stages + KT_TERMS + (size_t)method->vectors;
    m->memory = calloc((vectors + (size_t)method->matrices * n) * n, sizeof *m->memory);
    if (!m->memory) {
        return NULL;
    }
    m->state = m->memory;
    m->end_state = m->state + n;
    m->end_rates = m->end_state + n;
    m->rates = m->end_rates + n;
    m->terms = m->rates + stages * n;
    m->method = method;
    m->times.sign = w->end > w->start ? 1.0 : -1.0;
    m->times.stop = w->end;
    kt_fixed_begin(w, start, longest(w));
    return m->terms + KT_TERMS * n;
}

void kt_fixed_close(worker *w)
{
    kt_fixed *m = w->own;
    if (m) {
        free(m->memory);
        free(m);
    }
}

/* -- a step ----------------------------------------------------------------------------------- */

int kt_fixed_rates(worker *w, double time, const double *state, double *out)
{
    kt_fixed *m = w->own;
    ++m->counted.evaluations;
    return kt_rates(w, time, state, out);
}

/* Start at the end of the last step, and evaluate the rates there if they are not known. */
static int go_on(worker *w)
{
    kt_fixed *m = w->own;
    size_t size = (size_t)w->problem->state_count * sizeof *m->state;
    if (m->times.reached != m->times.time) {
        memcpy(m->state, m->end_state, size);
        memcpy(m->rates, m->end_rates, size);
        m->times.time = m->times.reached;
        m->fitted = 0;
    }
    if (m->fresh && kt_fixed_rates(w, m->times.time, m->state, m->rates)) {
        return KT_REFUSED;
    }
    m->fresh = 0;
    return 0;
}

/* Count the steps in which rates jump, and refuse a step after too many of them. */
static int see_jumps(worker *w, double step)
{
    kt_fixed *m = w->own;
    int jumped = m->method->jumped(w, step);
    if (jumped < 0) {
        return jumped;
    }
    m->calm = jumped ? 0 : m->calm + 1;
    m->jumps = m->calm >= OFTEN_CALM ? 0 : m->jumps + jumped;
    return m->jumps >= OFTEN_JUMPS ? m->method->refuse_jumps(w, step) : 0;
}

static int take_step(worker *w)
{
    kt_fixed *m = w->own;
    int code = go_on(w);
    if (code) {
        return code;
    }
    double most = longest(w), end = end_of_step(&m->times, most), step = end - m->times.time;
    code = m->method->prepare(w, step);
    code = code ? code : m->method->attempt(w, end, step);
    code = code ? code : see_jumps(w, step);
    if (code) {
        m->times.next = fabs(step);
        return code;
    }
    ++m->counted.steps;
    reach(&m->times, end, most);
    return 0;
}

int kt_fixed_step(worker *w, double goal, double *time)
{
    (void)goal;
    kt_fixed *m = w->own;
    int code = take_step(w);
    if (!code) {
        *time = m->times.reached;
        memcpy(w->y, m->end_state, (size_t)w->problem->state_count * sizeof *w->y);
    }
    return code;
}

/* -- within the step, and after it ------------------------------------------------------------ */

int kt_fixed_interpolate(worker *w, double time, int derivative, double *out)
{
    kt_fixed *m = w->own;
    int n = w->problem->state_count;
    double step = m->times.reached - m->times.time;
    if (derivative >= KT_TERMS) {
        return 1;
    }
    if (derivative == 0 && time == m->times.reached) {
        memcpy(out, m->end_state, (size_t)n * sizeof *out);
        return 0;
    }
    if (!m->fitted) {
        m->method->fit(w);
        m->fitted = 1;
    }
    kt_interpolate(m->terms, KT_TERMS, n, (time - m->times.time) / step, step, derivative, out);
    return 0;
}

int kt_fixed_set_stop(worker *w, double time)
{
    kt_fixed *m = w->own;
    m->times.stop = time;
    return 0;
}

double kt_fixed_next(worker *w)
{
    kt_fixed *m = w->own;
    return m->times.next;
}

void kt_fixed_count(worker *w, kt_statistics *total)
{
    kt_fixed *m = w->own;
    total->steps += m->counted.steps;
    total->evaluations += m->counted.evaluations;
    total->jacobians += m->counted.jacobians;
    total->factorisations += m->counted.factorisations;
    total->order = 4;
}
