/* Every method of the native solver over a motion of the strut, and a loop that does not close.
 *
 * Macros that begin with GIVEN are defined on the command line. */
#include "integrate.h"
#include "macpherson.h"
#include <stdlib.h>

static int root(double time, const double *state, double *out, void *data)
{
    (void)time, (void)data;
    out[0] = state[0] - 1.6;
    return 0;
}

int main(void)
{
    double parameters[MACPHERSON_PARAMETER_COUNT] = {GIVEN_PARAMETERS};
    double constants[MACPHERSON_CONSTANT_COUNT];
    if (macpherson_prepare(parameters, constants)) return 1;
    double inputs[MACPHERSON_INPUT_COUNT] = {0}, atol[4] = {1e-9, 1e-9, 1e-9, 1e-9};
    double breaks[3] = {0.0, 0.5, 1.0};
    double coefficients[8] = {0.01, 0.0, 0.0, 0.01, 0.0, 0.01, 0.0, 0.0};
    kt_spline spline = {2, breaks, coefficients,
                        {MACPHERSON_INPUT_RACK_POSITION, MACPHERSON_INPUT_RACK_VELOCITY,
                          MACPHERSON_INPUT_RACK_ACCELERATION}};
    kt_event event = {MACPHERSON_SIGNAL_TYRE_FORCE, 0.0};
    int directions[2] = {0, 0}, terminal[2] = {0, 0}, guards[] = {GIVEN_GUARDS};
    double usual_margins[] = {GIVEN_MARGINS};
    kt_problem problem = {
        .rhs = macpherson_rhs, .jacobian = macpherson_rhs_jacobian, .signals = macpherson_signals,
        .margins = macpherson_margins, .guard_count = GIVEN_GUARD_COUNT, .guards = guards,
        .usual_margins = usual_margins,
        .state_count = 4, .input_count = MACPHERSON_INPUT_COUNT,
        .signal_count = MACPHERSON_SIGNAL_COUNT, .constants = constants, .inputs = inputs,
        .spline_count = 1, .splines = &spline, .event_count = 1, .events = &event, .root_count = 1,
        .roots = root, .directions = directions, .terminal = terminal};
    double state[4] = {GIVEN_STATE}, times[101];
    for (int i = 0; i < 101; ++i) times[i] = 0.01 * i;
    for (int method = KT_BDF; method <= KT_RUNGE_KUTTA; ++method) {
        for (int every_step = 0; every_step < 2; ++every_step) {
            for (long max_steps = 5; max_steps < 1000000; max_steps *= 1000) {
                kt_options options = {.method = method, .table = "ARKODE_VERNER_8_5_6",
                                      .rtol = 1e-6, .atol = atol, .max_steps = max_steps,
                                      .max_step = method == KT_RK4 || method == KT_RODASP
                                          ? 1e-3 : 0.0,
                                      .stop_at_outputs = !every_step, .dense = 1};
                kt_result result;
                int outcome = kt_integrate(&problem, &options, state, times, 101, every_step,
                                           &result);
                if (outcome != KT_DONE && outcome != KT_TOO_MANY_STEPS) return 2 + outcome;
                kt_free(&result);
            }
        }
    }
    inputs[MACPHERSON_INPUT_STRUT_FORCE] = -1e6; /* a loop that will not close */
    kt_options options = {.method = KT_BDF, .rtol = 1e-6, .atol = atol, .max_steps = 100000};
    kt_result result;
    int outcome = kt_integrate(&problem, &options, state, times, 101, 1, &result);
    kt_free(&result);
    return outcome == KT_STATE ? 0 : 1;
}
