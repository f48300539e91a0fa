"""Axes of curves: motions of a rig, supports of wheels, load cases, steady turns, speeds."""

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import lru_cache, partial
from typing import Any, get_args

import xarray as xr

from ...core.named_types import Array
from ...core.validator import Validator, shown
from ..analysis.characteristics.datasets import KNOWN, OF_AXLES, OF_CARS
from ..analysis.compliance.flexibility import WheelSupport
from ..analysis.compliance.linear import (
    COMPLIANCES,
    COMPLIANCES_OF_AXLES,
    COMPLIANCES_OF_CARS,
    linear,
)
from ..assembly.assembly import Assembly
from ..assembly.by_wheel import WHEEL, flat
from ..assembly.of import assembly_of
from ..assembly.quantity import HEAVE, PITCH, RACK, ROLL, STEERING_WHEEL, TRAVEL, Quantity
from . import loading, riding, turning
from .axis import SweepAxis
from .loading import CASES, LOADING
from .riding import RIDE
from .turning import TURNS

_OF_AXLES = {
    "bump": (TRAVEL, "parallel wheel travel"),
    "roll": (ROLL, "roll"),
    "left": (TRAVEL, "travel of the left wheel"),
    "right": (TRAVEL, "travel of the right wheel"),
    "steer": (STEERING_WHEEL, "the steering wheel"),
}
SWEEP_AXES: dict[str, SweepAxis] = {
    "travel": SweepAxis(TRAVEL, KNOWN["travel"], "wheel travel"),
    # curves over the rack are those of suspensions and of axles
    "rack": SweepAxis(RACK, OF_AXLES[RACK.name] | KNOWN["rack"], "the rack"),
    **{
        name: SweepAxis(along, OF_AXLES[along.name], words)
        for name, (along, words) in _OF_AXLES.items()
    },
    # curves over roll are those of axles and of cars
    "roll": SweepAxis(ROLL, OF_AXLES[ROLL.name] | OF_CARS, "roll"),
    "heave": SweepAxis(HEAVE, OF_CARS, "heave of the body"),
    "pitch": SweepAxis(PITCH, OF_CARS, "pitch of the body"),
}
"""Axes of characteristics by the name of the motion."""


def _compliance(held: WheelSupport, assembly: Assembly, travels: Array) -> xr.Dataset:
    """Return the compliance of an assembly; of a car, the columns of its parts with bushes."""
    if not assembly.body_moves:
        return linear(assembly, None, travels, held=held).drop_dims(["moved", "by"])
    curves: dict[str, xr.Variable] = {}
    for name, part in assembly.held_parts.items():
        if not part.has_bushes:
            continue
        found = _compliance(held, part, travels)
        if assembly.axles:
            wheels = found[WHEEL].copy(data=[f"{name}_{wheel}" for wheel in part.wheels])
            of_axle = [str(one) for one, data in found.items() if WHEEL not in data.dims]
            found = found.assign_coords({WHEEL: wheels})
            found = found.rename_vars({one: f"{one}_{name}" for one in of_axle})
        curves |= {str(one): data.variable for one, data in flat(found).items()}
    return xr.Dataset(curves, {TRAVEL.name: (TRAVEL.name, travels, TRAVEL.attributes())})


_COMPLIANCES = COMPLIANCES | COMPLIANCES_OF_AXLES | COMPLIANCES_OF_CARS
UNDER_LOADS = {
    held: SweepAxis(TRAVEL, _COMPLIANCES, "wheel travel", partial(_compliance, held))
    for held in get_args(WheelSupport)
}
"""Axes of compliance, wheel travel in parallel, by the support of the wheels."""

OF_CORNERS = ("travel", "rack", LOADING)
_COMPLIANCES_OVER: dict[str, Mapping[str, Quantity]] = {
    "travel": COMPLIANCES,
    "bump": COMPLIANCES_OF_AXLES,
    "heave": COMPLIANCES | COMPLIANCES_OF_CARS,
}
# Curves over axes of one name that differ between subjects, by axis and usual axis.
_OF_SUBJECTS = {
    ("rack", "travel"): KNOWN["rack"],
    ("rack", "bump"): OF_AXLES[RACK.name],
    ("roll", "bump"): OF_AXLES[ROLL.name],
    ("roll", "heave"): OF_CARS,
}


