"""A rigid axle as an assembly: one beam carries both wheels."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from ...core.named_types import Array
from ...core.quantities import variable
from ..models.rigid_axle.axle import BeamAxle, RigidAxle
from ..models.rigid_axle.model import HEAVE, ROLL, RigidAxleModel
from ..models.rigid_axle.rods import Ends
from ..models.rigid_axle.structure import BEAM
from .anti_roll_bar import RollBar
from .measures.measure import Measure
from .measures.rigid_axle import MEASURES
from .rigid_axle_parts import RigidAxleParts
from .soft_lines import SoftLines, lines_by_rates
from .whole_axle import WholeAxleAssembly
from .whole_axle_kinematics import RigidAxleKinematics

if TYPE_CHECKING:
    import xarray as xr


class RigidAxleAssembly(WholeAxleAssembly):
    """A rigid axle; `model` has its equations, if they exist already."""

    AXLE: ClassVar[type[BeamAxle]] = RigidAxle
    MODEL: ClassVar[type[RigidAxleModel]] = RigidAxleModel
    PARTS: ClassVar[type[RigidAxleParts]] = RigidAxleParts
    KINEMATICS: ClassVar[type[RigidAxleKinematics]] = RigidAxleKinematics
    MEASURES: ClassVar[tuple[Measure, ...]] = MEASURES
    ENDS = (
        "a rod or a damper reaches no farther, or a spring or a damper has turned by a right angle"
    )
    MODES: ClassVar[Mapping[str, str]] = {HEAVE: "axle hop", ROLL: "axle tramp"}

    axle: BeamAxle
    on_a_beam = True

    def _model(self) -> RigidAxleModel:
        """Return its equations; of an axle on five rods those of four."""
        return self.MODEL(self.axle, guided=self.axle.overheld)

    @property
    def simplified(self) -> Sequence[str]:
        if not self.axle.overheld:
            return ()
        (fifth,) = {*self.axle.rods} - {*self.axle.guides}
        return "the rotation of the springs", f"the effect of {fifth} on the position of the axle"

    @property
    def words(self) -> str:
        rods = ", ".join(self.axle.rods).replace("_", " ")
        return f"A {self.axle.heading()} on {len(self.axle.rods)} rods: {rods}."

    def soft_lines(self, poses: Mapping[str, Any]) -> dict[str, SoftLines]:
        if not self.axle.overheld:
            return super().soft_lines(poses)
        return {"": lines_by_rates(self.KINEMATICS(poses[""]))}

    def require_rigid_motion(self) -> None:
        if self.axle.overheld:
            self.MODEL(self.axle)

    def further(
        self, over: str, poses: Mapping[str, Any], found: "xr.Dataset"
    ) -> "dict[str, xr.Variable]":
        from xarray import Variable  # noqa: PLC0415 (slow to import)

        rods = [*self.axle.rods]
        pulls = [pull(found, f"{BEAM} at {rod}_axle by {rod}", poses[""].rod(rod)) for rod in rods]
        words = "force along a rod, positive in tension"
        return {
            "rod": Variable("rod", rods),
            "rod_force": variable((over, "rod"), np.stack(pulls, axis=-1), words, "N"),
        } | super().further(over, poses, found)

    def described(self) -> dict[str, str]:
        track = f"{2e3 * self.axle.half_track:.4g} mm"
        return {"track": track, "rods": lengths_of(self.axle.ends())}

    @property
    def bar(self) -> RollBar | None:
        if self.axle.anti_roll_bar is None:
            return None
        return RollBar(self.model.parameters["bar_rate"], BEAM)


def pull(found: "xr.Dataset", load: str, along: Array) -> Array:
    """Return the force of a load along a link, positive in tension, (n,) [N].

    `found` has all loads, with that of the link on the axle; `along` is the unit
    vector from this end of the link to its other end.
    """
    return np.einsum("ni,ni->n", found["force"].sel(load=load).values, along)


def lengths_of(links: Mapping[str, Ends]) -> str:
    """Return the lengths of links by name, as text."""
    return ", ".join(
        f"{name.replace('_', ' ')} {1e3 * float(np.linalg.norm(last - first)):.1f} mm"
        for name, (first, last) in links.items()
    )
