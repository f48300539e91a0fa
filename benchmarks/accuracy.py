"""How accurate a simulation by default is: ``python -m benchmarks.accuracy``.

The packaged suspensions of one wheel ride for two seconds over a harmonic road, released off their
rest, by the method and the tolerances that `kintrafo.simulate` has by default. Every signal is
compared with the same of SciPy's DOP853 at a relative tolerance of 1e-12, by the difference as a
part of the signal's range.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
from kintrafo import Model, simulate, state_at_height
from kintrafo.vehicle.data.starter import packaged

from .report import fill_page, markdown_table

TIMES = np.linspace(0.0, 2.0, 2001)
ROAD = 0.01, 2.0  # [m], [Hz]
TIGHT = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-14, "max_step": 0.01}


def road(time: float) -> float:
    """Return the height of the road [m]."""
    height, frequency = ROAD
    return height * np.sin(2.0 * np.pi * frequency * time)


def errors(name: str) -> tuple[float, float]:
    """Return the largest error of accelerations, and of all other signals, as parts of ranges."""
    model = Model(name)
    height = float(model.signal("wheel_center_z", model.design_state)) + 0.005
    start = state_at_height(model, height, spin_rate=93.0)
    inputs = {"road_height": road}
    found = simulate(model, (0.0, 2.0), start, inputs=inputs, t_eval=TIMES)
    expected = simulate(model, (0.0, 2.0), start, inputs=inputs, t_eval=TIMES, **TIGHT)
    of_rates, of_others = [0.0], [0.0]
    for signal, values in expected.signals.items():
        if np.ptp(values) > 0.0:
            off = np.abs(found.signals[signal] - values).max() / np.ptp(values)
            acceleration = model.equations.SIGNALS[signal]["unit"].endswith("/s^2")
            (of_rates if acceleration else of_others).append(float(off))
    return max(of_rates), max(of_others)


def main() -> int:
    """Run the command."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--page", type=Path, help="a page whose table is replaced")
    options = parser.parse_args()
    rows = [
        [f"`{name}`", *(f"{error:.1e}" for error in errors(name))]
        for name in packaged()
        if name.endswith("_car")
    ]
    table = markdown_table(["by default", "accelerations", "all other signals"], rows)
    print(table)
    if options.page:
        fill_page(options.page, {"accuracy": table})
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
