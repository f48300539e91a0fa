"""Stops of Project Chrono's springs, at a minimum and a maximum length.

In bump and in rebound Chrono has the same curve of force over compression, linear between its
points. The linear part from first contact is a stop here, too; the stiffer part is added to the
curve of the spring. A spring with a curve of its own, which has no room for more points, has stops
with the law of this project, ``rate x + progression x^3``, with Chrono's rate at first contact and
its force at 40 mm.
"""

from typing import Any, NamedTuple

from .parts import millimetres

_CURVE = (
    (0.01, 1000.0), (0.02, 2500.0), (0.03, 4500.0), (0.04, 7500.0), (0.05, 12500.0),
    (0.06, 125000.0),
)  # fmt: skip
"""Compressions [m] and forces [N] of Chrono's ``SpringForce``, except zero."""

_RATE = _CURVE[0][1] / _CURVE[0][0]
_STIFFER = tuple((x, force - _RATE * x) for x, force in _CURVE)

# Without the last point in rebound, where the spring would pull with tons: a curve has no room.
_IN_BUMP, _IN_REBOUND = _STIFFER, _STIFFER[:-1]

_CUBED = _STIFFER[3][1] / _STIFFER[3][0] ** 3 * 1e-9
_WITHIN = _CURVE[-2][0]
_APART = max(abs(_RATE * x + 1e9 * _CUBED * x**3 - force) / force for x, force in _CURVE[:-1])

LONGEST = _CURVE[-1][0]
"""The greatest compression of Chrono's curve [m]."""


class Stops(NamedTuple):
    """The stops of a spring."""

    # lengths of the spring at first contact [m]
    shortest: float
    longest: float
    beside_a_curve: bool = False  # whether the spring is a curve

    def sections(self, at_design: float) -> dict[str, Any]:
        """Return the sections of a hardpoint file, from the spring's length at design [m]."""
        away = {"bump": at_design - self.shortest, "rebound": self.longest - at_design}
        more = {"progression_N_per_mm3": round(_CUBED, 9)} if self.beside_a_curve else {}
        return {
            f"{side}_stop": {
                "clearance_mm": round(millimetres(open_by), 9),
                "rate_N_per_m": _RATE,
                **more,
            }
            for side, open_by in away.items()
        }

    def stiffer(self) -> tuple[tuple[float, float], ...]:
        """Return lengths [m], falling, and the forces there above those of linear stops [N]."""
        extended = [(self.longest + x, -force) for x, force in reversed(_IN_REBOUND)]
        return (*extended, *((self.shortest - x, force) for x, force in _IN_BUMP))

    def words(self) -> str:
        """Return the description of their representation."""
        bump, rebound = (1e3 * side[-1][0] for side in (_IN_BUMP, _IN_REBOUND))
        lengths = f"{millimetres(self.shortest):g} and {millimetres(self.longest):g} mm"
        if self.beside_a_curve:
            return (
                f"spring: touches its stops at lengths of {lengths}; [bump_stop] and "
                f"[rebound_stop] have a rate and a cubic term, by which the force is that of "
                f"Chrono within {100.0 * _APART:.0f} % up to {1e3 * _WITHIN:g} mm pressed in; "
                "beyond, Chrono's is stiffer"
            )
        return (
            f"spring: touches its stops at lengths of {lengths}; [bump_stop] and [rebound_stop] "
            f"have the rate of Chrono's, {_RATE / 1e3:g} N/mm, and the curve of [spring] what is "
            f"more from {1e3 * _STIFFER[0][0]:g} mm on. Up to {bump:g} mm in bump and {rebound:g} "
            "mm in rebound the force is that of Chrono; beyond, it goes on straight"
        )
