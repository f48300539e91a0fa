"""The subjects of the golden set: what files describe, with everything that they may hold."""

import tomllib
from functools import partial
from pathlib import Path

import kintrafo
from cars.axles import BENT
from kintrafo import Axle
from kintrafo.vehicle.data.starter import whole_axles

ARM = {"axial_N_per_mm": 400.0, "radial_N_per_mm": 1200.0}
ROD = {"axial_N_per_mm": 5000.0}
WISHBONES = {"lower_arm_front": ARM, "lower_arm_rear": ARM, "upper_arm_rear": ARM}
BUSHES = {
    "chrono_generic": {"arm_rear": ARM},
    "double_wishbone_car": WISHBONES,
    "lopsided_axle": WISHBONES,
    "multi_link_car": {"front_lower_link_inner": ROD, "rear_upper_link_inner": ROD},
    "multi_link_axle": {"front_lower_link_inner": ROD, "rear_upper_link_inner": ROD},
    "offset_strut_car": {"arm_front": ARM, "arm_rear": ARM},
    "pull_rod_car": WISHBONES,
    "push_rod_axle": WISHBONES,
    "push_rod_car": WISHBONES,
    "reference_axle": {"arm_front": ARM, "strut_top": {"axial_N_per_mm": 500.0}},
    "reference_car": {"arm_front": ARM, "strut_top": {"axial_N_per_mm": 500.0}},
    "rigid_axle": {"left_link_chassis": ROD, "panhard_rod_axle": ROD},
    "trailing_arm_car": {"arm_inner": ARM, "arm_outer": ARM},
}
BUSHES |= {
    file.stem: tomllib.loads(file.read_text(encoding="utf-8"))
    for file in sorted((Path(__file__).parent / "bushes").glob("*.toml"))
}
"""Bushes of each subject, one set for both sides; of further axles without sides a file each."""

STEERING = {"angle_deg": [-90.0, 0.0, 90.0], "rack_mm": [11.0, 0.0, -12.0]}

CORNERS = ("chrono_generic", "double_wishbone_car", "multi_link_car", "offset_strut_car",
           "pull_rod_car", "push_rod_car", "reference_car", "trailing_arm_car")  # fmt: skip


AXLES = {
    "reference_axle": lambda: Axle.load("reference_axle"),
    "lopsided_axle": lambda: BENT,
    "multi_link_axle": lambda: Axle.from_dict(
        {"axle": "rear", "side": "multi_link_car", "steering": STEERING}
    ),
    "push_rod_axle": lambda: Axle.from_dict({"axle": "front", "side": "push_rod_car"}),
}
WHOLE_AXLES = {name: partial(kintrafo.load, name) for name in whole_axles()}
