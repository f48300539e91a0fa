/* Creation and deletion of an instance, and its values. */
#include "instance.h"

#include "trust.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MESSAGE = 2000, NOT_FINITE_BIT = 30, LAST_GUARD_BIT = 29 };

/* Tolerance of the principal moments of a possible inertia, relative to the largest. */
#define INERTIA_ROUNDING 1.0e-9

/* Default tolerance, as in other integrations of this project. */
#define USUAL_TOLERANCE 1.0e-6

/* -- messages --------------------------------------------------------------------------------- */

static void tell(const ku_instance *u, int status, const char *format, va_list arguments)
{
    vsnprintf(u->message, MESSAGE, format, arguments);
    static const char *const CATEGORIES[] = {
        "logEvents", "logStatusWarning", "logStatusDiscard", "logStatusError", "logStatusFatal",
    };
    if (status > KU_OK || u->logging) {
        u->report(u, status, CATEGORIES[status], u->message);
    }
}

int ku_say(const ku_instance *u, int status, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    tell(u, status, format, arguments);
    va_end(arguments);
    return status;
}

static const char *mode_name(int mode)
{
    switch (mode) {
    case KU_INSTANTIATED: return "instantiated";
    case KU_INITIALISING: return "in initialization mode";
    case KU_EVENTS: return "in event mode";
    case KU_CONTINUOUS: return "in continuous-time mode";
    case KU_STEPPING: return "in step mode";
    case KU_TERMINATED: return "terminated";
    default: return "in an error; reset or free it";
    }
}

int ku_mode(const ku_instance *u) { return (int)*u->now.mode; }

void ku_enter(ku_instance *u, int mode) { *u->now.mode = mode; }

int ku_may(const ku_instance *u, const char *function, int modes)
{
    if (ku_mode(u) & modes) {
        return 1;
    }
    ku_say(u, KU_ERROR, "%s: it cannot be called now, the instance is %s.", function,
           mode_name(ku_mode(u)));
    return 0;
}

int ku_is(const ku_instance *u, const char *function, int co_simulation)
{
    if (u->co_simulation == co_simulation) {
        return 1;
    }
    ku_say(u, KU_ERROR, "%s: the instance is one for %s.", function,
           u->co_simulation ? "Co-Simulation" : "Model Exchange");
    return 0;
}

/* -- creation and deletion -------------------------------------------------------------------- */

/* Set the pointers of saved numbers into an array; return their count. */
static int lay_out(ku_numbers *n, double *at)
{
    const km_model *m = &km_this;
    double *begin = at;
    n->all = at;
    n->time = at++;
    n->mode = at++;
    n->ready = at++;
    n->tolerance = at++;
    n->next = at++;
    n->step = at++;
    n->implicit = at++;
    n->parameters = at;
    at += m->parameters;
    n->state = at;
    at += m->states;
    n->inputs = at;
    at += m->inputs;
    n->slopes = at;
    at += (KU_ORDERS - 1) * m->inputs;
    n->count = (int)(at - begin);
    return n->count;
}

static size_t number_count(void)
{
    const km_model *m = &km_this;
    return 7 + (size_t)m->parameters + (size_t)m->states + (size_t)KU_ORDERS * m->inputs;
}

static size_t size_of_tangents(void)
{
    const km_model *m = &km_this;
    if (!m->prepare_tangent) {
        return 0;
    }
    return 2 * (2 * (size_t)m->parameters + m->constants + m->states + m->inputs) + m->states + m->signals;
}

static void lay_out_tangents(ku_tangents *t, double *at)
{
    const km_model *m = &km_this;
    if (!m->prepare_tangent) {
        return;
    }
    t->parameters = at;
    t->constants = t->parameters + 2 * m->parameters;
    t->state = t->constants + 2 * m->constants;
    t->inputs = t->state + 2 * m->states;
    t->rates = t->inputs + 2 * m->inputs;
    t->signals = t->rates + m->states;
    t->one = t->signals + m->signals;
    t->bound = t->one + m->parameters;
}

static size_t size_of_all(void)
{
    const km_model *m = &km_this;
    size_t n = (size_t)m->states;
    return number_count() + (size_t)m->constants + n + m->signals + m->guards + n * n + m->linearised
        + m->events + 4 * n + 2 * (size_t)m->inputs + 7 * (size_t)m->guards
        + size_of_tangents() + 1;
}

