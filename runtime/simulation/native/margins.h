/*
 * How near a state is to where a loop cannot close, and for how long a step may be trusted there.
 *
 * A closed form takes the root of a margin with a sign that is chosen once. At a dead point the true
 * motion passes to the other sign: the root, the height s of a triangle, goes through zero with a
 * finite velocity. The equations know only s^2, which is smooth, so that a solver which steps over the
 * dead point finds the reflected motion and sees nothing wrong with it. A motion that turns before
 * the dead point has a bounded acceleration of s and is slow there. What tells the two apart is the
 * time in which s would be used up, s over its velocity, that is twice the margin over its rate:
 * it shrinks to nothing before a dead point and opens again before a turn. So no step is longer than a
 * part of it; and a step at whose end s comes out of zero within the step is not believed.
 *
 * The same holds where the ends of a spring meet: s is their distance, the margin its square, which touches
 * zero and rises again, and the direction of the force turns round within no time.
 */
#ifndef KINTRAFO_MARGINS_H
#define KINTRAFO_MARGINS_H

#include "trust.h"

typedef struct {
    int count;
    const int *meaning; /* of each guard, bits as above */
    double *before;     /* margins of the state that was reached last */
    double *now;        /* those of the state that is looked at */
    double *ahead;      /* those of the same motion a short time later */
    double *between;    /* those of an output within a step */
    double *greatest;   /* so far: the size of the numbers that a margin is a difference of */
} kt_margins;

/* Return whether there is memory; `scale` has margins of the size that is usual. */
int kt_open_margins(kt_margins *m, int count, const int *meaning, const double *scale);

void kt_close_margins(kt_margins *m);

/* Return a guard whose margin, one of `values`, is not positive where it must be; -1: none. */
int kt_crossed(const kt_margins *m, const double *values);

/* Return whether the margins have changed so little from `before` to `now` that they are positive between, too. */
int kt_steady(const kt_margins *m);

/*
 * Return whether a margin has changed so much from `before` to `now` that its rate is needed, a step of
 * `next` times the length of the last one being planned. Most steps pass here, at a small price.
 */
int kt_changes(const kt_margins *m, double next);

/*
 * Return a guard that says that a step has passed a dead point: its margin rises as if it had been
 * zero within the step. -1: none. `lapse` is the time from `now` to `ahead`, `step` that of the step.
 */
int kt_reflected(const kt_margins *m, double lapse, double step);

/*
 * Return how long the next step may be, infinite where no margin falls. `nearest` is the guard that
 * limits it, and `over` tells whether its margin has come down to nothing.
 */
double kt_longest_step(const kt_margins *m, double lapse, int *nearest, int *over);

/* Make `now` the margins of the state that is reached. */
void kt_reach(kt_margins *m);

#endif
