"""Cars that are quickly derived.

One drives, on struts, trailing arms and linear tyres, and one on axles without sides; one heaves,
pitches and rolls on arms alone.
"""

import kintrafo
from kintrafo.vehicle.models.car import Car

TYRE = {"radius_mm": 316.0, "effective_radius_mm": 306.0, "vertical_stiffness_N_per_mm": 200.0,
        "vertical_damping_N_s_per_m": 50.0, "slip_stiffness_N": 9.0e4,
        "cornering_stiffness_N_per_rad": 6.5e4, "friction": 1.1, "relaxation_x_mm": 300.0,
        "relaxation_y_mm": 400.0}  # fmt: skip
LINES = ("front_left_strut", "front_right_strut", "rear_left_spring", "rear_right_spring")
"""Lines of the springs and dampers of the packaged car that drives."""
FILE = {
    "car": "full",
    "front": {"axle": "front", "side": "reference_car", "drive": {"share": 1.0}},
    "rear": {"axle": "rear", "side": "trailing_arm_car"},
    "wheelbase_mm": 2600.0, "rear_origin_mm": -2600.0,
    "body": {"mass_kg": 1300.0, "com_mm": [-1300.0, 0.0, 582.4], "inertia_xx_kg_m2": 480.0,
             "inertia_yy_kg_m2": 1900.0, "inertia_zz_kg_m2": 2100.0},
    "tyres": {"front": TYRE, "rear": TYRE},
    "brakes": {"torque_Nm": 6000.0},
    "air": {"drag_area_m2": 0.65, "front_lift_area_m2": 0.05, "rear_lift_area_m2": 0.1},
}  # fmt: skip
COLUMN = {"stiffness_Nm_per_deg": 1.5, "damping_Nm_s_per_deg": 0.01, "pinion_inertia_kg_m2": 1e-3,
          "friction_Nm": 0.5, "rack_friction_N": 100.0}  # fmt: skip
"""A steering column that twists."""


def light_car(**changes):
    """Return the car that drives, with changes of values in its file."""
    return Car.from_dict(FILE).with_changes({"body.mass_kg": 1300.0, **changes})


def car_on_beams():
    """Return a car whose front wheels are steered by a drag link and a column, on a twist beam."""
    vehicle = {"vehicle.front_brake_share": None, "vehicle.center_of_gravity_height_mm": None}
    beams = {
        end: kintrafo.load(name).with_changes(vehicle | {"vehicle.wheelbase_mm": None} | more)
        for end, name, more in (
            ("front", "steered_rigid_axle", {}),
            ("rear", "twist_beam", {"drive": {"share": 1.0, "torque_on": "body"}}),
        )
    }
    brakes = {"torque_Nm": 6000.0, "front_share": 0.6}
    return Car.from_dict(FILE | beams | {"brakes": brakes, "steering_column": COLUMN})


def car_on_arms():
    """Return a car on four trailing arms, with the shortest equations."""
    arm = kintrafo.load("trailing_arm_car")
    axles = {
        end: {
            "axle": end,
            "side": arm.with_changes(
                {"vehicle.end": end, "vehicle.center_of_gravity_height_mm": None}
            ),
        }
        for end in ("front", "rear")
    }
    data = {"car": "roll", "wheelbase_mm": 2600.0, "rear_origin_mm": -2600.0}
    data["body"] = {
        "mass_kg": 1200.0,
        "com_mm": [-1200.0, 20.0, 600.0],
        "inertia_xx_kg_m2": 450.0,
        "inertia_yy_kg_m2": 1800.0,
        "inertia_zz_kg_m2": 1900.0,
    }
    data["seats"] = {"driver": {"place_mm": [-1500.0, 400.0, 500.0]}}
    return Car.from_dict(data | {end: kintrafo.Axle.from_dict(axle) for end, axle in axles.items()})
