"""Checks of the geometry of any suspension."""

from collections.abc import Callable, Mapping
from typing import Any

from pydantic import ValidationError

from ...core.vectors import angle_between_lines
from ..input.hardpoints import Hardpoints
from ..input.messages import subsection
from ..input.section import Section
from ..input.vehicle import VehicleSection, WheelSection

# Least distance of a wheel from the vehicle's centre plane [m].
_SMALLEST_HALF_TRACK = 0.001
# Least angle of spin axis and steering axis, below which steering would spin the wheel [deg].
_SMALLEST_SPIN_AXIS_ANGLE = 1.0


def _valid(kind: type[Section], data: Mapping[str, Any]) -> dict[str, Any]:
    """Return the sections that are valid alone; None for an optional one that is left out."""
    sections: dict[str, Any] = {}
    for name, field in kind.model_fields.items():
        model = subsection(kind, name)
        if model is None:
            continue
        if data.get(name) is None and not field.is_required():
            sections[name] = None
            continue
        try:
            sections[name] = model.model_validate(data.get(name))
        except ValidationError:
            continue
    return sections


def geometry_problems(
    kind: type[Section],
    data: Mapping[str, Any],
    further: Callable[[Mapping[str, Any]], list[str]],
) -> list[str]:
    """Return the problems of the geometry, from the sections of `data` that are valid alone.

    `further` returns further problems of the kind from these sections.
    """
    return problems_of_sections(_valid(kind, data), further)


def problems_of_sections(
    sections: Mapping[str, Any], further: Callable[[Mapping[str, Any]], list[str]]
) -> list[str]:
    """Return the problems of the geometry, from valid sections by name, see `geometry_problems`."""
    hardpoints = sections.get("hardpoints")
    if hardpoints is None:
        return []
    problems: list[str] = hardpoints.unit_problems()
    if problems:
        return problems
    problems = hardpoints.geometry_problems()
    vehicle, wheel = sections.get("vehicle"), sections.get("wheel")
    if vehicle is not None:
        problems += _wrong_side(vehicle, hardpoints)
    if vehicle is not None and wheel is not None:
        problems += _spin_axis_along_steering_axis(vehicle, wheel, hardpoints)
    return problems + further(sections)


def _wrong_side(vehicle: VehicleSection, hardpoints: Hardpoints) -> list[str]:
    """Return a problem if the wheel is not on the declared side."""
    if vehicle.sign * hardpoints.metres("wheel_center")[1] >= _SMALLEST_HALF_TRACK:
        return []
    half = "above" if vehicle.side == "left" else "below"
    limit = 1000.0 * vehicle.sign * _SMALLEST_HALF_TRACK
    problem = (
        f'[vehicle] side = "{vehicle.side}", but {hardpoints.text("wheel_center")}: '
        f"y points left, so a {vehicle.side} wheel must have y {half} {limit:g} mm. Change "
        "side, or the sign of y of all hardpoints."
    )
    return [problem]


def _spin_axis_along_steering_axis(
    vehicle: VehicleSection, wheel: WheelSection, hardpoints: Hardpoints
) -> list[str]:
    """Return a problem if the spin axis is along the steering axis."""
    axis = hardpoints.steering_axis()
    if axis is None:
        return []
    angle = angle_between_lines(wheel.spin_axis(vehicle.sign), axis)
    if angle >= _SMALLEST_SPIN_AXIS_ANGLE:
        return []
    problem = (
        f"[wheel] camber_deg = {wheel.camber_deg} deg and toe_deg = {wheel.toe_deg} deg put the "
        f"spin axis within {angle:.3f} deg of the {hardpoints.AXIS_NAME}; at least "
        f"{_SMALLEST_SPIN_AXIS_ANGLE:g} deg are needed to steer the wheel. Correct the angles, or "
        f"{hardpoints.text(*(hardpoints.STEERING_AXIS or ()))}."
    )
    return [problem]
