"""A summary of a corner, an axle or a rigid axle, with problems and unusual values."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from ...core.errors import InputError
from ...core.quantities import display_of
from ...core.validator import Validator
from ...systems.linearisation import linearise
from ..assembly.assembly import Assembly
from ..assembly.equilibrium import equilibrium
from ..assembly.measures.measure import columns
from ..assembly.of import given_assembly
from ..assembly.usual import USUAL_TRAVEL
from ..models.plausibility import USUAL_HOP
from ..models.positions import PositionError
from .wheel_facts import (
    LEAST_WHEEL_RATE,
    NO_STIFFNESS,
    RestFacts,
    WheelFacts,
    facts_of,
    without_friction,
)

__all__ = [
    "USUAL_HOP", "USUAL_RIDE", "AxleFacts", "Checkup", "RestFacts", "WheelFacts", "as_dict",
    "checkup", "without_friction",
]  # fmt: skip

# Natural frequency of the body of a comfortable passenger car [Hz]: Audi, Self-Study Programme 242,
# page 9.
USUAL_RIDE = (1.0, 1.5)

# Characteristics at design over parallel travel, with their labels.
_WORDS = {
    "track": "track",
    "roll_center_height": "roll-centre height",
    "roll_steer": "roll steer",
    "roll_stiffness": "roll stiffness",
    "bar_share": "share of the anti-roll bar or beam",
    "roll_stiffness_bar": "roll stiffness of the anti-roll bar or beam",
    "roll_stiffness_with_tyres": "roll stiffness with tyres",
    "wheel_rate_left": "wheel rate, left",
    "wheel_rate_right": "wheel rate, right",
    "anti_dive": "anti-dive",
    "anti_lift_driven": "anti-lift under drive",
    "anti_lift_braked": "anti-lift under braking",
    "anti_squat": "anti-squat",
}
# Left out where there are corners: they are in the facts of each.
_OF_EACH_CORNER = ("roll_steer", "roll_stiffness_bar", "wheel_rate_left", "wheel_rate_right")
# Farther from design at rest, a rate, a unit or a free length is probably wrong [m].
_MOST_TRAVEL = 0.5 * USUAL_TRAVEL


@dataclass(frozen=True)
class AxleFacts:
    """Results for both wheels of an axle together.

    Attributes
    ----------
    heading : str
        Title of the axle.
    values : dict of str to float
        Characteristics at design, by the names of `kintrafo.characteristics.over`, SI units; those
        that are known. Of a rigid axle also ``reach_down`` and ``reach_up`` [m], ``heave_at_rest``
        [m], ``heave_frequency`` and ``roll_frequency``, the undamped natural frequencies of its
        modes on the tyres [Hz], ``heave_damping_ratio`` and ``roll_damping_ratio``.
    rows : dict of str to str
        The same and more as texts, with units, by their labels.
    """

    heading: str
    values: dict[str, float]
    rows: dict[str, str]


@dataclass(frozen=True)
class Checkup:
    """Results of a first check of a suspension or an axle.

    Attributes
    ----------
    wheels : tuple of WheelFacts
        Results for each independently suspended wheel: one of a suspension, or of an axle whose
        sides are mirror images; two of other axles; none of a rigid axle.
    axle : AxleFacts or None
        Results for both wheels together; None for a suspension of one wheel.
    problems : tuple of str
        Errors, and almost certain mistakes.
    notes : tuple of str
        Unusual values.
    """

    wheels: tuple[WheelFacts, ...]
    axle: AxleFacts | None
    problems: tuple[str, ...]
    notes: tuple[str, ...]


def checkup(subject: Any) -> Checkup:
    """Return a summary of a suspension, an axle or a rigid axle, with problems and notes.

    Parameters
    ----------
    subject : Suspension, Model, Axle, AxleModel, RigidAxle or RigidAxleModel

    Returns
    -------
    Checkup

    Raises
    ------
    InputError
        If the subject is not one of these, or a rigid axle moves only on its bushes.

    Examples
    --------
    >>> from kintrafo import Model, checkup, load
    >>> found = checkup.checkup(Model("reference_car"))
    >>> found.problems, round(found.wheels[0].equilibrium.frequency, 2)
    ((), 12.35)
    >>> round(checkup.checkup(load("reference_axle")).axle.values["bar_share"], 2)
    0.42
    >>> round(checkup.checkup(load("rigid_axle")).axle.values["roll_center_height"], 2)
    0.41
    """
    with Validator("checkup") as given:
        assembly = given_assembly(given, subject)
    wheels = tuple(facts_of(model) for model in assembly.corners.values())
    seen = assembly.plausibility()
    problems, notes = [*seen.problems], [*seen.notes]
    axle = None
    if len(assembly.wheels) > 1:
        found = _AxleLook(assembly, problems, notes)
        axle = AxleFacts(assembly.heading, found.values, found.rows)
    return Checkup(
        wheels,
        axle,
        (*_in_words(assembly, [(one.side, one.problems) for one in wheels]), *problems),
        (*_in_words(assembly, [(one.side, one.notes) for one in wheels]), *notes),
    )


def _in_words(assembly: Assembly, by_side: list[tuple[str, tuple[str, ...]]]) -> list[str]:
    """Return texts about wheels, each with its side if there are several wheels."""
    several = len(assembly.wheels) > 1
    return [
        f"{side} side: {text}" if several else text for side, texts in by_side for text in texts
    ]


class _AxleLook:
    """Values of both wheels of an axle together; problems and notes are appended to the lists."""

    def __init__(self, assembly: Assembly, problems: list[str], notes: list[str]) -> None:
        self._assembly, self._problems, self._notes = assembly, problems, notes
        self.values: dict[str, float] = {}
        self.rows: dict[str, str] = assembly.described()
        for name, (value, ends) in assembly.reach().items():
            self.values[f"reach_{name}"] = value
            self.rows[f"travel {name} to"] = f"{1e3 * value:.1f} mm{'' if ends else ' and more'}"
        if assembly.MODES:
            self._at_rest()
        try:
            self._at_design()
            self._in_roll()
            if "steer" in assembly.motions:
                self._in_steering()
        except (InputError, PositionError) as error:
            problems += getattr(error, "problems", (str(error),))

    def _at_rest(self) -> None:
        """Find the equilibrium, and the modes about it without friction."""
        assembly, model = self._assembly, self._assembly.model
        smooth = assembly.without_friction().model
        try:
            state, sliding = equilibrium(model), equilibrium(smooth)
        except PositionError as error:
            self._problems.append(str(error))
            return
        signals = model.signals(state)
        names = assembly.names_of(assembly.wheels[0])
        heights, design = (
            np.mean([of[f"{assembly.names_of(w).signals}wheel_center_z"] for w in assembly.wheels])
            for of in (signals, model.signals(model.design_state))
        )
        travel = float(heights - design)
        spring = next(
            n for n in signals if n.startswith(names.prefix) and n.endswith("spring_force")
        )
        self.values["heave_at_rest"] = travel
        self.rows["equilibrium"] = (
            f"wheel centres at {1e3 * heights:.3f} mm, {1e3 * travel + 0.0:+.3f} mm from design"
        )
        self.rows["forces there, each wheel"] = (
            f"tyre {float(signals[f'{names.signals}tyre_force']):.0f} N, "
            f"spring {float(signals[spring]):.0f} N"
        )
        linear = linearise(smooth, sliding)
        for name, words in assembly.MODES.items():
            mode = linear.mode_of(name)
            self.values[f"{name}_frequency"] = mode.natural_frequency
            self.values[f"{name}_damping_ratio"] = mode.damping_ratio
            self.rows[f"{words} on the tyres"] = mode.text
        if abs(travel) > _MOST_TRAVEL:
            self._notes.append(
                f"the axle rests {1e3 * travel:+.1f} mm from its design position: "
                "check the springs' free length or force, and the tyres' free height"
            )

    def _at_design(self) -> None:
        assembly = self._assembly
        found = assembly.values("bump", np.zeros(1))
        known = columns(assembly.measures("bump"), assembly.wheels)
        left_out = _OF_EACH_CORNER if assembly.corners else ()
        alike = len(assembly.corners) < len(assembly.wheels)
        for stem, words in _WORDS.items():
            name = stem if stem in found else f"{stem}_left"
            if stem in left_out or name not in found:
                continue
            shown = display_of(known[name].attributes())
            self.values[name] = float(found[name][0])
            label = words if name == stem or alike else f"{words}, left"
            self.rows[label] = f"{self.values[name] * shown.factor:.4g} {shown.units}"
        rates = [self.values.get(f"wheel_rate_{wheel}", np.inf) for wheel in assembly.wheels]
        if np.mean(rates) < LEAST_WHEEL_RATE:
            self._notes.append(NO_STIFFNESS)

    def _in_roll(self) -> None:
        assembly, angles = self._assembly, self._assembly.usual("roll")
        # drop links must also reach over all of the usual travel
        assembly.values("bump", assembly.usual("bump"))
        moments = assembly.values("roll", angles[[0, -1]]).get("roll_moment")
        if moments is not None:
            moment = float(moments[-1])
            self.rows[f"roll moment at {np.degrees(angles[-1]):.3g} deg"] = f"{moment:.4g} N m"

    def _in_steering(self) -> None:
        assembly, along = self._assembly, self._assembly.usual("steer")
        found = assembly.values("steer", along)
        if assembly.subject.end == "rear":
            return
        ends = np.degrees([found["steer_left"].min(), found["steer_left"].max()])
        self.rows["left wheel steers"] = f"{ends[0]:.1f} deg to {ends[1]:.1f} deg"
        if "steering_ratio" in found:
            ratio = float(found["steering_ratio"][np.abs(along).argmin()])
            self.rows["steering ratio"] = f"{ratio:.2f}, in the middle"
        if "turning_circle" in found:
            self.rows["turning circle"] = f"{float(found['turning_circle'].min()):.2f} m"


def as_dict(found: Checkup) -> dict[str, Any]:
    """Return a checkup as plain numbers, texts and nested dictionaries, SI units."""
    with Validator("as_dict") as given:
        given.instance("found", found, Checkup, "a result of checkup is needed")
    if found.axle is None:
        return found.wheels[0].as_dict()
    sides = {one.side: one.as_dict() for one in found.wheels}
    return {
        "heading": found.axle.heading,
        **({"sides": sides} if sides else {}),
        "values": dict(found.axle.values),
        "problems": list(found.problems),
        "notes": list(found.notes),
    }
