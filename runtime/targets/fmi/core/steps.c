/* Co-Simulation: steps of a solver from one communication point to the next. */
#include "instance.h"

#include "number.h"
#include "worker.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Communication points are equal if they differ by less than this, relative to their size or in seconds. */
#define RESOLVED 1.0e-9

/* Absolute tolerance divided by the relative one. */
#define ABSOLUTE 1.0e-3

enum { MOST_STEPS = 10000000 };

const kt_solver *kt_solver_of(int method)
{
    return method == KT_RK4 ? &kt_rk4 : method == KT_RODASP ? &kt_rodasp : &kt_dormand_prince;
}

/* -- memory ----------------------------------------------------------------------------------- */

static int make_memory(ku_instance *u)
{
    const km_model *m = &km_this;
    size_t inputs = (size_t)m->inputs;
    u->splines = calloc(inputs + 1, sizeof *u->splines);
    u->breaks = calloc(2, sizeof *u->breaks);
    u->coefficients = calloc(KU_ORDERS * inputs + 1, sizeof *u->coefficients);
    u->usual = calloc((size_t)m->guards + 1, sizeof *u->usual);
    u->tolerances = calloc((size_t)m->states + 1, sizeof *u->tolerances);
    u->courses = calloc(inputs + 1, sizeof *u->courses);
    return u->splines && u->breaks && u->coefficients && u->usual && u->tolerances && u->courses;
}

static void find_courses(ku_instance *u);

static int method_of(const ku_instance *u)
{
    if (*u->now.step == 0.0) {
        return KT_DORMAND_PRINCE;
    }
    return *u->now.implicit == 0.0 ? KT_RK4 : KT_RODASP;
}

int ku_open_steps(ku_instance *u)
{
    const km_model *m = &km_this;
    ku_close_steps(u);
    if (!make_memory(u)) {
        return ku_say(u, KU_ERROR, "there is no memory for the solver.");
    }
    ku_usual_margins(u, u->usual);
    find_courses(u);
    if (!m->states) {
        return KU_OK;
    }
    for (int i = 0; i < m->states; ++i) {
        u->tolerances[i] = ABSOLUTE * *u->now.tolerance;
    }
    u->problem = (kt_problem){
        .rhs = m->rates, .jacobian = m->jacobian, .signals = m->signals_of, .margins = m->margins,
        .state_count = m->states, .input_count = m->inputs, .signal_count = m->signals,
        .position_count = m->positions, .speed_count = m->speeds,
        .constants = u->constants, .inputs = u->now.inputs, .splines = u->splines,
        .guard_count = m->guards, .guards = m->guard_use, .usual_margins = u->usual,
        .spline_count = m->inputs,
    };
    u->options = (kt_options){
        .method = method_of(u),
        .rtol = *u->now.tolerance, .atol = u->tolerances, .max_step = *u->now.step,
        .max_steps = MOST_STEPS,
    };
    u->motion = kt_open_motion(&u->problem, &u->options, u->now.state, 1.0, &u->result);
    return u->motion ? KU_OK : ku_say(u, KU_ERROR, "there is no memory for the solver.");
}

void ku_close_steps(ku_instance *u)
{
    kt_close_motion(u->motion);
    kt_free(&u->result);
    u->motion = NULL;
    free(u->splines);
    free(u->breaks);
    free(u->coefficients);
    free(u->usual);
    free(u->tolerances);
    free(u->courses);
    u->courses = NULL;
    u->course_count = 0;
    u->splines = NULL;
    u->breaks = u->coefficients = u->usual = u->tolerances = NULL;
}

/* -- inputs within a step --------------------------------------------------------------------- */

/* Return the index of the input that is the derivative of another one; -1: none. */
static int rate_of(int input)
{
    const km_model *m = &km_this;
    for (int i = 0; i < m->inputs; ++i) {
        if (m->input[i].derivative_of == input) {
            return i;
        }
    }
    return -1;
}

