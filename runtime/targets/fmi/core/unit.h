/*
 * An instance of a model, for both versions of FMI: values by their references, derivatives, events, steps.
 *
 * fmi2.c and fmi3.c are the two fronts. Statuses have the same numbers in both.
 */
#ifndef KINTRAFO_FMU_UNIT_H
#define KINTRAFO_FMU_UNIT_H

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

/* Derivatives of an input that are known at the begin of a step, from order zero to three. */
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

typedef struct unit unit;
typedef void (*ku_report)(const unit *u, int status, const char *category, const char *message);

/* Numbers of a saved instance, all doubles, so that they can be serialised. */
typedef struct {
    double *all; /* the arrays below, one after the other */
    int count;
    double *time, *mode, *ready, *tolerance, *next;
    double *parameters, *state, *inputs, *slopes, *step, *implicit;
} ku_numbers;

struct unit {
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
unit *ku_open(const char *label, const char *token, int co_simulation, int logging,
              ku_report report, void *front);
void ku_close(unit *u);
void ku_reset(unit *u);

/* Report a message, formatted as by printf, and return the status. */
int ku_say(const unit *u, int status, const char *format, ...);

/* Return whether a function may be called now; an error is reported if not. */
int ku_may(const unit *u, const char *function, int modes);

/* Return whether the instance is one for Co-Simulation, or for Model Exchange, likewise. */
int ku_is(const unit *u, const char *function, int co_simulation);

int ku_mode(const unit *u);
void ku_enter(unit *u, int mode);

int ku_start(unit *u, double time, int tolerance_defined, double tolerance);
int ku_begin(unit *u); /* after initialisation */

/* -- values ----------------------------------------------------------------------------------- */

int ku_get(unit *u, const unsigned *references, size_t count, double *values);
int ku_set(unit *u, const unsigned *references, size_t count, const double *values);
int ku_set_time(unit *u, double time);
int ku_set_states(unit *u, const double *states, size_t count);
int ku_get_states(unit *u, double *states, size_t count);
int ku_get_rates(unit *u, double *rates, size_t count);
int ku_get_nominals(unit *u, double *nominals, size_t count);
int ku_get_events(unit *u, double *values, size_t count);
int ku_set_slopes(unit *u, const unsigned *references, size_t count, const int *orders,
                  const double *values);

/* The block of a reference, and its index there. */
enum ku_block ku_find(unsigned reference, int *place);

/* Compute the constants if parameters were changed; errors are reported. */
int ku_ready(unit *u);

/* Evaluate the results that are not known at the present values. */
int ku_know_rates(unit *u);
int ku_know_signals(unit *u);
int ku_know_margins(unit *u);
void ku_forget(unit *u);

/* Report the guards that refuse the present values, from a status word of the model. */
int ku_refused(unit *u, const char *what, int word);

/* -- derivatives ------------------------------------------------------------------------------ */

/* Along a direction of the knowns; or, transposed, of a weighted sum of the unknowns. */
int ku_derivative(unit *u, const unsigned *unknowns, size_t rows, const unsigned *knowns,
                  size_t columns, const double *seed, double *found, int transposed);

/* -- events ----------------------------------------------------------------------------------- */

/* Report the events that have occurred; `over` becomes 1 if the model ends here, else 0. */
int ku_update(unit *u, int *over);

/* End of a step of the importer; `over` becomes 1 if it has passed a dead point, else 0. */
int ku_completed(unit *u, int *over);
void ku_mark(unit *u);

/* Evaluate the margins at the design position, which are their usual sizes. */
void ku_usual_margins(unit *u, double *usual);

/* -- saved instances -------------------------------------------------------------------------- */

void *ku_save(unit *u, void *into);
int ku_restore(unit *u, const void *saved);
size_t ku_size(void);
int ku_serialise(unit *u, const void *saved, unsigned char *bytes, size_t size);
void *ku_deserialise(unit *u, const unsigned char *bytes, size_t size);

/* -- Co-Simulation ---------------------------------------------------------------------------- */

int ku_open_steps(unit *u);
void ku_close_steps(unit *u);
void ku_begin_anew(unit *u);
int ku_step(unit *u, double time, double length);

#endif
