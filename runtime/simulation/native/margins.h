/*
 * Distance of a state from dead points, where a loop cannot close, and limits of steps there.
 *
 * A closed form has the root of a margin with a sign that is chosen once. At a dead point the true motion
 * passes to the other sign: the root, the height s of a triangle, passes zero with a finite velocity. The
 * equations contain only s^2, which is smooth, so that a solver which steps over the dead point computes the
 * reflected motion without noticing it. A motion that turns before the dead point has a bounded acceleration
 * of s and is slow there. The two differ in the time until s would be zero, s over its velocity, which is
 * twice the margin over its rate: it decreases to zero before a dead point and increases again before a turn.
 * So no step is longer than a part of that time; and a step is refused if s at its end, extrapolated back, was
 * zero within the step.
 *
 * The same holds if the ends of a spring meet: s is their distance, the margin its square, which touches
 * zero and rises again, and the direction of the force reverses at once.
 */
#ifndef KINTRAFO_MARGINS_H
#define KINTRAFO_MARGINS_H

#include "trust.h"

typedef struct {
    int count;
    const int *meaning; /* of each guard, bits as above */
    double *before;     /* margins of the state that was reached last */
    double *now;        /* margins of the state that is checked */
    double *ahead;      /* margins of the same motion a short time later */
    double *between;    /* margins of an output within a step */
    double *greatest;   /* greatest values so far: the size of the numbers whose difference is a margin */
} kt_margins;

/* Return whether there is memory; `scale` has margins of usual size. */
int kt_open_margins(kt_margins *m, int count, const int *meaning, const double *scale);

void kt_close_margins(kt_margins *m);

/* Return a guard whose margin, one of `values`, must be positive and is not; -1: none. */
int kt_crossed(const kt_margins *m, const double *values);

/* Return whether the change of the margins from `before` to `now` is so small that they are positive between. */
int kt_steady(const kt_margins *m);

/*
 * Return whether the change of a margin from `before` to `now` is so large that its rate is needed, if the
 * next step has `next` times the length of the last one. For most steps it is not, which saves evaluations.
 */
int kt_changes(const kt_margins *m, double next);

/*
 * Return a guard whose dead point a step has passed: its margin rises as if it had been zero within the
 * step. -1: none. `lapse` is the time from `now` to `ahead`, `step` the length of the step.
 */
int kt_reflected(const kt_margins *m, double lapse, double step);

/*
 * Return the longest next step, infinite if no margin falls. `nearest` is the guard that limits it, and
 * `over` is whether its margin is zero up to rounding.
 */
double kt_longest_step(const kt_margins *m, double lapse, int *nearest, int *over);

/* Accept `now` as the margins of the state that is reached. */
void kt_reach(kt_margins *m);

#endif
