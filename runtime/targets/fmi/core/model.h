/*
 * What the core knows of a model: its functions, sizes, and what its variables are. model.c is written for
 * each model; everything else is the same for all.
 */
#ifndef KINTRAFO_FMU_MODEL_H
#define KINTRAFO_FMU_MODEL_H

#include <stddef.h>

typedef int (*km_function)(const double *constants, const double *state, const double *inputs,
                           double *out);
typedef int (*km_of_parameters)(const double *parameters, double *out);

/* A range has bounds where they are finite; a value may not be `above` itself. */
typedef struct {
    const char *name, *unit;
    double least, above, most;
} km_parameter;

/* An input may be the derivative of another one: its place, or -1. */
typedef struct {
    const char *name;
    int derivative_of;
} km_input;

/*
 * A zero crossing: of a signal and a level, which is a number and a parameter with its sign (place -1: none);
 * or of the margin of a guard (signal -1). It cannot happen where the parameter that it needs is zero.
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
    int use; /* KT_ACTS, KT_SINGULAR: what it means for an integration */
} km_guard;

/* Why `prepare` refuses parameters. */
typedef struct {
    const char *meaning, *remedy;
} km_assumption;

/* Places of the elements of an inertia: xx, yy, zz, xy, xz, yz. */
typedef struct {
    const char *body;
    int place[6];
} km_inertia;

/* Where a derivative is in what `linearisation` computes; -1: it is not there, since it is empty. */
typedef struct {
    int rates_by_inputs, signals_by_states, signals_by_inputs;
} km_places;

typedef struct {
    const char *name;
    int states, inputs, signals, parameters, constants, guards, events, assumptions, tensors;
    int positions, speeds; /* of the states */
    int linearised; /* size of what `linearisation` computes */
    int zeros;      /* so many assumptions, the first ones, are of what is taken to be zero */
    km_of_parameters prepare, design_state;
    km_function rates, jacobian, signals_of, margins, linearisation;
    /* along a direction, which follows the values of each array; NULL where the equations have none */
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

/* Numbers of one parameter set: token, then parameters, start and inputs behind each other. */
const char *km_token(void);
double km_value(int place);

#endif