ku_instance *ku_open(const char *label, const char *token, int co_simulation, int logging,
                     ku_report report, void *front)
{
    const km_model *m = &km_this;
    ku_instance *u = calloc(1, sizeof *u);
    const char *known = label ? label : "";
    if (!u) {
        return NULL;
    }
    u->memory = calloc(size_of_all(), sizeof *u->memory);
    u->label = malloc(strlen(known) + 1);
    u->message = malloc(MESSAGE);
    u->report = report;
    u->front = front;
    u->co_simulation = co_simulation;
    u->logging = logging;
    if (!u->memory || !u->label || !u->message) {
        ku_close(u);
        return NULL;
    }
    strcpy(u->label, known);
    double *at = u->memory + lay_out(&u->now, u->memory);
    u->constants = at;
    u->rates = u->constants + m->constants;
    u->signals = u->rates + m->states;
    u->margins = u->signals + m->signals;
    u->jacobian = u->margins + m->guards;
    u->linearised = u->jacobian + (size_t)m->states * m->states;
    u->before = u->linearised + m->linearised;
    u->way.state = u->before + m->events;
    u->way.rates = u->way.state + m->states;
    u->way.rates_ahead = u->way.rates + m->states;
    u->way.ahead = u->way.rates_ahead + m->states;
    u->way.inputs = u->way.ahead + m->states;
    u->way.inputs_ahead = u->way.inputs + m->inputs;
    u->way.margins = u->way.inputs_ahead + m->inputs;
    u->way.usual = u->way.margins + 6 * m->guards;
    lay_out_tangents(&u->tangents, u->way.usual + m->guards);
    if (!token || strcmp(token, km_token()) != 0) {
        ku_say(u, KU_ERROR,
               "the token of the model description is not that of this library, which is %s: they are "
               "of two exports. Take both from one.", km_token());
        ku_close(u);
        return NULL;
    }
    ku_reset(u);
    return u;
}

void ku_close(ku_instance *u)
{
    ku_close_steps(u);
    free(u->memory);
    free(u->label);
    free(u->message);
    free(u);
}

void ku_reset(ku_instance *u)
{
    const km_model *m = &km_this;
    ku_close_steps(u);
    memset(u->now.all, 0, (size_t)u->now.count * sizeof *u->now.all);
    *u->now.mode = KU_INSTANTIATED;
    *u->now.tolerance = USUAL_TOLERANCE;
    for (int i = 0; i < m->parameters; ++i) {
        u->now.parameters[i] = km_value(i);
    }
    for (int i = 0; i < m->states; ++i) {
        u->now.state[i] = km_value(m->parameters + i);
    }
    for (int i = 0; i < m->inputs; ++i) {
        u->now.inputs[i] = km_value(m->parameters + m->states + i);
    }
    u->stopped = u->before_known = u->way.known = 0;
    ku_forget(u);
}

int ku_start(ku_instance *u, double time, int tolerance_defined, double tolerance)
{
    if (!isfinite(time)) {
        return ku_say(u, KU_ERROR, "start time = %g s: a finite number is needed.", time);
    }
    if (tolerance_defined && !(tolerance > 0.0 && tolerance < 1.0)) {
        return ku_say(u, KU_ERROR, "tolerance = %g: a number above 0 and below 1 is needed.", tolerance);
    }
    *u->now.time = u->last_time = time;
    if (tolerance_defined) {
        *u->now.tolerance = tolerance;
    }
    return KU_OK;
}

int ku_begin(ku_instance *u)
{
    int status = ku_ready(u);
    if (status == KU_OK && u->co_simulation) {
        status = ku_open_steps(u);
    }
    if (status == KU_OK) {
        ku_enter(u, u->co_simulation ? KU_STEPPING : KU_EVENTS);
    }
    return status;
}

/* -- parameters ------------------------------------------------------------------------------- */

static int in_range(const ku_instance *u, int i)
{
    const km_parameter *p = &km_this.parameter[i];
    double value = u->now.parameters[i];
    const char *unit = strcmp(p->unit, "1") ? p->unit : "";
    if (!isfinite(value)) {
        ku_say(u, KU_ERROR, "parameter %s = %g %s: a finite number is needed.", p->name, value, unit);
    } else if (!(value >= p->least)) {
        ku_say(u, KU_ERROR, "parameter %s = %g %s is out of its range; give %g %s or more.", p->name,
               value, unit, p->least, unit);
    } else if (!(value > p->above)) {
        ku_say(u, KU_ERROR, "parameter %s = %g %s is out of its range; give more than %g %s.", p->name,
               value, unit, p->above, unit);
    } else if (!(value <= p->most)) {
        ku_say(u, KU_ERROR, "parameter %s = %g %s is out of its range; give %g %s or less.", p->name,
               value, unit, p->most, unit);
    } else {
        return 1;
    }
    return 0;
}

