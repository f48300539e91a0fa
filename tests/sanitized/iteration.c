/* A block that iterates, in two lanes: one closes, and one cannot.
 *
 * Macros that begin with GIVEN are defined on the command line. */
#define KINTRAFO_LANES /* its functions are declared below, as of vectors */
#include "five_bar.h"
#include <stdlib.h>

typedef double pair __attribute__((vector_size(16)));
typedef long long words __attribute__((vector_size(16)));
words in_lanes_rhs(const pair *, const pair *, const pair *, pair *);
words in_lanes_prepare(const pair *, pair *), in_lanes_design_state(const pair *, pair *);

static pair *exactly(size_t count)
{
    return aligned_alloc(16, 16 * count); /* so that one element too far is seen */
}

int main(void)
{
    pair *parameters = exactly(FIVE_BAR_PARAMETER_COUNT), *out = exactly(FIVE_BAR_STATE_COUNT);
    pair *constants = exactly(FIVE_BAR_CONSTANT_COUNT), *state = exactly(FIVE_BAR_STATE_COUNT);
    pair *inputs = exactly(FIVE_BAR_INPUT_COUNT);
    for (int i = 0; i < FIVE_BAR_INPUT_COUNT; ++i) inputs[i] = (pair){0.0};
    const double values[] = {GIVEN_PARAMETERS};
    for (int i = 0; i < FIVE_BAR_PARAMETER_COUNT; ++i) parameters[i] = values[i] + (pair){0.0};
    words failed = in_lanes_prepare(parameters, constants);
    in_lanes_design_state(parameters, state);
    state[0] += (pair){0.05, 7.0}; /* the first lane is within reach, the second is not, after a whole turn */
    words status = in_lanes_rhs(constants, state, inputs, out);
    free(parameters), free(out), free(constants), free(state), free(inputs);
    return failed[0] || failed[1] || status[0] || !status[1];
}
