/*
 * Model Exchange: dead points that a step of the importer has passed.
 *
 * margins.h explains them: a height, the root of a margin, passes zero with its speed, and the equations, which
 * contain only its square, continue with the reflected motion: the height rises again at once. A motion that turns
 * before zero has been accelerated, and the accelerations at both ends of the step show by how much. A change of
 * speed that they do not explain is a dead point.
 */
#include "instance.h"

#include "trust.h"

#include <math.h>
#include <string.h>

/* Most change of speed in a turn, relative to the one explained by the greater of both accelerations. */
#define EXPLAINED 1.5

/* Longest time of a height to zero at its speed, relative to the step, if zero may be within the step. */
#define WITHIN 8.0

typedef struct {
    double height, speed, acceleration;
} ku_height;

static int is_singular(int guard) { return (km_this.guard[guard].use & KT_SINGULAR) != 0; }

static int any_singular(void)
{
    for (int i = 0; i < km_this.guards; ++i) {
        if (is_singular(i)) {
            return 1;
        }
    }
    return 0;
}

/* Advance inputs whose rates are inputs. */
static void move_inputs(double lapse, double *inputs)
{
    const km_model *m = &km_this;
    for (int i = 0; i < m->inputs; ++i) {
        if (m->input[i].derivative_of >= 0) {
            inputs[m->input[i].derivative_of] += lapse * inputs[i];
        }
    }
}

/* Compute the state after a lapse with some rates, and the margins there. */
static void put_ahead(ku_instance *u, double lapse, const double *state, const double *rates, double *margins)
{
    const km_model *m = &km_this;
    for (int i = 0; i < m->states; ++i) {
        u->way.ahead[i] = state[i] + lapse * rates[i];
    }
    m->margins(u->constants, u->way.ahead, u->way.inputs_ahead, margins);
}

/*
 * Evaluate the margins of a point and of the motion after one lapse and two; return whether the model accepts them.
 * Heun's rule and the midpoint rule are exact for constant accelerations, also at rest.
 */
static int look(ku_instance *u, double lapse, const double *state, const double *inputs, double *margins)
{
    const km_model *m = &km_this;
    double *first = u->way.rates, *second = u->way.rates_ahead;
    memcpy(u->way.inputs_ahead, inputs, (size_t)m->inputs * sizeof *inputs);
    m->margins(u->constants, state, inputs, margins);
    int word = m->rates(u->constants, state, inputs, first);
    move_inputs(lapse, u->way.inputs_ahead);
    put_ahead(u, lapse, state, first, margins + m->guards); /* for the rates there */
    word |= m->rates(u->constants, u->way.ahead, u->way.inputs_ahead, second);
    for (int i = 0; i < m->states; ++i) {
        first[i] = 0.5 * (first[i] + second[i]);
    }
    put_ahead(u, lapse, state, first, margins + m->guards);
    move_inputs(lapse, u->way.inputs_ahead);
    put_ahead(u, 2.0 * lapse, state, second, margins + 2 * m->guards);
    return !word;
}

/* Return the height of a margin with its speed and acceleration, from its values at three points. */
static ku_height height_of(const double *margins, int guard, double lapse)
{
    double now = margins[guard], next = margins[km_this.guards + guard], last = margins[2 * km_this.guards + guard];
    double second = (last - 2.0 * next + now) / (lapse * lapse);
    double first = (next - now) / lapse - 0.5 * lapse * second;
    double height = sqrt(fmax(now, 0.0)), speed = 0.5 * first / height;
    return (ku_height){height, speed, (0.5 * second - speed * speed) / height};
}

/*
 * Return whether a motion that begins at rest near zero has passed it: its speed is zero where the step begins, but
 * with its acceleration the height is zero within the step. Beyond zero the true height is negative, so that speed and
 * acceleration at the end have the other sign. It has passed zero if these explain the change of the speed better.
 */
static int fell(ku_height before, ku_height now, double step)
{
    double ahead = before.height + step * (before.speed + 0.5 * step * before.acceleration);
    double as_turned = now.speed - before.speed - 0.5 * step * (before.acceleration + now.acceleration);
    double as_passed = -now.speed - before.speed - 0.5 * step * (before.acceleration - now.acceleration);
    return ahead < 0.0 && now.speed > 0.0 && fabs(as_passed) < fabs(as_turned);
}

static int passed(ku_height before, ku_height now, double step)
{
    int near = before.speed < 0.0 && before.height < -WITHIN * step * before.speed;
    double greater = fmax(fmax(before.acceleration, now.acceleration), 0.0);
    return (near && now.speed - before.speed > EXPLAINED * step * greater) || fell(before, now, step);
}

void ku_usual_margins(ku_instance *u, double *usual)
{
    const km_model *m = &km_this;
    memset(u->way.inputs_ahead, 0, (size_t)m->inputs * sizeof *u->way.inputs_ahead);
    m->design_state(u->now.parameters, u->way.ahead);
    m->margins(u->constants, u->way.ahead, u->way.inputs_ahead, usual);
    for (int i = 0; i < m->guards; ++i) {
        usual[i] = isfinite(usual[i]) ? fabs(usual[i]) : 0.0;
    }
}

/* Store the point from which the motion continues. */
void ku_mark(ku_instance *u)
{
    const km_model *m = &km_this;
    u->way.time = *u->now.time;
    memcpy(u->way.state, u->now.state, (size_t)m->states * sizeof *u->now.state);
    memcpy(u->way.inputs, u->now.inputs, (size_t)m->inputs * sizeof *u->now.inputs);
    u->way.known = u->way.begins = 1;
}

/* Return whether a step has passed the dead point of a guard, or the motion begins in it, and report that. */
static int ended(const ku_instance *u, int guard, const double *before, const double *now, double lapse, double step)
{
    const char *meaning = km_this.guard[guard].meaning;
    if (u->way.begins && !(before[guard] > KT_NOTHING * u->way.usual[guard])) {
        ku_say(u, KU_WARNING, "the motion begins in a dead point: %s. Begin beside it, or use Co-Simulation.", meaning);
        return 1;
    }
    if (!passed(height_of(before, guard, lapse), height_of(now, guard, lapse), step)) {
        return 0;
    }
    ku_say(u, KU_WARNING, "the motion ends between %.9g s and %.9g s: %s.", u->way.time, *u->now.time, meaning);
    return 1;
}

int ku_completed(ku_instance *u, int *over)
{
    const km_model *m = &km_this;
    int status = ku_ready(u);
    double step = *u->now.time - u->way.time, lapse = KT_LAPSE * step;
    double *before = u->way.margins, *now = u->way.margins + 3 * m->guards;
    *over = 0;
    if (status != KU_OK || !any_singular()) {
        return status;
    }
    if (u->way.begins) {
        ku_usual_margins(u, u->way.usual);
    }
    if (u->way.known && step > 0.0 && look(u, lapse, u->now.state, u->now.inputs, now)
        && look(u, lapse, u->way.state, u->way.inputs, before)) {
        for (int i = 0; i < m->guards && !*over; ++i) {
            *over = is_singular(i) && ended(u, i, before, now, lapse, step);
        }
    }
    ku_mark(u);
    u->way.begins = 0;
    return KU_OK;
}