/* Return the place of a derivative of an input: an input of its own, or a slope; NULL beyond those. */
static double *derivative_at(ku_instance *u, int input, int order)
{
    int base = input;
    for (int k = 0; k < order; ++k) {
        int rate = rate_of(base);
        if (rate < 0) {
            int left = order - k;
            return left < KU_ORDERS ? &u->now.slopes[(left - 1) * km_this.inputs + base] : NULL;
        }
        base = rate;
    }
    return &u->now.inputs[base];
}

/* Note the inputs that are no derivatives, and the places of their derivatives. */
static void find_courses(ku_instance *u)
{
    const km_model *m = &km_this;
    u->course_count = 0;
    for (int i = 0; i < m->inputs; ++i) {
        if (m->input[i].derivative_of >= 0) {
            continue;
        }
        ku_course *c = &u->courses[u->course_count++];
        int first = rate_of(i);
        *c = (ku_course){.targets = {i, first, first < 0 ? -1 : rate_of(first)}};
        for (int order = 0; order < KU_ORDERS; ++order) {
            c->at[order] = derivative_at(u, i, order);
        }
    }
}

int ku_set_slopes(ku_instance *u, const unsigned *references, size_t count, const int *orders,
                  const double *values)
{
    for (size_t i = 0; i < count; ++i) {
        int place;
        if (ku_find(references[i], &place) != KU_INPUT) {
            return ku_say(u, KU_ERROR, "the variable with the value reference %u is no input.", references[i]);
        }
        if (orders[i] < 1 || orders[i] >= KU_ORDERS) {
            return ku_say(u, KU_ERROR, "a derivative of order %d of %s: 1 to %d are possible.", orders[i],
                          km_this.input[place].name, KU_ORDERS - 1);
        }
        if (!isfinite(values[i])) {
            return ku_say(u, KU_ERROR, "a derivative of %s = %g: a finite number is needed.",
                          km_this.input[place].name, values[i]);
        }
    }
    for (size_t i = 0; i < count; ++i) {
        int place;
        ku_find(references[i], &place);
        double *at = derivative_at(u, place, orders[i]);
        if (at) {
            *at = values[i];
        }
    }
    ku_forget(u);
    return KU_OK;
}

/* Read the derivatives of an input at the beginning of a step; return whether any is not zero. */
static int derivatives_of(const ku_course *c, double *found)
{
    int moves = 0;
    for (int order = 0; order < KU_ORDERS; ++order) {
        found[order] = c->at[order] ? *c->at[order] : 0.0;
        moves |= order && found[order] != 0.0;
    }
    return moves;
}

/* Extrapolate inputs with their known derivatives, by polynomials over the step. */
static void lay_splines(ku_instance *u, double time, double end)
{
    int count = 0;
    u->breaks[0] = time;
    u->breaks[1] = end;
    for (int i = 0; i < u->course_count; ++i) {
        const ku_course *course = &u->courses[i];
        double d[KU_ORDERS], *c = u->coefficients + KU_ORDERS * count;
        if (!derivatives_of(course, d)) {
            continue;
        }
        c[0] = d[3] / 6.0;
        c[1] = 0.5 * d[2];
        c[2] = d[1];
        c[3] = d[0];
        u->splines[count++] = (kt_spline){
            1, u->breaks, c, {course->targets[0], course->targets[1], course->targets[2]},
        };
    }
    u->problem.spline_count = count;
}

/* Set the inputs to their values at a time. */
static void move_inputs(ku_instance *u, double length)
{
    for (int i = 0; u->problem.spline_count && i < u->course_count; ++i) {
        const ku_course *course = &u->courses[i];
        double d[KU_ORDERS];
        if (!derivatives_of(course, d)) {
            continue;
        }
        for (int order = 0; order < KU_ORDERS; ++order) {
            double value = 0.0;
            for (int k = KU_ORDERS - 1; k >= order; --k) { /* Horner: d[k] h^(k - order) / (k - order)! */
                value = d[k] + value * length / (k - order + 1);
            }
            if (course->at[order]) {
                *course->at[order] = value;
            }
        }
    }
}

