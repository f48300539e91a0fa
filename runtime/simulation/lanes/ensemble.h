/*
 * Integration of many systems of one model, each with parameters, state and inputs of its own.
 *
 * A call owns its memory; several may run at the same time with other systems of the same problem.
 */
#ifndef KINTRAFO_ENSEMBLE_H
#define KINTRAFO_ENSEMBLE_H

/* A time-varying input: a cubic spline. */
typedef struct {
    int pieces;
    const double *breaks;       /* pieces + 1 times, increasing */
    const double *coefficients; /* 4 x pieces, row-major, highest power first, from the left break */
} kt_course;

/* A time span without jumps, with `course_count` courses. */
typedef struct {
    double end;
    const kt_course *courses;
    long milestone_count;
    const double *milestones; /* times that no step passes over, increasing */
    long turn_count;
    const double *turns; /* times of extrema of inputs, increasing */
    const double *reaches; /* longest step that may pass over each */
} kt_segment;

/* The inputs of some systems over the whole time. */
typedef struct {
    int segment_count;
    const kt_segment *segments;
} kt_drive;

/*
 * A number that is accumulated of a signal. Each output represents a time span, its weight. Sums are those of
 * differences from the first value, which keeps small changes accurate. The time above a level is that of
 * straight lines between the outputs.
 */
enum kt_reduction_kind { KT_GREATEST, KT_LEAST, KT_FIRST, KT_SUM, KT_SQUARES, KT_ABOVE, KT_LAST };

typedef struct {
    int item; /* index of the item */
    int kind;
    int origin;   /* for a sum: the reduction with the first value, before it; for KT_ABOVE: KT_LAST, after it */
    double level; /* for KT_ABOVE */
} kt_reduction;

/* The end of a system. */
enum kt_end {
    KT_WAITING,      /* not integrated yet */
    KT_DONE,
    KT_PARAMETERS,   /* impossible parameters: code is the return value of the model's function prepare */
    KT_REFUSED,      /* the model refuses a state: code is its status word */
    KT_DEAD_POINT,   /* dead point of a guard: code is its index */
    KT_SMALL_STEP,   /* the error is too large for any step */
    KT_MANY_STEPS,
    KT_STIFF         /* stability has limited its steps for long */
};

typedef struct {
    /* functions of the model in lanes; null if it does not have one */
    void *prepare, *design_state, *rhs, *signals, *margins;
    int parameter_count, constant_count, state_count, input_count, signal_count, guard_count;
    int position_count; /* number of positions, which come first in the state */
    const int *guards; /* effect of each, see ../native/margins.h */

    /* the systems; a stride of zero: the same values for all */
    const double *parameters; /* common values */
    int varied_count;
    const int *varied;      /* indices of the parameters that differ */
    const double *variants; /* systems x varied */
    const double *states;   /* initial states; NaN: element of the design position */
    long state_stride;
    const double *inputs; /* values of the inputs that do not vary with time */
    long input_stride;
    const kt_drive *drives;
    const int *drive_of; /* null: the first for all */
    int course_count;
    const int *targets; /* 3 for each course: inputs of the value and two derivatives; -1: none */

    /* the integration; times of outputs increase, from the start on */
    double start, end;
    long time_count;
    const double *times;
    double rtol;
    const double *atol;
    double first_step; /* 0: chosen here */
    double max_step;   /* infinite: none */
    long max_steps;
    long stiff_after; /* steps after which a stiff system ends; 0: it does not */

    /* results: indices of signals, followed by those of elements of the state */
    const int *items;
    int sample_count; /* number of items that are kept at all times */
    double *samples;  /* systems x sample_count x times, from system first_sampled on */
    long first_sampled;
    int reduction_count;
    const kt_reduction *reductions;
    const double *weights; /* weights of the times */
    double *reduced;       /* systems x reductions */
    int bound_count;       /* bounds of items: upper ones where `above` is 1, else lower ones */
    const int *bound_items, *above;
    const double *limits; /* systems x bounds */
    long limit_stride;
    double *beyond; /* systems x bounds: the value farthest beyond, NaN for none */

    /* end of each system; only those with KT_WAITING are integrated */
    int *ends, *codes;
    double *ended;  /* time that was reached, or at which a state is refused */
    double *finals; /* systems x states: states at that time */
    long *steps;
} kt_problem;

/*
 * Integrate the systems from `first` to before `last`, until `stop` is not zero. Returns 0, or 1 without memory.
 */
int kt_integrate_2(const kt_problem *problem, long first, long last, const volatile int *stop);
int kt_integrate_4(const kt_problem *problem, long first, long last, const volatile int *stop);
int kt_integrate_8(const kt_problem *problem, long first, long last, const volatile int *stop);

/* Most lanes that this processor supports; functions with more must not be called. */
int kt_widest(void);

#endif