/*
 * Principal moments are possible if the matrix tr(J) / 2 - J is positive semidefinite: its eigenvalues are
 * half of the difference of the sum of two moments and the third. So no principal minor may be negative.
 */
static int of_a_body(const ku_instance *u, const km_inertia *t)
{
    double j[6];
    for (int i = 0; i < 6; ++i) {
        j[i] = u->now.parameters[t->place[i]];
    }
    double trace = j[0] + j[1] + j[2], half = (0.5 + INERTIA_ROUNDING) * trace;
    double a = half - j[0], b = half - j[1], c = half - j[2], d = -j[3], e = -j[4], f = -j[5];
    double third = a * (b * c - f * f) - d * (d * c - f * e) + e * (d * f - b * e);
    return a >= 0.0 && b >= 0.0 && c >= 0.0 && a * b >= d * d && a * c >= e * e && b * c >= f * f
        && third >= 0.0;
}

static int inertia_is_possible(const ku_instance *u)
{
    const km_model *m = &km_this;
    for (int i = 0; i < m->tensors; ++i) {
        if (!of_a_body(u, &m->tensor[i])) {
            ku_say(u, KU_ERROR,
                   "inertia of %s: its principal moments are those of no body, since the largest is at most "
                   "the sum of the others and none is negative. Check the diagonal and the signs of xy, xz, yz.",
                   m->tensor[i].body);
            return 0;
        }
    }
    return 1;
}

static int solver_is_possible(const ku_instance *u)
{
    double step = *u->now.step, implicit = *u->now.implicit;
    if (!(step >= 0.0 && isfinite(step))) {
        ku_say(u, KU_ERROR, "solver.step = %g s: a finite number of 0 s or more is needed.", step);
    } else if (implicit != 0.0 && implicit != 1.0) {
        ku_say(u, KU_ERROR, "solver.implicit = %g: 0 or 1 is needed.", implicit);
    } else if (implicit != 0.0 && step == 0.0) {
        ku_say(u, KU_ERROR, "solver.implicit = 1 needs fixed steps: give solver.step a length above 0 s.");
    } else if (step > 0.0 && km_this.states && !km_this.jacobian) {
        ku_say(u, KU_ERROR, "solver.step = %g s: methods with fixed steps need the Jacobian of the equations, which "
               "were derived without it. Set solver.step to 0 s.", step);
    } else {
        return 1;
    }
    return 0;
}

int ku_ready(ku_instance *u)
{
    const km_model *m = &km_this;
    if (*u->now.ready) {
        return KU_OK;
    }
    for (int i = 0; i < m->parameters; ++i) {
        if (!in_range(u, i)) {
            return KU_ERROR;
        }
    }
    if (!solver_is_possible(u) || !inertia_is_possible(u)) {
        return KU_ERROR;
    }
    int failed = m->prepare(u->now.parameters, u->constants);
    if (failed > m->constants) {
        const km_assumption *broken = &m->assumption[failed - m->constants - 1];
        return ku_say(u, KU_ERROR, "parameters: %s; %s.", broken->meaning, broken->remedy);
    }
    if (failed) {
        return ku_say(u, KU_ERROR,
                      "parameters: the constant %s is not finite: points coincide, a point lies on a line "
                      "that it must be beside, or something moves without mass.", m->constant_name[failed - 1]);
    }
    *u->now.ready = 1.0;
    ku_forget(u);
    return KU_OK;
}

/* -- evaluation ------------------------------------------------------------------------------- */

void ku_forget(ku_instance *u)
{
    u->rates_known = u->signals_known = u->margins_known = u->jacobian_known = u->linearised_known = 0;
}

int ku_refused(ku_instance *u, const char *what, int word)
{
    const km_model *m = &km_this;
    double *margins = u->margins;
    m->margins(u->constants, u->now.state, u->now.inputs, margins);
    for (int i = 0; i < m->guards; ++i) {
        int bit = i < LAST_GUARD_BIT ? i : LAST_GUARD_BIT;
        if ((word >> bit & 1) && !(margins[i] > 0.0)) {
            const km_guard *g = &m->guard[i];
            return ku_say(u, KU_DISCARD, "%s at %.9g s: %s (%s = %.3g %s, must be positive).", what,
                          *u->now.time, g->meaning, g->name, margins[i],
                          strcmp(g->unit, "1") ? g->unit : "");
        }
    }
    return ku_say(u, KU_DISCARD, "%s at %.9g s: a result is no finite number. Check states and inputs.",
                  what, *u->now.time);
}

