"""A torque on a wheel about its spin axis, by a shaft or a brake."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import networkx as nx
import sympy as sp
from typing_extensions import override

from ...program.functions import IsPositive
from ..bodies import Body
from ..declared import DeclarationError, Name, declared
from ..inputs import Input
from ..joints import Revolute
from ..parameters import AngularSpeed
from ..shown import Shown
from ..wheel import Wheel
from .force import Action, Description, Force

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ..surroundings import Surroundings


@declared
@dataclass(frozen=True, kw_only=True)
class ShaftTorque(Force):
    """A torque on a wheel about its spin axis; its reaction is on the carrier or on the chassis.

    Without `standstill` the torque is the input, positive as the wheel rolls forward. With it the
    input is the torque of a brake: it opposes the spin of the wheel relative to the reacting part,
    as ``torque * w / sqrt(w^2 + standstill^2)`` of the spin w, and so vanishes with the spin. A
    brake does not drive: a torque below zero counts as zero.

    Parameters
    ----------
    name
        Name of its signal: the acting torque [N m].
    wheel
        The wheel that it turns.
    bearing
        The driven hinge about which the wheel turns on its carrier, along its spin axis.
    reaction
        The carrier, as of a brake or a motor at the wheel; or a body that the whole suspension
        hangs on, as of a final drive or an inboard brake behind a shaft.
    torque
        Torque [N m]; of a brake zero or more.
    standstill
        Of a brake: the spin at which 71 % (1/sqrt(2)) of its torque acts [rad/s].
    """

    name: Name
    wheel: Wheel
    bearing: Revolute
    reaction: Body
    torque: Input
    standstill: AngularSpeed | None = None

    def __post_init__(self) -> None:
        problems = self.wheel.bearing_problems(self.bearing)
        if self.torque.unit != "N m":
            problems.append(f"input {self.torque.name!r} is in {self.torque.unit}; N m is needed")
        if problems:
            raise DeclarationError(f"ShaftTorque {self.name!r}", problems)

    @property
    def identity(self) -> tuple[str, str]:
        return "force", self.name

    @property
    def along(self) -> Revolute:
        return self.bearing

    def describe(self) -> Description:
        kind = "brake" if self.standstill is not None else "shaft"
        acts = f"`{self.torque.name}` of a {kind} on {self.reaction.name}, about the spin axis a"
        return Description(f"torque {self.name}", acts, r"$`T\,\mathbf{W}_b^T\mathbf{a}`$")

    def act(self, at: Surroundings) -> Action:
        """Append its power on the spin of the wheel relative to the body with the reaction."""
        carrier, spin = self.wheel.carrier.name, at.coordinate(self.bearing.name)
        axis = at.direction(carrier, self.wheel.spin)
        rates = {spin: sp.Integer(1)}
        if self.reaction.name != carrier:
            self._see_reaction(at)
            # coordinates that move the reaction move the carrier with it, without a relative turn
            together = at.twists(self.reaction.name)
            rates |= {
                k: axis.dot(twist.angular)
                for k, twist in at.twists(carrier).items()
                if k not in together
            }
        torque: sp.Expr = sp.Symbol(self.torque.name)
        if self.standstill is not None:
            turning = sum((rate * at.rate(k) for k, rate in rates.items()), sp.Integer(0))
            turning = at.program.define(f"{self.name}_spin", turning)
            slow = self.standstill.symbol
            # at zero, the derivative with respect to the torque is that of positive torques
            pressed = torque * (1 - IsPositive(-torque))
            torque = -pressed * turning / sp.sqrt(turning * turning + slow * slow)
        torque = at.program.define(f"{self.name}_acting", torque)
        independent = {spin, *at.independent}
        forces = {k: torque * rate for k, rate in rates.items() if k in independent}
        return Action(forces, {self.name: torque})

    def _see_reaction(self, at: Surroundings) -> None:
        """Raise an error for a reaction on a body beside the suspension."""
        graph = nx.Graph([(j.first.name, j.second.name) for j in at.mechanism.joints])
        ground, carrier = at.mechanism.ground, self.wheel.carrier.name
        reaction = self.reaction.name
        if reaction == ground:
            return
        graph.remove_node(reaction)
        if ground in graph and nx.has_path(graph, ground, carrier):
            problem = (
                f"the reaction is on {reaction!r}, past which joints lead to {carrier!r}; give the "
                "carrier, or the body that its whole suspension hangs on"
            )
            raise DeclarationError(f"ShaftTorque {self.name!r}", [problem])

    @override
    def signals(self, at: Surroundings, action: Action) -> Iterator[Shown]:
        meaning = "torque on the wheel about its spin axis, positive as it rolls forward"
        yield Shown(self.name, action.values[self.name], "N m", meaning)
