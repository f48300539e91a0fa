"""Axles that tests share."""

import numpy as np
from kintrafo import Axle, Suspension
from kintrafo.vehicle.models.positions import arm_angles, design_height

AXLE = Axle.load("reference_axle")
WISHBONES = Suspension.load("double_wishbone_car")
BAR_OF_STRUTS = {
    "unit": "mm", "bush": [240.0, -400.0, 320.0], "link_top": [30.0, -580.0, 330.0],
    "link_foot": [30.0, -580.0, 200.0], "link_on": "control_arm", "rate_Nm_per_deg": 17.5,
}  # fmt: skip
BAR_OF_WISHBONES = {
    "unit": "mm", "bush": [-250.0, -380.0, 260.0], "link_top": [-60.0, -600.0, 300.0],
    "link_foot": [-50.0, -610.0, 195.0], "link_on": "knuckle", "axis": [0.1, 1.0, -0.05],
    "rate_Nm_per_deg": 25.0,
}  # fmt: skip
# A rear axle whose sides differ, with stops that act, and a bar that is bent at design.
LOPSIDED = {
    "axle": "rear",
    "right": WISHBONES.with_changes({"bump_stop": {"clearance_mm": 5.0, "rate_N_per_m": 1e5}}),
    "left": WISHBONES.mirrored().with_changes(
        {
            "bump_stop": {"clearance_mm": 8.0, "rate_N_per_m": 1e5},
            "spring.rate_N_per_m": 65e3,
            "hardpoints.lower_ball_joint.z": 190.0,
        }
    ),
    "anti_roll_bar": BAR_OF_WISHBONES | {"free_twist_deg": 1.5},
    "drive": {"share": 0.6},
    "brakes": {"torque_on": "body"},
}
BENT = Axle.from_dict(LOPSIDED)


def placed(model, travels, racks):
    """Return states and inputs of a whole axle at rest."""
    states = np.tile(model.design_state, (racks.size, 1))
    inputs = np.zeros((racks.size, len(model.input_names)))
    inputs[:, model.input_names.index("rack_position")] = racks
    for side, corner in model.axle.models.items():
        column = model.state_names.index(f"{side}_{corner.names.arm}")
        states[:, column] = arm_angles(corner, design_height(corner) + travels[side], racks)
    return states, inputs
