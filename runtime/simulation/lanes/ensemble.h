/*
 * Integrate many systems of one model at once, each with parameters, state and inputs of its own.
 *
 * A call owns its memory, and may run beside others on other systems of the same problem.
 */
#ifndef KINTRAFO_ENSEMBLE_H
#define KINTRAFO_ENSEMBLE_H

/* A time-varying input: a cubic spline, and which inputs get its value and derivatives. */
typedef struct {
    int pieces;
    const double *breaks;       /* pieces + 1 times, increasing */
    const double *coefficients; /* 4 x pieces, row-major, highest power first, from the left break */
} kt_course;

/* A time in which nothing jumps, with as many courses as the problem says. */
typedef struct {
    double end;
    const kt_course *courses;
    long milestone_count;
    const double *milestones; /* times that no step passes over, increasing */
    long turn_count;
    const double *turns; /* times at which inputs turn, likewise */
    const double *reaches; /* no step passes over a turn that is longer than this */
} kt_segment;

/* What the inputs of some systems do over the whole time. */
typedef struct {
    int segment_count;
    const kt_segment *segments;
} kt_drive;

/*
 * What is kept of a signal on its way. Each output stands for a time, its weight. Sums are those of how
 * much it differs from its first value, so that little is lost where it changes little. The time above a
 * level is that of straight lines between the outputs.
 */
enum kt_reduction_kind { KT_GREATEST, KT_LEAST, KT_FIRST, KT_SUM, KT_SQUARES, KT_ABOVE, KT_LAST };

typedef struct {
    int item; /* of the items */
    int kind;
    int origin;   /* of a sum: what keeps the first value, before it; of KT_ABOVE: KT_LAST, behind it */
    double level; /* of KT_ABOVE */
} kt_reduction;

/* How a system ends. */
enum kt_end {
    KT_WAITING,      /* its turn has not come: the caller wanted an end */
    KT_DONE,
    KT_PARAMETERS,   /* of no system: the code of the model's function prepare */
    KT_REFUSED,      /* the model refuses a state: its status word */
    KT_DEAD_POINT,   /* the motion comes to the dead point of a guard: its place */
    KT_SMALL_STEP,   /* the error stays too large for any step */
    KT_MANY_STEPS,
    KT_STIFF         /* stability limits its steps, and has done so for long */
};

typedef struct {
    /* functions of the model in lanes; those that it has not are null */
    void *prepare, *design_state, *rhs, *signals, *margins;
    int parameter_count, constant_count, state_count, input_count, signal_count, guard_count;
    int position_count; /* so many elements of the state are positions, and come first */
    const int *guards; /* what each means, as in margins.h beside the other solver */

    /* the systems; a stride of zero: the same for all */
    const double *parameters; /* what is common */
    int varied_count;
    const int *varied;      /* which parameters are not */
    const double *variants; /* systems x varied */
    const double *states;   /* at the start; NaN: that of the design position */
    long state_stride;
    const double *inputs; /* values of those that do not vary with time */
    long input_stride;
    const kt_drive *drives;
    const int *drive_of; /* null: all have the first */
    int course_count;
    const int *targets; /* 3 for each course: input for the value and two derivatives; -1: none */

    /* the integration; outputs come at increasing times, none before the start */
    double start, end;
    long time_count;
    const double *times;
    double rtol;
    const double *atol;
    double first_step; /* 0: chosen here */
    double max_step;   /* infinite: none */
    long max_steps;
    long stiff_after; /* steps after which one that is stiff ends; 0: none does */

    /* what is wanted: signals, and behind the last of them elements of the state */
    const int *items;
    int sample_count; /* so many of the items are kept at all times */
    double *samples;  /* systems x sample_count x times, from one of the systems on */
    long first_sampled;
    int reduction_count;
    const kt_reduction *reductions;
    const double *weights; /* of the times */
    double *reduced;       /* systems x reductions */
    int bound_count;       /* what items must not pass: greatest values where `above` is 1, else least */
    const int *bound_items, *above;
    const double *limits; /* systems x bounds */
    long limit_stride;
    double *beyond; /* systems x bounds: the value furthest beyond, NaN where there is none */

    /* how each system ends; those that do not wait are left out */
    int *ends, *codes;
    double *ended;  /* time that was reached, or at which something is refused */
    double *finals; /* systems x states: there */
    long *steps;
} kt_problem;

/*
 * Integrate the systems from `first` on, up to `last`; as soon as `stop` is not zero, no further.
 * Returns 0, or 1 where there is no memory.
 */
int kt_integrate_2(const kt_problem *problem, long first, long last, const volatile int *stop);
int kt_integrate_4(const kt_problem *problem, long first, long last, const volatile int *stop);
int kt_integrate_8(const kt_problem *problem, long first, long last, const volatile int *stop);

/* How many lanes this processor has; those that are wider must not be called. */
int kt_widest(void);

#endif
