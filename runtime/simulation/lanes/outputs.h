/* Results of the motion: samples, reductions, and values beyond bounds. */
#ifndef KINTRAFO_OUTPUTS_H
#define KINTRAFO_OUTPUTS_H

#include "courses.h"

#include <string.h>

static double due_time(const kt_problem *p, long output)
{
    return output < p->time_count ? p->times[output] : INFINITY;
}

static void begin_outputs(lane_pool *w, int lane)
{
    static const double nothing[] = {
        [KT_GREATEST] = -INFINITY, [KT_LEAST] = INFINITY, [KT_FIRST] = NAN, [KT_SUM] = 0.0,
        [KT_SQUARES] = 0.0, [KT_ABOVE] = 0.0, [KT_LAST] = NAN,
    };
    const kt_problem *p = w->p;
    w->output[lane] = 0;
    w->due[lane] = due_time(p, 0);
    for (int i = 0; i < p->reduction_count; ++i) {
        w->kept[i][lane] = nothing[p->reductions[i].kind];
    }
    for (int i = 0; i < p->bound_count; ++i) {
        w->beyond[i][lane] = NAN;
        w->limits[i][lane] = p->limits[p->limit_stride * w->system[lane] + i];
    }
}

/* Compute the polynomial that interpolates the states within a step. */
static void find_terms(lane_pool *w, real step)
{
    int n = w->p->state_count;
    for (int i = 0; i < n; ++i) {
        real moved = w->end_state[i] - w->state[i], sum = DENSE[0] * w->rates[i];
        for (int s = 2; s < STAGES; ++s) {
            sum += DENSE[s] * w->rates[s * n + i];
        }
        real bent = step * w->rates[i] - moved, last = step * sum;
        real back = moved - step * w->rates[(STAGES - 1) * n + i] - bent;
        w->terms[i] = w->state[i];
        w->terms[n + i] = moved + bent;
        w->terms[2 * n + i] = back + last - bent;
        w->terms[3 * n + i] = -(back + 2.0 * last);
        w->terms[4 * n + i] = last;
    }
}

/* Evaluate the state at a part of the step, and the signals there; note the status if they are refused. */
static bits show(lane_pool *w, real part, real time)
{
    const kt_problem *p = w->p;
    int n = p->state_count;
    real *state = w->shown + p->signal_count;
    for (int i = 0; i < n; ++i) {
        const real *c = w->terms + i;
        real inside = (((c[4 * n] * part + c[3 * n]) * part + c[2 * n]) * part + c[n]) * part + c[0];
        state[i] = choose(part == 1.0, w->end_state[i], inside);
    }
    if (!w->signals) {
        return (bits){0};
    }
    evaluate_inputs(w, time);
    return w->signals(w->constants, state, w->inputs, w->shown);
}

/* Load the weights of the outputs in time, and their distances from the ones before. */
static real weights_now(const lane_pool *w, bits lanes, real *lapse)
{
    real weight = {0.0};
    *lapse = weight;
    for (int i = 0; i < WIDTH; ++i) {
        long output = w->output[i];
        if (lanes[i]) {
            weight[i] = w->p->weights[output];
            (*lapse)[i] = output ? w->p->times[output] - w->p->times[output - 1] : 0.0;
        }
    }
    return weight;
}

/* Return the part of a straight line above zero; zero if it has no begin. */
static real part_above(real from, real to)
{
    real nothing = {0.0}, part = (greater(from, nothing) + greater(to, nothing))
        / (magnitude(from) + magnitude(to));
    return choose(part > 0.0, part, nothing); /* also for NaN */
}

static void reduce(lane_pool *w, bits lanes)
{
    const kt_problem *p = w->p;
    if (!p->reduction_count) {
        return;
    }
    real lapse, weight = weights_now(w, lanes, &lapse);
    for (int i = 0; i < p->reduction_count; ++i) {
        const kt_reduction *r = &p->reductions[i];
        real value = w->shown[p->items[r->item]], kept = w->kept[i], next;
        real moved = value - w->kept[r->origin];
        switch (r->kind) {
        case KT_GREATEST: next = greater(kept, value); break;
        case KT_LEAST: next = lesser(kept, value); break;
        case KT_FIRST: next = choose(kept == kept, kept, value); break;
        case KT_SUM: next = kept + weight * moved; break;
        case KT_SQUARES: next = kept + weight * (moved * moved); break;
        case KT_LAST: next = value; break;
        default: next = kept + lapse * part_above(w->kept[r->origin] - r->level, value - r->level);
        }
        w->kept[i] = choose(lanes, next, kept);
    }
}

static void see_bounds(lane_pool *w, bits lanes)
{
    const kt_problem *p = w->p;
    for (int i = 0; i < p->bound_count; ++i) {
        real sign = SPREAD(p->above[i] ? 1.0 : -1.0), value = w->shown[p->bound_items[i]];
        bits worse = (sign * (value - w->limits[i]) > 0.0) & ~(sign * (value - w->beyond[i]) <= 0.0);
        w->beyond[i] = choose(lanes & worse, value, w->beyond[i]);
    }
}

/* Store the outputs that are due, and advance to the next ones. */
static void keep(lane_pool *w, bits lanes)
{
    const kt_problem *p = w->p;
    reduce(w, lanes);
    see_bounds(w, lanes);
    for (int l = 0; l < WIDTH; ++l) {
        if (!lanes[l]) {
            continue;
        }
        for (int i = 0; i < p->sample_count; ++i) {
            long row = (w->system[l] - p->first_sampled) * p->sample_count + i;
            p->samples[row * p->time_count + w->output[l]] = w->shown[p->items[i]][l];
        }
        w->due[l] = due_time(p, ++w->output[l]);
    }
}

static void copy(real *to, const real *from, int count)
{
    memcpy(to, from, (size_t)count * sizeof *to);
}

/* Restore some lanes to their state before the step's outputs; samples are written again. */
static void take_back(lane_pool *w, bits lanes, const long *output)
{
    for (int i = 0; i < w->p->reduction_count; ++i) {
        w->kept[i] = choose(lanes, w->kept_before[i], w->kept[i]);
    }
    for (int i = 0; i < w->p->bound_count; ++i) {
        w->beyond[i] = choose(lanes, w->beyond_before[i], w->beyond[i]);
    }
    for (int lane = 0; lane < WIDTH; ++lane) {
        if (lanes[lane]) {
            w->output[lane] = output[lane];
            w->due[lane] = due_time(w->p, output[lane]);
        }
    }
}

/*
 * Write the outputs that are due within a step. Returns the lanes in which the model refuses an output: they have
 * none of this step.
 */
static bits put_out(lane_pool *w, bits lanes, real reached)
{
    real step = reached - w->time;
    bits pending = lanes & (w->due <= reached), refused = {0};
    if (!any(pending)) {
        return refused;
    }
    long output[WIDTH];
    memcpy(output, w->output, sizeof output);
    copy(w->kept_before, w->kept, w->p->reduction_count);
    copy(w->beyond_before, w->beyond, w->p->bound_count);
    find_terms(w, step);
    for (; any(pending); pending = pending & ~refused & (w->due <= reached)) {
        bits inside = pending & (w->due < reached);
        real time = choose(inside, w->due, reached);
        real part = choose(inside, (time - w->time) / step, SPREAD(1.0));
        bits status = show(w, part, time), bad = pending & (status != 0);
        w->status = choose_bits(bad, status, w->status);
        refused |= bad;
        keep(w, pending & ~bad);
    }
    take_back(w, refused, output);
    return refused;
}

#endif
