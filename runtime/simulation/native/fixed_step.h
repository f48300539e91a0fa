/* Methods with steps of one length: when each step ends, and all that they have in common. Lengths have no sign. */
#ifndef KINTRAFO_FIXED_STEP_H
#define KINTRAFO_FIXED_STEP_H

#include "worker.h"

/* A code that is never returned: there are no tolerances. */
#define KT_NO_TOLERANCES 1

/* Terms of the polynomial within a step. */
#define KT_TERMS 4

/* The steps of one method; codes are those of a solver, zero where nothing is wrong. */
typedef struct {
    int (*prepare)(worker *w, double step);             /* what is needed before the stages, or refuse the step */
    int (*attempt)(worker *w, double end, double step); /* find the end, or a code */
    int (*jumped)(worker *w, double step);              /* whether rates jump to and fro in the step, or a code */
    int (*refuse_jumps)(worker *w, double step);        /* the code of steps that do so again and again */
    void (*fit)(worker *w);                             /* find the polynomial within the last step */
} kt_fixed_method;

typedef struct {
    double sign;          /* of the time's direction */
    double time, reached; /* the last step goes from the one to the other; equal before it is taken */
    double origin;        /* times of the steps are counted from here, so that they do not drift */
    long since;           /* steps since then */
    double next;          /* how long the next one is at most: shorter where the model refused a state */
    double stop;          /* no step passes over this time */
} kt_fixed_times;

/* The first member of what belongs to a method. */
typedef struct {
    const kt_fixed_method *method;
    kt_fixed_times times;
    double *state, *end_state; /* of the last step */
    double *rates, *end_rates; /* at the begin; at the end, which are those of the next begin */
    double *terms;             /* KT_TERMS x states: the polynomial within the last step */
    int jumps, calm;           /* steps in which rates have jumped, and those in a row in which not */
    int elsewhere;             /* the state is not that to which the step before led */
    int fresh, fitted;         /* the rates at `time` are not known; the terms are those of the last step */
    kt_statistics counted;
} kt_fixed;

/* Begin at a time; the arrays are there. */
void kt_fixed_open(worker *w, const kt_fixed_method *method, double start);

/* Evaluate the rates, and count that. */
int kt_fixed_rates(worker *w, double time, const double *state, double *out);

/* What a `kt_solver` of these methods has. */
int kt_fixed_begin(worker *w, double time, double length);
int kt_fixed_step(worker *w, double goal, double *time);
int kt_fixed_set_stop(worker *w, double time);
int kt_fixed_interpolate(worker *w, double time, int derivative, double *out);
double kt_fixed_next(worker *w);
void kt_fixed_count(worker *w, kt_statistics *total);

#endif
