/*
 * An instance of a model, for both versions of FMI: values by their references, derivatives, events, steps.
 *
 * fmi2.c and fmi3.c are the two fronts. Statuses have the same numbers in both.
 */
#ifndef KINTRAFO_FMU_INSTANCE_H
#define KINTRAFO_FMU_INSTANCE_H

#include "integrate.h"
#include "model.h"

enum { KU_OK, KU_WARNING, KU_DISCARD, KU_ERROR, KU_FATAL };

/* States of an instance, on which the allowed calls depend; bits, so that a call can name several. */
enum {
    KU_INSTANTIATED = 1, KU_INITIALISING = 2, KU_EVENTS = 4, KU_CONTINUOUS = 8, KU_STEPPING = 16,
    KU_TERMINATED = 32, KU_FAILED = 64,
    KU_SET_UP = KU_INSTANTIATED | KU_INITIALISING,
    KU_RUNNING = KU_EVENTS | KU_CONTINUOUS | KU_STEPPING,
    KU_ANY = KU_SET_UP | KU_RUNNING | KU_TERMINATED | KU_FAILED
};

/* Derivatives of an input that are known at the beginning of a step, from order zero to three. */
enum { KU_ORDERS = 4 };

/* An input that is no derivative: its index and those of its derivatives, and their places. */
typedef struct {
    int targets[3];
    double *at[KU_ORDERS];
} ku_course;

/* Model Exchange: the point that the last step reached, and memory for margins ahead. */
typedef struct {
    int known, begins; /* whether there is a point; whether the motion begins at it */
    double time;
    double *state, *inputs, *rates, *rates_ahead, *ahead, *inputs_ahead, *margins, *usual;
} ku_way;

/* Values followed by a direction, and the changes of rates and signals along it. */
typedef struct {
    double *parameters, *constants, *state, *inputs, *rates, *signals;
    double *one, *bound; /* directions of one parameter, and of those that cannot change alone */
} ku_tangents;

typedef struct ku_instance ku_instance;
typedef void (*ku_report)(const ku_instance *u, int status, const char *category, const char *message);

/* Numbers of a saved instance, all doubles, so that they can be serialised. */
typedef struct {
    double *all; /* the arrays below, one after the other */
    int count;
    double *time, *mode, *ready, *tolerance, *next;
    double *parameters, *state, *inputs, *slopes, *step, *implicit;
} ku_numbers;

struct ku_instance {
    ku_report report;
    void *front; /* of fmi2.c or fmi3.c */
    char *label;
    int co_simulation, logging;
    ku_numbers now;
    double *memory;
    double *constants, *rates, *signals, *margins, *jacobian, *linearised, *before;
    int rates_known, signals_known, margins_known, jacobian_known, linearised_known, before_known;
    char *message;
    double last_time; /* end of the last complete step */
    int stopped;      /* a step reached a dead point */
    ku_way way;
    ku_tangents tangents;
    /* Co-Simulation */
    kt_problem problem;
    kt_options options;
    kt_result result;
    ku_course *courses;
    int course_count;
    kt_spline *splines;
    double *breaks, *coefficients, *usual, *tolerances;
    kt_motion *motion;
};

/* Value references: consecutive blocks in this order. */
enum ku_block {
    KU_TIME, KU_STATE, KU_RATE, KU_INPUT, KU_SIGNAL, KU_EVENT, KU_PARAMETER, KU_STEP, KU_IMPLICIT,
    KU_NOTHING
};

/* -- creation and deletion -------------------------------------------------------------------- */

/* NULL without memory, or if the token is that of another model, which is reported to `front`. */
ku_instance *ku_open(const char *label, const char *token, int co_simulation, int logging,
                     ku_report report, void *front);
void ku_close(ku_instance *u);
void ku_reset(ku_instance *u);

/* Report a message, formatted as by printf, and return the status. */
int ku_say(const ku_instance *u, int status, const char *format, ...);

/* Return whether a function may be called now; an error is reported if not. */
int ku_may(const ku_instance *u, const char *function, int modes);

/* Return whether the instance is one for Co-Simulation, or for Model Exchange, likewise. */
int ku_is(const ku_instance *u, const char *function, int co_simulation);

int ku_mode(const ku_instance *u);
void ku_enter(ku_instance *u, int mode);

int ku_start(ku_instance *u, double time, int tolerance_defined, double tolerance);
int ku_begin(ku_instance *u); /* after initialisation */

/* -- values ----------------------------------------------------------------------------------- */

int ku_get(ku_instance *u, const unsigned *references, size_t count, double *values);
int ku_set(ku_instance *u, const unsigned *references, size_t count, const double *values);
int ku_set_time(ku_instance *u, double time);
int ku_set_states(ku_instance *u, const double *states, size_t count);
int ku_get_states(ku_instance *u, double *states, size_t count);
int ku_get_rates(ku_instance *u, double *rates, size_t count);
int ku_get_nominals(ku_instance *u, double *nominals, size_t count);
int ku_get_events(ku_instance *u, double *values, size_t count);
int ku_set_slopes(ku_instance *u, const unsigned *references, size_t count, const int *orders,
                  const double *values);

/* The block of a reference, and its index there. */
enum ku_block ku_find(unsigned reference, int *place);

/* Compute the constants if parameters were changed; errors are reported. */
int ku_ready(ku_instance *u);

/* Evaluate the results that are not known at the present values. */
int ku_know_rates(ku_instance *u);
int ku_know_signals(ku_instance *u);
int ku_know_margins(ku_instance *u);
void ku_forget(ku_instance *u);

/* Report the guards that refuse the present values, from a status word of the model. */
int ku_refused(ku_instance *u, const char *what, int word);

/* -- derivatives ------------------------------------------------------------------------------ */

/* Along a direction of the knowns; or, transposed, of a weighted sum of the unknowns. */
int ku_derivative(ku_instance *u, const unsigned *unknowns, size_t rows, const unsigned *knowns,
                  size_t columns, const double *seed, double *found, int transposed);

/* -- events ----------------------------------------------------------------------------------- */

/* Report the events that have occurred; `over` becomes 1 if the model ends here, else 0. */
int ku_update(ku_instance *u, int *over);

/* End of a step of the importer; `over` becomes 1 if it has passed a dead point, else 0. */
int ku_completed(ku_instance *u, int *over);
void ku_mark(ku_instance *u);

/* Evaluate the margins at the design position, which are their usual sizes. */
void ku_usual_margins(ku_instance *u, double *usual);

/* -- saved instances -------------------------------------------------------------------------- */

void *ku_save(ku_instance *u, void *into);
int ku_restore(ku_instance *u, const void *saved);
size_t ku_size(void);
int ku_serialise(ku_instance *u, const void *saved, unsigned char *bytes, size_t size);
void *ku_deserialise(ku_instance *u, const unsigned char *bytes, size_t size);

/* -- Co-Simulation ---------------------------------------------------------------------------- */

int ku_open_steps(ku_instance *u);
void ku_close_steps(ku_instance *u);
void ku_begin_anew(ku_instance *u);
int ku_step(ku_instance *u, double time, double length);

#endif