static int know(ku_instance *u, int *known, km_function function, double *out, const char *what)
{
    int status = ku_ready(u);
    if (status != KU_OK || *known || !function) {
        return status;
    }
    int word = function(u->constants, u->now.state, u->now.inputs, out);
    if (word) {
        return ku_refused(u, what, word);
    }
    *known = 1;
    return KU_OK;
}

int ku_know_rates(ku_instance *u) { return know(u, &u->rates_known, km_this.rates, u->rates, "derivatives"); }

int ku_know_signals(ku_instance *u)
{
    return know(u, &u->signals_known, km_this.signals_of, u->signals, "outputs");
}

int ku_know_margins(ku_instance *u)
{
    int status = ku_ready(u);
    if (status == KU_OK && !u->margins_known) {
        km_this.margins(u->constants, u->now.state, u->now.inputs, u->margins);
        u->margins_known = 1;
    }
    return status;
}

/* -- references ------------------------------------------------------------------------------- */

enum ku_block ku_find(unsigned reference, int *place)
{
    const km_model *m = &km_this;
    const int sizes[KU_NOTHING] = {
        1, m->states, m->states, m->inputs, m->signals, m->events, m->parameters, 1, 1,
    };
    unsigned left = reference;
    for (int block = 0; block < KU_NOTHING; ++block) {
        if (left < (unsigned)sizes[block]) {
            *place = (int)left;
            return (enum ku_block)block;
        }
        left -= (unsigned)sizes[block];
    }
    *place = 0;
    return KU_NOTHING;
}

static double event_value(const ku_instance *u, int i)
{
    const km_event *e = &km_this.event[i];
    if (e->signal < 0) {
        return u->margins[e->guard];
    }
    if (e->needs >= 0 && u->now.parameters[e->needs] == 0.0) {
        return 1.0;
    }
    double level = e->level;
    if (e->parameter >= 0) {
        level += e->sign * u->now.parameters[e->parameter];
    }
    return u->signals[e->signal] - level;
}

/* Evaluate the function whose zeros are an event. */
static int know_event(ku_instance *u, int i)
{
    return km_this.event[i].signal < 0 ? ku_know_margins(u) : ku_know_signals(u);
}

static int get(ku_instance *u, unsigned reference, double *value)
{
    int place, status = KU_OK;
    switch (ku_find(reference, &place)) {
    case KU_TIME:
        *value = *u->now.time;
        break;
    case KU_STATE:
        *value = u->now.state[place];
        break;
    case KU_RATE:
        status = ku_know_rates(u);
        *value = u->rates[place];
        break;
    case KU_INPUT:
        *value = u->now.inputs[place];
        break;
    case KU_SIGNAL:
        status = ku_know_signals(u);
        *value = u->signals[place];
        break;
    case KU_EVENT:
        status = know_event(u, place);
        *value = event_value(u, place);
        break;
    case KU_PARAMETER:
        *value = u->now.parameters[place];
        break;
    case KU_STEP:
        *value = *u->now.step;
        break;
    case KU_IMPLICIT:
        *value = *u->now.implicit;
        break;
    default:
        return ku_say(u, KU_ERROR, "there is no variable with the value reference %u.", reference);
    }
    return status;
}

int ku_get(ku_instance *u, const unsigned *references, size_t count, double *values)
{
    for (size_t i = 0; i < count; ++i) {
        int status = get(u, references[i], &values[i]);
        if (status != KU_OK) {
            return status;
        }
    }
    return KU_OK;
}

