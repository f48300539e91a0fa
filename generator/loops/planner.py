"""From cycles to kinematic transformers: which pair of joints, which closed form, in which order.

A transformer is one loop of the minimal cycle basis, cut at its *characteristic pair of joints*
(Hiller & Woernle, 1988): the pair whose own coordinates, taken together, are the most numerous, so
that the fewest closure equations remain. The pairs and the closed forms that they lead to are found
by `pairs`, what each makes known is said in `acceptance`. Everything here is structure; the algebra
is in `solutions`.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import permutations
from typing import TYPE_CHECKING

from ..closed_forms.carriers import held_together
from ..closed_forms.coupling import coupled
from ..declare.joints import Joint, Prismatic, Revolute, Spherical, Universal
from ..declare.model import DRIVABLE
from .acceptance import accept
from .actions import (
    Action,
    CutJoint,
    HeldByRod,
    PlaceByCross,
    PlaceByGuide,
    PlaceByJoint,
    PlaceByPin,
    PlaceIdle,
    PlaceTelescope,
    Solution,
    SolveCarrier,
    SolveHinge,
    SolveSlide,
    SolveStrut,
    SolveTogether,
    Strut,
)
from .errors import NoClosedFormError
from .graph import Cycle, MinimalBasis, Topology
from .known import Settled
from .pairs import PairCandidate, closed_form, pair_candidates

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..closed_forms.coupling import Coupling
    from ..declare.mechanism import Mechanism
    from ..declare.model import Model
    from .known import Coordinate


_Offer = tuple[Cycle, list[Cycle]]
"""A cycle of the basis, with the others that could have been taken."""

Closing = CutJoint | HeldByRod
"""What closes a loop that is solved by iteration."""


@dataclass(frozen=True)
class Transformer:
    """A loop with its characteristic pair, its equation and its place in the order of solution.

    Attributes
    ----------
    unknowns
        Number of relative coordinates of the loop that were unknown before it was solved.
    candidates
        All pairs with a common isotropic element (the distance of two points), best first.
    inputs, outputs
        Names of coordinates, ``joint.coordinate``.
    pair
        The characteristic pair; none where a single joint closes a loop that is solved by
        iteration.
    rivals
        Other cycles of the same length that could have been taken, with their unknowns.
    closing
        The joint or the rod that closes the loop, if it is solved by iteration.
    """

    number: int
    cycle: Cycle
    unknowns: int
    candidates: tuple[PairCandidate, ...]
    pair: PairCandidate | None
    action: Solution
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    rivals: tuple[tuple[Cycle, int], ...]
    closing: Closing | None = None


def _one_for_each(closing: Sequence[Closing], cycles: Sequence[Cycle]) -> tuple[Closing, ...]:
    """Return for each of some loops something else that closes it."""

    def closes(end: Closing, cycle: Cycle) -> bool:
        if isinstance(end, CutJoint):
            return end.joint in cycle.joints
        return set(end.links) <= set(cycle.bodies)

    return next(
        ends for ends in permutations(closing, len(cycles)) if all(map(closes, ends, cycles))
    )


def _pair_at(closing: Closing, candidates: Sequence[PairCandidate]) -> PairCandidate | None:
    """Return the two joints at the ends of a rod that closes a loop."""
    if isinstance(closing, CutJoint):
        return None
    links = set(closing.links)
    return next(p for p in candidates if all(links & set(j.bodies) for j in p.joints))


@dataclass
class Plan:
    """The order of solution of a model.

    Attributes
    ----------
    transformers
        The loops in the order in which they are solved.
    actions
        Everything the kinematics has to do, in order.
    """

    model: Model
    topology: Topology
    transformers: list[Transformer] = field(default_factory=list)
    actions: list[Action] = field(default_factory=list)
    _settled: Settled = field(init=False, repr=False)

    def __post_init__(self) -> None:
        self._settled = Settled(self._mechanism, self.topology)

    @classmethod
    def of(cls, model: Model) -> Plan:
        """Analyse a model: choose the basis, the pairs and the order."""
        plan = cls(model, Topology(model.mechanism))
        plan._settled.placed.add(plan._mechanism.ground)
        for name in plan._driven:
            joint = plan._mechanism.joint(name)
            plan._settled.known.update((name, c) for c in joint.coordinates)
        plan._place_neighbours()
        plan._solve_loops()
        plan._place_idle()
        plan._check_complete()
        return plan

    def _solve_loops(self) -> None:
        """Choose a minimal cycle basis, and solve each loop as soon as it can be solved.

        Of equally short cycles the one with the fewest unknowns goes first; one that cannot be
        solved yet waits until another one has placed more bodies.
        """
        basis = MinimalBasis(self.topology)
        waiting: list[_Offer] = []
        while (options := basis.options()) or waiting:
            options.sort(key=self._settled.unknowns)  # stable: ties keep the figure's order
            offers = [(c, [o for o in options if o is not c]) for c in options]
            solved = next((offer for offer in (*waiting, *offers) if self._solve(*offer)), None)
            if solved is None and not offers:
                waiting = self._iterate(waiting)
                continue
            taken = solved or offers[0]
            if taken in waiting:
                waiting.remove(taken)
            else:
                basis.choose(taken[0])
                waiting += [] if solved else [taken]

    @property
    def _driven(self) -> tuple[str, ...]:
        return (*self.model.independent, *self.model.prescribed)

    @property
    def _mechanism(self) -> Mechanism:
        return self.model.mechanism

    def is_pinned(self, body: str) -> bool:
        """Tell whether a rod is placed by its pins; others are free to turn about their line."""
        pinned = {a.body for a in self.actions if isinstance(a, PlaceByPin)}
        return body in pinned | {a.near for a in self.actions if isinstance(a, PlaceTelescope)}

    # -- placing bodies -------------------------------------------------------------------------

    def _place_neighbours(self) -> None:
        """Place every body that follows from a placed one without a closure equation."""
        progress = True
        while progress:
            progress = False
            for joint in self._mechanism.joints:
                action = self._follow(joint)
                if action is not None:
                    self.actions.append(action)
                    self._settled.placed.add(action.child)
                    self._settled.on_line.discard(action.child)
                    progress = True

    def _follow(self, joint: Joint) -> PlaceByJoint | PlaceByCross | PlaceByGuide | None:
        placed = [b in self._settled.placed for b in joint.bodies]
        if placed[0] == placed[1]:
            return None
        parent, child = joint.bodies if placed[0] else reversed(joint.bodies)
        if (
            isinstance(joint, Universal)
            and child == joint.second
            and child in self._settled.on_line
        ):
            return PlaceByCross(joint, parent, child)
        strut = self._strut_at(joint)
        if strut is not None:
            return PlaceByGuide(strut) if child == strut.far else None
        if isinstance(joint, Revolute | Prismatic) and self._settled.unknowns_of(joint) == 0:
            if child != joint.second:
                message = (
                    f"joint {joint.name!r}: declare {parent!r} first and {child!r} second, "
                    "since its coordinate drives the second body"
                )
                raise NoClosedFormError(message)
            return PlaceByJoint(joint, parent, child)
        return None

    def _strut_at(self, joint: Joint) -> Strut | None:
        """Return the strut whose guide a joint is, if its line is known."""
        struts = [a for a in self.actions if isinstance(a, SolveStrut)]
        held = [a.telescope for a in self.actions if isinstance(a, SolveHinge | SolveSlide)]
        known = [*struts, *(strut for strut in held if isinstance(strut, Strut))]
        return next((strut for strut in known if strut.joint == joint), None)

    def _place_idle(self) -> None:
        """Place the links without mass that nothing keeps from turning about their line."""
        for body in self._mechanism.idle_links:
            if body in self._settled.on_line and body not in self.model.massive:
                self.actions.append(PlaceIdle(body))
                self._settled.on_line.discard(body)
                self._settled.placed.add(body)

    # -- solving a loop -------------------------------------------------------------------------

    def _solve(self, cycle: Cycle, rivals: list[Cycle]) -> bool:
        """Solve a loop if its equation is in the catalogue and all that it reads is known."""
        candidates = pair_candidates(self._settled, cycle)
        for pair in candidates:
            action = closed_form(self._settled, cycle, pair)
            if action is None:
                continue
            unknowns = self._settled.unknowns(cycle)
            before = self._coordinates(cycle) & self._settled.known
            after = accept(self._settled, self.actions, action)
            self.transformers.append(
                Transformer(
                    number=len(self.transformers) + 1,
                    cycle=cycle,
                    unknowns=unknowns,
                    candidates=tuple(candidates),
                    pair=pair,
                    action=action,
                    inputs=self._labels(before),
                    outputs=self._labels(after),
                    rivals=tuple((c, self._unknowns_before(c, after)) for c in rivals),
                )
            )
            self._place_neighbours()
            return True
        return False

    @staticmethod
    def _coordinates(cycle: Cycle) -> set[Coordinate]:
        return {(j.name, c) for j in cycle.joints for c in j.coordinates}

    # -- loops without a closed form ------------------------------------------------------------

    def _iterate(self, waiting: list[_Offer]) -> list[_Offer]:
        """Solve what waits by iteration, as little as possible; return the loops that still wait.

        A body that rods hold together, or else the fewest loops of hinges and guides.
        """
        cycles = [cycle for cycle, _ in waiting]
        action: SolveCarrier | SolveTogether | None
        action, closed = held_together(self._settled, cycles)
        coupling = None if action else coupled(self._settled, self._driven, cycles)
        if coupling is not None:
            closed = list(coupling.cycles)
            action = None if coupling.obstacle else coupling.action
        if action is None or not self.model.allow_iteration:
            cycle = (closed or cycles)[0]
            message = self._refusal(cycle, pair_candidates(self._settled, cycle))
            if action is None:
                message += self._miscounted()
            message += self._remedy(action, coupling)
            raise NoClosedFormError(message, len(self.transformers))
        solved = [offer for offer in waiting if offer[0] in closed]
        self._solve_together(action, solved)
        self._place_neighbours()
        return [offer for offer in waiting if offer not in solved]

    def _solve_together(self, action: SolveCarrier | SolveTogether, offers: list[_Offer]) -> None:
        """Record the loops that one iteration solves: a transformer for each of them."""
        cycles = [cycle for cycle, _ in offers]
        candidates = [pair_candidates(self._settled, cycle) for cycle in cycles]
        closing = _one_for_each(action.closing, cycles)
        unknowns = [self._settled.unknowns(cycle) for cycle in cycles]
        given = [self._coordinates(cycle) & self._settled.known for cycle in cycles]
        found = accept(self._settled, self.actions, action)
        left = set(found)
        for i, (cycle, rivals) in enumerate(offers):
            own = self._coordinates(cycle) & left
            left -= own
            self.transformers.append(
                Transformer(
                    number=len(self.transformers) + 1,
                    cycle=cycle,
                    unknowns=unknowns[i],
                    candidates=tuple(candidates[i]),
                    pair=_pair_at(closing[i], candidates[i]),
                    closing=closing[i],
                    action=action,
                    inputs=self._labels(given[i]),
                    outputs=self._labels(own),
                    rivals=tuple((c, self._unknowns_before(c, found)) for c in rivals),
                )
            )

    def _unknowns_before(self, cycle: Cycle, solved: set[Coordinate]) -> int:
        own = {(j.name, c) for j in cycle.joints for c in j.coordinates}
        return self._settled.unknowns(cycle) + len(own & solved)

    def _labels(self, coordinates: set[Coordinate]) -> tuple[str, ...]:
        """Return coordinates by name; those of a ball joint together, as its orientation."""
        labels = []
        for joint in self._mechanism.joints:
            own = [c for c in joint.coordinates if (joint.name, c) in coordinates]
            if isinstance(joint, Spherical) and own:
                labels.append(f"{joint.name}.orientation")
            else:
                labels += [f"{joint.name}.{c}" for c in own]
        return tuple(labels)

    # -- refusals -------------------------------------------------------------------------------

    def _refusal(self, cycle: Cycle, candidates: list[PairCandidate]) -> str:
        loop = " - ".join(cycle.bodies)
        tried = "; ".join(
            f"{p.joints[0].name}/{p.joints[1].name} leaves {p.equations} equation(s) in "
            f"{self._settled.unknowns(cycle) - p.eliminated} unknown(s)"
            for p in candidates
        )
        return (
            f"the loop {loop} (joints {', '.join(j.name for j in cycle.joints)}) has no closed "
            f"form in the catalogue. {self._settled.unknowns(cycle)} of its coordinates are "
            "unknown. "
            f"Pairs tried: {tried or 'none, since no two of its joints keep a point in common'}."
        )

    def _miscounted(self) -> str:
        """Say by how much the driven coordinates differ from the degrees of freedom."""
        joints = [self._mechanism.joint(name) for name in self._driven]
        driven = sum(j.freedoms for j in joints)
        mobility = self.topology.mobility - len(self._mechanism.idle_links)
        if driven == mobility:
            return ""
        if mobility < 0:
            return (
                f" Counting the freedoms of the joints, the mechanism has {mobility} of its own: "
                "it moves only if special dimensions let it, such as parallel axes."
            )
        return (
            f" The model has {driven} independent or prescribed coordinate(s), its mechanism "
            f"{mobility} degree(s) of freedom: declare {abs(mobility - driven)} "
            f"{'fewer' if driven > mobility else 'more'}."
        )

    @staticmethod
    def _remedy(action: SolveCarrier | SolveTogether | None, coupling: Coupling | None) -> str:
        """Say whether an iteration would solve what has no closed form."""
        if isinstance(action, SolveCarrier):
            problem = (
                f" {action.body} is held by {action.rod_names} together: {len(action.rods)} "
                "equations remain in as many unknowns."
            )
        elif coupling is not None:
            together = coupling.action
            problem = (
                f" Closed at {together.closing_names}, {len(coupling.cycles)} loop(s) leave "
                f"{together.equations} equations for the {len(together.unknowns)} unknown "
                f"coordinates of {together.joint_names}"
            )
            problem += f", but {coupling.obstacle}." if coupling.obstacle else "."
        else:
            return ""
        if action is None:
            return problem
        return (
            f"{problem} Newton's method solves them, for these loops alone, if the model is "
            "declared with allow_iteration=True."
        )

    def _check_complete(self) -> None:
        """See that every body has a pose; say what holds the first one that has none."""
        placed = self._settled.placed
        missing = [b.name for b in self._mechanism.bodies if b.name not in placed]
        if missing:
            remedy = next(r for j in self._mechanism.joints if (r := self._leading_to(j)))
            message = (
                f"model {self.model.name!r}: nothing determines the pose of {', '.join(missing)}; "
                f"{remedy}"
            )
            raise NoClosedFormError(message, len(self.transformers))

    def _leading_to(self, joint: Joint) -> str:
        """Say what would determine the body at the far side of a joint; empty: not this joint."""
        here, there = sorted(joint.bodies, key=self._settled.placed.__contains__, reverse=True)
        if here not in self._settled.placed or there in self._settled.placed:
            return ""
        if isinstance(joint, Revolute | Prismatic):
            return f"declare joint {joint.name!r} independent or prescribed"
        if isinstance(joint, Universal) and there == joint.first and there in self._settled.on_line:
            return (
                f"declare {here!r} first and {there!r} second in the cross {joint.name!r}, with "
                f"the shaft along the rod {there!r}"
            )
        return (
            f"joint {joint.name!r} is {joint.kind}, and no coordinate of it can be driven. Declare "
            f"{DRIVABLE[type(joint)]}, and drive these"
        )
