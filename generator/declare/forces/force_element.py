"""Springs, dampers and stops along a path."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import sympy as sp
from typing_extensions import override

from ..declared import DeclarationError, Name, declared
from ..inputs import Input
from ..laws import Law, Stretch
from ..parameters import Parameter
from ..paths import Path
from ..shown import Event, Range, Shown
from .force import Action, Description, Force

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ..surroundings import Surroundings
    from ..whole import Whole


@declared
@dataclass(frozen=True)
class ForceElement(Force):
    """Springs, dampers and stops that act along one path between two bodies (Eq. 23 of the paper).

    Parameters
    ----------
    name
        Prefix of the names of its signals: ``<name>_length`` [m], ``<name>_velocity`` [m/s]; of a
        twist, ``<name>_angle`` [rad] and ``<name>_angular_velocity`` [rad/s].
    path
        The line between two points, or the joint, along which it acts.
    laws
        Springs, dampers and so on. Their forces are added; a positive one pushes the ends apart.
    """

    name: Name
    path: Path
    laws: tuple[Law, ...]

    def __post_init__(self) -> None:
        problems = [
            f"law {law!r} is declared twice; once is enough"
            for i, law in enumerate(self.laws)
            if law in self.laws[:i]
        ]
        problems += [problem for law in self.laws for problem in law.problems(self.path)]
        wanted = "an angle or a moment" if self.turns else "a length or a force"
        problems += [
            f"{number.name!r} is in {number.unit}; {type(self.path).__name__} needs a parameter "
            f"of {wanted}"
            for law in self.laws
            for number in vars(law).values()
            if isinstance(number, Parameter) and number.of_angle not in (None, self.turns)
        ]
        problems += [
            f"input {given.name!r} is in {given.unit}; {self.path.words.unit} is needed"
            for law in self.laws
            for given in vars(law).values()
            if isinstance(given, Input) and given.unit != self.path.words.unit
        ]
        events = [e.name for law in self.laws for e in law.events_of_length(self.name)]
        problems += [
            f"event {name!r} is declared twice; an element has one stop of each side: put the "
            "other one on an element of its own"
            for name in dict.fromkeys(events)
            if events.count(name) > 1
        ]
        if problems:
            raise DeclarationError(f"ForceElement {self.name!r}", problems)

    @property
    def identity(self) -> tuple[str, str]:
        return "force", self.name

    @property
    def turns(self) -> bool:
        """Whether it acts on an angle, by moments."""
        return self.path.words.force == "moment"

    def signal(self, law: Law) -> str:
        """Return the name of the signal of one of its laws, without the element's name."""
        return law.signal.replace("force", self.path.words.force)

    def shown_as(self, law: Law, mechanism: Whole) -> str:
        """Return the name of a law's signal, with the element's where other elements have it too.

        That of a moment always has the element's name.

        Parameters
        ----------
        law, mechanism
            One of its laws, and the mechanism.
        """
        signal = self.signal(law)
        having = [
            force
            for force in mechanism.forces
            if isinstance(force, ForceElement) and signal in map(force.signal, force.laws)
        ]
        alone = len(having) == 1 and not self.turns
        return signal if alone else f"{self.name}_{signal}"

    def describe(self) -> Description:
        laws = "; ".join(law.describe() for law in self.laws)
        length = r"\vartheta" if self.turns else r"\ell"
        share = rf"$`\left(\partial {length}/\partial\mathbf{{q}}\right)^T F`$"
        return Description(self.name, f"F, {self.path.words.sense}: {laws}", share)

    def act(self, at: Surroundings) -> Action:
        """Append the sum of the laws; a force that pushes the ends apart acts on the length."""
        program, name = at.program, self.name
        path = self.path.path_length(at, name)
        rates = [m * at.rate(k) for k, m in path.motion.items()]
        velocity = program.define(f"{name}_velocity", sum(rates, sp.Integer(0)))
        stretch = Stretch(program, name, path.length, velocity, path.slide)
        values, total = {self._of_length: path.length, self._of_rate: velocity}, sp.Integer(0)
        for shown, laws in self._by_signal(at.mechanism).items():
            own = sum((law.force(stretch) for law in laws), sp.Integer(0))
            values[shown] = program.define(shown, own)
            total += values[shown]
        total = program.define(f"{name}_total_force", total)
        own = {state: rate for law in self.laws for state, rate in law.rates(stretch).items()}
        return Action({k: total * m for k, m in path.motion.items()}, values, total, own)

    def _by_signal(self, mechanism: Whole) -> dict[str, list[Law]]:
        """Return the laws by the names of their signals; those of one name are shown together."""
        groups: dict[str, list[Law]] = {}
        for law in self.laws:
            groups.setdefault(self.shown_as(law, mechanism), []).append(law)
        return groups

    @property
    def _of_length(self) -> str:
        return f"{self.name}_{self.path.words.length[0]}"

    @property
    def _of_rate(self) -> str:
        return f"{self.name}_{self.path.words.rate[0]}"

    @override
    def signals(self, at: Surroundings, action: Action) -> Iterator[Shown]:
        words, described = self.path.words, {}
        for name, (_, unit, meaning) in (
            (self._of_length, words.length),
            (self._of_rate, words.rate),
        ):
            described[name] = unit, meaning.format(self.name)
        for law in self.laws:
            if not law.from_outside:
                meaning = f"{law.meaning.replace('force', words.force)}, {words.sense}"
                described[self.shown_as(law, at.mechanism)] = words.unit, meaning
        ranges, events = self._ranges, {self._of_length: self._events}
        for name, (unit, meaning) in described.items():
            limits = ranges.get(name, ()), events.get(name, ())
            yield Shown(name, action.values[name], unit, meaning, *limits)

    @property
    def _ranges(self) -> dict[str, tuple[Range, ...]]:
        """Valid ranges of length and rate."""
        of_path = self.path.ranges_of_length(self.name)
        of_length = tuple(r for law in self.laws for r in law.ranges_of_length())
        of_rate = tuple(r for law in self.laws for r in law.ranges_of_rate())
        return {self._of_length: (*of_path, *of_length), self._of_rate: of_rate}

    @property
    def _events(self) -> tuple[Event, ...]:
        """Events at certain lengths."""
        of_laws = (event for law in self.laws for event in law.events_of_length(self.name))
        return (*self.path.events_of_length(self.name), *of_laws)
