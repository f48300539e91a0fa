/*
 * Dormand and Prince's method of order 5, for one system alone. Its free interpolant gives outputs and
 * finds events without an evaluation more.
 */
#include "dormand_prince.h"
#include "worker.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What SUNDIALS returns in the same cases. */
enum { TOO_SMALL = -3, REFUSED = -8, NO_ROOTS = -12, FLAT = -22, NEVER = -99 };

/* Terms of the interpolant. */
#define TERMS 5

/* Times nearer to each other than this part of them are one, where a root is looked for. */
#define RESOLVED (100.0 * DBL_EPSILON)

typedef struct {
    double *memory;
    double *state, *end_state, *stage;
    double *rates;  /* stages x states */
    double *terms;  /* TERMS x states: powers of the part of the step */
    double sign;    /* of the time's direction */
    double time, reached; /* the last step goes from the one to the other; equal before it is taken */
    double next;    /* how long the next one is to be; 0: to be chosen */
    double error;   /* binary logarithm of the square of that of the step before */
    double stop;
    int fresh;      /* the rates at `time` are not known */
    int fitted;     /* the terms are those of the last step */
    kt_statistics counted;

    double *low, *high, *middle; /* values of the functions whose roots are events */
    int *idle;      /* those that have been zero from the begin on */
    int *found;     /* those that are zero at the root that was returned last */
    double seen;    /* up to where roots have been looked for */
    int looks;      /* `low` is known, of that time */
    int at_root;    /* there is a root at that time */
} method;

/* -- begin and end ---------------------------------------------------------------------------- */

static int begin_anew(worker *w, double time, double length)
{
    method *m = w->own;
    memcpy(m->state, w->y, (size_t)w->problem->state_count * sizeof *m->state);
    memset(&m->counted, 0, sizeof m->counted);
    m->time = m->reached = m->seen = time;
    m->next = fabs(length);
    m->error = 0.0;
    m->fresh = 1;
    m->fitted = m->looks = m->at_root = 0;
    return 0;
}

static int open_method(worker *w, double start)
{
    int n = w->problem->state_count, roots = kt_root_count(w);
    method *m = w->own = calloc(1, sizeof *m);
    if (!m) {
        return KT_MEMORY;
    }
    m->memory = calloc((size_t)(3 + STAGES + TERMS) * n + 3 * roots, sizeof *m->memory);
    m->idle = calloc((size_t)2 * roots + 1, sizeof *m->idle);
    if (!m->memory || !m->idle) {
        return KT_MEMORY;
    }
    m->found = m->idle + roots;
    m->state = m->memory;
    m->end_state = m->state + n;
    m->stage = m->end_state + n;
    m->rates = m->stage + n;
    m->terms = m->rates + STAGES * n;
    m->low = m->terms + TERMS * n;
    m->high = m->low + roots;
    m->middle = m->high + roots;
    m->sign = w->end > w->start ? 1.0 : -1.0;
    m->stop = w->end;
    begin_anew(w, start, w->options->first_step);
    return KT_DONE;
}

static void close_method(worker *w)
{
    method *m = w->own;
    if (m) {
        free(m->memory);
        free(m->idle);
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

/* Return the mean square of some numbers, each measured by what is tolerated; binary logarithm. */
static double size_of(const worker *w, const double *numbers, const double *other)
{
    const method *m = w->own;
    int n = w->problem->state_count;
    double sum = 0.0;
    for (int i = 0; i < n; ++i) {
        double largest = fmax(fabs(m->state[i]), fabs(other[i]));
        double measured = numbers[i] / (w->options->atol[i] + w->options->rtol * largest);
        sum += measured * measured;
    }
    return log2(fmax(sum / n, 1e-60));
}

/* Return the length of the first step, by the size of the state and of its rates. */
static double first_step(const worker *w)
{
    const method *m = w->own;
    double size = size_of(w, m->state, m->state), rate = size_of(w, m->rates, m->state);
    double length = exp2(0.2 * (LOG2_FIRST - 0.5 * rate));
    return fmin(length, size > -33.0 ? exp2(0.5 * (size - rate)) : 1e-4);
}

/* Return how long the next step is, as planned and as it is for its stop. */
static double planned(const worker *w, double *length)
{
    const method *m = w->own;
    double most = w->options->max_step > 0.0 ? fmin(m->next, w->options->max_step) : m->next;
    double left = m->sign * (m->stop - m->time);
    /* two equal steps, rather than one and what remains */
    *length = left <= most ? left : left < 2.0 * most ? 0.5 * left : most;
    return most;
}

/* Find the rates of all stages and the state at the end of a step; positive where one is refused. */
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
    return size_of(w, m->stage, m->end_state);
}

/* Let the end of the last step be the begin of the next one, and see that its rates are known. */
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
            return REFUSED;
        }
        m->fresh = 0;
    }
    if (m->next == 0.0) {
        m->next = fmin(first_step(w), fabs(w->end - w->start));
    }
    return 0;
}