@dataclass(frozen=True)
class _Family:
    """Axes of one name with different options, and a function that returns the axis with some."""

    options: tuple[str, ...]
    axis: Callable[[Validator, Mapping[str, Any]], SweepAxis]
    # returns options as texts and numbers, from those that were given
    plain: Callable[[Validator, Mapping[str, Any]], Mapping[str, Any]] = lambda _, given: given


_FAMILIES = {
    TURNS: _Family(turning.OPTIONS, turning.axis),
    RIDE: _Family(riding.OPTIONS, riding.axis),
    LOADING: _Family(loading.OPTIONS, loading.axis, loading.plain),
}


def options_of(over: str) -> tuple[str, ...]:
    """Return the names of the options of an axis, none of most axes."""
    return _FAMILIES[name_of_axis(over)].options if name_of_axis(over) in _FAMILIES else ()


def name_of_axis(over: str) -> str:
    """Return the name of an axis without its options: that of ``speed:road=C`` is ``speed``."""
    return over.partition(":")[0]


def title_of_axis(over: str) -> str:
    """Return the name of an axis with its options for a message: of a load case, its name."""
    return over.partition(f",{CASES}=")[0]


def given_axis(
    given: Validator,
    title: str,
    over: Any,
    axes: Iterable[str],
    options: Mapping[str, Any] | None = None,
) -> str:
    """Return the checked name of an axis with its options: ``speed:road=C,seat=driver``.

    Options may be in the name, or further ones such as those of a file; `axes` are the possible
    names.
    """
    known = tuple(axes)
    name = name_of_axis(over) if isinstance(over, str) else over
    if given.among(title, name, known) != name:
        return known[0]
    found: dict[str, Any] = {}
    for key, mark, value in _parts_of(over):
        if not mark or not options_of(name):
            given.fail(f"{title} = {shown(over)}: write NAME:OPTION=VALUE,... Options are those of "
                       f"{' and '.join(_FAMILIES)}.")  # fmt: skip
            return name
        found[given.among(f"option of {name}", key.strip(), options_of(name))] = value.strip()
    found |= options or {}
    if name in _FAMILIES:
        found = dict(_FAMILIES[name].plain(given, found))
    written = ",".join(f"{key}={found[key]}" for key in options_of(name) if key in found)
    chosen = f"{name}:{written}" if written else name
    if found:
        _FAMILIES[name].axis(given, found)
    return name if given.failed else chosen


@lru_cache(maxsize=256)
def sweep_axis(over: str) -> SweepAxis:
    """Return an axis by its name with options, or raise an `InputError` if one is not allowed."""
    name = name_of_axis(over)
    if name not in _FAMILIES:
        return (SWEEP_AXES | UNDER_LOADS)[name]
    with Validator(name) as given:
        return _FAMILIES[name].axis(given, {key: value for key, _, value in _parts_of(over)})


def _parts_of(over: str) -> list[tuple[str, str, str]]:
    """Return key, ``=`` and value of the options in a name; a value may have commas."""
    texts = re.split(r",(?=\s*\w+\s*=)", over.partition(":")[2])
    return [text.partition("=") for text in texts if text]


def known_anywhere(name: str) -> Quantity:
    """Return the quantity of a curve by its name, over any axis."""
    axes = [*SWEEP_AXES.values(), *UNDER_LOADS.values(), *map(sweep_axis, _FAMILIES)]
    return next(axis.known[name] for axis in axes if name in axis.known)


ALL_AXES = (*SWEEP_AXES, *_FAMILIES)
"""The names of all axes."""


def sweep_axes_of(subject: Any) -> tuple[str, ...]:
    """Return the names of the axes of an assembly, the usual one first."""
    assembly = assembly_of(subject)
    if assembly.body_moves:
        return (*assembly.motions, TURNS if assembly.drives else RIDE)
    # without the ratio of the steering the motion 'steer' is over the rack
    along = {name: motion.along.name for name, motion in assembly.motions.items()}
    rig = tuple(name for name in along if along[name] == SWEEP_AXES[name].along.name)
    return (*rig, LOADING)


def known_over(over: str, usual: str) -> Mapping[str, Quantity]:
    """Return the curves over an axis of a subject with this usual axis, by their columns."""
    return _OF_SUBJECTS.get((over, usual), sweep_axis(over).known)


def compliances_over(over: str) -> Mapping[str, Quantity]:
    """Return the compliances over a motion, by the names of their columns; none over others."""
    return _COMPLIANCES_OVER.get(over, {})