/* Return whether a variable can be set now; report an error if not. */
static int can_be_set(const ku_instance *u, unsigned reference, double value)
{
    const km_model *m = &km_this;
    int place, setting_up = (ku_mode(u) & KU_SET_UP) != 0;
    enum ku_block block = ku_find(reference, &place);
    if (!isfinite(value)) {
        ku_say(u, KU_ERROR, "value reference %u = %g: a finite number is needed.", reference, value);
    } else if (block == KU_PARAMETER && !setting_up) {
        ku_say(u, KU_ERROR,
               "parameter %s is fixed: it can be set before initialization mode is left, not later.",
               m->parameter[place].name);
    } else if ((block == KU_STEP || block == KU_IMPLICIT) && !setting_up) {
        ku_say(u, KU_ERROR, "solver.%s can be set before initialization mode is left, not later.",
               block == KU_STEP ? "step" : "implicit");
    } else if (block == KU_STATE && !setting_up && ku_mode(u) != KU_EVENTS
               && ku_mode(u) != KU_CONTINUOUS) {
        ku_say(u, KU_ERROR, "state %s can be set before initialization mode is left, not later.",
               m->state_name[place]);
    } else if (block == KU_TIME || block == KU_RATE || block == KU_SIGNAL || block == KU_EVENT) {
        ku_say(u, KU_ERROR, "the variable with the value reference %u is computed: it cannot be set.",
               reference);
    } else if (block == KU_NOTHING) {
        ku_say(u, KU_ERROR, "there is no variable with the value reference %u.", reference);
    } else {
        return 1;
    }
    return 0;
}

/* Set a variable; return whether its value has changed. */
static int set(ku_instance *u, unsigned reference, double value)
{
    int place;
    double *at;
    enum ku_block block = ku_find(reference, &place);
    switch (block) {
    case KU_STATE:
        at = &u->now.state[place];
        *u->now.next = 0.0;
        break;
    case KU_INPUT:
        at = &u->now.inputs[place];
        break;
    case KU_PARAMETER:
        at = &u->now.parameters[place];
        *u->now.ready = 0.0;
        break;
    default:
        at = block == KU_STEP ? u->now.step : u->now.implicit;
        *u->now.ready = 0.0;
        break;
    }
    int changed = memcmp(at, &value, sizeof value) != 0;
    *at = value;
    return changed;
}

int ku_set(ku_instance *u, const unsigned *references, size_t count, const double *values)
{
    for (size_t i = 0; i < count; ++i) { /* all or none are set */
        if (!can_be_set(u, references[i], values[i])) {
            return KU_ERROR;
        }
    }
    int changed = 0;
    for (size_t i = 0; i < count; ++i) {
        changed |= set(u, references[i], values[i]);
    }
    if (changed) {
        ku_forget(u);
        ku_begin_anew(u);
    }
    return KU_OK;
}

/* -- arrays of states ------------------------------------------------------------------------- */

static int counted(const ku_instance *u, const char *what, size_t count, int expected)
{
    if (count == (size_t)expected) {
        return 1;
    }
    ku_say(u, KU_ERROR, "%s: %lu numbers are given, and there are %d.", what, (unsigned long)count, expected);
    return 0;
}

int ku_set_time(ku_instance *u, double time)
{
    if (!isfinite(time)) {
        return ku_say(u, KU_ERROR, "time = %g s: a finite number is needed.", time);
    }
    *u->now.time = time; /* it has an effect through inputs only */
    return KU_OK;
}

int ku_set_states(ku_instance *u, const double *states, size_t count)
{
    if (!counted(u, "continuous states", count, km_this.states)) {
        return KU_ERROR;
    }
    memcpy(u->now.state, states, count * sizeof *states);
    ku_forget(u);
    return KU_OK;
}

int ku_get_states(ku_instance *u, double *states, size_t count)
{
    if (!counted(u, "continuous states", count, km_this.states)) {
        return KU_ERROR;
    }
    memcpy(states, u->now.state, count * sizeof *states);
    return KU_OK;
}

int ku_get_rates(ku_instance *u, double *rates, size_t count)
{
    if (!counted(u, "derivatives", count, km_this.states)) {
        return KU_ERROR;
    }
    int status = ku_know_rates(u);
    memcpy(rates, u->rates, count * sizeof *rates);
    return status;
}

int ku_get_nominals(ku_instance *u, double *nominals, size_t count)
{
    if (!counted(u, "nominal values", count, km_this.states)) {
        return KU_ERROR;
    }
    for (size_t i = 0; i < count; ++i) {
        nominals[i] = 1.0;
    }
    return KU_OK;
}

/* -- events ----------------------------------------------------------------------------------- */

int ku_get_events(ku_instance *u, double *values, size_t count)
{
    if (!counted(u, "event indicators", count, km_this.events)) {
        return KU_ERROR;
    }
    for (size_t i = 0; i < count; ++i) {
        int status = know_event(u, (int)i);
        if (status != KU_OK) {
            return status;
        }
        values[i] = event_value(u, (int)i);
    }
    return KU_OK;
}

