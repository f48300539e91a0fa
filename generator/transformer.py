"""From cycles to kinematic transformers: which pair of joints, which closed form, in which order.

A transformer is one loop of the minimal cycle basis, cut at its *characteristic pair of joints*
(Hiller & Woernle, 1988): the pair whose own coordinates, taken together, are the most numerous, so
that the fewest closure equations remain. Everything here is structure; the algebra is in
`solutions`.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import combinations
from typing import TYPE_CHECKING

from .actions import (
    Action,
    HeldByRod,
    PinnedTelescope,
    PlaceByCross,
    PlaceByJoint,
    PlaceByPin,
    PlaceTelescope,
    Solution,
    SolveCarrier,
    SolveHinge,
    SolveSlide,
    SolveStroke,
    SolveTelescope,
    SolveTurn,
)
from .joints import Cylindrical, Joint, Prismatic, Revolute, Spherical, Universal
from .topology import Cycle, MinimalBasis, Topology

if TYPE_CHECKING:
    from .geometry import Point
    from .mechanism import Body, Mechanism, Model


# A rod is one equation; the pose of a body about a known point has three unknowns, else six.
_RODS_ABOUT_A_POINT = 3
_RODS_WITHOUT_A_POINT = 6

_Offer = tuple[Cycle, list[Cycle]]
"""A cycle of the basis, with the others that could have been taken."""


class NoClosedFormError(ValueError):
    """A loop has no solution in the catalogue of closed forms."""


@dataclass(frozen=True)
class PairCandidate:
    """A pair of joints at which a loop could be cut, and what that eliminates.

    Attributes
    ----------
    eliminated
        Number of unknown coordinates of the two joints.
    equations
        Number of closure equations that remain, of the six of a spatial loop or the three of a
        planar one. The turn of a link about the line through two ball joints takes part in none.
    """

    joints: tuple[Joint, Joint]
    eliminated: int
    equations: int


@dataclass(frozen=True)
class _CutLoop:
    """A loop cut at the centres of a pair of joints, seen as two arcs from anchor to end.

    ``joints`` and ``bodies`` are those of one arc; ``other_joints`` and ``others`` of the other.
    """

    anchor: Point
    end: Point
    joints: tuple[Joint, ...]
    bodies: tuple[str, ...]
    other_joints: tuple[Joint, ...]
    others: tuple[str, ...]


def _common_point(joint: Joint, cycle: Cycle) -> Point | None:
    """Return the point that a joint keeps common; in a plane, a hinge has one too."""
    if cycle.planar and isinstance(joint, Revolute):
        return joint.axis.through
    return joint.center


def _views(cycle: Cycle, pair: PairCandidate) -> list[_CutLoop]:
    """Return the four ways to look at a cut loop: either arc first, either direction."""
    i, j = sorted(cycle.joints.index(joint) for joint in pair.joints)
    anchor, end = (_common_point(cycle.joints[k], cycle) for k in (i, j))
    if anchor is None or end is None:
        return []
    inner = cycle.joints[i + 1 : j], cycle.bodies[i + 1 : j + 1]
    outer = (
        (cycle.joints[j + 1 :] + cycle.joints[:i])[::-1],
        (cycle.bodies[j + 1 :] + cycle.bodies[: i + 1])[::-1],
    )
    views = []
    for (joints, bodies), (other_joints, others) in ((inner, outer), (outer, inner)):
        views.append(_CutLoop(anchor, end, joints, bodies, other_joints, others))
        views.append(
            _CutLoop(end, anchor, joints[::-1], bodies[::-1], other_joints[::-1], others[::-1])
        )
    return views


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
    rivals
        Other cycles of the same length that could have been taken, with their unknowns.
    """

    number: int
    cycle: Cycle
    unknowns: int
    candidates: tuple[PairCandidate, ...]
    pair: PairCandidate
    action: Solution
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    rivals: tuple[tuple[Cycle, int], ...]


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
    _known: set[tuple[str, str]] = field(default_factory=set)
    _placed: set[str] = field(default_factory=set)
    _on_line: set[str] = field(default_factory=set)

    @classmethod
    def of(cls, model: Model) -> Plan:
        """Analyse a model: choose the basis, the pairs and the order."""
        plan = cls(model, Topology(model.mechanism))
        plan._placed.add(plan._mechanism.ground)
        for name in (*model.independent, *model.prescribed):
            joint = plan._mechanism.joint(name)
            plan._known.update((name, c) for c in joint.coordinates)
        plan._place_neighbours()
        plan._solve_loops()
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
            options.sort(key=self._unknowns)  # stable: ties keep the order of the figure's numbers
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
    def _mechanism(self) -> Mechanism:
        return self.model.mechanism

    def is_known(self, joint: Joint, coordinate: str) -> bool:
        """Tell whether a relative coordinate is given or already solved."""
        return (joint.name, coordinate) in self._known

    def lines(self) -> list[SolveTurn | SolveHinge | SolveSlide]:
        """Return the solutions that leave their rod on a line, free to turn about it."""
        pinned = {a.body for a in self.actions if isinstance(a, PlaceByPin)}
        pinned |= {a.near for a in self.actions if isinstance(a, PlaceTelescope)}
        held = [a for a in self.actions if isinstance(a, SolveTurn | SolveHinge | SolveSlide)]
        return [a for a in held if a.rod not in pinned]

    def _unknowns(self, cycle: Cycle) -> int:
        return sum(self._unknowns_of(joint) for joint in cycle.joints)

    def _unknowns_of(self, joint: Joint) -> int:
        return sum(not self.is_known(joint, c) for c in joint.coordinates)

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
                    self._placed.add(action.child)
                    self._on_line.discard(action.child)
                    progress = True

    def _follow(self, joint: Joint) -> PlaceByJoint | PlaceByCross | None:
        placed = [b in self._placed for b in joint.bodies]
        if placed[0] == placed[1]:
            return None
        parent, child = joint.bodies if placed[0] else reversed(joint.bodies)
        if isinstance(joint, Universal) and child == joint.second and child in self._on_line:
            return PlaceByCross(joint, parent, child)
        if isinstance(joint, Revolute | Prismatic) and self._unknowns_of(joint) == 0:
            if child != joint.second:
                message = (
                    f"joint {joint.name!r}: declare {parent!r} first and {child!r} second, "
                    "since its coordinate drives the second body"
                )
                raise NoClosedFormError(message)
            return PlaceByJoint(joint, parent, child)
        return None

    # -- solving a loop -------------------------------------------------------------------------

    def _solve(self, cycle: Cycle, rivals: list[Cycle]) -> bool:
        """Solve a loop if its equation is in the catalogue and all that it reads is known."""
        candidates = self._pair_candidates(cycle)
        for pair in candidates:
            action = self._closed_form(cycle, pair)
            if action is None:
                continue
            unknowns = self._unknowns(cycle)
            before = self._coordinates(cycle) & self._known
            after = self._accept(action)
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
    def _coordinates(cycle: Cycle) -> set[tuple[str, str]]:
        return {(j.name, c) for j in cycle.joints for c in j.coordinates}

    # -- loops without a closed form ------------------------------------------------------------

    def _iterate(self, waiting: list[_Offer]) -> list[_Offer]:
        """Solve a body that rods hold together, by iteration; return the loops that still wait."""
        action, solved = self._held_together(waiting)
        if action is None or not self.model.allow_iteration:
            cycle, _ = (solved or waiting)[0]
            message = self._refusal(cycle, self._pair_candidates(cycle))
            raise NoClosedFormError(message + self._remedy(action))
        self._solve_together(action, solved)
        self._place_neighbours()
        return [offer for offer in waiting if offer not in solved]

    def _held_together(self, waiting: list[_Offer]) -> tuple[SolveCarrier | None, list[_Offer]]:
        """Return the first body that rods hold together, with the loops that they close."""
        for action in filter(None, map(self._carrier, self._mechanism.bodies)):
            links = {link for held in action.rods for link in held.links}
            inside = {action.body} | links | self._placed
            closed = [offer for offer in waiting if inside.issuperset(offer[0].bodies)]
            if len(closed) == action.loops:
                return action, closed
        return None, []

    def _solve_together(self, action: SolveCarrier, offers: list[_Offer]) -> None:
        """Record the loops that one iteration solves: a transformer for each of them."""
        candidates = [self._pair_candidates(cycle) for cycle, _ in offers]
        pairs = self._rod_pairs(action, candidates)
        unknowns = [self._unknowns(cycle) for cycle, _ in offers]
        given = [self._coordinates(cycle) & self._known for cycle, _ in offers]
        found = self._accept(action)
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
                    pair=pairs[i],
                    action=action,
                    inputs=self._labels(given[i]),
                    outputs=self._labels(own),
                    rivals=tuple((c, self._unknowns_before(c, found)) for c in rivals),
                )
            )

    @staticmethod
    def _rod_pairs(
        action: SolveCarrier, candidates: list[list[PairCandidate]]
    ) -> list[PairCandidate]:
        """Return for each loop the two joints of a rod whose length is its equation."""
        pairs: list[PairCandidate] = []
        for offered in candidates:
            at_rods = [
                pair
                for held in action.rods
                for pair in offered
                if all(set(held.links) & set(joint.bodies) for joint in pair.joints)
            ]
            pairs.append(next((p for p in at_rods if p not in pairs), at_rods[0]))
        return pairs

    def _carrier(self, body: Body) -> SolveCarrier | None:
        """Return the action for a body that three rods and a point hold, or six rods."""
        if body.name in self._placed | self._on_line:
            return None
        rods = [held for j in self._mechanism.joints_of(body.name) if (held := self._rod(body, j))]
        bases = [
            j
            for j in self._mechanism.joints_of(body.name)
            if isinstance(j, Spherical) and j.other(body.name) in self._placed
        ]
        if len(bases) == 1 and len(rods) == _RODS_ABOUT_A_POINT:
            (base,) = bases
            return SolveCarrier(body.name, tuple(rods), (base.at, base.other(body.name)))
        if not bases and len(rods) == _RODS_WITHOUT_A_POINT:
            return SolveCarrier(body.name, tuple(rods))
        return None

    def _rod(self, body: Body, joint: Joint) -> HeldByRod | None:
        """Return the rod that holds a body at a joint, if its other end is at a placed body."""
        end, rod = joint.center, joint.other(body.name)
        far, guide, other = None, None, self._beyond(joint, rod)
        if isinstance(other, Prismatic) and self._unknowns_of(other) == 0:
            guide, far, rod = other, rod, other.other(rod)
            other = self._beyond(guide, rod)
        anchor = other.center if other else None
        if other is None or end is None or anchor is None:
            return None
        settled = {rod, far} & (self._placed | self._on_line)
        if settled or other.other(rod) not in self._placed:
            return None
        if guide is not None and not self._is_strut(guide, rod, other, end):
            return None
        return HeldByRod(body.name, rod, end, anchor, other.other(rod), guide, far)

    def _beyond(self, joint: Joint, link: str) -> Joint | None:
        """Return the other joint of a link that has two."""
        others = [j for j in self._mechanism.joints_of(link) if j != joint]
        return others[0] if len(others) == 1 else None

    @staticmethod
    def _is_strut(guide: Prismatic, rod: str, anchor: Joint, end: Point) -> bool:
        """Tell whether a guide is along the line of its ends, and a cross holds its first link."""
        between = guide.direction.between
        along = between is not None and set(between) == {anchor.center, end}
        crossed = isinstance(anchor, Universal) and anchor.second == rod
        return along and crossed and guide.first == rod

    def _unknowns_before(self, cycle: Cycle, solved: set[tuple[str, str]]) -> int:
        own = {(j.name, c) for j in cycle.joints for c in j.coordinates}
        return self._unknowns(cycle) + len(own & solved)

    def _labels(self, coordinates: set[tuple[str, str]]) -> tuple[str, ...]:
        """Return coordinates by name; those of a ball joint together, as its orientation."""
        labels = []
        for joint in self._mechanism.joints:
            own = [c for c in joint.coordinates if (joint.name, c) in coordinates]
            if isinstance(joint, Spherical) and own:
                labels.append(f"{joint.name}.orientation")
            else:
                labels += [f"{joint.name}.{c}" for c in own]
        return tuple(labels)

    def _pair_candidates(self, cycle: Cycle) -> list[PairCandidate]:
        """Return the pairs of joints that both keep a point in common, most eliminated first."""
        pairs = [
            self._pair(cycle, a, b)
            for a, b in combinations(cycle.joints, 2)
            if _common_point(a, cycle) is not None and _common_point(b, cycle) is not None
        ]
        return sorted(pairs, key=lambda p: -p.eliminated)

    def _pair(self, cycle: Cycle, a: Joint, b: Joint) -> PairCandidate:
        eliminated = self._unknowns_of(a) + self._unknowns_of(b)
        idle = isinstance(a, Spherical) and isinstance(b, Spherical)
        dimension = 3 if cycle.planar else 6
        return PairCandidate((a, b), eliminated, dimension - eliminated + idle)

    def _closed_form(self, cycle: Cycle, pair: PairCandidate) -> Solution | None:
        if pair.equations != 1:
            return None
        for view in _views(cycle, pair):
            action = (
                self._telescope(view)
                or self._stroke(view)
                or self._turn(view)
                or self._driven_by_rod(view)
            )
            if action is not None:
                return action
        return None

    def _stroke(self, view: _CutLoop) -> SolveStroke | None:
        """Return the action for two links on a guide in a plane, both pins on placed bodies."""
        telescope = self._pinned_telescope(view)
        placed = {view.others[0], view.others[-1]} <= self._placed
        if telescope is None or not placed or self._unknowns_of(telescope.joint) == 0:
            return None
        return SolveStroke(**vars(telescope))

    def _pinned_telescope(self, view: _CutLoop) -> PinnedTelescope | None:
        """Return the telescope in a plane that one arc of a loop is."""
        if len(view.joints) != 1 or not isinstance(view.joints[0], Prismatic):
            return None
        near, far = view.bodies
        near_hinge = self.topology.joint_between(view.others[0], near)
        far_hinge = self.topology.joint_between(view.others[-1], far)
        if not (isinstance(near_hinge, Revolute) and isinstance(far_hinge, Revolute)):
            return None
        if {near, far} & self._placed:
            return None
        at_anchor = near, near_hinge, view.anchor, view.others[0]
        return PinnedTelescope(
            view.joints[0], *at_anchor, far, far_hinge, view.end, view.others[-1]
        )

    def _driven_by_rod(self, view: _CutLoop) -> SolveHinge | SolveSlide | None:
        """Return the action for a rod from a placed point to a body on a hinge or a guide."""
        pinned = self._pinned_telescope(view)
        if not (len(view.bodies) == 1 or pinned) or not view.other_joints:
            return None
        rod, joint, body = view.bodies[0], view.other_joints[-1], view.others[-1]
        parent = joint.other(body)
        settled = {rod, body} & self._placed or self._unknowns_of(joint) == 0
        if settled or not {parent, view.others[0]} <= self._placed:
            return None
        if pinned and self._unknowns_of(pinned.joint) > 0:
            return None
        telescope = PlaceTelescope(**vars(pinned)) if pinned else None
        held = parent, rod, view.end, view.anchor, view.others[0], telescope
        if isinstance(joint, Revolute):
            return SolveHinge(body, joint, *held)
        return SolveSlide(body, joint, *held) if isinstance(joint, Prismatic) else None

    def _telescope(self, view: _CutLoop) -> SolveTelescope | None:
        """Return the action for two links on a common axis, both ends on placed bodies."""
        if len(view.joints) != 1 or not isinstance(view.joints[0], Cylindrical):
            return None
        joint, (anchor_link, end_link) = view.joints[0], view.bodies
        # the axis of the joint runs from the second body to the anchor, a point of the first
        along_axis = joint.axis.towards == view.anchor
        placed = {view.others[0], view.others[-1]} <= self._placed
        if self.is_known(joint, "slide") or not (along_axis and placed):
            return None
        if anchor_link != joint.first:
            return None
        return SolveTelescope(
            joint, view.anchor, view.others[0], anchor_link, view.end, view.others[-1], end_link
        )

    def _turn(self, view: _CutLoop) -> SolveTurn | None:
        """Return the action for a rod from a placed point to a body that can still turn."""
        if len(view.bodies) != 1:
            return None
        if view.others[0] not in self._placed or view.others[-1] not in self._on_line:
            return None
        return SolveTurn(view.others[-1], view.bodies[0], view.end, view.anchor, view.others[0])

    def _accept(self, action: Solution) -> set[tuple[str, str]]:
        """Record what a solution makes known; return the coordinates that are new."""
        if isinstance(action, SolveHinge | SolveSlide):
            return self._accept_driven(action)
        if isinstance(action, SolveStroke):
            self.actions.append(action)
            return self._accept_telescope(action)
        if isinstance(action, SolveCarrier):
            return self._accept_carrier(action)
        if isinstance(action, SolveTelescope):
            new = {(action.joint.name, "slide")}
            self._on_line.add(action.end_link)
            joints = [] if action.misses_end else self._aim(action)
        else:
            new = set()
            self._on_line.discard(action.body)
            self._placed.add(action.body)
            self._on_line.add(action.rod)
            aimed = [
                a
                for a in self.actions
                if isinstance(a, SolveTelescope) and a.misses_end and a.end_link == action.body
            ]
            joints = [
                *(joint for a in aimed for joint in self._aim(a)),
                *self._mechanism.joints_of(action.rod),
                *(j for j in self._mechanism.joints_of(action.body) if self._joins_solved(j)),
            ]
        self.actions.append(action)
        new |= {(j.name, c) for j in joints for c in j.coordinates}
        new -= self._known
        self._known |= new
        return new

    def _accept_driven(self, action: SolveHinge | SolveSlide) -> set[tuple[str, str]]:
        """Record the body that a rod drives, and the rod: placed by its hinge, or on its line."""
        self.actions.append(action)
        self._placed.add(action.body)
        if action.telescope is not None:
            self.actions.append(action.telescope)
            own = {(action.joint.name, c) for c in action.joint.coordinates}
            self._known |= own
            return own | self._accept_telescope(action.telescope)
        carrier = self.topology.joint_between(action.anchor_body, action.rod)
        if isinstance(carrier, Revolute):
            self.actions.append(
                PlaceByPin(action.rod, carrier, action.anchor_body, action.end, action.body)
            )
            self._placed.add(action.rod)
        else:
            self._on_line.add(action.rod)
        solved = [action.joint, *self._mechanism.joints_of(action.rod)]
        joints = [j for j in solved if self._joins_solved(j)]
        new = {(j.name, c) for j in joints for c in j.coordinates} - self._known
        if not isinstance(carrier, Revolute):  # its turn about the line is still open
            new -= {
                (j.name, c) for j in self._mechanism.joints_of(action.rod) for c in j.coordinates
            }
        self._known |= new
        return new

    def _accept_carrier(self, action: SolveCarrier) -> set[tuple[str, str]]:
        """Record a body that rods hold together, and the rods: each on its line."""
        self.actions.append(action)
        self._placed.add(action.body)
        self._on_line |= {held.rod for held in action.rods}
        links = [link for held in action.rods for link in held.links]
        at_rods = [j for link in links for j in self._mechanism.joints_of(link)]
        at_body = [j for j in self._mechanism.joints_of(action.body) if self._joins_solved(j)]
        new = {(j.name, c) for j in (*at_rods, *at_body) for c in j.coordinates} - self._known
        self._known |= new
        return new

    def _accept_telescope(self, action: PinnedTelescope) -> set[tuple[str, str]]:
        """Record the two links of a telescope in a plane, and the joints at them."""
        self._placed |= {action.near, action.far}
        links = (action.joint, action.near_hinge, action.far_hinge)
        new = {(j.name, c) for j in links for c in j.coordinates} - self._known
        self._known |= new
        return new

    def _aim(self, action: SolveTelescope) -> list[Joint]:
        """Record that the direction of a telescope is known; return what that settles."""
        self._on_line.add(action.anchor_link)
        universal = self._mechanism.universal_at(action.anchor_link, action.anchor)
        return [universal] if universal else []

    def _joins_solved(self, joint: Joint) -> bool:
        solved = self._placed | self._on_line
        return all(body in solved for body in joint.bodies)

    # -- refusals -------------------------------------------------------------------------------

    def _refusal(self, cycle: Cycle, candidates: list[PairCandidate]) -> str:
        loop = " - ".join(cycle.bodies)
        tried = "; ".join(
            f"{p.joints[0].name}/{p.joints[1].name} leaves {p.equations} equation(s)"
            for p in candidates
        )
        return (
            f"the loop {loop} (joints {', '.join(j.name for j in cycle.joints)}) has no closed "
            f"form in the catalogue. {self._unknowns(cycle)} of its coordinates are unknown. "
            f"Pairs tried: {tried or 'none, since no two of its joints keep a point in common'}."
            f"{self._miscounted()}"
        )

    def _miscounted(self) -> str:
        """Say by how much the driven coordinates differ from the degrees of freedom."""
        joints = [
            self._mechanism.joint(n) for n in (*self.model.independent, *self.model.prescribed)
        ]
        driven, mobility = sum(j.freedoms for j in joints), self.topology.mobility
        if driven == mobility:
            return ""
        return (
            f" The model has {driven} independent or prescribed coordinate(s), its mechanism "
            f"{mobility} degree(s) of freedom: declare {abs(mobility - driven)} "
            f"{'fewer' if driven > mobility else 'more'}."
        )

    @staticmethod
    def _remedy(action: SolveCarrier | None) -> str:
        """Say whether an iteration would solve what has no closed form."""
        if action is None:
            return ""
        return (
            f" {action.body} is held by {action.rod_names} together: {len(action.rods)} equations "
            "remain in as many unknowns. Newton's method solves them, for these loops alone, if "
            "the model is declared with allow_iteration=True."
        )

    def _check_complete(self) -> None:
        missing = [b.name for b in self._mechanism.bodies if b.name not in self._placed]
        if missing:
            message = (
                f"model {self.model.name!r}: nothing determines the pose of {', '.join(missing)}; "
                "declare one more independent or prescribed joint"
            )
            raise NoClosedFormError(message)
