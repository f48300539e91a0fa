/*
 * Integration of a generated model, from the first step to the last in C.
 *
 * A call is independent of all others: it owns its memory, and its context of SUNDIALS if it has one.
 */
#ifndef KINTRAFO_INTEGRATE_H
#define KINTRAFO_INTEGRATE_H

/* A function of a generated model; returns 0, or status bits. */
typedef int (*kt_function)(const double *constants, const double *state, const double *inputs,
                           double *out);

/* A root function of the caller; returns 0, or another number to end the integration. */
typedef int (*kt_root)(double time, const double *state, double *out, void *data);

/* Called now and then; returns whether the caller wants the integration to end. */
typedef int (*kt_interrupted)(void *data);

/* A time-varying input: a cubic spline, and the inputs with its value and derivatives. */
typedef struct {
    int pieces;
    const double *breaks;       /* pieces + 1 times, increasing */
    const double *coefficients; /* 4 x pieces, row-major, highest power first, from the left break */
    int target[3];              /* input for the value and two derivatives; -1: none */
} kt_spline;

/* A zero crossing of a signal of the model. */
typedef struct {
    int signal;
    double level;
} kt_event;

typedef struct {
    kt_function rhs;
    kt_function jacobian; /* row-major */
    kt_function signals;
    kt_function margins;
    int state_count, input_count, signal_count;
    int position_count, speed_count; /* the state begins with positions, followed by speeds; with equal
                                        numbers each speed is the rate of a position */
    const double *constants;
    const double *inputs; /* values of the inputs that do not vary */
    int spline_count;
    const kt_spline *splines;
    long milestone_count;
    const double *milestones; /* times that no step passes over, in the order of the integration */
    long turn_count;
    const double *turns; /* times of extrema of inputs, in the same order */
    const double *reaches; /* longest step that may pass over each */
    int event_count; /* events of the model's signals, which come before the caller's */
    const kt_event *events;
    int root_count; /* the caller's events */
    kt_root roots;
    void *root_data;
    const int *directions; /* of all events: -1 falling, +1 rising, 0 both */
    const int *terminal;   /* of all events: 0 never, n stops at the n-th crossing */
    int guard_count;
    const int *guards;           /* effect of each guard, see margins.h */
    const double *usual_margins; /* usual size of the margins */
    kt_interrupted interrupted;
    void *interrupted_data;
} kt_problem;

enum kt_method { KT_BDF, KT_ADAMS, KT_DORMAND_PRINCE, KT_RK4, KT_RODASP, KT_RUNGE_KUTTA };

typedef struct {
    int method;
    const char *table; /* Butcher table of KT_RUNGE_KUTTA */
    double rtol;
    const double *atol;
    double first_step; /* 0: chosen by the solver */
    double max_step;   /* 0: unlimited; the fixed step of KT_RK4 and KT_RODASP */
    long max_steps;
    int stop_at_outputs; /* steps end at every output, instead of interpolation */
    int dense;           /* store the polynomial of every step */
} kt_options;

typedef struct {
    long steps, evaluations, jacobians, factorisations, error_test_failures;
    long order; /* of the last step */
} kt_statistics;

/* A growing table of doubles. */
typedef struct {
    double *data;
    long rows, capacity;
    int width;
} kt_table;

enum kt_outcome {
    KT_DONE,
    KT_EVENT,           /* a terminal event */
    KT_STATE,           /* the model refused a state: see refused_* */
    KT_TOO_MANY_STEPS,
    KT_TOO_ACCURATE,    /* the tolerances are below the limit of the arithmetic */
    KT_CALLER,          /* a root function failed, or the caller wants an end */
    KT_UNSTABLE,        /* the fixed step is too long: see longest_step */
    KT_JUMPS,           /* rates alternate from step to step */
    KT_SINGULAR_STEP,   /* the matrix of a step is singular */
    KT_BAD_TABLE,       /* the installed SUNDIALS has no such Runge-Kutta table */
    KT_MEMORY,
    KT_FAILED           /* anything else: see code */
};

typedef struct {
    kt_table output;   /* time, state: at the output times, or of every step */
    kt_table events;   /* index, time, state */
    kt_table dense;    /* first time, last time, order, derivatives 0 .. 12 of the state at the end */
    kt_statistics statistics;
    double time;       /* reached */
    double *state;     /* there */
    int refused_status;
    int refused_guard; /* the guard at whose dead point the motion ends; -1: none */
    double refused_time;
    double *refused_state;
    double longest_step; /* the longest stable step, if the fixed one is not stable */
    int code;          /* counts of the solver, as in SUNDIALS */
} kt_result;

enum { KT_MAX_ORDER = 12 };

/*
 * Integrate from times[0] to times[count - 1]. With `every_step`, the output is every internal step
 * and only the first and last time matter; else it is exactly at the times.
 * The result must be freed with kt_free after any outcome.
 */
int kt_integrate(const kt_problem *problem, const kt_options *options, const double *state,
                 const double *times, long count, int every_step, kt_result *result);

void kt_free(kt_result *result);

/* A motion that the caller advances piece by piece. */
typedef struct worker kt_motion;

/*
 * Return a motion, or NULL without memory. Problem, options and result must exist as long as it does; `kt_advance`
 * fills the result. Only for methods that do not need SUNDIALS.
 */
kt_motion *kt_open_motion(const kt_problem *problem, const kt_options *options, const double *state,
                          double length, kt_result *result);

/*
 * Advance from a state at one time to another time, with the first step of the options, or by default one over
 * the whole time; allocates nothing. The state reached, and its time, are in the result after any outcome.
 */
int kt_advance(kt_motion *motion, const double *state, const double *inputs, const double *times);

/* Return the planned length of the next step, as first step of the next piece. */
double kt_next_step(kt_motion *motion);

void kt_close_motion(kt_motion *motion);

/* Version of the SUNDIALS library. */
const char *kt_version(void);

#endif
