/*
 * Distance of each lane from dead points, and limits of its steps there.
 *
 * ../native/margins.h explains it; ../native/margins.c and integrate.c do the same for one system.
 */
#ifndef KINTRAFO_APPROACH_H
#define KINTRAFO_APPROACH_H

#include "../native/trust.h"
#include "courses.h"

enum { NO_GUARD = -1 };

static real smallest_step(const lane_pool *w)
{
    double of_time = KT_SMALLEST_OF_TIME * (w->p->end - w->p->start);
    real of_step = KT_SMALLEST_OF_STEP * w->longest;
    return choose((of_step > 0.0) & (of_step < of_time), of_step, SPREAD(of_time));
}

/* Set a guard for lanes without one. */
static void blame(lane_pool *w, bits lanes, int guard)
{
    w->guard = choose_bits(lanes & (w->guard == NO_GUARD), (bits){0} + guard, w->guard);
}

/* Note guards whose margins at the end of a step must be positive and are not. */
static void see_crossed(lane_pool *w, bits lanes)
{
    for (int i = 0; i < w->p->guard_count; ++i) {
        if (w->p->guards[i] & KT_ACTS) {
            blame(w, lanes & ~(w->now[i] > 0.0), i);
        }
    }
}

/* Return the lanes in which the change of a margin is so large that its rate is needed. */
static bits changed(const lane_pool *w, real step, real next)
{
    real little = KT_LITTLE / greater(next / step, SPREAD(1.0));
    bits found = {0};
    for (int i = 0; i < w->p->guard_count; ++i) {
        if (w->p->guards[i] & KT_SINGULAR) {
            real now = w->now[i], change = magnitude(now - w->before[i]);
            found |= ~((change <= little * now) & (now > KT_NOTHING * w->greatest[i]));
        }
    }
    return found;
}

/* Evaluate the margins a short time after the step's end, along a tangent. */
static void look_ahead(lane_pool *w, real time, real lapse)
{
    int n = w->p->state_count, positions = w->p->position_count;
    const real *rates = w->rates + (STAGES - 1) * n; /* at the end */
    for (int i = 0; i < n; ++i) {
        w->stage[i] = i < positions ? w->end_state[i] + lapse * rates[i] : w->end_state[i];
    }
    evaluate_inputs(w, time + lapse);
    w->margins(w->constants, w->stage, w->inputs, w->ahead);
}

/* Note guards whose margins rise as if they had been zero within the step. */
static void see_reflected(lane_pool *w, bits lanes, real lapse, real step)
{
    for (int i = 0; i < w->p->guard_count; ++i) {
        if (w->p->guards[i] & KT_SINGULAR) {
            real gained = w->ahead[i] - w->now[i];
            blame(w, lanes & (2.0 * w->now[i] * lapse < gained * step), i);
        }
    }
}

/* Limit the steps of some lanes by the margins ahead; note the guards of lanes at a dead point. */
static void limit(lane_pool *w, bits lanes, real lapse, real step)
{
    real longest = SPREAD(INFINITY);
    bits over = {0}, nearest = (bits){0} + NO_GUARD;
    for (int i = 0; i < w->p->guard_count; ++i) {
        if (w->p->guards[i] & KT_SINGULAR) {
            real now = w->now[i], gone = now - w->ahead[i];
            real left = greater(now, SPREAD(0.0));
            real allowed = KT_PART * left * lapse / choose(gone > 0.0, gone, SPREAD(1.0));
            bits nothing = now <= KT_NOTHING * w->greatest[i];
            bits sooner = (nothing & ~over) | (~(nothing ^ over) & (allowed < longest));
            sooner &= gone > 0.0;
            longest = choose(sooner, allowed, longest);
            nearest = choose_bits(sooner, (bits){0} + i, nearest);
            over = choose_bits(sooner, nothing, over);
        }
    }
    bits slow = (step < smallest_step(w)) & (longest < KT_NEAR * w->longest);
    w->stuck = choose_bits(lanes, slow & (w->stuck + 1), w->stuck);
    w->trusted = choose(lanes, longest, w->trusted);
    over |= (w->stuck >= KT_MOST_STUCK) | (longest < KT_SMALLEST_PART * magnitude(w->time));
    w->guard = choose_bits(lanes & over, nearest, w->guard);
}

/* Accept the margins at the step's end as those of the state that is reached. */
static void reach(lane_pool *w, bits lanes)
{
    for (int i = 0; i < w->p->guard_count; ++i) {
        w->before[i] = choose(lanes, w->now[i], w->before[i]);
        w->greatest[i] = choose(lanes & (w->now[i] > w->greatest[i]), w->now[i], w->greatest[i]);
    }
}

#endif
