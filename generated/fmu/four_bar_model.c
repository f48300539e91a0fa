/* Planar four-bar linkage, one degree of freedom: description for the core. Written by kintrafo. */
#include "model.h"

#include "equations/four_bar.h"

#include <math.h>

static const km_parameter parameters[] = {
    {"crank_bearing_x", "m", -INFINITY, -INFINITY, INFINITY},
    {"crank_bearing_y", "m", -INFINITY, -INFINITY, INFINITY},
    {"crank_pin_x", "m", -INFINITY, -INFINITY, INFINITY},
    {"crank_pin_y", "m", -INFINITY, -INFINITY, INFINITY},
    {"rocker_pin_x", "m", -INFINITY, -INFINITY, INFINITY},
    {"rocker_pin_y", "m", -INFINITY, -INFINITY, INFINITY},
    {"rocker_bearing_x", "m", -INFINITY, -INFINITY, INFINITY},
    {"rocker_bearing_y", "m", -INFINITY, -INFINITY, INFINITY},
    {"crank_com_x", "m", -INFINITY, -INFINITY, INFINITY},
    {"crank_com_y", "m", -INFINITY, -INFINITY, INFINITY},
    {"coupler_com_x", "m", -INFINITY, -INFINITY, INFINITY},
    {"coupler_com_y", "m", -INFINITY, -INFINITY, INFINITY},
    {"rocker_com_x", "m", -INFINITY, -INFINITY, INFINITY},
    {"rocker_com_y", "m", -INFINITY, -INFINITY, INFINITY},
    {"spring_ground_x", "m", -INFINITY, -INFINITY, INFINITY},
    {"spring_ground_y", "m", -INFINITY, -INFINITY, INFINITY},
    {"crank_mass", "kg", 0x0.0p+0, -INFINITY, INFINITY},
    {"crank_inertia_zz", "kg m^2", 0x0.0p+0, -INFINITY, INFINITY},
    {"coupler_mass", "kg", 0x0.0p+0, -INFINITY, INFINITY},
    {"coupler_inertia_zz", "kg m^2", 0x0.0p+0, -INFINITY, INFINITY},
    {"rocker_mass", "kg", 0x0.0p+0, -INFINITY, INFINITY},
    {"rocker_inertia_zz", "kg m^2", 0x0.0p+0, -INFINITY, INFINITY},
    {"spring_rate", "N/m", 0x0.0p+0, -INFINITY, INFINITY},
    {"spring_free_length", "m", 0x0.0p+0, -INFINITY, INFINITY},
    {"damper_rate", "N s/m", 0x0.0p+0, -INFINITY, INFINITY},
};

static const km_input inputs[] = {
    {"crank_torque", -1},
};

static const km_event events[] = {
    {"margins.rocker_reach_squared", "the loop ground - crank - coupler - rocker: point crank_pin lies on the line of rocker, whose rotation is undetermined", -1, 0, 0x0.0p+0, -1, 0x1.0000000000000p+0, -1},
    {"margins.rocker_closure", "the loop ground - crank - coupler - rocker cannot close: the rod coupler cannot reach rocker, beyond its dead point", -1, 1, 0x0.0p+0, -1, 0x1.0000000000000p+0, -1},
    {"margins.spring_length_squared", "the ends of spring coincide", -1, 2, 0x0.0p+0, -1, 0x1.0000000000000p+0, -1},
    {"margins.pivot_crank_angle", "the mass matrix is not positive definite at crank_angle", -1, 3, 0x0.0p+0, -1, 0x1.0000000000000p+0, -1},
};

static const km_guard guards[] = {
    {"rocker_reach_squared", "m^2", "the loop ground - crank - coupler - rocker: point crank_pin lies on the line of rocker, whose rotation is undetermined", 3},
    {"rocker_closure", "m^2", "the loop ground - crank - coupler - rocker cannot close: the rod coupler cannot reach rocker, beyond its dead point", 3},
    {"spring_length_squared", "m^2", "the ends of spring coincide", 3},
    {"pivot_crank_angle", "kg m^2 or kg", "the mass matrix is not positive definite at crank_angle", 1},
};

static const km_assumption assumptions[] = {
    {"at the design position, rocker_pin is on the line about which rocker turns", "move rocker_pin away from that line"},
    {"at the design position, the ends crank_pin and rocker_pin of coupler coincide", "move one of the two"},
    {"at the design position, crank_pin is on the line about which rocker turns, so that coupler does not hold it", "move crank_pin away from that line"},
    {"at the design position the rod coupler is at its dead point: it, rocker_pin and the line about which rocker turns are in one plane", "choose a design position where crank_pin is beside that plane"},
};

static const km_inertia tensors[] = {
    {0},
};

static const int guard_use[] = {
    3,
    3,
    3,
    1,
};

static const char *const constants[] = {
    "crank_bearing_x",
    "crank_bearing_y",
    "rocker_bearing_x",
    "rocker_bearing_y",
    "spring_ground_x",
    "spring_ground_y",
    "spring_rate",
    "spring_free_length",
    "damper_rate",
    "rocker_arm_design_x",
    "rocker_arm_design_y",
    "rocker_arm_radius",
    "rocker_arm_unit_x",
    "rocker_arm_unit_y",
    "rocker_arm_radius_least",
    "crank_arm_crank_pin_x",
    "crank_arm_crank_pin_y",
    "coupler_length",
    "rocker_reach_design",
    "rocker_rod_height_design",
    "rocker_rod_height_design_least",
    "rocker_branch",
    "rocker_reach_squared_floor",
    "rocker_closure_floor",
    "coupler_arm_unit_x",
    "coupler_arm_unit_y",
    "coupler_radius_inverse",
    "crank_arm_crank_com_x",
    "crank_arm_crank_com_y",
    "coupler_coupler_com_2",
    "coupler_coupler_com_3",
    "rocker_rocker_com_2",
    "rocker_rocker_com_3",
    "coupler_first_moment_2",
    "coupler_first_moment_3",
    "coupler_carried_inertia_xx",
    "rocker_carried_inertia_xx",
    "crank_carried_inertia_xx",
    "spring_length_squared_floor",
    "constant_4",
    "constant_5",
    "constant_6",
    "constant_7",
    "constant_8",
    "constant_9",
};

static const char *const states[] = {
    "crank_angle",
    "crank_angle_rate",
};

static const char *const signals[] = {
    "spring_length",
    "spring_velocity",
    "spring_force",
    "damper_force",
};

const km_model km_this = {
    .name = "four_bar",
    .states = 2, .inputs = 1, .signals = 4,
    .parameters = 25, .constants = 45, .guards = 4,
    .events = 4, .assumptions = 4, .tensors = 0,
    .positions = 1, .speeds = 1, .linearised = 14,
    .prepare = four_bar_prepare, .design_state = four_bar_design_state,
    .rates = four_bar_rhs, .jacobian = four_bar_rhs_jacobian,
    .signals_of = four_bar_signals, .margins = four_bar_margins,
    .linearisation = four_bar_linearisation,
    .prepare_tangent = NULL, .zeros = 0,
    .rates_tangent = NULL, .signals_tangent = NULL,
    .places = { 0, 2, 10 },
    .parameter = parameters, .input = inputs, .event = events, .guard = guards, .guard_use = guard_use,
    .assumption = assumptions, .tensor = tensors, .constant_name = constants,
    .state_name = states, .signal_name = signals,
};