/* -- a step ----------------------------------------------------------------------------------- */

static int explain(ku_instance *u, int outcome)
{
    const km_model *m = &km_this;
    const kt_result *r = &u->result;
    double time = *u->now.time;
    if (outcome == KT_STATE && r->refused_guard >= 0) {
        return ku_say(u, KU_DISCARD, "the motion ends at %.9g s: %s.", r->refused_time,
                      m->guard[r->refused_guard].meaning);
    }
    if (outcome == KT_STATE) {
        for (int i = 0; i < m->states; ++i) {
            u->now.state[i] = r->refused_state[i];
        }
        int status = ku_refused(u, "the step", r->refused_status);
        for (int i = 0; i < m->states; ++i) {
            u->now.state[i] = r->state[i];
        }
        return status;
    }
    if (outcome == KT_UNSTABLE) {
        return ku_say(u, KU_DISCARD,
                      "solver.step = %g s is too long for stability at %.9g s: give %.3g s or less, or set "
                      "solver.implicit to 1.", *u->now.step, time, r->longest_step);
    }
    if (outcome == KT_JUMPS || outcome == KT_SINGULAR_STEP) {
        return ku_say(u, KU_DISCARD,
                      "solver.implicit = 1 does not suit the motion at %.9g s: %s. Set solver.implicit to 0 and "
                      "shorten solver.step, or set both to 0.", time,
                      outcome == KT_JUMPS ? "rates jump to and fro within its steps"
                                          : "the linear equations of a step have no unique solution");
    }
    if (outcome == KT_TOO_MANY_STEPS) {
        return ku_say(u, KU_DISCARD, "the solver has taken %d steps, the most of one communication step.",
                      (int)MOST_STEPS);
    }
    if (outcome == KT_MEMORY) {
        return ku_say(u, KU_ERROR, "there is no memory for the solver.");
    }
    return ku_say(u, KU_DISCARD, "the steps of the solver have become too small at %.9g s.", time);
}

/* Integrate the states over a step; the time that was reached is noted. */
static int integrate(ku_instance *u, double end)
{
    const double times[2] = {*u->now.time, end};
    /* the fixed step, or the planned first one */
    u->options.first_step = *u->now.step > 0.0 ? *u->now.step : *u->now.next;
    int outcome = kt_advance(u->motion, u->now.state, u->now.inputs, times);
    *u->now.time = u->result.time;
    memcpy(u->now.state, u->result.state, (size_t)km_this.states * sizeof *u->now.state);
    *u->now.next = kt_next_step(u->motion);
    return outcome;
}

/* Start the next step without data of the last one. */
void ku_begin_anew(ku_instance *u) { u->result.output.rows = 0; }

int ku_step(ku_instance *u, double time, double length)
{
    double now = *u->now.time;
    if (!(fabs(time - now) <= RESOLVED * greater(1.0, fabs(now)))) {
        return ku_say(u, KU_ERROR, "the step begins at %.12g s, and the instance is at %.12g s.", time, now);
    }
    if (!(length > 0.0 && isfinite(length) && time + length > now)) {
        return ku_say(u, KU_ERROR, "a step of %g s: a finite number above 0 s is needed.", length);
    }
    if (u->stopped) {
        return ku_say(u, KU_DISCARD, "the motion has ended at %.9g s. Reset the instance, or go back.", now);
    }
    double end = time + length;
    int outcome = KT_DONE;
    lay_splines(u, now, end);
    if (km_this.states) {
        outcome = integrate(u, end);
    } else {
        *u->now.time = end;
    }
    move_inputs(u, *u->now.time - now);
    u->last_time = *u->now.time;
    ku_forget(u);
    if (outcome == KT_DONE) {
        return KU_OK;
    }
    u->stopped = outcome == KT_STATE;
    return explain(u, outcome);
}
