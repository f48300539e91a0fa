/*
 * Directions in which a system changes, integrated along the steps of its motion: the tangent of Dormand and
 * Prince's method. Each lane has a direction of its own; the motion is the same in all of them.
 *
 * A call owns its memory; several may run at the same time with other directions of the same motion.
 */
#ifndef KINTRAFO_DIRECTIONS_H
#define KINTRAFO_DIRECTIONS_H

typedef struct {
    /* functions of the model in lanes; without signals the latter is null */
    void *rhs_tangent, *signals_tangent;
    int constant_count, state_count, input_count, signal_count;
    const double *constants;

    /* the steps, and the points of their stages: steps x stages x elements */
    long step_count;
    const double *lengths;
    const int *restarts; /* whether inputs may jump before a step: its first stage is then not the last one before */
    const double *states, *inputs;

    /* the outputs, in the order of their times */
    long time_count;
    const long *step_of;
    const double *weights; /* times x stages: weights of the rates, without the length of the step */
    const double *states_there, *inputs_there; /* times x elements */
    int item_count;
    const int *items; /* indices of signals, followed by those of elements of the state */

    /* the directions: changes of constants, of the initial state, and of inputs */
    const double *of_constants, *of_start, *of_inputs; /* directions x elements */
    double *found; /* directions x times x items */
} kt_motion;

/*
 * Integrate the directions from `first` to before `last`. Returns 0; 1 without memory; or 2 if the model refuses a
 * state, or a derivative is not finite.
 */
int kt_follow_2(const kt_motion *motion, long first, long last);
int kt_follow_4(const kt_motion *motion, long first, long last);
int kt_follow_8(const kt_motion *motion, long first, long last);

#endif
