/* y' = c y: derivatives with respect to c in the first direction, twice of them in the second, those with
 * respect to the start in the third; the fourth is infinite. */
#include "directions.h"
#include <math.h>
#include <stdlib.h>

typedef double pair __attribute__((vector_size(16)));
typedef long long words __attribute__((vector_size(16)));
enum { STEPS = 8, STAGES = 7, TIMES = 3, DIRECTIONS = 4 };

static words rates(const pair *c, const pair *y, const pair *inputs, pair *out)
{
    (void)inputs;
    out[0] = c[1] * y[0] + c[0] * y[1];
    return ~(out[0] - out[0] == 0.0);
}

static words doubled(const pair *c, const pair *y, const pair *inputs, pair *out)
{
    (void)c, (void)inputs;
    out[0] = 2.0 * y[1];
    return (words){0};
}

static double *exactly(size_t count)
{
    return calloc(count, sizeof(double)); /* so that one element too far is seen */
}

int main(void)
{
    const double nodes[STAGES] = {0.0, 0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0}, c[1] = {-0.5};
    double *lengths = exactly(STEPS), *states = exactly(STEPS * STAGES);
    for (int i = 0; i < STEPS; ++i) {
        lengths[i] = 1.0 / STEPS;
        for (int s = 0; s < STAGES; ++s)
            states[STAGES * i + s] = exp(c[0] * (i + nodes[s]) / STEPS);
    }
    /* at the start, and at the ends of the fourth and the last step */
    long step_of[TIMES] = {0, 3, STEPS - 1};
    const double step[STAGES] = {35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0,
                                 -2187.0 / 6784.0, 11.0 / 84.0, 0.0};
    double *weights = exactly(TIMES * STAGES), *there = exactly(TIMES), *none = exactly(0);
    for (int i = STAGES; i < TIMES * STAGES; ++i) weights[i] = step[i % STAGES];
    int restarts[STEPS] = {1};
    double of_constants[DIRECTIONS] = {1.0, 2.0, 0.0, INFINITY};
    double of_start[DIRECTIONS] = {0.0, 0.0, 1.0, 0.0};
    int items[2] = {0, 1};
    kt_motion motion = {
        .rhs_tangent = rates, .signals_tangent = doubled, .constant_count = 1, .state_count = 1,
        .signal_count = 1, .constants = c, .step_count = STEPS, .lengths = lengths,
        .restarts = restarts, .states = states, .inputs = none, .time_count = TIMES, .step_of = step_of,
        .weights = weights, .states_there = there, .inputs_there = none, .item_count = 2,
        .items = items, .of_constants = of_constants, .of_start = of_start, .of_inputs = none,
        .found = exactly(DIRECTIONS * TIMES * 2)};
    if (kt_follow_2(&motion, 0, 3) || kt_follow_2(&motion, 2, DIRECTIONS) != 2) return 1;
    double wrong = 0.0;
    const double times[TIMES] = {0.0, 0.5, 1.0};
    for (int i = 0; i < TIMES; ++i) {
        double grown = exp(c[0] * times[i]), exact[3] = {times[i], 2.0 * times[i], 1.0};
        for (int k = 0; k < 3; ++k) {
            const double *found = motion.found + 2 * (TIMES * k + i);
            wrong = fmax(wrong, fabs(found[1] - exact[k] * grown));
            wrong = fmax(wrong, fabs(found[0] - 2.0 * found[1]));
        }
    }
    free(lengths), free(states), free(weights), free(there), free(none), free(motion.found);
    return wrong > 1e-9; /* steps of 1/8 to the fifth power, over some thousands */
}
