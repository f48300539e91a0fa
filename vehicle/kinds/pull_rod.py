"""The double wishbone suspension with pull rod and rocker.

It is a push-rod suspension whose rod is joined to the upper arm.
"""

from collections.abc import Mapping
from types import ModuleType
from typing import ClassVar, Literal

from pydantic import Field

from ...generated import pull_rod
from ..input.bodies import RigidBody
from ..input.hardpoints import Pair
from ..input.section import Triple
from .double_wishbone import DoubleWishboneHardpoints
from .push_rod import PushRod, RockerBodies, RockerHardpoints

_PULL_ROD = ("pull_rod_outer", "pull_rod_inner")


class PullRodHardpoints(RockerHardpoints):
    """The points that define a double wishbone suspension with pull rod, at the design position.

    All are in chassis axes (ISO 8855: x forward, y left, z up), in the unit that `unit` names.
    """

    ROD: ClassVar[Pair] = _PULL_ROD
    ROD_WORDS: ClassVar[str] = "pull rod"
    CARRIERS: ClassVar[Mapping[str, str]] = {
        **DoubleWishboneHardpoints.CARRIERS,
        "spring_seat": "rocker",
        "pull_rod_outer": "upper_arm",
        "pull_rod_inner": "rocker",
    }
    JOINTS: ClassVar[tuple[str, ...]] = (
        *DoubleWishboneHardpoints.JOINTS,
        *_PULL_ROD,
        "spring_seat",
    )

    pull_rod_outer: Triple = Field(description="ball joint of pull rod and upper arm")
    pull_rod_inner: Triple = Field(description="joint of pull rod and rocker")


class PullRodBody(RigidBody):
    """The pull rod."""

    POINTS: ClassVar[tuple[str, ...]] = _PULL_ROD


class PullRodBodies(RockerBodies):
    """All bodies. Tie rod, rack and pull rod have no mass in the equations of this suspension."""

    MASSLESS: ClassVar[tuple[str, ...]] = ("tie_rod", "rack", "pull_rod")

    pull_rod: PullRodBody = Field(
        default=PullRodBody(mass_kg=0.0), description="the pull rod, whose mass must be 0"
    )


class PullRod(PushRod):
    """A double wishbone suspension with pull rod and rocker at its design position.

    The pull rod leads from the upper arm to the rocker; spring and damper act between the rocker
    and the chassis. See `Suspension`.
    """

    GENERAL: ClassVar[ModuleType] = pull_rod
    ADDITION: ClassVar[str] = "pull rod"
    TITLE: ClassVar[str] = "pull-rod suspension"
    STARTER: ClassVar[str] = "pull_rod_car"
    PAGE: ClassVar[str] = """: a double wishbone whose spring lies on the chassis.

The pull rod leads from the upper arm down to the rocker, which turns about the line through its two
bearings and compresses spring and damper. The free length of the spring is given directly
(`free_length_mm`) or by the force at the design position (`force_at_design_N`). The damper has a
rate or a curve; the stops depend on its length."""

    # a kind of its own, which inherits nearly everything
    suspension: Literal["pull_rod"] = Field(  # type: ignore[assignment]
        description="the kind of suspension"
    )
    hardpoints: PullRodHardpoints = Field(  # type: ignore[assignment]
        description="the points that define the geometry"
    )
    bodies: PullRodBodies = Field(  # type: ignore[assignment]
        description="masses and inertia"
    )
