/* Steps of one length: when each one ends. Lengths have no sign. */
#ifndef KINTRAFO_FIXED_STEP_H
#define KINTRAFO_FIXED_STEP_H

#include "worker.h"

#include <math.h>

/* Part of a step that is not taken for one: rounding of times. */
#define KT_SLIVER 1.0e-9

/* A code that is never returned: there are no tolerances. */
#define KT_NO_TOLERANCES 1

typedef struct {
    double sign;          /* of the time's direction */
    double time, reached; /* the last step goes from the one to the other; equal before it is taken */
    double origin;        /* times of the steps are counted from here, so that they do not drift */
    long since;           /* steps since then */
    double next;          /* how long the next one is at most: shorter where the model refused a state */
    double stop;          /* no step passes over this time */
} kt_fixed_steps;

static inline double kt_longest_fixed(const worker *w)
{
    return w->options->max_step > 0.0 ? w->options->max_step : fabs(w->end - w->start);
}

static inline void kt_begin_steps(kt_fixed_steps *s, double time, double length)
{
    s->time = s->reached = s->origin = time;
    s->since = 0;
    s->next = fabs(length);
}

static inline int kt_is_whole(const kt_fixed_steps *s, double most) { return s->next >= most; }

static inline int kt_lands(const kt_fixed_steps *s, double most)
{
    return s->sign * (s->stop - s->time) <= fmin(s->next, most) * (1.0 + KT_SLIVER);
}

/* Return the time at which the next step ends. */
static inline double kt_end_of_step(const kt_fixed_steps *s, double most)
{
    if (kt_lands(s, most)) {
        return s->stop;
    }
    return kt_is_whole(s, most) ? s->origin + s->sign * (double)(s->since + 1) * most
                                : s->time + s->sign * s->next;
}

/* Note that the step to this time is taken. */
static inline void kt_reach_end(kt_fixed_steps *s, double end, double most)
{
    int anew = kt_lands(s, most) || !kt_is_whole(s, most);
    s->reached = end;
    s->next = fmin(2.0 * s->next, most);
    s->since = anew ? 0 : s->since + 1;
    s->origin = anew ? end : s->origin;
}

#endif
