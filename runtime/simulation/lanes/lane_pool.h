/*
 * Data of the systems that are integrated together, one in each lane.
 */
#ifndef KINTRAFO_CREW_H
#define KINTRAFO_CREW_H

#include "../native/dormand_prince.h"
#include "ensemble.h"
#include "vectors.h"

typedef bits (*kt_prepare)(const real *parameters, real *out);
typedef bits (*kt_function)(const real *constants, const real *state, const real *inputs, real *out);

/* The present piece of an input for each lane. */
typedef struct {
    real left, right; /* its time span; the first and the last piece extend beyond it */
    real cubic, square, linear, constant;
    int piece[WIDTH];
} course_now;

/* Systems that wait for a lane; they are prepared together. */
typedef struct {
    long first;     /* their indices among all systems */
    int count, taken;
    bits failed;    /* return values of the model's function prepare */
    real *constants, *state, *margins;
} waiting;

typedef struct {
    const kt_problem *p;
    kt_prepare prepare, design_state;
    kt_function rhs, signals, margins;
    long next, last; /* the systems that wait after the prepared ones */
    waiting queue;

    long system[WIDTH];
    bits running;
    bits fresh; /* the rates are not known: a step of length zero evaluates them */
    real time, goal; /* no step passes over the goal, which is a milestone or the end of a segment */
    real aim;        /* target of the next step: the goal, or an earlier extremum of inputs */
    real step;       /* next step that the error permits; 0: to be chosen */
    real trusted;    /* longest step that falling margins permit */
    real longest;    /* longest step so far */
    real error;      /* logarithm of the error of the step before */
    bits again;      /* the step is repeated: the one after it must not be longer */
    bits tried, taken, stuck;
    bits stiff, calm; /* number of steps limited by stability, and of consecutive ones that were not */
    int segment[WIDTH];
    long milestone[WIDTH], turn[WIDTH], output[WIDTH];
    real due; /* time of the next output, infinite after the last */

    real *constants, *state, *end_state, *stage, *inputs;
    real *rates; /* stages x states */
    course_now *courses;
    real *before, *now, *ahead, *greatest; /* margins, see approach.h */
    real *shown, *terms; /* an output: signals and state; its interpolant: 5 x states */
    real *kept, *kept_before;     /* reductions */
    real *beyond, *beyond_before; /* worst values beyond the bounds */
    real *limits;

    /* reasons to refuse the last step */
    bits status; /* status words of the model */
    bits guard;  /* a guard whose margin refuses it; -1: none */
} lane_pool;

INLINE long drive_number(const kt_problem *p, long system)
{
    return p->drive_of ? p->drive_of[system] : 0;
}

INLINE const kt_segment *segment_of(const lane_pool *w, int lane)
{
    const kt_problem *p = w->p;
    return &p->drives[drive_number(p, w->system[lane])].segments[w->segment[lane]];
}

#endif
