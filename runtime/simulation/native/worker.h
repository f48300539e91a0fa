/*
 * What an integration works with, and what the solvers have in common: each takes one step at a time, and
 * `integrate.c` decides what comes of it.
 */
#ifndef KINTRAFO_WORKER_H
#define KINTRAFO_WORKER_H

#include "integrate.h"
#include "margins.h"
#include "roots.h"

/* What solvers return where they give up: what SUNDIALS returns in the same cases, if it knows them. */
enum {
    KT_TOO_SMALL = -3, KT_REFUSED = -8, KT_NO_ROOTS = -12, KT_FLAT = -22, KT_UNSTABLE_STEP = -1000,
    KT_JUMPING_RATES = -1001, KT_SINGULAR_MATRIX = -1002,
};

/*
 * A solver; w->own is its memory, and w->y the state at the time that it has returned last. Lengths of
 * steps have no sign, but for that of `begin_anew`.
 */
typedef struct {
    int (*open)(worker *w, double start); /* begin with the state w->y; returns an outcome */
    void (*close)(worker *w);
    /* Take a step; the time returned has its state in w->y. Returns a negative code where it gives up. */
    int (*step)(worker *w, double goal, double *time);
    /* Let no step pass over a time, which is not before that reached. Returns 0, as the next two do. */
    int (*set_stop)(worker *w, double time);
    /* A derivative of the state within the last step; fails where its polynomial has none so high. */
    int (*interpolate)(worker *w, double time, int derivative, double *out);
    /* Begin with the state w->y and a step of this length; if w->rates_known with the last rates. */
    int (*begin_anew)(worker *w, double time, double step);
    double (*next_step)(worker *w); /* length of what it tries next, or has tried last without success */
    void (*count)(worker *w, kt_statistics *total); /* add what was counted since it began, or began anew */
    int too_accurate; /* the code that says that tolerances are below what the arithmetic can do */
    int heeds_trust; /* whether it takes no step longer than `trusted`; others are stopped there */
} kt_solver;

extern const kt_solver kt_cvode, kt_erk, kt_dormand_prince, kt_rk4, kt_rodasp;

/* Return the solver of a method; what has no SUNDIALS has a function of its own in place of `solvers.c`. */
const kt_solver *kt_solver_of(int method);

struct worker {
    const kt_problem *problem;
    const kt_options *options;
    kt_result *result;
    const kt_solver *solver;
    void *own;
    double *y, *scratch;
    double *inputs, *signals;
    long turn;           /* the first time at which an input turns behind that reached */
    int *piece;          /* of each spline: where it was evaluated last */
    int *crossings;      /* of each event */
    int caller_failed;
    int steady;          /* no input moved in the last step */
    int rates_known;     /* begin_anew has the state, and so the rates, of the end of the last step */
    kt_margins margins;
    kt_search search;
    double reached;      /* by the last step; what has been looked at may end before */
    double *moved;       /* a state a short time later */
    double start, end;   /* of the whole time */
    double longest_step; /* so far */
    double trusted;      /* no longer step may be taken, since a margin falls */
    int stuck;           /* very short steps in a row */
    double asked;        /* when the caller was asked last whether to go on [s] */
};

/* Return the first turn between two times that a step of some length does not pass over, or else the second. */
double kt_next_turn(worker *w, double time, double end, double step);

/* Evaluate the inputs at a time. */
void kt_evaluate_inputs(worker *w, double time);

/* Evaluate the right-hand side; positive where the model refuses the state, which is noted. */
int kt_rates(worker *w, double time, const double *state, double *out);

/* Evaluate the Jacobian, row-major, likewise. */
int kt_jacobian(worker *w, double time, const double *state, double *out);

/*
 * Evaluate how rates change with time by the inputs alone, as the central difference over so long a time to
 * both sides; all by the polynomials of the inputs that hold after it, which has the sign of the step. Likewise.
 */
int kt_rates_by_time(worker *w, double time, const double *state, double lapse, double *out,
                     double *scratch);

/* How many functions there are whose zeros are events. */
int kt_root_count(const worker *w);

/* Evaluate them; negative where one cannot be. */
int kt_roots(worker *w, double time, const double *state, double *out);

#endif
