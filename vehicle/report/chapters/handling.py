"""The chapters of a car that drives: steady turns, and a step of the steering wheel."""

from typing import Any

from ....core.errors import KintrafoError
from ....core.quantities import displayed, heading_of
from ....core.tabulated import Tabulated, significant
from ....core.units import KM_PER_H
from ...analysis.handling import circle, drive
from ...analysis.handling.result import HandlingResult
from ...plots.by_axle import by_axle, names_by_axle
from ...plots.handling import first_names
from ...plots.motion.animate import played
from .chapter import Chapter, not_valid
from .curves import small_pictures

# Speed of the steady turns [m/s], and their step, for the curvature near the limit [m/s^2].
_SPEED, _STEP = 80.0 / KM_PER_H, 0.1


def steady_turns_chapter(subject: Any) -> Chapter:
    """Return the chapter of the steady turns of a car at 80 km/h (ISO 4138).

    Parameters
    ----------
    subject : Car or CarModel
        A car that drives. The chapter has the reason if it has no steady turns.

    Returns
    -------
    Chapter
    """
    title = "Steady turns"
    try:
        found = circle(subject, speed=_SPEED, step=_STEP)
    except KintrafoError as error:
        return Chapter(title, (f"There are none: {error}",))
    curves = found.curves[""]
    panels = small_pictures(by_axle(curves), names_by_axle(curves, first_names(curves)))
    words = (
        "At 80 km/h, from straight running to the greatest lateral acceleration of a steady turn. "
        "Each turn is a solution of the equations of motion, without a simulation. The gradients "
        "in the table are those of the turn with the least lateral acceleration."
    )
    return Chapter(title, (words, *not_valid(found.not_valid)), (_metrics(found),), panels=panels)


def step_steer_chapter(subject: Any) -> Chapter:
    """Return the chapter of a step of the steering wheel (ISO 7401), with a player.

    Parameters
    ----------
    subject : Car or CarModel
        A car that drives. The chapter has the reason if it does not complete the manoeuvre.

    Returns
    -------
    Chapter
    """
    try:
        found = drive(subject, "step_steer")
    except KintrafoError as error:
        return Chapter("Step steer", (f"It cannot be driven: {error}",))
    title = str(found.metrics.attrs["title"])
    words = "The packaged manoeuvre step_steer: metrics are those of ISO 7401, in its axes."
    return Chapter(
        title=title[:1].upper() + title[1:],
        words=(words, *not_valid(found.not_valid)),
        tables=(_metrics(found),),
        players=(played(found),),
    )


def _metrics(found: HandlingResult) -> Tabulated:
    single = [data for data in found.metrics.values() if not data.ndim]
    rows = tuple((heading_of(data), significant(float(displayed(data)))) for data in single)
    return Tabulated("Metrics", ("metric", "value"), rows)
