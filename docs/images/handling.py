"""Draw the pictures of docs/suspension/handling.md: ``python docs/images/handling.py``."""

from pathlib import Path

import kintrafo
from kintrafo.vehicle.plots.handling import write_curves, write_path

HERE = Path(__file__)

if __name__ == "__main__":
    car = kintrafo.CarModel(kintrafo.load("driving_car"))
    turns = kintrafo.handling.drive(car, "circle")
    shown = ["steering_wheel_angle", "understeer_gradient", "roll_angle", "sideslip_angle",
             "drive_torque", "slip_angle"]  # fmt: skip
    title = f"driving_car: {turns.metrics.attrs['title']}"
    write_curves(
        turns.curves[""][shown], HERE.with_name("handling_circle.png"), title=title, force=True
    )
    speeds = kintrafo.handling.drive(car, "speed_range")
    title = f"driving_car: {speeds.metrics.attrs['title']}"
    write_curves(speeds.curves[""], HERE.with_name("handling_speed.png"), title=title, force=True)
    lane = kintrafo.handling.drive(car, "double_lane_change")
    write_path(
        lane.curves[""], HERE.with_name("handling_lane_change.png"), cones=lane.curves["_cones"],
        title=f"driving_car: {lane.metrics.attrs['title']}", force=True,
    )  # fmt: skip
