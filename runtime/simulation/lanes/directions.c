/* Directions along the steps of a motion, one in each lane. */
#include "directions.h"

#include "../native/dormand_prince.h"
#include "solver.h"

typedef bits (*kt_tangent)(const real *constants, const real *state, const real *inputs, real *out);

typedef struct {
    const kt_motion *m;
    kt_tangent rhs, signals;
    /* arguments of the model: values, the same in all lanes, followed by their changes */
    real *constants, *state, *inputs;
    real *begin, *end; /* change of the state at the begin and at the end of a step */
    real *rates;       /* change of its rates at each stage: stages x states */
    real *shown;       /* change of signals and state at an output */
    bits refused;
} lane_pool;

/* Set all lanes to a row of numbers. */
static void spread(real *to, const double *row, int count)
{
    for (int i = 0; i < count; ++i) {
        to[i] = SPREAD(row[i]);
    }
}

/* Set each lane to the row of its direction; lanes without one are unchanged. */
static void take(real *to, const double *rows, int size, long first, int count)
{
    for (int l = 0; l < count; ++l) {
        for (int i = 0; i < size; ++i) {
            to[i][l] = rows[(first + l) * size + i];
        }
    }
}

/* Return the weighted sum of changes of rates, for an element of the state. */
static real added(const lane_pool *w, const double *weights, int stages, int element, double length)
{
    real sum = {0.0};
    for (int s = 0; s < stages; ++s) {
        sum += weights[s] * w->rates[s * w->m->state_count + element];
    }
    return length * sum;
}

/* Compute the changes of the rates of all stages, and of the state at the end. */
static void go_through(lane_pool *w, long step)
{
    const kt_motion *m = w->m;
    int n = m->state_count;
    int first = !m->restarts[step]; /* else the first stage is the last one of the step before */
    memcpy(w->rates, w->rates + (STAGES - 1) * n, (size_t)n * sizeof *w->rates);
    for (int s = first; s < STAGES; ++s) {
        long place = step * STAGES + s;
        spread(w->state, m->states + place * n, n);
        spread(w->inputs, m->inputs + place * m->input_count, m->input_count);
        for (int i = 0; i < n; ++i) {
            w->end[i] = w->begin[i] + added(w, TABLE[s], s, i, m->lengths[step]);
            w->state[n + i] = w->end[i]; /* for the last stage this is the end */
        }
        w->refused |= w->rhs(w->constants, w->state, w->inputs, w->rates + s * n);
    }
}

/* Compute the changes of signals and state at an output within a step. */
static void show(lane_pool *w, long output, double length)
{
    const kt_motion *m = w->m;
    int n = m->state_count;
    real *along = w->shown + m->signal_count;
    for (int i = 0; i < n; ++i) {
        along[i] = w->begin[i] + added(w, m->weights + output * STAGES, STAGES, i, length);
        w->state[n + i] = along[i];
    }
    if (w->signals) {
        spread(w->state, m->states_there + output * n, n);
        spread(w->inputs, m->inputs_there + output * m->input_count, m->input_count);
        w->refused |= w->signals(w->constants, w->state, w->inputs, w->shown);
    }
}

static void keep(const lane_pool *w, long output, long first, int count)
{
    const kt_motion *m = w->m;
    for (int l = 0; l < count; ++l) {
        double *found = m->found + ((first + l) * m->time_count + output) * m->item_count;
        for (int i = 0; i < m->item_count; ++i) {
            found[i] = w->shown[m->items[i]][l];
        }
    }
}

/* Integrate at most as many directions as there are lanes. */
static void follow(lane_pool *w, long first, int count)
{
    const kt_motion *m = w->m;
    long output = 0;
    take(w->constants + m->constant_count, m->of_constants, m->constant_count, first, count);
    take(w->inputs + m->input_count, m->of_inputs, m->input_count, first, count);
    take(w->begin, m->of_start, m->state_count, first, count);
    for (long step = 0; step < m->step_count && !any(w->refused); ++step) {
        go_through(w, step);
        for (; output < m->time_count && m->step_of[output] == step; ++output) {
            show(w, output, m->lengths[step]);
            keep(w, output, first, count);
        }
        memcpy(w->begin, w->end, (size_t)m->state_count * sizeof *w->begin);
    }
}

int NAME_OF(kt_follow_, WIDTH)(const kt_motion *m, long first, long last)
{
    lane_pool w = {
        .m = m, .rhs = (kt_tangent)m->rhs_tangent, .signals = (kt_tangent)m->signals_tangent,
    };
    int n = m->state_count;
    const part parts[] = {
        {&w.constants, 2 * m->constant_count}, {&w.state, 2 * n}, {&w.inputs, 2 * m->input_count},
        {&w.begin, n}, {&w.end, n}, {&w.rates, STAGES * n}, {&w.shown, m->signal_count + n},
    };
    if (!reserve(parts, sizeof parts / sizeof *parts, 0)) {
        return 1;
    }
    spread(w.constants, m->constants, m->constant_count);
    for (long next = first; next < last && !any(w.refused); next += WIDTH) {
        follow(&w, next, last - next < WIDTH ? (int)(last - next) : WIDTH);
    }
    free(w.constants); /* begin of the memory */
    return any(w.refused) ? 2 : 0;
}
