/* Slider-crank, one degree of freedom: description for the core. Written by kintrafo. */
#include "model.h"

#include "equations/slider_crank.h"

#include <math.h>

static const km_parameter parameters[] = {
    {"crank_bearing_x", "m", -INFINITY, -INFINITY, INFINITY},
    {"crank_bearing_y", "m", -INFINITY, -INFINITY, INFINITY},
    {"crank_pin_x", "m", -INFINITY, -INFINITY, INFINITY},
    {"crank_pin_y", "m", -INFINITY, -INFINITY, INFINITY},
    {"piston_pin_x", "m", -INFINITY, -INFINITY, INFINITY},
    {"piston_pin_y", "m", -INFINITY, -INFINITY, INFINITY},
    {"crank_com_x", "m", -INFINITY, -INFINITY, INFINITY},
    {"crank_com_y", "m", -INFINITY, -INFINITY, INFINITY},
    {"rod_com_x", "m", -INFINITY, -INFINITY, INFINITY},
    {"rod_com_y", "m", -INFINITY, -INFINITY, INFINITY},
    {"piston_com_x", "m", -INFINITY, -INFINITY, INFINITY},
    {"piston_com_y", "m", -INFINITY, -INFINITY, INFINITY},
    {"crank_mass", "kg", 0x0.0p+0, -INFINITY, INFINITY},
    {"crank_inertia_zz", "kg m^2", 0x0.0p+0, -INFINITY, INFINITY},
    {"rod_mass", "kg", 0x0.0p+0, -INFINITY, INFINITY},
    {"rod_inertia_zz", "kg m^2", 0x0.0p+0, -INFINITY, INFINITY},
    {"piston_mass", "kg", 0x0.0p+0, -INFINITY, INFINITY},
};

static const km_input inputs[] = {
    {"crank_torque", -1},
};

static const km_event events[] = {
    {"margins.piston_closure", "the loop ground - crank - rod - piston cannot close: the rod rod is too short to reach the guide of piston", -1, 0, 0x0.0p+0, -1, 0x1.0000000000000p+0, -1},
    {"margins.pivot_crank_angle", "the mass matrix is not positive definite at crank_angle", -1, 1, 0x0.0p+0, -1, 0x1.0000000000000p+0, -1},
};

static const km_guard guards[] = {
    {"piston_closure", "m^2", "the loop ground - crank - rod - piston cannot close: the rod rod is too short to reach the guide of piston", 3},
    {"pivot_crank_angle", "kg m^2 or kg", "the mass matrix is not positive definite at crank_angle", 1},
};

static const km_assumption assumptions[] = {
    {"at the design position, the ends crank_pin and piston_pin of rod coincide", "move one of the two"},
    {"at the design position the rod rod is at its dead point: it is perpendicular to the guide of piston", "move crank_pin or piston_pin along the guide"},
};

static const km_inertia tensors[] = {
    {0},
};

static const int guard_use[] = {
    3,
    1,
};

static const char *const constants[] = {
    "crank_bearing_x",
    "crank_bearing_y",
    "piston_pin_x",
    "piston_pin_y",
    "piston_com_x",
    "piston_com_y",
    "piston_mass",
    "crank_arm_crank_pin_x",
    "crank_arm_crank_pin_y",
    "rod_design_x",
    "rod_length",
    "rod_length_least",
    "piston_rod_along_design_least",
    "piston_branch",
    "piston_closure_floor",
    "rod_arm_unit_x",
    "rod_arm_unit_y",
    "rod_radius_inverse",
    "crank_arm_crank_com_x",
    "crank_arm_crank_com_y",
    "rod_rod_com_2",
    "rod_rod_com_3",
    "rod_first_moment_2",
    "rod_first_moment_3",
    "rod_carried_inertia_xx",
    "crank_carried_inertia_xx",
    "constant_1",
    "constant_2",
    "crank_arm_piston_pin_y",
    "constant_3",
    "constant_4",
};

static const char *const states[] = {
    "crank_angle",
    "crank_angle_rate",
};

static const char *const signals[] = {
    0,
};

const km_model km_this = {
    .name = "slider_crank",
    .states = 2, .inputs = 1, .signals = 0,
    .parameters = 17, .constants = 31, .guards = 2,
    .events = 2, .assumptions = 2, .tensors = 0,
    .positions = 1, .speeds = 1, .linearised = 2,
    .prepare = slider_crank_prepare, .design_state = slider_crank_design_state,
    .rates = slider_crank_rhs, .jacobian = slider_crank_rhs_jacobian,
    .signals_of = NULL, .margins = slider_crank_margins,
    .linearisation = slider_crank_rhs_input_jacobian,
    .prepare_tangent = NULL, .zeros = 0,
    .rates_tangent = NULL, .signals_tangent = NULL,
    .places = { 0, -1, -1 },
    .parameter = parameters, .input = inputs, .event = events, .guard = guards, .guard_use = guard_use,
    .assumption = assumptions, .tensor = tensors, .constant_name = constants,
    .state_name = states, .signal_name = signals,
};
