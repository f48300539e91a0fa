"""Points of the bodies of a mechanism, from which pictures are drawn."""

from collections.abc import Mapping
from functools import cached_property
from typing import Any

import numpy as np

from ..core.named_types import Array, ArrayLike
from ..core.validator import Validator
from .system import System

End = tuple[str, str]
# A body with points in one place only is drawn with its centre of mass.
CENTER = "centre of mass"


class Skeleton:
    """The bodies of a mechanism as points.

    Parameters
    ----------
    system : System
        The equations, with the values of the hardpoints.

    Attributes
    ----------
    system : System
    ground : str
        Name of the body that does not move.
    bodies : dict
        Names of the points of each body, the ground first; bodies without points are left out.
    joints : dict
        Names of the points of each joint that has some.
    guides, springs : list of tuple
        The two ends of each, body and point.
    wheels : list of tuple
        Body and point of the centre of each wheel.

    Examples
    --------
    >>> from kintrafo.generated import four_bar
    >>> skeleton = Skeleton(System(four_bar))
    >>> skeleton.bodies["crank"]
    ('crank_bearing', 'crank_pin')
    >>> skeleton.places(skeleton.system.design_state)["crank"].shape
    (2, 3)
    """

    def __init__(self, system: System) -> None:
        with Validator("Skeleton") as given:
            given.instance("system", system, System, System.NEEDED)
        self.system = system
        drawing = system.equations.DRAWING
        self.ground = next(iter(drawing["points"]))
        self._design = self._at_design(drawing["points"])
        self.bodies = {body: tuple(points) for body, points in self._design.items()}
        self.joints = {name: tuple(points) for name, points in drawing["joints"].items() if points}
        self.guides: list[tuple[End, End]] = [(tuple(a), tuple(b)) for a, b in drawing["guides"]]
        self.springs: list[tuple[End, End]] = [(tuple(a), tuple(b)) for a, b in drawing["springs"]]
        self.wheels: list[End] = [(body, point) for body, point in drawing["wheels"]]

    def _at_design(self, described: Mapping[str, Mapping[str, Any]]) -> dict[str, dict[str, Array]]:
        """Return the positions of the points of each body at the design position [m]."""
        found: dict[str, dict[str, Array]] = {}
        for body, points in described.items():
            places = {name: np.array([self._number(c) for c in p]) for name, p in points.items()}
            alone = len({tuple(p) for p in places.values()}) < 2
            if alone and body in self.system.equations.MASSIVE_BODIES:
                places[CENTER] = self._centers[self._place_of(body)]
            if places:
                found[body] = places
        return found

    def _number(self, text: str | float) -> float:
        if not isinstance(text, str):
            return text
        value = self.system.parameters[text.removeprefix("-")]
        return -value if text.startswith("-") else value

    @cached_property
    def _centers(self) -> Array:
        """Centres of mass at the design position, shape (bodies, 3)."""
        return self.system.evaluate("positions", self.system.design_state)

    def _place_of(self, body: str) -> int:
        bodies: tuple[str, ...] = self.system.equations.BODIES
        return bodies.index(body)

    def places(self, states: ArrayLike, inputs: ArrayLike | None = None) -> dict[str, Array]:
        """Return the positions of the points of each body, (..., points, 3) [m].

        They are in the order of the names in `bodies`, in the axes of the ground. States and
        inputs, one or many, are as for `System.evaluate`.
        """
        centers = self.system.evaluate("positions", states, inputs)
        turns = self.system.evaluate("orientations", states, inputs)
        leading = centers.shape[:-2]
        found = {}
        for body, points in self._design.items():
            at_design = np.array([*points.values()])
            if body == self.ground or body not in self.system.equations.BODIES:
                found[body] = np.broadcast_to(at_design, (*leading, *at_design.shape))
                continue
            place = self._place_of(body)
            arms = at_design - self._centers[place]
            turned = np.einsum("...ij,kj->...ki", turns[..., place, :, :], arms)
            found[body] = centers[..., place, None, :] + turned
        return found