/* Take a step, as long as its error allows. */
static int take_step(worker *w)
{
    method *m = w->own;
    double least = ROUNDING * fmax(fabs(m->time), fabs(w->end - w->start)), length, square;
    int code = go_on(w), again = 0;
    if (code) {
        return code;
    }
    for (;;) {
        double plan = planned(w, &length);
        if (attempt(w, m->sign * length)) {
            m->next = length;
            return REFUSED;
        }
        square = error_of(w, m->sign * length);
        double factor = SAFE * exp2(0.5 * (OF_ERROR_BEFORE * m->error - OF_ERROR * square));
        factor = fmin(fmax(factor, MOST_SHORTER), MOST_LONGER);
        int good = square <= 0.0;
        m->next = length * (again || !good ? fmin(factor, 1.0) : factor);
        if (good) {
            /* a step that was shorter for its stop says nothing against the length that was planned */
            m->next = !again && length < plan ? fmax(m->next, plan) : m->next;
            break;
        }
        again = 1;
        ++m->counted.error_test_failures;
        if (!(m->next >= least)) { /* nor a NaN */
            return TOO_SMALL;
        }
    }
    ++m->counted.steps;
    m->error = fmax(square, LOG2_LEAST_SQUARE);
    m->reached = length == m->sign * (m->stop - m->time) ? m->stop : m->time + m->sign * length;
    return 0;
}

/* -- within the step -------------------------------------------------------------------------- */

/* Find the powers by which the states within the last step are interpolated. */
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
    for (int i = 0; i < n; ++i) {
        double value = 0.0;
        for (int k = TERMS - 1; k >= derivative; --k) {
            double factor = 1.0;
            for (int j = 0; j < derivative; ++j) {
                factor *= (k - j) / step;
            }
            value = value * part + factor * m->terms[k * n + i];
        }
        out[i] = value;
    }
    return 0;
}

/* -- roots ------------------------------------------------------------------------------------ */

/* Evaluate the functions at a time within the last step. */
static int look_at(worker *w, double time, double *values)
{
    interpolate(w, time, 0, w->scratch);
    return kt_roots(w, time, w->scratch, values);
}

/* Tell whether a function that went from one value to another passed zero, in the sense that is wanted. */
static int passes(const worker *w, int which, double from, double to)
{
    const method *m = w->own;
    int wanted = w->problem->directions[which], up = from < 0.0;
    int crosses = !m->idle[which] && from != 0.0 && (to == 0.0 || up != (to < 0.0));
    return crosses && (wanted == 0 || (wanted > 0) == up);
}

static int any_passes(const worker *w, const double *to)
{
    const method *m = w->own;
    int some = 0;
    for (int i = 0; i < kt_root_count(w); ++i) {
        some |= passes(w, i, m->low[i], to[i]);
    }
    return some;
}

/*
 * Know the values just behind the time that was seen, where functions are zero at it. One that stays zero
 * is left out of the search from the begin on, and an error behind a root.
 */
