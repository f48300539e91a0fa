"""A double wishbone suspension whose push rod leads from the lower arm up to a rocker.

The default values are this project's own.
"""

from __future__ import annotations

from .. import declare as d
from . import rocker
from .double_wishbone import LOWER_ARM
from .suspension import spring

ROCKER = rocker.Rocker(
    outer=d.Point("push_rod_outer", (0.0, -0.65, 0.21), "push rod at the lower arm"),
    inner=d.Point("push_rod_inner", (-0.01, -0.37, 0.53), "push rod at the rocker"),
    front=d.Point("rocker_front", (0.03, -0.31, 0.47), "front bearing of the rocker"),
    rear=d.Point("rocker_rear", (-0.05, -0.31, 0.47), "rear bearing of the rocker"),
    top=d.Point("spring_top", (-0.03, -0.06, 0.585), "end of the spring on the chassis"),
    seat=d.Point("spring_seat", (-0.01, -0.335, 0.56), "end of the spring on the rocker"),
    rocker=d.Body("rocker", 0.8, (-0.01, -0.31, 0.5), (0.001, 0.001, 0.001)),
    rod=d.Body("push_rod", 0.0, (-0.005, -0.51, 0.37)),
)

MODELS = (rocker.model(LOWER_ARM, ROCKER, spring(42000.0, 0.398, ends="its ends")),)
