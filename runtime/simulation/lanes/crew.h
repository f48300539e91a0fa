/*
 * The systems that are integrated together, one in each lane: what is known of them.
 */
#ifndef KINTRAFO_CREW_H
#define KINTRAFO_CREW_H

#include "../native/dormand_prince.h"
#include "ensemble.h"
#include "vectors.h"

typedef bits (*kt_prepare)(const real *parameters, real *out);
typedef bits (*kt_function)(const real *constants, const real *state, const real *inputs, real *out);

/* The piece of a course at which each lane is. */
typedef struct {
    real left, right; /* where it holds; the first and the last one go on */
    real cubic, square, linear, constant;
    int piece[WIDTH];
} course_now;

/* Systems that wait for a lane, prepared together. */
typedef struct {
    long first;     /* of them, among all */
    int count, taken;
    bits failed;    /* codes of the model's function prepare */
    real *constants, *state, *margins;
} waiting;

typedef struct {
    const kt_problem *p;
    kt_prepare prepare, design_state;
    kt_function rhs, signals, margins;
    long next, last; /* the systems that wait behind those that are prepared */
    waiting queue;

    long system[WIDTH];
    bits running;
    bits fresh; /* nothing is known of the rates yet: a step of no length finds them */
    real time, goal; /* no step passes over the goal: a milestone, or the end of a segment */
    real aim;        /* of the next step: the goal, or a time before at which inputs turn */
    real step;       /* the next one, as the error allows; 0: to be chosen */
    real trusted;    /* no longer one may be taken, since a margin falls */
    real longest;    /* so far */
    real error;      /* logarithm of that of the step before */
    bits again;      /* a step is tried again: the one after it is not to be longer */
    bits tried, taken, stuck;
    bits stiff, calm; /* how often stability has limited the step, and how often in a row it has not */
    int segment[WIDTH];
    long milestone[WIDTH], turn[WIDTH], output[WIDTH];
    real due; /* time of the next output, infinite behind the last */

    real *constants, *state, *end_state, *stage, *inputs;
    real *rates; /* stages x states */
    course_now *courses;
    real *before, *now, *ahead, *greatest; /* margins, see approach.h */
    real *shown, *terms; /* an output: signals and state; what it is interpolated by: 5 x states */
    real *kept, *kept_before;     /* reductions */
    real *beyond, *beyond_before; /* worst values beyond the bounds */
    real *limits;

    /* what has come of the last step, where it is not believed */
    bits status; /* status words of the model */
    bits guard;  /* a guard whose margin speaks against it; -1: none */
} crew;

INLINE long drive_number(const kt_problem *p, long system)
{
    return p->drive_of ? p->drive_of[system] : 0;
}

INLINE const kt_segment *segment_of(const crew *w, int lane)
{
    const kt_problem *p = w->p;
    return &p->drives[drive_number(p, w->system[lane])].segments[w->segment[lane]];
}

#endif
