/* Every function of the model with all laws of force, over states that it reaches and others.
 *
 * Macros that begin with GIVEN are defined on the command line: for each function CALL(name, results). */
#include "macpherson_general.h"
#include <stdlib.h>
#include <string.h>

enum {
    PARAMETERS = MACPHERSON_GENERAL_PARAMETER_COUNT,
    CONSTANTS = MACPHERSON_GENERAL_CONSTANT_COUNT,
    STATES = MACPHERSON_GENERAL_STATE_COUNT,
    INPUTS = MACPHERSON_GENERAL_INPUT_COUNT
};

#define CALL(name, results)                                                           \
    {                                                                                 \
        double *out = exactly(results);                                               \
        status |= macpherson_general_##name(constants, state, inputs, out);           \
        free(out);                                                                    \
    }

static double *exactly(size_t count)
{
    return malloc(count * sizeof(double)); /* so that one element too far is seen */
}

int main(void)
{
    static const double values[PARAMETERS] = {GIVEN_PARAMETERS};
    double *parameters = exactly(PARAMETERS), *constants = exactly(CONSTANTS);
    double *state = exactly(STATES), *inputs = exactly(INPUTS);
    int status = 0;
    memcpy(parameters, values, sizeof values);
    if (macpherson_general_prepare(parameters, constants)) return 1;
    for (int trial = 0; trial < 200; ++trial) {
        for (int i = 0; i < STATES; ++i) state[i] = i == 0 ? 1.2 + 0.005 * trial : 0.1 * i;
        for (int i = 0; i < INPUTS; ++i) inputs[i] = 0.001 * trial;
        GIVEN_CALLS
    }
    free(parameters), free(constants), free(state), free(inputs);
    return status == -1;
}
