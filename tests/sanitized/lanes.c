/* An ensemble in two lanes, with lanes that end early: by parameters, and at a dead point.
 *
 * Macros that begin with GIVEN are defined on the command line. */
#include "ensemble.h"
#define KINTRAFO_LANES /* its functions are declared below, as of vectors */
#include "macpherson.h"
#include <stdlib.h>

typedef double pair __attribute__((vector_size(16)));
typedef long long words __attribute__((vector_size(16)));
#define FUNCTION(name) words in_lanes_##name(const pair *, const pair *, const pair *, pair *);
FUNCTION(rhs) FUNCTION(signals) FUNCTION(margins)
words in_lanes_prepare(const pair *, pair *), in_lanes_design_state(const pair *, pair *);

enum { SYSTEMS = 7, STATES = 4, TIMES = 11, GUARDS = GIVEN_GUARD_COUNT };

static void *exactly(size_t count, size_t size)
{
    return calloc(count, size); /* so that one element too far is seen */
}

int main(void)
{
    double parameters[MACPHERSON_PARAMETER_COUNT] = {GIVEN_PARAMETERS};
    int varied[1] = {MACPHERSON_PARAMETER_DAMPER_RATE}, guards[GUARDS] = {GIVEN_GUARDS};
    double *variants = exactly(SYSTEMS, 8), *states = exactly(SYSTEMS * STATES, 8);
    double *inputs = exactly(SYSTEMS * MACPHERSON_INPUT_COUNT, 8);
    double start[STATES] = {GIVEN_STATE}, times[TIMES], weights[TIMES], atol[STATES];
    int drive_of[SYSTEMS];
    for (int i = 0; i < SYSTEMS; ++i) {
        variants[i] = i == 4 ? 0.0 / 0.0 : 1000.0 + 100.0 * i;
        drive_of[i] = i % 2;
        for (int k = 0; k < STATES; ++k) states[STATES * i + k] = start[k];
    }
    inputs[3 * MACPHERSON_INPUT_COUNT + MACPHERSON_INPUT_STRUT_FORCE] = -1e6;
    for (int i = 0; i < STATES; ++i) atol[i] = 1e-9;
    for (int i = 0; i < TIMES; ++i) times[i] = 0.05 * i, weights[i] = 0.05;
    double breaks[3] = {0.0, 0.2, 0.5}, milestones[1] = {0.2}, reaches[1] = {1e-3};
    double coefficients[8] = {0.01, 0.0, 0.0, 0.01, 0.0, 0.01, 0.0, 0.0};
    kt_course course = {2, breaks, coefficients};
    kt_segment whole = {0.5, &course, 0, milestones, 1, milestones, reaches};
    kt_segment halves[2] = {{0.3, &course, 1, milestones, 0, milestones, reaches},
                              {0.5, &course, 0, milestones, 0, milestones, reaches}};
    kt_drive drives[2] = {{1, &whole}, {2, halves}};
    int targets[3] = {MACPHERSON_INPUT_RACK_POSITION, MACPHERSON_INPUT_RACK_VELOCITY,
                      MACPHERSON_INPUT_RACK_ACCELERATION};
    int items[2] = {MACPHERSON_SIGNAL_TYRE_FORCE, MACPHERSON_SIGNAL_COUNT + 1};
    kt_reduction reductions[4] = {{0, KT_GREATEST, 0, 0.0}, {0, KT_FIRST, 0, 0.0},
                                  {0, KT_SQUARES, 1, 0.0}, {1, KT_ABOVE, 0, 1.0}};
    int bounds[1] = {MACPHERSON_SIGNAL_TYRE_FORCE}, above[1] = {0};
    double limits[1] = {3000.0};
    kt_problem problem = {
        .prepare = in_lanes_prepare, .design_state = in_lanes_design_state, .rhs = in_lanes_rhs,
        .signals = in_lanes_signals, .margins = in_lanes_margins,
        .parameter_count = MACPHERSON_PARAMETER_COUNT, .constant_count = MACPHERSON_CONSTANT_COUNT,
        .state_count = STATES, .position_count = STATES / 2,
        .input_count = MACPHERSON_INPUT_COUNT, .signal_count = MACPHERSON_SIGNAL_COUNT,
        .guard_count = GUARDS, .guards = guards,
        .parameters = parameters, .varied_count = 1, .varied = varied, .variants = variants,
        .states = states, .state_stride = STATES, .inputs = inputs,
        .input_stride = MACPHERSON_INPUT_COUNT, .drives = drives, .drive_of = drive_of,
        .course_count = 1, .targets = targets, .start = 0.0, .end = 0.5, .time_count = TIMES,
        .times = times, .rtol = 1e-6, .atol = atol, .max_step = 1.0, .max_steps = 1000,
        .items = items, .sample_count = 2, .samples = exactly(SYSTEMS * 2 * TIMES, 8),
        .reduction_count = 4, .reductions = reductions, .weights = weights,
        .reduced = exactly(SYSTEMS * 4, 8), .bound_count = 1, .bound_items = bounds,
        .above = above, .limits = limits, .beyond = exactly(SYSTEMS, 8),
        .ends = exactly(SYSTEMS, sizeof(int)), .codes = exactly(SYSTEMS, sizeof(int)),
        .ended = exactly(SYSTEMS, 8), .finals = exactly(SYSTEMS * STATES, 8),
        .steps = exactly(SYSTEMS, sizeof(long))};
    const int go_on = 0;
    if (kt_integrate_2(&problem, 0, SYSTEMS, &go_on) || kt_widest() < 2) return 1;
    int wrong = 0;
    for (int i = 0; i < SYSTEMS; ++i) {
        int expected = i == 3 ? KT_DEAD_POINT : i == 4 ? KT_PARAMETERS : KT_DONE;
        wrong |= problem.ends[i] != expected;
    }
    free(variants), free(states), free(inputs), free(problem.samples), free(problem.reduced);
    free(problem.beyond), free(problem.ends), free(problem.codes), free(problem.ended);
    free(problem.finals), free(problem.steps);
    return wrong;
}
