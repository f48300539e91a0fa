"""The driven coordinates of a model: names, rates, and the bodies that each moves."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import networkx as nx
import sympy as sp

from ..declare.joints import Revolute
from .jointed import jointed_base

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from ..declare.bodies import Body
    from ..declare.formulation import Formulation
    from ..declare.joints import Joint
    from .motion import BodyMotion


class Coordinates:
    """The coordinates that are independent or prescribed.

    Prescribed joints in `held` do not move in this variant. `states` is the layout of the state;
    `symbols` has the symbol of each coordinate by its name: a reported name, or that of a motion;
    of a free body, which has no coordinates, the speeds. `moving` are the names of those that move,
    `independent` those of the independent ones, in the order of the speeds of the state,
    `eliminated` those whose speeds constraints give, and `solved` these speeds, once they are
    found.

    Notes
    -----
    *Unit rate.* The biases of connected bodies, apart from ground and moving bases, that a single
    coordinate moves (rotors apart) are computed for a unit rate of that coordinate, and scaled by
    the square of the true rate at the very end. `rate_scale` is the true rate for such a
    coordinate, and one for all others, whose biases are computed at the true rates.
    """

    def __init__(self, formulation: Formulation, held: Iterable[str] = ()) -> None:
        self.formulation = formulation
        self._mechanism = formulation.mechanism
        self._motions = {motion.name: motion for motion in formulation.prescribed.values()}
        self._motion_of = {name: motion.name for name, motion in formulation.motions.items()}
        self._held = frozenset(held)
        self.states = formulation.states
        self._speeds = self.states.speed_of
        self.driven = formulation.driven
        self.given = formulation.given
        self._given_names = frozenset(joint.name for joint in self.given)
        names = [k for joint in self.driven for k in self.all_of(joint)]
        inputs = {name: motion.inputs[0].name for name, motion in self._motions.items()}
        self.symbols = {k: sp.Symbol(inputs.get(k, k)) for k in names}
        self.moving = [k for j in self.driven if j.name not in self._held for k in self.all_of(j)]
        self.independent = list(self.states.coordinates)
        self.eliminated = list(self.states.eliminated_coordinates)
        self.solved: dict[str, sp.Expr] = {}

    def of(self, joint: Joint) -> str:
        """Return the name of the coordinate that moves a driven joint, or one that follows it."""
        joint = joint.first_followed
        if joint.name in self._motion_of:
            return self._motion_of[joint.name]
        return next(c.name for c in self._mechanism.coordinates if c.joint.name == joint.name)

    def all_of(self, joint: Joint) -> tuple[str, ...]:
        """Return the names of all coordinates of a driven joint; a free one has six."""
        if joint in self.formulation.independent:
            return self.states.part_of(joint).coordinates
        return (self.of(joint),)

    def ratio(self, joint: Joint) -> sp.Expr:
        """Return the displacement of a joint per unit of the coordinate that moves it."""
        if joint.gear is None:
            return sp.Integer(1)
        return joint.gear.ratio.symbol * self.ratio(joint.gear.joint)

    def is_given(self, joint: Joint) -> bool:
        """Return whether a joint's coordinate is independent, prescribed, or follows such a one."""
        return joint.name in self._given_names

    def moves(self, joint: Joint) -> bool:
        """Return whether a given joint moves in this variant."""
        return self.of(joint) in self.moving

    # -- rates ------------------------------------------------------------------------------------

    @property
    def unconstrained(self) -> list[str]:
        """The names of the independent and the eliminated ones, joint by joint."""
        return list(self._speeds)

    def true_rate(self, coordinate: str) -> sp.Expr:
        """Return the rate of a coordinate: a symbol, unless constraints give it."""
        if coordinate in self.solved:
            return self.solved[coordinate]
        motion = self._motions.get(coordinate)
        return sp.Symbol(self._speeds[coordinate] if motion is None else motion.rates[0])

    def rate(self, coordinate: str) -> sp.Expr:
        """Return the rate of a coordinate at which biases are computed."""
        return sp.Integer(1) if coordinate in self.single_coordinate else self.true_rate(coordinate)

    def rate_scale(self, coordinate: str) -> sp.Expr:
        """Return the factor whose square scales the biases of bodies that a coordinate moves."""
        return self.true_rate(coordinate) if coordinate in self.single_coordinate else sp.Integer(1)

    def rate_scale_of(self, placed: BodyMotion) -> sp.Expr:
        """Return the factor whose square scales the bias of a body."""
        if placed.total is not None:  # on a moving base, its bias is that of the true rates
            return sp.Integer(1)
        single = [k for k in placed.motion if k in self.single_coordinate]
        return self.rate_scale(single[0]) if single else sp.Integer(1)

    def speed(self, joint: Joint) -> sp.Expr:
        """Return the rate of a given joint at which biases are computed; zero where it is held."""
        return self.ratio(joint) * self.rate(self.of(joint)) if self.moves(joint) else sp.Integer(0)

    def given_acceleration(self, joint: Joint) -> sp.Expr:
        """Return the part of a given joint's acceleration that an input gives."""
        return self.ratio(joint) * self.acceleration(self.of(joint))

    def acceleration(self, coordinate: str) -> sp.Expr:
        """Return the given part of a coordinate's acceleration: that of an input."""
        if coordinate in self._motions and coordinate in self.moving:
            return sp.Symbol(self._motions[coordinate].rates[1])
        return sp.Integer(0)

    # -- moved bodies ----------------------------------------------------------------------------

    @cached_property
    def rotors(self) -> dict[str, Body]:
        """The bodies of revolution at the end of a chain, by their independent spin coordinate.

        A body whose hinge others follow through gears is not one of them.
        """
        rotors = {}
        followed = [joint.first_followed for joint in self._mechanism.geared]
        for joint in self.formulation.independent:
            body = joint.second
            leaf = len(self._mechanism.joints_of(body.name)) == 1 and joint not in followed
            if isinstance(joint, Revolute) and leaf and body.rotor_axis is not None:
                rotors[self.of(joint)] = body
        return rotors

    @cached_property
    def single_coordinate(self) -> frozenset[str]:
        """The independent coordinates that alone move connected bodies.

        On a moving base, they do so relative to the base; its own motion is added at the true
        rates.
        """
        pacing = list(self._pacing())
        together = {k for several in pacing if len(several) > 1 for k in several}
        alone = {k for several in pacing for k in several} - together
        return frozenset(alone.intersection(self.independent))

    def _pacing(self) -> Iterator[set[str]]:
        """Yield sets of coordinates that move connected bodies."""
        graph = nx.Graph([joint.bodies for joint in self._mechanism.joints])
        drives = [
            (j.second.name, k)
            for j in self.given
            for k in self.all_of(j.first_followed)
            if k in self.moving and k not in self.rotors
        ]
        for bodies in nx.connected_components(graph.subgraph(set(graph) - self._still())):
            yield {k for body, k in drives if body in bodies}

    def _still(self) -> set[str]:
        """Return the ground and the bases, and the bodies that held joints tie to them."""
        held = [j for j in self.given if j.first_followed.name in self._held]
        tied = nx.Graph([joint.bodies for joint in held])
        links, *base = jointed_base(self.formulation) or ([],)
        bases = [self._mechanism.ground, *base, *(j.joint.second.name for j in self.states.free)]
        tied.add_nodes_from(bases)
        components = (nx.node_connected_component(tied, body) for body in bases)
        return set(links).union(*components)
