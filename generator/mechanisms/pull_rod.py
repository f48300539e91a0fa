"""A double wishbone suspension whose pull rod hangs on the upper arm and turns a rocker by pulling.

The default values are this project's own.
"""

from __future__ import annotations

from .. import declare as d
from . import rocker
from .double_wishbone import UPPER_ARM
from .suspension import spring

ROCKER = rocker.Rocker(
    outer=d.Point("pull_rod_outer", (-0.01, -0.62, 0.49), "pull rod at the upper arm"),
    inner=d.Point("pull_rod_inner", (-0.01, -0.363, 0.233), "pull rod at the rocker"),
    front=d.Point("rocker_front", (0.03, -0.29, 0.26), "front bearing of the rocker"),
    rear=d.Point("rocker_rear", (-0.05, -0.29, 0.26), "rear bearing of the rocker"),
    top=d.Point("spring_top", (-0.03, -0.05, 0.334), "end of the spring on the chassis"),
    seat=d.Point("spring_seat", (-0.01, -0.354, 0.324), "end of the spring on the rocker"),
    rocker=d.Body("rocker", 0.8, (-0.01, -0.3, 0.26), (0.001, 0.001, 0.001)),
    rod=d.Body("pull_rod", 0.0, (-0.01, -0.4915, 0.3615)),
)

MODELS = (rocker.model(UPPER_ARM, ROCKER, spring(60000.0, 0.426, ends="its ends")),)
