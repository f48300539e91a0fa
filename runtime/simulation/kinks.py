"""Motions whose steps end where the equations have a kink, as derivatives require.

When a stop is touched, the derivatives of the right-hand side jump. A step over that time has
stages on both sides of it, and an error of its derivatives in proportion to its length; steps that
end very near that time have none. So steps become shorter towards a kink, and longer after it.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.optimize.elementwise import find_root

from ..core.errors import InputError
from ..core.named_types import Array
from ..equations.errors import named
from ..systems.system import System
from .result import Simulation
from .retraced import RetracedSteps
from .signals import TimeInputs

Indices = NDArray[np.intp]

_FUNCTION = "kinks"
# Parts of a step at whose borders its polynomial is evaluated; two kinks within a part are found by
# the stages, if at all.
_PARTS = 8
# Towards a kink each step is shorter than the last by the first factor. The error of the stages is
# the cube of a step's length, so that they are all on one side. The shortest step is the root of
# rtol of the longest: the time of the kink has that error. A kink may move when steps before it
# change: up to a few shortest lengths that is accepted.
_SHORTER, _FEW = 8.0, 4.0
# Zero relative to the greatest value, such as a gap at rest; distance from a kink relative to a
# step; equality relative to the greatest rate.
_ZERO, _BESIDE, _SAME = 1e-9, 1e-9, 1e-6
_ROUNDS = 12


def ended_at_kinks(
    system: System,
    motion: Simulation,
    profiles: TimeInputs,
    again: Callable[[TimeInputs], Simulation],
    rtol: float,
) -> tuple[Simulation, RetracedSteps]:
    """Return a motion without kinks inside its longer steps, and its steps.

    The system has derivatives with respect to parameters, the motion every step and the tolerance
    `rtol`; `again` returns the motion for inputs with more milestones. Raises `InputError` if the
    rates jump at a kink, or ever more kinks are found.
    """
    steps = RetracedSteps(system, motion, profiles)
    if not hasattr(system.equations, _FUNCTION):
        return motion, steps
    shortest = float(np.sqrt(rtol) * steps.length.max())
    for _ in range(_ROUNDS):
        times, reach = _found(system, steps, _FEW * shortest)
        if not times.size:
            return motion, steps
        profiles = profiles.with_milestones(_towards(times, reach, shortest))
        motion = again(profiles)
        steps = RetracedSteps(system, motion, profiles)
    words = (
        f"around t = {times[0]:.6g} s the motion has one kink after the other, such as of a "
        "stop that is only just touched, and its gradient is not known there. End the motion "
        "before, or give a smaller max_step."
    )
    raise InputError([words], "motion_gradient")


def _towards(times: Array, reach: Array, shortest: float) -> Array:
    """Return times before and after kinks, within their reach, ever closer together."""
    count = 1 + max(0, int(np.log(reach.max(initial=shortest) / shortest) / np.log(_SHORTER)))
    distances = 0.5 * shortest * _SHORTER ** np.arange(count + 1)
    near = distances < reach[:, None]
    return np.concatenate([(times[:, None] + sign * distances)[near] for sign in (-1.0, 1.0)])


def _found(system: System, steps: RetracedSteps, short: float) -> tuple[Array, Array]:
    """Return the times of kinks in steps longer than some length, and the lengths of the steps."""
    within = system.evaluate(_FUNCTION, *steps.within(np.linspace(0.0, 1.0, _PARTS + 1)))
    at_stages = system.evaluate(_FUNCTION, steps.states, steps.inputs)
    seen = np.concatenate([at_stages, within], axis=1)
    zero = _ZERO * np.abs(seen).max(axis=(0, 1))
    mixed = (seen.min(axis=1) < -zero) & (seen.max(axis=1) > zero)
    mixed &= (steps.length > short)[:, None]
    passes = mixed[:, None] & (within[:, :-1] * within[:, 1:] < 0.0)
    step, part, which = np.nonzero(passes)
    root = _roots(system, steps, step, part, which)
    _refuse_jumps(system, steps, step, root)
    # kinks that only stages detect: the step is halved until they do not
    unseen = np.flatnonzero((mixed & ~passes.any(axis=1)).any(axis=1))
    return (
        np.concatenate([steps.time(step, root), steps.time(unseen, np.full(unseen.shape, 0.5))]),
        np.concatenate([steps.length[step], np.full(unseen.size, short)]),
    )


def _roots(
    system: System, steps: RetracedSteps, step: Indices, part: Indices, which: Indices
) -> Array:
    """Return the position of each kink in its step, from 0 to 1."""

    def value(at: Array, step: Array, which: Array) -> Array:
        chosen = step.astype(int).ravel()
        values = system.evaluate(_FUNCTION, *steps.point(chosen, at.ravel()))
        found = np.take_along_axis(values, which.astype(int).reshape(-1, 1), axis=1)
        return np.asarray(found.reshape(at.shape))

    ends = part / _PARTS, (part + 1) / _PARTS
    found = find_root(value, ends, args=(step.astype(float), which.astype(float)))
    return np.asarray(found.x)


def _refuse_jumps(system: System, steps: RetracedSteps, step: Indices, root: Array) -> None:
    """Refuse a kink at which the rates themselves jump: its time depends on the parameters."""
    sides = (steps.point(step, root + sign * _BESIDE) for sign in (-1.0, 1.0))
    before, behind = (system.evaluate("rhs", *side) for side in sides)
    jumps = np.abs(behind - before) > _SAME * np.abs(steps.rates).max(axis=(0, 1))
    if not jumps.any():
        return
    place, element = np.argwhere(jumps)[0]
    time = float(steps.time(step[place], root[place]))
    name = named(system.state_names[element], system.equations.STATE)
    words = (
        f"at t = {time:.6g} s the rate of {name} jumps, as where a tyre "
        "with damping meets the road. That moment moves with the parameters, and there is no "
        "gradient over it. End the motion before, or leave the damping out."
    )
    raise InputError([words], "motion_gradient")
