"""Targets and limits of characteristics, from a file or an argument."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, ClassVar, TypeVar

import numpy as np
from numpy.typing import NDArray

from ...core.named_types import Array
from ...core.quantities import bracketed, display_of
from ...core.validator import Validator
from ..analysis.compliance.flexibility import HELD
from ..assembly.by_wheel import columns_of
from ..assembly.of import assembly_of, given_assembly
from ..assembly.quantity import Quantity
from ..assembly.rig import STEERING
from ..corner.wheeled import NOT_STEERED
from ..input.toml_file import read_sections
from .curves import CurveBundle, Curves
from .evaluation import available, listed
from .loading import CASES, LOADING
from .sweep_axes import (
    ALL_AXES,
    OF_CORNERS,
    compliances_over,
    given_axis,
    known_over,
    name_of_axis,
    options_of,
    sweep_axes_of,
    sweep_axis,
    title_of_axis,
)

SECTIONS = (
    "distribution", "tolerances", "free", "targets", "minimise", "maximise", "limits", "accuracy",
)  # fmt: skip
# Axes that are not named in titles.
_USUAL = ("travel", "bump", "heave")
# Greatest value of a characteristic and least deviation in a file, in display units.
GREATEST, LEAST = 1e9, 1e-9


@dataclass(frozen=True)
class Goal:
    """A characteristic at some positions: to make least or greatest, or with a target or a limit.

    Attributes
    ----------
    KIND : str
        'extreme', 'target' or 'limit'.
    """

    name: str
    # one of `sweep_axes.ALL_AXES`, with its options; or the support of the wheel under loads
    over: str
    at: Array  # positions, (n,) [m]; over roll [rad]

    KIND: ClassVar[str] = "extreme"

    def beyond(self, values: Array) -> Array:
        """Return by how much values at its positions miss the goal; not above zero if it is met.

        No value misses an extreme.
        """
        return np.full(np.shape(values), -np.inf)

    @property
    def quantity(self) -> Quantity:
        """The quantity of the characteristic."""
        return sweep_axis(self.over).known[self.name]

    @property
    def over_words(self) -> str:
        """The axis after a name, such as `` over the rack``; empty for the usual axis."""
        usual = self.over in _USUAL or self.over in HELD
        return "" if usual else f" over {sweep_axis(self.over).words}"

    @property
    def curves(self) -> Curves:
        """The curves of the characteristic at its positions."""
        return Curves(self.over, self.at, (self.name,))


@dataclass(frozen=True)
class TargetValue(Goal):
    """A target of a characteristic, with values at n positions, (n,), in SI units.

    `within` is a deviation that matters, SI units, the unit of deviations; NaN if it is not needed
    and left out, as in `pareto`.
    """

    value: Array
    within: float

    KIND: ClassVar[str] = "target"

    def beyond(self, values: Array) -> Array:
        return np.abs(values - self.value) - self.within


@dataclass(frozen=True)
class Limit(Goal):
    """A limit of a characteristic.

    Attributes
    ----------
    name, over, at
        Characteristic, motion or axis, and positions on it.
    least, most : float
        Bounds, SI units; infinite if there is none.
    """

    least: float
    most: float

    KIND: ClassVar[str] = "limit"

    def beyond(self, values: Array) -> Array:
        return np.maximum(self.least - values, values - self.most)

    def kept(self, values: Array) -> NDArray[np.bool_]:
        """Return which of some values are within the limit."""
        return (values >= self.least) & (values <= self.most)

    @property
    def sides(self) -> list[tuple[float, float]]:
        """The finite bounds, with 1 for a lower and -1 for an upper bound."""
        return [(s, b) for s, b in ((1.0, self.least), (-1.0, self.most)) if np.isfinite(b)]

    @property
    def size(self) -> float:
        """The unit of room, that of the greater bound."""
        return max(abs(bound) for _, bound in self.sides) or 1.0

    def room(self, values: Array) -> Array:
        """Return the distances to the bounds, in parts of the size; negative beyond a bound."""
        return np.concatenate([sign * (values - bound) / self.size for sign, bound in self.sides])


def read(path: str | Path) -> dict[str, Any]:
    """Return the content of a TOML file of tolerances, free values, targets and limits.

    Parameters
    ----------
    path : str or pathlib.Path

    Returns
    -------
    dict
        By the name of the section. Paths of load cases, which are relative to the file, include its
        folder.

    Raises
    ------
    InputError
        If it cannot be read, or has other sections.
    """
    found = read_sections(path, SECTIONS)
    return {name: _in(Path(path).parent, section) for name, section in found.items()}


def _in(folder: Path, described: Any) -> Any:
    """Return a section with the folder in the paths of load cases."""
    if isinstance(described, list):
        return [_in(folder, each) for each in described]
    if not isinstance(described, Mapping):
        return described
    return {
        key: str(folder / value) if key == CASES and isinstance(value, str) else _in(folder, value)
        for key, value in described.items()
    }


def limits(described: Mapping[str, Any], axes: Sequence[str] = OF_CORNERS) -> list[Limit]:
    """Return limits of characteristics from tables as in `tolerance` and `optimise`.

    Parameters
    ----------
    described : mapping
        By characteristic.
    axes : sequence of str, optional
        As in `goals`.

    Returns
    -------
    list of Limit
    """
    with Validator("limits") as given:
        tables = given.mapping("limits", described, "names and limits")
        return limits_of(given, tables, _axes(given, axes))


def goals(described: Mapping[str, Any], axes: Sequence[str] = OF_CORNERS) -> list[Goal]:
    """Return targets and limits of characteristics from the sections of a file.

    Parameters
    ----------
    described : mapping
        Result of `read`; other sections are not used.
    axes : sequence of str, optional
        Motions of the goals, the first one by default: ``travel`` and ``rack``, or of an axle, also
        a rigid one, ``bump``, ``roll``, ``left`` and ``right``; and ``load`` of load cases.

    Returns
    -------
    list of TargetValue and Limit
    """
    with Validator("goals") as given:
        sections = given.mapping("described", described, "sections and tables")
        known = _axes(given, axes)
        targets, limits = (
            given.mapping(name, sections.get(name, {}), "tables") for name in ("targets", "limits")
        )
        return [*targets_of(given, targets, known), *limits_of(given, limits, known)]


def _axes(given: Validator, axes: Any) -> Sequence[str]:
    """Return the axes of goals; the usual ones if the argument is not valid."""
    names = given.names("axes", axes, ALL_AXES)
    if not names and not given.failed:
        given.fail(f"axes is empty: one is needed, of {', '.join(ALL_AXES)}.")
    return names or OF_CORNERS


def words_of(kind: str, name: str, over: str) -> str:
    """Return a target or limit in words: ``limit: scrub radius [mm] over the rack``."""
    quantity = sweep_axis(over).known[name]
    words = f"{kind}: {bracketed(quantity.long_name, quantity.attributes())}"
    if over in HELD:
        return f"{words} (held: {over})"
    return words if over in _USUAL else f"{words} over {sweep_axis(over).words}"


@dataclass(frozen=True)
class Verdict:
    """Result for a goal.

    Attributes
    ----------
    name, over : str
        The characteristic, and the motion along its curve or, of compliance, the support of the
        wheels.
    kind : str
        'target' or 'limit'.
    met : bool
        Whether all of its positions are within the limit, or within ``within`` of the target.
    beyond : float
        Amount by which the value at the worst position is beyond the limit, or beyond ``within`` of
        the target, SI units; negative if the goal is met.
    at : float
        The worst position, SI units: of travel or rack [m], of roll [rad].
    """

    name: str
    over: str
    kind: str
    met: bool
    beyond: float
    at: float


def judge(suspension: Any, wanted: Sequence[Goal]) -> list[Verdict]:
    """Return for each target and limit whether a suspension, an axle or a car meets it.

    Parameters
    ----------
    suspension : Suspension, Model, Axle, RigidAxle or Car
    wanted : sequence of TargetValue and Limit
        Result of `goals`.

    Returns
    -------
    list of Verdict
        In the order of `wanted`, for each wheel if a name is that of all wheels.

    Raises
    ------
    InputError
        If the file lacks data for one of them.
    PositionError
        If the suspension does not reach a position.

    Examples
    --------
    >>> from kintrafo import load, variation
    >>> car = load("reference_car")
    >>> limits = {"toe": {"at_mm": [-50.0, 50.0], "least": -0.2, "most": 0.2}}
    >>> found = variation.judge(car, variation.goals({"limits": limits}))
    >>> [(verdict.name, verdict.met, verdict.at) for verdict in found]
    [('toe', False, -0.05)]
    """
    with Validator("judge") as given:
        given_assembly(given, suspension, "suspension", cars=True)
        check_goals(given, "wanted", wanted)
        if not given.failed:
            assembly = assembly_of(suspension)
            check_data(given, assembly, wanted)
    wanted = of_columns(assembly, wanted)
    found = CurveBundle([goal.curves for goal in wanted]).of(assembly) if wanted else []
    return [_verdict(goal, values[0]) for goal, values in zip(wanted, found, strict=True)]


def _verdict(goal: Goal, values: Array) -> Verdict:
    beyond = goal.beyond(values)
    worst, met = int(beyond.argmax()), bool((beyond <= 0.0).all())
    found = float(beyond[worst]), float(goal.at[worst])
    return Verdict(goal.name, goal.over, goal.KIND, met, *found)


def check_goals(given: Validator, name: str, wanted: Any) -> None:
    """Add an error for anything but a list of goals."""
    if not isinstance(wanted, list | tuple) or not all(
        isinstance(one, TargetValue | Limit) for one in wanted
    ):
        given.fail(f"{name}: a list of targets and limits, from `variation.goals`, is needed.")


_Goal = TypeVar("_Goal", bound=Goal)


def of_columns(suspension: Any, goals: Iterable[_Goal]) -> list[_Goal]:
    """Return goals of single columns: those of all wheels for a name without wheel."""
    assembly = assembly_of(suspension)
    return [
        replace(goal, name=name)
        for goal in goals
        for name in columns_of([goal.name], available(assembly, goal.over))
    ]


def check_data(given: Validator, suspension: Any, goals: Iterable[Goal]) -> None:
    """Add errors for goals without data in the file, or without a finite value.

    A position out of reach is a `PositionError`.
    """
    assembly = assembly_of(suspension)
    axes = sweep_axes_of(suspension)
    for goal in goals:
        axis = axes[0] if goal.over in HELD else title_of_axis(goal.over)
        name = f"{goal.name} over {axis}"
        if name_of_axis(goal.over) not in (*axes, *HELD):
            given.fail(f"{name}: the curves of this subject are over {', '.join(axes)}.")
            continue
        assembly.refuse_of_steering([goal.name])
        known = available(assembly, goal.over)
        columns = columns_of([goal.name], known)
        if not {*columns} <= {*known}:
            if name_of_axis(goal.over) == LOADING:
                words = f"{sweep_axis(goal.over).words}:"
                given.among(words, goal.name, listed(goal.over, known))
                continue
            given.fail(
                f"{name}: the file lacks data for this characteristic. Add them to [vehicle], "
                "[rack], [tyre] or [bushings]."
            )
            continue
        values = replace(goal.curves, names=tuple(columns)).of(assembly)
        missing = goal.at[~np.isfinite(values).all(axis=0)]
        if missing.size:
            over = sweep_axis(goal.over)
            places = ", ".join(f"{over.factor * at:g} {over.unit}" for at in missing)
            given.fail(
                f"{name}: it has no finite value at {places}, as a turning circle straight ahead. "
                f"Leave that position out of {over.key}."
            )


def targets_of(
    given: Validator, described: Mapping[str, Any], axes: Sequence[str], *, weighed: bool = True
) -> list[TargetValue]:
    """Return targets by the names of characteristics, in millimetres and display units.

    A characteristic has a table, or a list of tables, as over travel and over the rack. ``within``
    may be left out if targets are not weighed against each other.
    """
    found = []
    for name, table in _tables(given, described, ("targets", axes), {"value", "within"}):
        left_out = not weighed and "within" not in table.entries
        within = np.nan if left_out else table.number("within", least=LEAST)
        found.append(TargetValue(name, table.over, table.at, table.numbers("value"), within))
    return found


def extremes_of(
    given: Validator, described: Mapping[str, Any], section: str, axes: Sequence[str]
) -> list[Goal]:
    """Return characteristics to minimise or maximise, with their positions, as `targets_of`."""
    found = _tables(given, described, (section, axes), set())
    return [Goal(name, table.over, table.at) for name, table in found]


def limits_of(given: Validator, described: Mapping[str, Any], axes: Sequence[str]) -> list[Limit]:
    """Return limits by the names of characteristics, as `targets_of`."""
    found = []
    for name, table in _tables(given, described, ("limits", axes), {"least", "most"}):
        least, most = (
            table.number(key) if key in table.entries else sign * np.inf
            for key, sign in (("least", -1.0), ("most", 1.0))
        )
        if not least < most:
            given.fail(f"[limits.{name}]: least must be smaller than most.")
        if not {"least", "most"} & {*table.entries}:
            given.fail(f"[limits.{name}]: least or most is needed, in {table.unit}.")
        found.append(Limit(name, table.over, table.at, least, most))
    return found


@dataclass(frozen=True)
class _GoalTable:
    """A table of a file for one characteristic."""

    given: Validator
    title: str
    entries: Mapping[str, Any]
    over: str
    at: Array
    unit: str
    factor: float

    def number(self, key: str, *, least: float = -GREATEST) -> float:
        """Return a number in SI units."""
        value = self._given(key)
        name = f"{self.title} {key}"
        return self.given.number(name, value, self.unit, least=least, below=GREATEST) / self.factor

    def numbers(self, key: str) -> Array:
        """Return a number for each position in SI units; one represents all."""
        name = f"{self.title} {key}"
        values = self.given.array(name, self._given(key), self.unit, dimensions=[0, 1])
        if values.size not in (1, self.at.size):
            self.given.fail(
                f"{name}: {values.size} numbers and {self.at.size} in "
                f"{sweep_axis(self.over).key}: one for each position is needed, or one for all."
            )
            return np.zeros_like(self.at)
        if (np.abs(values) > GREATEST).any():
            self.given.fail(f"{name}: numbers of {GREATEST:g} {self.unit} or less are needed.")
        return np.broadcast_to(values / self.factor, self.at.shape).copy()

    def _given(self, key: str) -> Any:
        if key not in self.entries:
            self.given.fail(f"{self.title}: {key} is missing, in {self.unit}.")
        return self.entries.get(key, 1.0)


def _tables(
    given: Validator, described: Mapping[str, Any], of: tuple[str, Sequence[str]], keys: set[str]
) -> Iterable[tuple[str, _GoalTable]]:
    section, axes = of
    for name, table in (
        (str(name), table)
        for name, tables in described.items()
        for table in (tables if isinstance(tables, list | tuple) else [tables])
    ):
        title = f"[{section}.{name}]"
        if not isinstance(table, Mapping):
            at_key = sweep_axis(axes[0]).key
            given.fail(f"{title} must be a section, with {' and '.join([at_key, *sorted(keys)])}.")
            continue
        named = table.get("over", axes[0])
        if isinstance(named, str) and named in STEERING and not {*STEERING, "heave"} & {*axes}:
            given.fail(NOT_STEERED.format(f"{title} over = {named!r}"))
            continue
        options = options_of(named) if isinstance(named, str) else ()
        chosen = {key: table[key] for key in options if key in table}
        over = given_axis(given, f"{title} over", named, axes, chosen)
        under_loads = compliances_over(over)
        at_key, known = sweep_axis(over).key, known_over(over, axes[0])
        if under_loads:
            known = {**known, **under_loads}
        columns = columns_of([name], known)
        known_keys = [at_key, "over", *options, *sorted(keys)]
        if {*columns} <= {*under_loads}:
            known_keys.append("held")
            over = given.among(f"{title} held", table.get("held", "height"), HELD)
        for key in table.keys() - {*known_keys}:
            given.fail(f"{title} {key} is not known: there are {', '.join(known_keys)}.")
        if columns[0] not in known:
            given.among(title, name, known)
            continue
        shown = display_of(known[columns[0]].attributes())
        unit, factor = sweep_axis(over).unit, sweep_axis(over).factor
        asked = table.get(at_key, factor * sweep_axis(over).at)
        at = given.array(f"{title} {at_key}", asked, unit, dimensions=[0, 1])
        positions = np.atleast_1d(at) / factor
        found = _GoalTable(given, title, table, over, positions, shown.units, shown.factor)
        yield from ((column, found) for column in columns)
