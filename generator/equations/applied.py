"""The force elements of a model: generalised forces Q, internal states and signals."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..declare.declared import DeclarationError
from .acting import acted, shown_by
from .inertia import NONE
from .surroundings import Seen

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    import sympy as sp

    from ..declare.forces.force import Force
    from ..declare.shown import Shown
    from .in_motion import InMotion
    from .surroundings import Momenta


class Applied:
    """Effect of the force elements.

    `forces` are the generalised forces by the names of unconstrained coordinates, `internal_rates`
    the rates of internal states, by their names and in their order.
    """

    def __init__(self, moving: InMotion, momenta: Momenta) -> None:
        self.mechanism, self._moving, self._momenta = moving.mechanism, moving, momenta
        at = Seen(moving, momenta, None)
        names = moving.coordinates.unconstrained
        self.forces: dict[str, sp.Expr] = dict.fromkeys(names, NONE)
        self._actions = []
        for force in self.mechanism.forces:
            moving.program.section(f"forces: {type(force).__name__}")
            action = acted(force, at)
            self._actions.append(action)
            for k in names:
                if k in action.forces:
                    self.forces[k] += action.forces[k]
        self.internal_rates = self._rates_of_internal()

    def _rates_of_internal(self) -> dict[str, sp.Expr]:
        """Return the rates of internal states in their order; each is that of one force."""
        names = [entry.name for entry in self._moving.coordinates.states.internal]
        given = [
            (name, force)
            for force, a in zip(self.mechanism.forces, self._actions, strict=True)
            for name in a.rates
        ]
        problems = [
            f"{' '.join(force.identity)}: a rate of {name!r}, which is not an internal state of "
            "the mechanism; have an InternalState among the fields of the force"
            for name, force in given
            if name not in names
        ]
        for name in names:
            forces = [" ".join(force.identity) for known, force in given if known == name]
            if len(forces) != 1:
                found = f"rates by {' and '.join(forces)}" if forces else "no rate"
                problems.append(
                    f"internal state {name!r} has {found}; one force returns "
                    f"Action(..., rates={{{name!r}: ...}})"
                )
        if problems:
            raise DeclarationError(self.mechanism.name, problems)
        rates = {name: rate for action in self._actions for name, rate in action.rates.items()}
        return {name: self._moving.program.define(f"{name}_rate", rates[name]) for name in names}

    def signals(self, accelerations: Mapping[str, sp.Expr]) -> Iterator[Shown]:
        """Yield the signals of all forces in their order, and then those of the constraints."""
        at = Seen(self._moving, self._momenta, accelerations)
        for force, action in zip(self.mechanism.forces, self._actions, strict=True):
            yield from shown_by(force, at, action)
        for constraint in self.mechanism.constraints:
            yield from constraint.signals(at)

    def total(self, force: Force) -> sp.Expr:
        """Return the force by which an element pushes two ends apart [N or N m]."""
        found = self._actions[self.mechanism.forces.index(force)].total
        if found is None:
            problem = (
                "its Action has no total, which an output shows: give it the force on the ends"
            )
            raise DeclarationError(" ".join(force.identity), [problem])
        return found
