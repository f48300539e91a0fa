"""The planner, from cycles to transformers: pairs of joints, closed forms, and their order.

A transformer is one loop of the minimal cycle basis, cut at its *characteristic pair of joints*
(Hiller & Woernle, 1988): the pair whose own coordinates, taken together, are the most numerous, so
that the fewest closure equations remain. `cut` finds the pairs; the forms of a catalogue decide
which loops they close (`forms`). Everything here is structure.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import permutations
from typing import TYPE_CHECKING, ClassVar, Self

from ..declare.formulation import DRIVABLE
from ..declare.joints import Free, Joint, Prismatic, Revolute, Spherical, Universal
from ..kinematics.kinematics import Loop
from .aimed import aimed
from .crossed import between_crosses, crosses_turned
from .cut import PairCandidate, pair_candidates, views
from .errors import NoClosedFormError
from .graph import Cycle, JointGraph, MinimalBasis
from .known import Known, coordinates_of
from .redundant import redundant
from .tilted import tilted
from .turned import held_apart

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..declare.formulation import Formulation
    from ..declare.mechanism import Mechanism
    from ..kinematics.step import KinematicStep
    from .forms import Attempt, Catalogue, ClosedForm, Closing, Iteration, PlannedStep, Solution
    from .known import Coordinate


_Offer = tuple[Cycle, list[Cycle]]
"""A cycle of the basis, with the others that could have been taken."""


@dataclass(frozen=True)
class Transformer:
    """A loop with its characteristic pair, its equation and its place in the order of solution."""

    number: int
    cycle: Cycle
    # number of relative coordinates of the loop that were unknown before it was solved
    unknowns: int
    # all pairs with a common isotropic element (the distance of two points), best first
    candidates: tuple[PairCandidate, ...]
    # characteristic pair; none where a single joint closes a loop that is solved by iteration
    pair: PairCandidate | None
    step: Solution
    # names of coordinates, `joint.coordinate`
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    # other cycles of the same length that could have been taken, with their unknowns
    rivals: tuple[tuple[Cycle, int], ...]
    # joint or the rod that closes the loop, if it is solved by iteration
    closing: Closing | None = None


def _one_for_each(closing: Sequence[Closing], cycles: Sequence[Cycle]) -> tuple[Closing, ...]:
    """Return one joint or rod for each loop that closes it."""
    return next(
        ends
        for ends in permutations(closing, len(cycles))
        if all(end.closes(cycle) for end, cycle in zip(ends, cycles, strict=True))
    )


def _pair_at(closing: Closing, candidates: Sequence[PairCandidate]) -> PairCandidate | None:
    """Return the two joints at the ends of a rod that closes a loop."""
    links = set(closing.between)
    if not links:
        return None
    return next(p for p in candidates if all(links & set(j.bodies) for j in p.joints))


@dataclass
class Plan:
    """The order of solution of a model."""

    catalogue: ClassVar[Catalogue]  # forms that it tries, of a class of plans

    formulation: Formulation
    topology: JointGraph
    # loops in the order in which they are solved
    transformers: list[Transformer] = field(default_factory=list)
    _known: Known = field(init=False, repr=False)

    def __post_init__(self) -> None:
        self._known = Known(self._mechanism, self.topology)

    @classmethod
    def of(cls, formulation: Formulation) -> Self:
        """Analyse a model: choose the basis, the pairs and the order."""
        plan = cls(formulation, JointGraph(formulation.mechanism))
        plan._known.placed.add(plan._mechanism.ground)
        plan._known.add_all(map(plan._mechanism.joint, plan._driven))
        plan._place_neighbours()
        plan._solve_loops()
        massive = [body.name for body in formulation.massive]
        for kind in plan.catalogue.leftovers:
            for step in kind.left(plan._known, massive):
                plan._accept(step)
        plan._check_complete()
        return plan

    @property
    def steps(self) -> list[KinematicStep]:
        """All steps of the kinematics, in order."""
        return self._known.steps

    @property
    def loops(self) -> dict[object, Loop]:
        """The loop that a step closes, the first one of several, by the step."""
        found: dict[object, Loop] = {}
        for t in self.transformers:
            found.setdefault(t.step, Loop(t.number, t.cycle.bodies, t.cycle.joints))
        return found

    def _solve_loops(self) -> None:
        """Choose a minimal cycle basis, and solve each loop as soon as it can be solved.

        Of equally short cycles the one with the fewest unknowns goes first; one that cannot be
        solved yet waits until another one has placed more bodies.
        """
        basis = MinimalBasis(self.topology)
        waiting: list[_Offer] = []
        while (options := basis.options()) or waiting:
            options.sort(key=self._known.unknowns)  # stable: ties keep the figure's order
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
        return tuple(joint.name for joint in self.formulation.given)

    @property
    def _mechanism(self) -> Mechanism:
        return self.formulation.mechanism

    # -- placing bodies -------------------------------------------------------------------------

    def _accept(self, step: PlannedStep) -> set[Coordinate]:
        """Append a step, and record its results."""
        self._known.steps.append(step)
        return step.accept(self._known)

    def _place_neighbours(self) -> None:
        """Place every body beside a placed one that needs no closure equation."""
        progress = True
        while progress:
            progress = False
            for joint in self._mechanism.joints:
                step = self._follow(joint)
                if step is not None:
                    self._accept(step)
                    progress = True

    def _follow(self, joint: Joint) -> PlannedStep | None:
        """Return the step that places a body beside a placed one by a joint, if there is one."""
        placed = [b in self._known.placed for b in joint.bodies]
        if placed[0] == placed[1]:
            return None
        parent, child = joint.bodies if placed[0] else reversed(joint.bodies)
        tried = (f.follow(self._known, joint, parent, child) for f in self.catalogue.followers)
        return next((step for step in tried if step), None)

    # -- solving a loop -------------------------------------------------------------------------

    def _solve(self, cycle: Cycle, rivals: list[Cycle]) -> bool:
        """Solve a loop if a form of the catalogue fits and all its inputs are known."""
        candidates = pair_candidates(self._known, cycle)
        for pair in candidates:
            step = self._closed_form(cycle, pair)
            if step is None:
                continue
            unknowns = self._known.unknowns(cycle)
            before = coordinates_of(cycle.joints) & self._known.coordinates
            after = self._accept(step)
            self.transformers.append(
                Transformer(
                    number=len(self.transformers) + 1,
                    cycle=cycle,
                    unknowns=unknowns,
                    candidates=tuple(candidates),
                    pair=pair,
                    step=step,
                    inputs=self._labels(before),
                    outputs=self._labels(after),
                    rivals=tuple((c, self._unknowns_before(c, after)) for c in rivals),
                )
            )
            self._place_neighbours()
            return True
        return False

    def _closed_form(self, cycle: Cycle, pair: PairCandidate) -> ClosedForm | None:
        """Return the solution of a loop cut at a pair, if a form of the catalogue fits."""
        forms = [form for form in self.catalogue.closed if pair.equations in form.equations]
        tried = (form.match(self._known, cut) for cut in views(cycle, pair) for form in forms)
        return next((step for step in tried if step), None)

    # -- loops without a closed form ------------------------------------------------------------

    def _iterate(self, waiting: list[_Offer]) -> list[_Offer]:
        """Solve waiting loops by iteration, as few as possible; return those that still wait.

        Solve a body on rods first, or else the fewest loops of hinges and guides.
        """
        cycles = [cycle for cycle, _ in waiting]
        crossed = [c for c in cycles if between_crosses(self._mechanism, c)]
        apart = held_apart(self._known, self._driven)
        forms = () if crossed or apart else self.catalogue.iterations
        tried = (f.attempt(self._known, self._driven, cycles) for f in forms)
        attempt = next((a for a in tried if a), None)
        if attempt is None or attempt.obstacle or not self.formulation.allow_iteration:
            cycle = (attempt.cycles if attempt else crossed or cycles)[0]
            message = self._refusal(cycle, pair_candidates(self._known, cycle))
            mechanism = self._mechanism
            hint = ""
            if attempt is None:
                hint = between_crosses(mechanism, cycle) or crosses_turned(mechanism, cycle)
            hint = hint or apart or tilted(mechanism) or aimed(mechanism)
            if hint:
                message += f" {hint}."
            elif attempt is None or attempt.obstacle:
                message += self._miscounted()
            raise NoClosedFormError(message + self._remedy(attempt), len(self.transformers))
        solved = [offer for offer in waiting if offer[0] in attempt.cycles]
        self._solve_together(attempt.action, solved)
        self._place_neighbours()
        return [offer for offer in waiting if offer not in solved]

    def _solve_together(self, action: Iteration, offers: list[_Offer]) -> None:
        """Record the loops that one iteration solves: a transformer for each of them."""
        cycles = [cycle for cycle, _ in offers]
        candidates = [pair_candidates(self._known, cycle) for cycle in cycles]
        closing = _one_for_each(action.closing, cycles)
        unknowns = [self._known.unknowns(cycle) for cycle in cycles]
        given = [coordinates_of(cycle.joints) & self._known.coordinates for cycle in cycles]
        found = self._accept(action)
        left = set(found)
        for i, (cycle, rivals) in enumerate(offers):
            own = coordinates_of(cycle.joints) & left
            left -= own
            self.transformers.append(
                Transformer(
                    number=len(self.transformers) + 1,
                    cycle=cycle,
                    unknowns=unknowns[i],
                    candidates=tuple(candidates[i]),
                    pair=_pair_at(closing[i], candidates[i]),
                    closing=closing[i],
                    step=action,
                    inputs=self._labels(given[i]),
                    outputs=self._labels(own),
                    rivals=tuple((c, self._unknowns_before(c, found)) for c in rivals),
                )
            )

    def _unknowns_before(self, cycle: Cycle, solved: set[Coordinate]) -> int:
        return self._known.unknowns(cycle) + len(coordinates_of(cycle.joints) & solved)

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
            f"{self._known.unknowns(cycle) - p.eliminated} unknown(s)"
            for p in candidates
        )
        return (
            f"the loop {loop} (joints {', '.join(j.name for j in cycle.joints)}) has no closed "
            f"form in the catalogue. {self._known.unknowns(cycle)} of its coordinates are "
            "unknown. "
            f"Pairs tried: {tried or 'none, since no two of its joints keep a point in common'}."
        )

    def _miscounted(self) -> str:
        """Return a sentence on the difference between driven coordinates and degrees of freedom."""
        driven = sum(j.freedoms for j in self.formulation.driven)
        mobility = self.topology.mobility - len(self._mechanism.passive_links)
        if driven == mobility:
            return ""
        spare = redundant(self._mechanism, [joint.name for joint in self.formulation.driven])
        if driven > mobility and spare:
            return f" {spare}."
        if mobility < 0:
            return (
                f" Counting the degrees of freedom of the joints, the mechanism has "
                f"{mobility} of its own: "
                "it moves only if special dimensions let it, such as parallel axes."
            )
        return (
            f" The model has {driven} independent or prescribed coordinate(s), its mechanism "
            f"{mobility} degree(s) of freedom: declare {abs(mobility - driven)} "
            f"{'fewer' if driven > mobility else 'more'}."
        )

    @staticmethod
    def _remedy(attempt: Attempt | None) -> str:
        """Return a sentence on the iteration that would solve a loop without closed form."""
        if attempt is None:
            return ""
        if attempt.obstacle:
            return f" {attempt.problem}, but {attempt.obstacle}."
        return (
            f" {attempt.problem}. Newton's method solves them, for these loops alone, if the model "
            "is declared with allow_iteration=True."
        )

    def _check_complete(self) -> None:
        """Raise an error if a body has no pose, with the joint to declare for the first one."""
        placed = self._known.placed
        missing = [b.name for b in self._mechanism.bodies if b.name not in placed]
        if missing:
            remedy = next(r for j in self._mechanism.joints if (r := self._leading_to(j)))
            message = (
                f"model {self.formulation.name!r}: nothing determines the pose of "
                f"{', '.join(missing)}; {remedy}"
            )
            raise NoClosedFormError(message, len(self.transformers))

    def _leading_to(self, joint: Joint) -> str:
        """Return advice for the body at the far side of a joint; empty: not for this joint."""
        here, there = sorted(joint.bodies, key=self._known.placed.__contains__, reverse=True)
        if here not in self._known.placed or there in self._known.placed:
            return ""
        if isinstance(joint, Revolute | Prismatic | Free):
            return f"declare joint {joint.name!r} independent or prescribed"
        if (
            isinstance(joint, Universal)
            and there == joint.first.name
            and there in self._known.on_line
        ):
            return (
                f"declare {here!r} first and {there!r} second in the cross {joint.name!r}, with "
                f"the shaft along the rod {there!r}"
            )
        return (
            f"joint {joint.name!r} is {joint.kind}, and no coordinate of it can be driven. Declare "
            f"{DRIVABLE[type(joint)]}, and drive these"
        )
