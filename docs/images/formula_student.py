"""Draw docs/images/formula_student.png: ``python docs/images/formula_student.py``."""

from pathlib import Path

import kintrafo
from kintrafo.vehicle.plots.curves import write_overview

NAMES = (
    "camber_gradient",
    "bump_steer",
    "motion_ratio",
    "wheel_rate",
    "roll_center_height_kinematic",
    "anti_dive",
)


def main() -> None:
    """Write the picture of the tutorial."""
    curves = kintrafo.characteristics.over(kintrafo.Model("formula_student"))
    path = Path(__file__).with_name("formula_student.png")
    write_overview(curves, path, NAMES, "formula_student", force=True)


if __name__ == "__main__":
    main()
