/*
 * Model Exchange: whether a step of the importer has passed a dead point.
 *
 * margins.h says what that is: a height, the root of a margin, passes zero with its speed, and the equations, which
 * know its square alone, go on with the reflected motion: the height rises again at once. Where a motion turns before
 * zero, it has been accelerated, and the accelerations at both ends of the step say by how much. A change of
 * speed that they do not explain is a dead point.
 */
#include "unit.h"

#include "trust.h"

#include <math.h>
#include <string.h>

/* How many times as much as the greater of both accelerations explains a speed may change in a turn. */
#define EXPLAINED 1.5

/* How many times the step a height takes to zero at its speed, at most, where zero may be within the step. */
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

/* Move states, and inputs whose rates are inputs, along the motion; return the status word of the rates. */
static int move(unit *u, double lapse, double *state, double *inputs)
{
    const km_model *m = &km_this;
    int word = m->rates(u->constants, state, inputs, u->way.rates);
    for (int i = 0; i < m->states; ++i) {
        state[i] += lapse * u->way.rates[i];
    }
    for (int i = 0; i < m->inputs; ++i) {
        if (m->input[i].derivative_of >= 0) {
            inputs[m->input[i].derivative_of] += lapse * inputs[i];
        }
    }
    return word;
}

/* Evaluate the margins of a point and of the two points that follow; return whether there are any. */
static int look(unit *u, double lapse, const double *state, const double *inputs, double *margins)
{
    const km_model *m = &km_this;
    int word = 0;
    memcpy(u->way.ahead, state, (size_t)m->states * sizeof *state);
    memcpy(u->way.inputs_ahead, inputs, (size_t)m->inputs * sizeof *inputs);
    for (int k = 0; k < 3 && !word; ++k) {
        m->margins(u->constants, u->way.ahead, u->way.inputs_ahead, margins + k * m->guards);
        word = k < 2 ? move(u, lapse, u->way.ahead, u->way.inputs_ahead) : 0;
    }
    return !word;
}

/* Return the height of a margin, and how it moves, from its values at three points. */
static ku_height height_of(const double *margins, int guard, double lapse)
{
    double now = margins[guard], next = margins[km_this.guards + guard], last = margins[2 * km_this.guards + guard];
    double second = (last - 2.0 * next + now) / (lapse * lapse);
    double first = (next - now) / lapse - 0.5 * lapse * second;
    double height = sqrt(fmax(now, 0.0)), speed = 0.5 * first / height;
    return (ku_height){height, speed, (0.5 * second - speed * speed) / height};
}

static int passed(ku_height before, ku_height now, double step)
{
    int near = before.speed < 0.0 && before.height < -WITHIN * step * before.speed;
    double greater = fmax(fmax(before.acceleration, now.acceleration), 0.0);
    return near && now.speed - before.speed > EXPLAINED * step * greater;
}

/* Remember where the way goes on from. */
void ku_mark(unit *u)
{
    const km_model *m = &km_this;
    u->way.time = *u->now.time;
    memcpy(u->way.state, u->now.state, (size_t)m->states * sizeof *u->now.state);
    memcpy(u->way.inputs, u->now.inputs, (size_t)m->inputs * sizeof *u->now.inputs);
    u->way.known = 1;
}

int ku_completed(unit *u, int *over)
{
    const km_model *m = &km_this;
    int status = ku_ready(u);
    double step = *u->now.time - u->way.time, lapse = KT_LAPSE * step;
    double *before = u->way.margins, *now = u->way.margins + 3 * m->guards;
    *over = 0;
    if (status != KU_OK || !any_singular()) {
        return status;
    }
    if (u->way.known && step > 0.0 && look(u, lapse, u->now.state, u->now.inputs, now)
        && look(u, lapse, u->way.state, u->way.inputs, before)) {
        for (int i = 0; i < m->guards && !*over; ++i) {
            *over = is_singular(i) && passed(height_of(before, i, lapse), height_of(now, i, lapse), step);
            if (*over) {
                ku_say(u, KU_WARNING, "the motion ends between %.9g s and %.9g s: %s.", u->way.time,
                       *u->now.time, m->guard[i].meaning);
            }
        }
    }
    ku_mark(u);
    return KU_OK;
}
