/*
 * Directions in which one system moves, followed along the steps of its motion: the tangent of Dormand and
 * Prince's method. Each lane has a direction of its own; the motion is the same in all of them.
 *
 * A call owns its memory, and may run beside others on other directions of the same motion.
 */
#ifndef KINTRAFO_DIRECTIONS_H
#define KINTRAFO_DIRECTIONS_H

typedef struct {
    /* functions of the model in lanes; without any signals the latter is null */
    void *rhs_tangent, *signals_tangent;
    int constant_count, state_count, input_count, signal_count;
    const double *constants;

    /* the steps, and where their stages are: steps x stages x elements */
    long step_count;
    const double *lengths;
    const int *anew; /* steps before which inputs may jump: their first stage is not the last one before */
    const double *states, *inputs;

    /* the outputs, in the order of their times */
    long time_count;
    const long *step_of;
    const double *weights; /* times x stages: of the rates, times the length of the step */
    const double *states_there, *inputs_there; /* times x elements */
    int item_count;
    const int *items; /* signals, and behind the last of them elements of the state */

    /* the directions: how much constants, the state at the start, and inputs change */
    const double *of_constants, *of_start, *of_inputs; /* directions x elements */
    double *found; /* directions x times x items */
} kt_motion;

/*
 * Follow the directions from `first` on, up to `last`. Returns 0; 1 where there is no memory; or 2 where the
 * model refuses a state, or a derivative is not finite.
 */
int kt_follow_2(const kt_motion *motion, long first, long last);
int kt_follow_4(const kt_motion *motion, long first, long last);
int kt_follow_8(const kt_motion *motion, long first, long last);

#endif
