/* Common parts of methods with a fixed step, and the ends of their steps. Lengths have no sign. */
#ifndef KINTRAFO_FIXED_STEP_H
#define KINTRAFO_FIXED_STEP_H

#include "worker.h"

#include <stddef.h>

/* A code that is never returned: there are no tolerances. */
#define KT_NO_TOLERANCES 1

/* Terms of the polynomial within a step. */
#define KT_TERMS 4

/* One method: its memory, and its steps, whose codes are those of a solver, zero for no error. */
typedef struct {
    size_t size;                                        /* size of its struct, which begins with a kt_fixed [bytes] */
    int stages;                                         /* number of stages with stored rates, the first at the begin */
    int vectors, matrices;                              /* numbers of further arrays: of states, of states x states */
    int (*prepare)(worker *w, double step);             /* before the stages; may refuse the step */
    int (*attempt)(worker *w, double end, double step); /* compute the end, or return a code */
    int (*jumped)(worker *w, double step);              /* whether rates alternate in the step, or a code */
    int (*refuse_jumps)(worker *w, double step);        /* the code if they do so repeatedly */
    void (*fit)(worker *w);                             /* compute the polynomial within the last step */
} kt_fixed_method;

typedef struct {
    double sign;          /* direction of time */
    double time, reached; /* begin and end of the last step; equal before the first */
    double origin;        /* times of the steps are counted from here, so that they do not drift */
    long since;           /* steps since then */
    double next;          /* longest next step: shorter after the model refused a state */
    double stop;          /* no step passes over this time */
} kt_fixed_times;

/* The first member of the struct of a method. */
typedef struct {
    const kt_fixed_method *method;
    double *memory;            /* memory of all arrays */
    kt_fixed_times times;
    double *state, *end_state; /* of the last step */
    double *rates, *end_rates; /* stages x states, at the begin first; at the end, which is the next begin */
    double *terms;             /* KT_TERMS x states: the polynomial within the last step */
    int jumps, calm;           /* steps in which rates have jumped; steps in a row without a jump */
    int elsewhere;             /* the state is not the end of the last step */
    int fresh, fitted;         /* the rates at `time` are not known; the terms are those of the last step */
    kt_statistics counted;
} kt_fixed;

/* Allocate the memory of a method, and begin at a time. Returns its further arrays, or NULL if there is no memory. */
double *kt_fixed_open(worker *w, const kt_fixed_method *method, double start);

/* Evaluate the rates, and count that. */
int kt_fixed_rates(worker *w, double time, const double *state, double *out);

/* Members of the `kt_solver` of each of these methods. */
void kt_fixed_close(worker *w);
int kt_fixed_begin(worker *w, double time, double length);
int kt_fixed_step(worker *w, double goal, double *time);
int kt_fixed_set_stop(worker *w, double time);
int kt_fixed_interpolate(worker *w, double time, int derivative, double *out);
double kt_fixed_next(worker *w);
void kt_fixed_count(worker *w, kt_statistics *total);

#endif
