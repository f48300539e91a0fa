"""Curves of any assembly over a sweep axis: characteristics, or compliance on its own bushes."""

import re
from collections.abc import Collection, Container, Iterable, Sequence
from typing import Any

import numpy as np
import xarray as xr

from ...core.named_types import Array
from ...core.validator import Validator
from ..analysis.characteristics.datasets import dataset
from ..analysis.compare import common_positions as common_to
from ..analysis.compliance.flexibility import HELD
from ..assembly.assembly import Assembly
from ..assembly.by_wheel import flat
from ..kinds import Suspension
from ..models.axle import Axle
from ..models.car import Car
from ..models.whole_axle import WholeAxle
from .loading import LOADING
from .sweep_axes import name_of_axis, sweep_axis

Subject = Suspension | Axle | WholeAxle | Car
"""Subjects with design variables, the numbers of their files."""

_NEEDED = "a kintrafo.Suspension, kintrafo.Axle, kintrafo.RigidAxle or kintrafo.Car is needed"


def check_subject(given: Validator, subject: Any) -> None:
    """Add an error for a subject without design variables."""
    given.instance("suspension", subject, (Suspension, Axle, WholeAxle, Car), _NEEDED)


def check_held_subject(given: Validator, subject: Any) -> None:
    """Add an error for a subject without design variables, or a car."""
    check_subject(given, subject)
    if getattr(subject, "whole_car", False):
        given.fail(
            "suspension: this is a whole car. kintrafo.variation.cars has its numbers over a grid "
            'of values; motions are those of car.axles["front"], car.axles["rear"], car.corner.'
        )


def usual_positions(assembly: Assembly, over: str) -> Array:
    """Return the usual positions within the reach of the wheels, SI units."""
    if over in assembly.motions:  # also motions without an axis, such as those of the steering
        return assembly.usual(over)
    return common_positions([assembly], over)


def common_positions(assemblies: Sequence[Assembly], over: str) -> Array:
    """Return the usual positions that all of some cars reach, with zero, SI units."""
    if usual := sweep_axis(over).usual:
        return np.array(usual)
    if over not in HELD:
        return common_to(assemblies, over)
    parts = [part for assembly in assemblies for part in assembly.held_parts.values()]
    return common_to(parts, parts[0].usual_motion)


def curves_over(assembly: Assembly, over: str, positions: Array) -> xr.Dataset:
    """Return all characteristics over a motion, or all compliances, or loads in a case."""
    curves = sweep_axis(over).curves
    return curves(assembly, positions) if curves else dataset(assembly, over, positions)


def values_of(
    assembly: Assembly, over: str, positions: Array, names: Collection[str] | None = None
) -> dict[str, Array]:
    """Return all or some characteristics or compliances, by the names of their columns."""
    if sweep_axis(over).curves is None and not assembly.axles:
        return assembly.values(over, positions, names)
    curves = flat(curves_over(assembly, over, positions))
    return {str(name): data.values for name, data in curves.items()}


def listed(over: str, known: Iterable[str], asked: Container[str] = ()) -> list[str]:
    """Return known names without components and moments in load cases, unless they are asked for.

    Messages and tables with all of them would be too long.
    """
    detail = re.compile(r"_force_[xyz]|_moment" if name_of_axis(over) == LOADING else r"(?!)")
    return [name for name in known if name in asked or not detail.search(name)]


def available(assembly: Assembly, over: str) -> tuple[str, ...]:
    """Return the names of characteristics or compliances for which the file has the data."""
    if over in HELD and not assembly.has_bushes:
        return ()
    return tuple(values_of(assembly, over, np.array([sweep_axis(over).at])))
