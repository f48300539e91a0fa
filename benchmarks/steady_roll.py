"""How far the body of a car rolls in a steady left turn: `python -m benchmarks.steady_roll NAME`.

The car runs straight at 22 m/s, the steering wheel turns within two seconds, and the roll is that
eight seconds later; the angle is sought at which the lateral acceleration is that wanted. The drive
torque stays that of running straight, so that the car becomes slower. ``--change PLACE=VALUE``
changes a value of the file first: with the preloads of its source, bmw_e90 has
``front.side.strut.spring_force_at_design_N=5600 rear.side.spring.force_at_design_N=7600``.
"""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

import kintrafo
import numpy as np
from kintrafo.vehicle.assembly.of import assembly_of
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation

if TYPE_CHECKING:
    from kintrafo.systems.state import State
    from kintrafo.vehicle.assembly.car import CarAssembly

SPEED, SETTLED, TURNED, END = 22.0, 4.0, 6.0, 16.0  # m/s, s
GRAVITY = 9.81
# Angles of a pinion of Chrono's [rad]; a steering wheel turns farther, up to the last one.
LEAST, MOST, LAST = 0.02, 0.3, 5.0


def turn(car: CarAssembly, start: State, angle: float) -> tuple[float, float, float]:
    """Return lateral acceleration [g], roll [deg] and speed [m/s] in a turn."""
    model = car.model
    times = np.linspace(0.0, END, 801)
    part = np.clip((times - SETTLED) / (TURNED - SETTLED), 0.0, 1.0)
    smooth = part**3 * (10.0 - 15.0 * part + 6.0 * part**2)
    rack = car.controls.rack(1.0)["rack_position"]
    inputs = {
        name: value
        for name, value in zip(model.input_names, np.asarray(start.inputs), strict=True)
        if not name.startswith("rack") and not name.endswith("_velocity")
    } | {"rack_position": CubicSpline(times, angle * rack * smooth)}
    how = {"method": "BDF", "rtol": 1e-6, "atol": 1e-8}
    result = kintrafo.simulate(model, (0.0, END), start, inputs=inputs, t_eval=times, **how)
    last = dict(zip(model.state_names, result.y[:, -1], strict=True))
    turned = Rotation.from_quat([last[f"body_e{i}"] for i in (1, 2, 3, 0)])
    rate = turned.apply([last[f"body_{name}"] for name in "pqr"])[2]
    speed = float(np.linalg.norm([last[f"body_{name}"] for name in "uvw"]))
    return speed * rate / GRAVITY, turned.as_euler("ZYX", degrees=True)[2], speed


def main() -> None:
    """Print the roll at a lateral acceleration."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("car")
    parser.add_argument("--lateral", type=float, default=0.6, help="acceleration in g")
    parser.add_argument("--change", nargs="*", default=[])
    given = parser.parse_args()
    car = kintrafo.load(given.car).with_changes({"car": "full"})
    start = assembly_of(car).running(SPEED)
    changes = {place: float(value) for place, value in (text.split("=") for text in given.change)}
    # from there, as a car on its stops is not said to rest
    changed = assembly_of(car.with_changes(changes))

    def left(angle: float) -> float:
        return turn(changed, start, angle)[0] - given.lateral

    most = MOST
    while left(most) < 0.0:
        most *= 2.0
        if most > LAST:
            parser.error(f"--lateral {given.lateral:g}: {given.car} does not reach it")
    angle = brentq(left, LEAST, most, xtol=1e-5)
    lateral, roll, speed = turn(changed, start, angle)
    print(f"{given.car}: {roll:.2f} deg of roll at {lateral:.3f} g and {speed:.1f} m/s")


if __name__ == "__main__":
    main()
