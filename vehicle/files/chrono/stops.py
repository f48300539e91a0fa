"""Stops of Project Chrono's springs, at a minimum and a maximum length.

In bump and in rebound Chrono has the same curve of force over the distance pressed in, straight
between its points. What of it is linear from the first touch on is a stop here, too; where it
becomes stiffer, the spring does.
"""

from typing import Any, NamedTuple

from .parts import millimetres

_CURVE = (
    (0.01, 1000.0),
    (0.02, 2500.0),
    (0.03, 4500.0),
    (0.04, 7500.0),
    (0.05, 12500.0),
    (0.06, 125000.0),
)
"""Distances pressed in [m], and forces [N]; of Chrono's ``SpringForce``, beside zero."""

_RATE = _CURVE[0][1] / _CURVE[0][0]
_STIFFER = tuple((x, force - _RATE * x) for x, force in _CURVE)

# A curve has no room for the last point in rebound, where the spring would pull with tons.
_IN_BUMP, _IN_REBOUND = _STIFFER, _STIFFER[:-1]

LONGEST = _CURVE[-1][0]
"""How far Chrono's curve goes [m]."""


class Stops(NamedTuple):
    """The stops of a spring.

    Attributes
    ----------
    shortest, longest : float
        Lengths of the spring at which it touches them [m].
    """

    shortest: float
    longest: float

    def sections(self, at_design: float) -> dict[str, Any]:
        """Return them as sections of a hardpoint file.

        Parameters
        ----------
        at_design : float
            Length of the spring at the design position [m].
        """
        away = {"bump": at_design - self.shortest, "rebound": self.longest - at_design}
        return {
            f"{side}_stop": {"clearance_mm": round(millimetres(open_by), 9), "rate_N_per_m": _RATE}
            for side, open_by in away.items()
        }

    def stiffer(self) -> tuple[tuple[float, float], ...]:
        """Return lengths [m], falling, and how much more they push there than linear ones [N]."""
        extended = [(self.longest + x, -force) for x, force in reversed(_IN_REBOUND)]
        return (*extended, *((self.shortest - x, force) for x, force in _IN_BUMP))

    def words(self) -> str:
        """Return how they are represented."""
        bump, rebound = (1e3 * side[-1][0] for side in (_IN_BUMP, _IN_REBOUND))
        return (
            f"spring: touches its stops at lengths of {millimetres(self.shortest):g} and "
            f"{millimetres(self.longest):g} mm; [bump_stop] and [rebound_stop] have the rate of "
            f"Chrono's, {_RATE / 1e3:g} N/mm, and the curve of [spring] what is more from "
            f"{1e3 * _STIFFER[0][0]:g} mm on. Up to {bump:g} mm in bump and {rebound:g} mm in "
            "rebound the force is that of Chrono; beyond, it goes on straight"
        )