int ku_update(ku_instance *u, int *over)
{
    const km_model *m = &km_this;
    int status = ku_know_margins(u);
    *over = 0;
    for (int i = 0; status == KU_OK && i < m->guards; ++i) {
        if ((m->guard[i].use & KT_ACTS) && !(u->margins[i] > 0.0)) {
            *over = 1;
            ku_say(u, KU_WARNING, "the motion ends at %.9g s: %s.", *u->now.time, m->guard[i].meaning);
            return KU_OK;
        }
    }
    for (int i = 0; status == KU_OK && i < m->events; ++i) {
        status = know_event(u, i);
        double value = event_value(u, i);
        if (status == KU_OK && u->before_known && (value > 0.0) != (u->before[i] > 0.0)) {
            ku_say(u, KU_OK, "%s at %.9g s: %s.", m->event[i].name, *u->now.time, m->event[i].meaning);
        }
        u->before[i] = value;
    }
    u->before_known = status == KU_OK;
    return status;
}

/* -- saved instances -------------------------------------------------------------------------- */

/* Discard the solver's data of earlier steps, so that a motion continues as after a restored state. */
static int forget_the_way(ku_instance *u)
{
    ku_close_steps(u);
    return u->co_simulation && ku_mode(u) == KU_STEPPING ? ku_open_steps(u) : KU_OK;
}

void *ku_save(ku_instance *u, void *into)
{
    if (forget_the_way(u) != KU_OK) {
        return NULL;
    }
    size_t size = number_count() * sizeof(double);
    void *saved = into ? into : malloc(size);
    if (saved) {
        memcpy(saved, u->now.all, size);
    }
    return saved;
}

int ku_restore(ku_instance *u, const void *saved)
{
    memcpy(u->now.all, saved, number_count() * sizeof(double));
    u->before_known = u->stopped = u->way.known = 0;
    u->last_time = *u->now.time;
    ku_forget(u);
    if (!*u->now.ready) {
        return KU_OK;
    }
    *u->now.ready = 0.0; /* the constants are computed again */
    int status = ku_ready(u);
    return status == KU_OK ? forget_the_way(u) : status;
}

/* Serialised form: a mark, the token, the numbers. */
static const char MARK[8] = "kintrafo";

enum { TOKEN = 64 };

size_t ku_size(void) { return sizeof MARK + TOKEN + number_count() * sizeof(double); }

int ku_serialise(ku_instance *u, const void *saved, unsigned char *bytes, size_t size)
{
    char token[TOKEN] = {0};
    if (!saved || !bytes || size < ku_size()) {
        return ku_say(u, KU_ERROR, "serialize: %lu bytes are needed, and %lu given.",
                      (unsigned long)ku_size(), (unsigned long)size);
    }
    strncpy(token, km_token(), TOKEN - 1);
    memcpy(bytes, MARK, sizeof MARK);
    memcpy(bytes + sizeof MARK, token, TOKEN);
    memcpy(bytes + sizeof MARK + TOKEN, saved, number_count() * sizeof(double));
    return KU_OK;
}

void *ku_deserialise(ku_instance *u, const unsigned char *bytes, size_t size)
{
    size_t numbers = number_count() * sizeof(double);
    char token[TOKEN] = {0};
    strncpy(token, km_token(), TOKEN - 1);
    if (!bytes || size != ku_size() || memcmp(bytes, MARK, sizeof MARK) != 0
        || memcmp(bytes + sizeof MARK, token, TOKEN) != 0) {
        ku_say(u, KU_ERROR, "deserialize: these bytes are no saved state of this model.");
        return NULL;
    }
    double *saved = malloc(numbers);
    if (!saved) {
        ku_say(u, KU_ERROR, "deserialize: there is no memory.");
        return NULL;
    }
    memcpy(saved, bytes + sizeof MARK + TOKEN, numbers);
    int mode = saved[1] > 0.0 && saved[1] <= KU_FAILED ? (int)saved[1] : 0, damaged = 0;
    for (size_t i = 0; i < number_count(); ++i) {
        damaged |= !isfinite(saved[i]);
    }
    if (damaged || !mode || (mode & (mode - 1))) {
        ku_say(u, KU_ERROR, "deserialize: these bytes were damaged.");
        free(saved);
        return NULL;
    }
    return saved;
}
