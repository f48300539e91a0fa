/* What tests call of the headers for lanes, and of models in lanes: through pointers to numbers. */
#define KINTRAFO_LANES
#include "vectors.h"

#include "elementary.h"
#include "../native/powers.h"

typedef bits (*of_two)(const real *parameters, real *out);
typedef bits (*of_three)(const real *constants, const real *state, const real *inputs, real *out);

void call_two(of_two function, const real *parameters, real *out, bits *status)
{
    *status = function(parameters, out);
}

void call_three(of_three function, const real *constants, const real *state, const real *inputs,
                real *out, bits *status)
{
    *status = function(constants, state, inputs, out);
}

/* The functions of one lane. */
double lane_sin(double x) { return kt_sine(SPREAD(x))[0]; }
double lane_cos(double x) { return kt_cosine(SPREAD(x))[0]; }
double lane_asin(double x) { return kt_arc_sine(SPREAD(x))[0]; }
double lane_atan2(double y, double x) { return kt_arc_tangent(SPREAD(y), SPREAD(x))[0]; }
double lane_exp(double x) { return kt_exponential(SPREAD(x))[0]; }
double lane_log(double x) { return kt_logarithm(SPREAD(x))[0]; }
double lane_log2(double x) { return logarithm(SPREAD(x))[0]; }
double lane_exp2(double x) { return exponential(SPREAD(x))[0]; }
