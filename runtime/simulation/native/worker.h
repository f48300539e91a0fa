/*
 * Data of an integration, and the interface of the solvers: each takes one step at a time, and `integrate.c`
 * accepts it or not.
 */
#ifndef KINTRAFO_WORKER_H
#define KINTRAFO_WORKER_H

#include "integrate.h"
#include "margins.h"
#include "roots.h"

/* Return codes of solvers that fail: those of SUNDIALS in the same cases, if there are any. */
enum {
    KT_TOO_SMALL = -3, KT_REFUSED = -8, KT_NO_ROOTS = -12, KT_FLAT = -22, KT_UNSTABLE_STEP = -1000,
    KT_JUMPING_RATES = -1001, KT_SINGULAR_MATRIX = -1002,
};

/*
 * A solver; w->own is its memory, and w->y the state at the time that it returned last. Lengths of steps have no
 * sign, except in `restart`.
 */
typedef struct {
    int (*open)(worker *w, double start); /* start with the state w->y; returns an outcome */
    void (*close)(worker *w);
    /* Take a step; w->y is the state at the returned time. Returns a negative code if it fails. */
    int (*step)(worker *w, double goal, double *time);
    /* Prevent steps over a time, which is not before that reached. Returns 0, as the next two do. */
    int (*set_stop)(worker *w, double time);
    /* A derivative of the state within the last step; fails if its order exceeds that of the polynomial. */
    int (*interpolate)(worker *w, double time, int derivative, double *out);
    /* Start with the state w->y and a step of this length; if w->rates_known with the last rates. */
    int (*restart)(worker *w, double time, double step);
    double (*next_step)(worker *w); /* length of the next step, or of the last failed one */
    void (*count)(worker *w, kt_statistics *total); /* add the counts since it was started or restarted */
    int too_accurate; /* the code for tolerances below the limit of the arithmetic */
    int heeds_trust; /* whether its steps are at most `trusted` long; others are stopped there */
} kt_solver;

extern const kt_solver kt_cvode, kt_erk, kt_dormand_prince, kt_rk4, kt_rodasp;

/* Return the solver of a method; builds without SUNDIALS define this function instead of `solvers.c`. */
const kt_solver *kt_solver_of(int method);

struct worker {
    const kt_problem *problem;
    const kt_options *options;
    kt_result *result;
    const kt_solver *solver;
    void *own;
    double *y, *scratch;
    double *inputs, *signals;
    long turn;           /* the first extremum of an input after the time reached */
    int *piece;          /* for each spline: piece of the last evaluation */
    int *crossings;      /* for each event */
    int caller_failed;
    int steady;          /* no input changed in the last step */
    int rates_known;     /* restart has the state, and so the rates, of the end of the last step */
    kt_margins margins;
    kt_search search;
    double reached;      /* by the last step; the accepted part may end before */
    double *moved;       /* a state a short time later */
    double start, end;   /* length of the whole time */
    double longest_step; /* longest step so far */
    double trusted;      /* longest step that falling margins permit */
    int stuck;           /* consecutive very short steps */
    double asked;        /* time at which the caller was asked last [s] */
};

/* Return the first extremum between two times that limits a step of some length, or else the second time. */
double kt_next_turn(worker *w, double time, double end, double step);

/* Evaluate the inputs at a time. */
void kt_evaluate_inputs(worker *w, double time);

/* Evaluate the right-hand side; positive if the model refuses the state, which is noted. */
int kt_rates(worker *w, double time, const double *state, double *out);

/* Evaluate the Jacobian, row-major, with the same return values. */
int kt_jacobian(worker *w, double time, const double *state, double *out);

/*
 * Evaluate the derivative of rates with respect to time by inputs, as a central difference over a time span to both
 * sides with the sign of the step; by the polynomials of the inputs after the time. The same return values.
 */
int kt_rates_by_time(worker *w, double time, const double *state, double lapse, double *out,
                     double *scratch);

/* Number of functions whose zeros are events. */
int kt_root_count(const worker *w);

/* Evaluate these functions; negative if one fails. */
int kt_roots(worker *w, double time, const double *state, double *out);

#endif
