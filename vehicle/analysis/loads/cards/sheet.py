"""Nodes, cases and units of the load cards of a part."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from textwrap import wrap
from typing import NamedTuple

import numpy as np

from .....core.named_types import Array
from ....assembly.part_poses import wrench_about
from ..mounts import CHASSIS
from .part import LoadedPart

LENGTHS = {"mm": 1e3, "m": 1.0}
"""Units of length, and their number in a metre."""

# Above the numbers of usual meshes, and below the limit of Nastran.
FIRST_NODE = 99_000_001

_AXES = {
    "part": "Axes of the part, which is where it is at design",
    "vehicle": "Axes of the vehicle, in which the part is where each case has it",
}
_DIRECTIONS = "x forward, y left, z up, with the origin of the hardpoints"
_CHASSIS = (
    "These are the totals at the mounts; the mass of the body and its other suspensions hold it."
)
_MASSES = "Weight and inertia are among them, at the centre of mass."
_WIDTH = 70


class Node(NamedTuple):
    """A node with its force and moment by the index of the case; units of the file."""

    number: int
    name: str
    by: Sequence[str]
    at: Array
    loads: dict[int, tuple[Array, Array]]


@dataclass(frozen=True)
class CardSheet:
    """The cards of a part.

    Attributes
    ----------
    loaded : LoadedPart
    length : str
        Unit of length: mm or m.
    source : str
        Name of the suspension or axle.
    """

    loaded: LoadedPart
    length: str
    source: str

    def nodes(self) -> list[Node]:
        """Return a node for each point, or for each case if the point moves on the part."""
        scale = LENGTHS[self.length]
        found: list[Node] = []
        for point in self.loaded.points:
            every = range(len(self.loaded.cases))
            for places in [every] if point.fixed else [[place] for place in every]:
                loads = {
                    place: (point.force[place], scale * point.moment[place])
                    for place in places
                    if point.force[place].any() or point.moment[place].any()
                }
                if not loads:
                    continue
                name = point.name if point.fixed else f"{point.name}_{self.loaded.cases[places[0]]}"
                number, at = FIRST_NODE + len(found), scale * point.at[places[0]]
                found.append(Node(number, name, point.by, at, loads))
        return found

    def remarks(self, digits: int) -> Iterator[str]:
        """Yield remarks on units, axes and sums of numbers with some digits."""
        loaded, moment = self.loaded, f"N {self.length}"
        yield from wrap(f"Loads on the part {loaded.part} of {self.source}, by kintrafo.", _WIDTH)
        yield f"Units: N, {self.length}, {moment}."
        yield from wrap(f"{_AXES[loaded.axes]}: {_DIRECTIONS}.", _WIDTH)
        forces, moments = self.left(digits)
        yield from wrap(
            f"Sums of these forces, and of moments about the origin: at most {forces:.1e} N and "
            f"{moments:.1e} {moment}. {_CHASSIS if loaded.part == CHASSIS else _MASSES}",
            _WIDTH,
        )
        for line in loaded.left_out:
            yield from wrap(f"Not carried: {line}", _WIDTH)

    def left(self, digits: int) -> tuple[float, float]:
        """Return the greatest sums of forces and of moments of a case, with numbers as written."""

        def written(values: Array) -> Array:
            return np.array([float(f"{value:.{digits - 1}e}") for value in values])

        sums = np.zeros((len(self.loaded.cases), 6))
        for node in self.nodes():
            for place, load in node.loads.items():
                at, force, moment = (written(values) for values in (node.at, *load))
                sums[place] += wrench_about(np.zeros(3), at, force, moment)
        forces, moments = (np.linalg.norm(part, axis=1) for part in (sums[:, :3], sums[:, 3:]))
        return float(forces.max(initial=0.0)), float(moments.max(initial=0.0))
