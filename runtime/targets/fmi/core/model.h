/*
 * Description of a model for the core: its functions, sizes and variables. model.c is written for each model;
 * everything else is the same for all.
 */
#ifndef KINTRAFO_FMU_MODEL_H
#define KINTRAFO_FMU_MODEL_H

#include <stddef.h>

typedef int (*km_function)(const double *constants, const double *state, const double *inputs,
                           double *out);
typedef int (*km_of_parameters)(const double *parameters, double *out);

/* A range; infinite bounds are none, and a value must be greater than `above`. */
typedef struct {
    const char *name, *unit;
    double least, above, most;
} km_parameter;

/* An input; it may be the derivative of another one, whose index is given, else -1. */
typedef struct {
    const char *name;
    int derivative_of;
} km_input;

/*
 * A zero crossing: of a signal minus a level, which is a number plus a parameter with a sign (index -1: none);
 * or of the margin of a guard (signal -1). It cannot occur if the parameter that it needs is zero.
 */
typedef struct {
    const char *name, *meaning;
    int signal, guard;
    double level;
    int parameter;
    double sign;
    int needs;
} km_event;

typedef struct {
    const char *name, *unit, *meaning;
    int use; /* KT_ACTS, KT_SINGULAR: its effect on an integration */
} km_guard;

/* Reasons why `prepare` refuses parameters. */
typedef struct {
    const char *meaning, *remedy;
} km_assumption;

/* Indices of the elements of an inertia: xx, yy, zz, xy, xz, yz. */
typedef struct {
    const char *body;
    int place[6];
} km_inertia;

/* Place of a derivative in the result of `linearisation`; -1: it is empty. */
typedef struct {
    int rates_by_inputs, signals_by_states, signals_by_inputs;
} km_places;

typedef struct {
    const char *name;
    int states, inputs, signals, parameters, constants, guards, events, assumptions, tensors;
    int positions, speeds; /* of the states */
    int linearised; /* size of the result of `linearisation` */
    int zeros;      /* number of assumptions, from the first, about quantities that are zero */
    km_of_parameters prepare, design_state;
    km_function rates, jacobian, signals_of, margins, linearisation;
    /* derivatives along a direction, which follows the values in each array; NULL without derivatives */
    km_of_parameters prepare_tangent;
    km_function rates_tangent, signals_tangent;
    km_places places;
    const km_parameter *parameter;
    const km_input *input;
    const km_event *event;
    const km_guard *guard;
    const int *guard_use;
    const km_assumption *assumption;
    const km_inertia *tensor;
    const char *const *constant_name;
    const char *const *state_name;
    const char *const *signal_name;
} km_model;

extern const km_model km_this;

/* Numbers of one parameter set: the token, followed by parameters, initial state and inputs. */
const char *km_token(void);
double km_value(int place);

#endif
