"""Handling with and without a compliant steering column: `python -m benchmarks.steering_column`.

Steady turns at 80 km/h and a step steer of `driving_car`, with a rigid column and with a
compliant one. The second car is derived and compiled at first use.
"""

from __future__ import annotations

import argparse

import kintrafo
import numpy as np
from kintrafo.core.units import KM_PER_H

SPEED = 80.0 / KM_PER_H  # m/s
GRAVITY = 9.80665
TURN = 3.0  # lateral acceleration of the steady turn, m/s^2
COLUMN = {"damping_Nm_s_per_deg": 0.005, "pinion_inertia_kg_m2": 0.0005, "rack_friction_N": 100.0}
STEADY = {
    "understeer gradient at 3 m/s^2 [deg/g]": "understeer_gradient",
    "gradient of the steering wheel angle at 3 m/s^2 [deg/g]": "steering_wheel_gradient",
}
STEP = {
    "gain of the yaw velocity [1/s]": ("yaw_rate_gain", 1.0),
    "response time of the yaw velocity [s]": ("yaw_rate_response_time", 1.0),
    "overshoot of the yaw velocity [%]": ("yaw_rate_overshoot", 100.0),
}


def of_car(car: kintrafo.Car) -> dict[str, float]:
    """Return the numbers of a row, by their meaning."""
    turns = kintrafo.handling.circle(car, speed=SPEED, lateral_acceleration=[TURN])
    step = kintrafo.handling.drive(car, "step_steer", {"holds_speed": True})
    found = {
        words: np.degrees(float(turns.metrics[name])) * GRAVITY for words, name in STEADY.items()
    }
    curves = turns.curves[""].isel(lateral_acceleration=0)
    twist = float(curves["column_twist"]) if "column_twist" in curves else 0.0
    found |= {
        f"torque of the steering wheel at {TURN:g} m/s^2 [N m]": float(curves["steering_torque"]),
        f"twist of the column at {TURN:g} m/s^2 [deg]": np.degrees(twist),
    }
    return found | {words: f * float(step.metrics[name]) for words, (name, f) in STEP.items()}


def main() -> None:
    """Print a table of both cars."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--stiffness", type=float, default=2.0, help="of the column in N m/deg")
    given = parser.parse_args()
    rigid = kintrafo.load("driving_car")
    soft = rigid.with_changes(
        {"steering_column": {"stiffness_Nm_per_deg": given.stiffness, **COLUMN}}
    )
    columns = [of_car(car) for car in (rigid, soft)]
    print(f"| | rigid column | column of {given.stiffness:g} N m/deg |")
    print("|---|---:|---:|")
    for name in columns[0]:
        print(f"| {name} | " + " | ".join(f"{one[name]:.3f}" for one in columns) + " |")


if __name__ == "__main__":
    main()
