"""Loads on the wheels of an assembly: those of load cases, or of tyres at rest."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ....core.named_types import Array
from ...assembly.load import Load
from ...assembly.part_poses import CENTER, CONTACT, PartPoses, touching, wheel_axes
from ...corner.corner import RoadWheel
from .cases import Case
from .dataset import of_side

WHEEL = "wheel"
"""The beginning of the names of parts that are wheels."""


@dataclass(frozen=True)
class AppliedLoads:
    """Loads on k wheels in n load cases."""

    racks: Array  # displacements of the rack, (n,) [m]
    # heights above design at which wheels are held, (n, k) [m]; NaN for a free wheel
    travels: Array
    # (n, k, 12), as in `Case.vector`; None for the forces of the tyres on the road at z = 0
    vectors: Array | None

    @classmethod
    def of(cls, cases: Sequence[Sequence[Case]]) -> "AppliedLoads":
        """Return the loads of cases, each with a `Case` for every wheel."""
        return cls(
            np.array([wheels[0].rack for wheels in cases]),
            np.array(
                [[np.nan if c.travel is None else c.travel for c in wheels] for wheels in cases]
            ),
            np.array([[case.vector for case in wheels] for wheels in cases]),
        )

    @classmethod
    def of_tyres(cls, wheels: int) -> "AppliedLoads":
        """Return the loads of rest on the road."""
        return cls(np.zeros(1), np.full((1, wheels), np.nan), None)

    def on(self, wheels: slice) -> "AppliedLoads":
        """Return the loads on some of the wheels."""
        own = None if self.vectors is None else self.vectors[:, wheels]
        return replace(self, travels=self.travels[:, wheels], vectors=own)

    @property
    def free(self) -> NDArray[np.bool_]:
        """Whether a wheel is not held, (n, k)."""
        return np.isnan(self.travels)

    def at(self, poses: Mapping[str, PartPoses], rows: NDArray[np.int64]) -> Array:
        """Return the loads in positions, each of a case, as in `Case.vector`, (rows, k, 12)."""
        if self.vectors is not None:
            return self.vectors[rows]
        found = np.zeros((len(rows), self.travels.shape[1], 12))
        forces = [(w, g.tyre_forces()[p]) for g in poses.values() for p, w in g.wheels.items()]
        for place, (wheel, force) in enumerate(forces):
            found[:, place, 6:9] = np.einsum("nij,nj->ni", wheel_axes(wheel), force)
        return found


def wheels_of(poses: Mapping[str, PartPoses]) -> Iterator[tuple[str, str, RoadWheel]]:
    """Yield suffix, part and wheel of each wheel of an assembly, in their order."""
    for suffix, group in poses.items():
        for part, wheel in group.wheels.items():
            yield suffix, part, wheel


def of_wheel(part: str, loads: Sequence[Load]) -> list[Load]:
    """Return loads on a wheel with the name of its part."""
    return [of_side(load, part.removeprefix(WHEEL)) for load in loads]


def road_and_drive(part: str, wheel: RoadWheel, vectors: Array) -> list[Load]:
    """Return the loads of road and drive on a wheel, from vectors, (n, 12), as in `Case.vector`."""
    force, moment, at_center, center_moment = np.einsum(
        "nij,nki->knj", wheel_axes(wheel), vectors.reshape(-1, 4, 3)
    )
    road = Load(WHEEL, CONTACT, "road", force, moment, touching(wheel))
    return of_wheel(
        part, [road, Load(WHEEL, CENTER, "drive", at_center, center_moment, wheel.center)]
    )
