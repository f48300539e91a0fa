"""Inputs of the simulation of a suspension: road and rack, by formula or as measured."""

from collections.abc import Mapping
from dataclasses import dataclass

from ...core.errors import InputError
from ...core.validator import Validator
from ...simulation.input_profiles import Signal
from .measurement import Measurement
from .roads import sine, step


@dataclass(frozen=True)
class TimeProfile:
    """One input as a function of time: at most one of `held`, `step` and `sine`.

    Attributes
    ----------
    held : float, optional
        Constant value [m].
    step : float, optional
        Value after a jump from zero [m].
    step_at : float
        Time of the jump [s].
    sine : float, optional
        Amplitude of a harmonic motion [m].
    frequency : float
        Frequency of that motion [Hz].
    """

    held: float | None = None
    step: float | None = None
    step_at: float = 0.1
    sine: float | None = None
    frequency: float = 1.0

    @property
    def given(self) -> tuple[str, ...]:
        """Names of the attributes with a value, of those three."""
        return tuple(n for n in ("held", "step", "sine") if getattr(self, n) is not None)

    def signal(self, end: float) -> Signal:
        """Return the input as `kintrafo.simulate` takes it, up to the last time [s]."""
        with Validator("profile") as given:
            for name in self.given:
                given.number(name, getattr(self, name), "m")
        if self.step is not None:
            return step(self.step, at=self.step_at, end=end)
        if self.sine is not None:
            return sine(self.sine, self.frequency, end=end)
        return self.held or 0.0


def excitation(
    profiles: Mapping[str, TimeProfile], end: float, measured: Measurement | None = None
) -> dict[str, Signal]:
    """Return inputs for `kintrafo.simulate` from time profiles and a measurement.

    Parameters
    ----------
    profiles : mapping of str to TimeProfile
        Time profiles by the name of the input: ``road_height``, ``rack_position``.
    end : float
        Last time of the simulation [s].
    measured : Measurement, optional
        Measured inputs, which are added under their names.

    Returns
    -------
    dict
        Numbers, samples or functions by the names of the inputs, for `kintrafo.simulate`.

    Raises
    ------
    InputError
        If one input is given in two ways.

    Examples
    --------
    >>> from kintrafo import excitation
    >>> held = excitation.TimeProfile(held=0.01)
    >>> excitation.excitation({"road_height": held}, end=1.0)
    {'road_height': 0.01}
    """
    with Validator("simulation") as given:
        end = given.number("duration", end, "s", above=0.0)
        for name, profile in given.mapping("profiles", profiles, "input names, profiles").items():
            given.instance(f"profile of {name!r}", profile, TimeProfile, "a TimeProfile is needed")
        if measured is not None:
            given.instance("measured", measured, Measurement, "a Measurement is needed")
    inputs: dict[str, Signal] = {} if measured is None else dict(measured.inputs())
    problems = []
    for name, profile in profiles.items():
        ways = (*profile.given, *(("measured",) if name in inputs else ()))
        if len(ways) > 1:
            problems.append(f"{name} is given in {len(ways)} ways: {', '.join(ways)}. Keep one.")
        elif profile.given:
            inputs[name] = profile.signal(end)
    if problems:
        raise InputError(problems, "simulation")
    return inputs
