"""Proposals of independent coordinates of a mechanism, or the reason for their absence.

The mobility gives their number, without the turns of links about their own line. Sets of so many
reported coordinates are tried by planning the solution of all loops, joints on the ground before
others: they are driven, as a rule. A trial takes milliseconds, but there may be very many.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import combinations, islice
from math import comb
from time import monotonic
from typing import TYPE_CHECKING

from ..declare.formulation import Formulation
from ..declare.joints import Free, Prismatic, Revolute
from ..loops.errors import NoClosedFormError
from ..loops.graph import JointGraph
from ..loops.redundant import redundant
from ..loops.tilted import tilted
from .plan import CataloguePlan

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from ..declare.joints import Joint
    from ..declare.mechanism import Mechanism

_SECONDS_TO_FIND = 20.0  # with so many choices, the author would name one
_SECONDS_TO_ADVISE = 3.0
_CHOICES_SHOWN = 3


@dataclass(frozen=True)
class Proposal:
    """Joints whose coordinates can be independent."""

    independent: tuple[str, ...]  # names of the joints
    # whether a loop is solved by iteration, which `Formulation.allow_iteration` must permit
    iterates: bool = False


def model_of(mechanism: Mechanism) -> Formulation:
    """Return a model of a mechanism with the first proposed coordinates, all bodies massive.

    Raises `NoClosedFormError` if there is no such set of coordinates.
    """
    search = CoordinateSearch(_bare(mechanism))
    closed = next(search.closed(_SECONDS_TO_FIND), None)
    if closed is None:
        raise NoClosedFormError(search.refusal())
    return search.model(closed.independent)


def proposals(
    declared: Mechanism | Formulation, seconds: float | None = None
) -> Iterator[Proposal]:
    """Yield sets of joints whose coordinates can be independent, in the order of preference.

    Sets with which every loop has a closed form come first. Prescribed coordinates of a model
    remain prescribed. `seconds` limits the time of each of the two searches; None: unlimited.
    """
    search = CoordinateSearch(declared if isinstance(declared, Formulation) else _bare(declared))
    closed = set()
    for proposal in search.closed(seconds):
        closed.add(proposal.independent)
        yield proposal
    yield from (p for p in search.iterated(seconds) if p.independent not in closed)


def advice(refused: Formulation) -> str:
    """Return a sentence with other independent coordinates for a refused model, if any."""
    search = CoordinateSearch(refused)
    if search.impossible:
        return ""
    closed = list(islice(search.closed(_SECONDS_TO_ADVISE), _CHOICES_SHOWN))
    if closed:
        return f"Every loop has a closed form with {_either(closed)}."
    if not refused.allow_iteration:
        return search.summary()
    iterated = list(islice(search.iterated(_SECONDS_TO_ADVISE), _CHOICES_SHOWN))
    return f"Every loop closes with {_either(iterated)}." if iterated else search.summary()


class CoordinateSearch:
    """Trials of all sets of reported coordinates that could be independent.

    The choice of independent joints in the model is ignored.
    """

    def __init__(self, formulation: Formulation) -> None:
        self._model = formulation
        mechanism = formulation.mechanism
        self.mobility = JointGraph(mechanism).mobility - len(mechanism.passive_links)
        given = formulation.motions
        self._free = _free(mechanism)
        self.count = self.mobility - sum(j.freedoms for j in self._free) - len(given)
        self.candidates = [j.name for j in _candidates(mechanism) if j.name not in given]
        needed = [force.along for force in mechanism.forces if force.along is not None]
        needed += [joint.first_followed for joint in mechanism.geared]
        self._needed = {joint.name for joint in needed}.difference(given)
        self._tried = 0
        self._nearest: tuple[tuple[str, ...], NoClosedFormError] | None = None

    @property
    def impossible(self) -> str:
        """Reason why no set can be tried; empty: there are sets."""
        mechanism, reported = self._model.mechanism, ", ".join(self.candidates) or "none"
        what = f"mechanism {mechanism.name!r} with mobility {self.mobility}"
        if self.count < 0 or self.mobility <= 0:
            special = (
                "If special dimensions let it move all the same, declare a Formulation that names "
                "the independent joints"
            )
            return (
                f"{what}: counting the degrees of freedom of its joints leaves nothing to move. "
                f"{tilted(mechanism) or redundant(mechanism) or special}"
            )
        if len(self.candidates) < self.count:
            return (
                f"{what}: {self.count} coordinate(s) must be independent; of hinges and guides it "
                f"reports {reported}. Report more of them among the coordinates, or declare a "
                "Formulation with prescribed joints"
            )
        if not self._needed <= set(self.candidates) or len(self._needed) > self.count:
            return (
                f"{what}: forces along joints (JointForce) or gears need the coordinates of "
                f"{', '.join(sorted(self._needed))}, but {self.count} of {reported} must be "
                "independent. Report these joints, or let Actuators in ForceElements push between "
                "points instead"
            )
        return ""

    def closed(self, seconds: float | None = None) -> Iterator[Proposal]:
        """Yield sets with a closed form of every loop, within a time limit."""
        yield from map(Proposal, self._closing(seconds, allow_iteration=False))

    def iterated(self, seconds: float | None = None) -> Iterator[Proposal]:
        """Yield sets with which every loop closes if iteration is allowed, within a time limit."""
        for independent in self._closing(seconds, allow_iteration=True):
            yield Proposal(independent, iterates=True)

    def model(self, independent: tuple[str, ...], *, allow_iteration: bool = False) -> Formulation:
        """Return the model with some independent joints, by their names."""
        joints = map(self._model.mechanism.joint, independent)
        every = (*self._free, *joints)
        return replace(self._model, independent=every, allow_iteration=allow_iteration)

    def refusal(self) -> str:
        """Return the reason of a failure, with the nearest trial and a remedy."""
        if self.impossible:
            return self.impossible
        name = self._model.mechanism.name
        text = f"mechanism {name!r} with mobility {self.mobility}. {self.summary()}"
        iterated = next(self.iterated(_SECONDS_TO_FIND), None)
        if iterated is not None:
            text += (
                " With iteration it does: declare a Formulation with "
                f"independent={iterated.independent} and allow_iteration=True."
            )
        if self._nearest is not None:
            independent, refusal = self._nearest
            text += f" Nearest came independent={independent}: {refusal}"
        return (
            f"{text.removesuffix('.')}. Otherwise report more coordinates, or declare a "
            "Formulation with the independent and the prescribed joints that you mean"
        )

    def summary(self) -> str:
        """Return a sentence on the failure of all sets, with their number."""
        every = comb(len(self.candidates) - len(self._needed), self.count - len(self._needed))
        limit = "" if self._tried >= every else f"the first {self._tried} of "
        return (
            f"From no {self.count} of the reported angles and slides "
            f"({', '.join(self.candidates)}; {limit}{every} set(s) tried) does every loop close in "
            "closed form."
        )

    def _closing(
        self, seconds: float | None, *, allow_iteration: bool
    ) -> Iterator[tuple[str, ...]]:
        end = None if seconds is None else monotonic() + seconds
        sets = [] if self.impossible else combinations(self.candidates, self.count)
        tried = 0
        for independent in sets:
            if not self._needed <= set(independent):
                continue
            if end is not None and monotonic() > end:
                return
            tried += 1
            self._tried = max(self._tried, tried)
            try:
                CataloguePlan.of(self.model(independent, allow_iteration=allow_iteration))
            except NoClosedFormError as refusal:
                # the nearest trial is the one with the most loops solved before
                if self._nearest is None or refusal.solved > self._nearest[1].solved:
                    self._nearest = independent, refusal
            else:
                yield independent


def _either(choices: Iterable[Proposal]) -> str:
    return " or ".join(f"independent={choice.independent}" for choice in choices)


def _bare(mechanism: Mechanism) -> Formulation:
    """Return a model of a mechanism with all possible coordinates independent."""
    return Formulation(
        name=mechanism.name,
        title=mechanism.title,
        mechanism=mechanism,
        independent=(*_free(mechanism), *_candidates(mechanism)),
        massive=mechanism.moving,
    )


def _free(mechanism: Mechanism) -> tuple[Joint, ...]:
    """Return the joints that must be independent: those of bodies that move in the world."""
    return tuple(joint for joint in mechanism.joints if isinstance(joint, Free))


def _candidates(mechanism: Mechanism) -> tuple[Joint, ...]:
    """Return the joints with one reported coordinate, those on the ground first."""
    reported = {c.joint.name for c in mechanism.coordinates}
    joints = [
        j
        for j in mechanism.joints
        if isinstance(j, Revolute | Prismatic) and j.name in reported and not j.follows
    ]
    joints.sort(key=lambda joint: mechanism.ground not in joint.bodies)  # stable
    return tuple(joints)