static int leave_zeros(worker *w, double resolved)
{
    method *m = w->own;
    int count = kt_root_count(w), zeros = 0, bad;
    for (int i = 0; i < count; ++i) {
        zeros += m->low[i] == 0.0;
    }
    if (!zeros || m->sign * (m->reached - m->seen) <= resolved) {
        return 0;
    }
    m->seen += m->sign * resolved;
    bad = look_at(w, m->seen, m->middle);
    for (int i = 0; i < count && !bad; ++i) {
        if (m->low[i] == 0.0) {
            m->idle[i] = m->middle[i] == 0.0;
            m->low[i] = m->middle[i];
            bad = m->idle[i] && m->at_root && m->found[i] ? FLAT : 0;
        }
    }
    return bad;
}

/* Narrow down the first zero between the time that was seen and the end; `high` is the value there. */
static int narrow(worker *w, double resolved, double *end)
{
    method *m = w->own;
    int count = kt_root_count(w), side = 0, before = 0;
    double low = m->seen, weight = 1.0;
    while (m->sign * (*end - low) > resolved) {
        /*
         * Where the straight line to the end crosses first, drawn nearer to the end that stays; half way
         * to an end that is zero, since all before it may be so too.
         */
        double part = 1.0;
        for (int i = 0; i < count; ++i) {
            if (passes(w, i, m->low[i], m->high[i])) {
                double crossed = m->low[i] / (m->low[i] - weight * m->high[i]);
                part = fmin(part, m->high[i] == 0.0 ? 0.5 : crossed);
            }
        }
        double room = 0.5 * resolved / fabs(*end - low);
        double time = low + fmin(fmax(part, room), 1.0 - room) * (*end - low);
        if (look_at(w, time, m->middle)) {
            return NO_ROOTS;
        }
        before = side;
        if (any_passes(w, m->middle)) {
            *end = time;
            memcpy(m->high, m->middle, (size_t)count * sizeof *m->high);
            side = 1;
        } else {
            low = time;
            memcpy(m->low, m->middle, (size_t)count * sizeof *m->low);
            side = 2;
        }
        weight = side != before ? 1.0 : side == 1 ? 2.0 * weight : 0.5 * weight;
    }
    return 0;
}

/* Look for roots in what has not been seen of the last step: 0, KT_ROOT, or why that cannot be. */
static int search(worker *w, double *time)
{
    method *m = w->own;
    int count = kt_root_count(w), root = 0, code;
    double end = m->reached, resolved = RESOLVED * (fabs(end) + fabs(end - m->time));
    if (!m->looks) {
        if (kt_roots(w, m->time, m->state, m->low)) {
            return NO_ROOTS;
        }
        m->looks = 1;
        m->at_root = 0;
        memset(m->idle, 0, (size_t)count * sizeof *m->idle);
    }
    code = leave_zeros(w, resolved);
    if (code) {
        return code;
    }
    if (look_at(w, end, m->high)) {
        return NO_ROOTS;
    }
    if (any_passes(w, m->high)) {
        code = narrow(w, resolved, &end);
        if (code) {
            return code;
        }
        root = 1;
    }
    for (int i = 0; i < count; ++i) {
        m->found[i] = !root ? 0 : passes(w, i, m->low[i], m->high[i]) ? (m->low[i] < 0.0 ? 1 : -1) : 0;
        m->idle[i] = m->idle[i] && m->high[i] == 0.0;
        m->low[i] = m->high[i];
    }
    m->at_root = root;
    *time = m->seen = end;
    return root ? KT_ROOT : 0;
}

/* -- what `integrate.c` calls ----------------------------------------------------------------- */

static int step(worker *w, double goal, double *time)
{
    (void)goal;
    method *m = w->own;
    int code = 0, rest = m->reached != m->time && m->seen != m->reached;
    if (!rest) {
        code = take_step(w);
        m->seen = m->time;
    }
    if (code) {
        return code;
    }
    if (kt_root_count(w)) {
        code = search(w, time);
    } else {
        *time = m->seen = m->reached;
    }
    if (code >= 0) {
        interpolate(w, *time, 0, w->y);
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

static double time_inside(worker *w)
{
    method *m = w->own;
    return m->reached;
}

static void crossings(worker *w, int *found)
{
    method *m = w->own;
    memcpy(found, m->found, (size_t)kt_root_count(w) * sizeof *found);
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
    open_method, close_method, step, set_stop, interpolate, begin_anew,
    next_step, time_inside, crossings, count, NEVER,
};
