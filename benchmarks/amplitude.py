"""What is left of an oscillation after a long time: ``python -m benchmarks.amplitude``.

A wheel hops without a damper for 1,000 s, some 12,000 times with the packaged suspension. The
amplitude in the last second is that of the first, but for what a method damps by itself.
"""

from __future__ import annotations

import argparse
import time

import numpy as np
from kintrafo import Model, System, simulate, state_at_height
from kintrafo.simulation.solvers import native_methods

CASES = (
    ("BDF", 1e-6, 1e-9),
    ("BDF", 1e-7, 1e-9),
    ("BDF", 1e-8, 1e-10),
    ("BDF", 1e-9, 1e-11),
    ("Adams", 1e-6, 1e-9),
    ("Verner", 1e-6, 1e-9),
    ("DormandPrince", 1e-6, 1e-9),
)
SAMPLES = 2000


def undamped() -> tuple[System, np.ndarray]:
    """Return the packaged suspension without its damper, and a state off its rest."""
    model = Model("reference_car")
    system = System(model.equations, model.parameters | {"damper_rate": 0.0})
    return system, state_at_height(model, 0.325)


def measured(duration: float) -> list[str]:
    """Return the rows of the table."""
    system, start = undamped()
    ends = np.linspace(0.0, 1.0, SAMPLES), np.linspace(duration - 1.0, duration, SAMPLES)
    rows = []
    for method, rtol, atol in CASES:
        if method not in native_methods():
            continue
        begin = time.process_time()
        result = simulate(
            system,
            (0.0, duration),
            start,
            method=method,
            rtol=rtol,
            atol=atol,
            t_eval=np.concatenate(ends),
        )
        took = time.process_time() - begin
        height = 1e3 * result.signals["wheel_center_z"]
        first, last = (np.ptp(part) / 2.0 for part in np.split(height, 2))
        rows.append(
            f"| {method} | {rtol:.0e} | {atol:.0e} | {result.steps:,} | {took:.2f} | "
            f"{first:.2f} | {last:.2f} | {100.0 * (1.0 - last / first):.2f} |"
        )
    return rows


def main() -> None:
    """Run the command."""
    parser = argparse.ArgumentParser(prog="benchmarks.amplitude", description=__doc__)
    parser.add_argument("--duration", type=float, default=1000.0, help="[s], more than 2")
    duration = parser.parse_args().duration
    if not duration > 2.0:
        parser.error(f"--duration {duration:g}: more than 2 s are needed")
    head = "method | rtol | atol | steps | CPU time [s] | first [mm] | last [mm] | lost [%]"
    print(f"| {head} |")
    print("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |")
    for row in measured(duration):
        print(row, flush=True)


if __name__ == "__main__":
    main()
