"""A car in a manoeuvre, and in steady turns."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from ....core.validator import Validator
from ...models.car.slope import Slope
from ...roads.road import Road
from .car import DrivingCar
from .circle import steady_turns
from .manoeuvres import MANOEUVRES, Manoeuvre, load_manoeuvre
from .result import HandlingResult
from .steady import SteadyCondition
from .subject import car_that_drives, driving_car

if TYPE_CHECKING:
    from ..run import Run


def drive(
    subject: Any,
    manoeuvre: str | Path | Mapping[str, Any] | Manoeuvre,
    changes: Mapping[str, Any] | None = None,
    *,
    road: Road | None = None,
    grade: float = 0.0,
    crossfall: float = 0.0,
    progress: Callable[[float], None] | None = None,
) -> HandlingResult:
    """Return the motion of a car in a manoeuvre, and its metrics.

    Parameters
    ----------
    subject : Car or CarModel
        A car that drives, ``car = "full"`` in its file.
    manoeuvre : str, pathlib.Path, mapping or Manoeuvre
        The name of a packaged manoeuvre, such as ``"step_steer"``; the path of a file, its content,
        or the result of `load_manoeuvre`.
    changes : mapping of str to Any, optional
        Values that replace those of the file, in its units, by key: ``{"speed_km_per_h": 100.0}``.
    road : Road, optional
        The road, such as `kintrafo.road_profiles.iso8608`; level by default. Its tracks are under
        the left and right wheels, and follow the path of the car; heights are those at the distance
        that the car has travelled, above the mean of both tracks at their first points. A manoeuvre
        begins in the motion on a level road, and beyond its end the road is level.
    grade, crossfall : float, optional
        Slope of the road along the path at the beginning, positive uphill, and across it, positive
        if it falls to the right [1]; for manoeuvres straight ahead.
    progress : callable, optional
        Called with the completed fraction, up to 1.

    Returns
    -------
    HandlingResult
        ``metrics``: the quantities that the standard defines, each with unit and meaning;
        ``curves``: datasets by name, over time, lateral acceleration or frequency; ``runs``: the
        simulations. All are in SI units, signs are those of ISO 8855.

    Raises
    ------
    InputError
        If the car does not drive, or a value of the manoeuvre cannot be driven.
    SimulationError
        If the motion cannot be finished.
    """
    if isinstance(manoeuvre, Manoeuvre):
        with Validator("drive") as given:
            if changes:
                given.fail("changes: these are of a file. Give its name, or leave them out.")
        found = manoeuvre
    else:
        found = load_manoeuvre(manoeuvre, changes)
    with Validator("drive") as given:
        if road is not None:
            given.instance("road", road, Road, "a kintrafo.road_profiles.Road is needed")
            if not found.TRAVELS:
                given.fail(f"road: {found.TITLE} is not simulated over a road. Leave it out.")
        slope = Slope.checked(given, grade, crossfall)
        if not given.failed and any(slope):
            refuse_slope(given, found)
    if not isinstance(subject, DrivingCar):
        subject = car_that_drives("drive", subject)
        found.check(subject.car)
    runs: list[Run] = []
    car = replace(driving_car("drive", subject), watched=runs.append, road=road)
    car = car.on_slope(slope) if any(slope) else car
    result = found.run(car, progress or (lambda _: None))._replace(runs=tuple(runs))
    words = ", ".join(filter(None, [slope.words, "" if road is None else road.words]))
    if words:
        for each in (result.metrics, *result.curves.values()):
            each.attrs["title"] = f"{each.attrs.get('title', found.TITLE)}, {words}"
    return result


def refuse_slope(given: Validator, manoeuvre: Manoeuvre) -> None:
    """Refuse a slope under a manoeuvre that is for a level road."""
    if not manoeuvre.SLOPES:
        straight = [name for name, one in MANOEUVRES.items() if one.SLOPES]
        given.fail(
            f"grade, crossfall: {manoeuvre.TITLE} is for a level road. Leave them out, or choose "
            f"one of {', '.join(straight)}."
        )


# Constant quantities of steady turns by argument: the condition, and the unit of the argument.
_CONSTANT = {
    "speed": ("speed", "m/s"),
    "radius": ("curvature", "m"),
    "steering_wheel": ("steering_wheel", "rad"),
}


def circle(
    subject: Any,
    *,
    speed: float | None = None,
    radius: float | None = None,
    steering_wheel: float | None = None,
    lateral_acceleration: Any = None,
    step: float = 0.25,
    turn: Literal["left", "right"] = "left",
) -> HandlingResult:
    """Return the steady turns of a car over lateral acceleration (ISO 4138).

    Nothing is simulated: each turn is a solution of the equations of motion in which only position,
    yaw angle and the angles of the wheels change.

    Parameters
    ----------
    subject : Car or CarModel
        A car that drives, ``car = "full"`` in its file.
    speed : float, optional
        Constant speed, above zero [m/s]. Exactly one of `speed`, `radius` and `steering_wheel` is
        needed.
    radius : float, optional
        Constant radius of the path, above zero [m].
    steering_wheel : float, optional
        Constant angle of the steering wheel, above zero for both sides of the turn [rad].
    lateral_acceleration : array_like, shape (n,), optional
        Lateral accelerations, above zero for both sides of the turn, in increasing order [m/s^2].
        By default multiples of `step` up to the greatest one of a steady turn.
    step : float, optional
        Distance between two lateral accelerations [m/s^2].
    turn : {'left', 'right'}, optional
        Side to which the car turns.

    Returns
    -------
    HandlingResult
        Curves over ``lateral_acceleration``: angles, gradients and forces, also of each wheel. The
        metrics are the gradients of the turn with the smallest lateral acceleration.

    Raises
    ------
    InputError
        If the car does not drive, or there is no such turn.
    """
    with Validator("circle") as given:
        constant = {"speed": speed, "radius": radius, "steering_wheel": steering_wheel}
        chosen = {name: value for name, value in constant.items() if value is not None}
        if len(chosen) != 1:
            given.fail("speed, radius, steering_wheel: give one of the three.")
        for name, value in chosen.items():
            given.number(name, value, _CONSTANT[name][1], above=0.0)
        step = given.number("step", step, "m/s^2", above=0.0)
        given.among("turn", turn, ("left", "right"))
        wanted = None
        if lateral_acceleration is not None:
            name = "lateral_acceleration"
            wanted = given.array(name, lateral_acceleration, "m/s^2", dimensions=[1])
            if not given.failed and ((wanted <= 0.0).any() or (np.diff(wanted) <= 0.0).any()):
                given.fail("lateral_acceleration: more than 0 m/s^2, rising, is needed.")
    car, sense = driving_car("circle", subject), 1 if turn == "left" else -1
    ((name, value),) = chosen.items()
    kind, _ = _CONSTANT[name]
    first = SteadyCondition(kind, 1.0 / value if kind == "curvature" else value).turned(sense)
    return steady_turns(car, first, sense=sense, step=step, wanted=wanted)
