"""Motions whose steps end where the equations have a kink, as derivatives need them.

A stop that is touched changes the derivatives of the right-hand side at once. A step over that
moment has stages on both sides of it, and its derivatives err in proportion to its length; those of
steps that all but end there do not. So steps grow shorter towards a kink, and longer behind it.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.optimize.elementwise import find_root

from ..core.errors import InputError
from ..equations.errors import named
from ..systems.system import System
from .result import Simulation
from .retraced import RetracedSteps
from .signals import TimeInputs

Array = NDArray[np.float64]
Indices = NDArray[np.intp]

_FUNCTION = "kinks"
# Parts of a step at whose borders its polynomial is looked at: a kink that is passed and passed
# back between two of them is seen by the stages, if at all.
_PARTS = 8
# Towards a kink each step is so many times shorter than the one before. The stages of a step are
# off by its length cubed, so that they stay on their side. The shortest is the root of rtol of the
# longest: the kink itself is known no better. Of a few times that length is that of a kink that
# has moved since, as steps before it changed.
_SHORTER, _FEW = 8.0, 4.0
# Of the greatest value that something has: it is zero, as a gap at rest. Of a step: what is so near
# to a kink is at it. Of the greatest rate: what differs by less is the same.
_ZERO, _BESIDE, _SAME = 1e-9, 1e-9, 1e-6
_ROUNDS = 12


def ended_at_kinks(
    system: System,
    motion: Simulation,
    courses: TimeInputs,
    again: Callable[[TimeInputs], Simulation],
    rtol: float,
) -> tuple[Simulation, RetracedSteps]:
    """Return a motion none of whose longer steps has a kink in it, and its steps.

    Parameters
    ----------
    system : System
        With derivatives by parameters.
    motion : Simulation
        With every step.
    courses : TimeInputs
    again : callable
        Takes inputs with more milestones and returns their motion.
    rtol : float
        Of the motion.

    Raises
    ------
    InputError
        If the rates jump where a kink was looked for, or there are kinks without end.
    """
    steps = RetracedSteps(system, motion, courses)
    if not hasattr(system.equations, _FUNCTION):
        return motion, steps
    shortest = float(np.sqrt(rtol) * steps.length.max())
    for _ in range(_ROUNDS):
        times, reach = _found(system, steps, _FEW * shortest)
        if not times.size:
            return motion, steps
        courses = courses.with_milestones(_towards(times, reach, shortest))
        motion = again(courses)
        steps = RetracedSteps(system, motion, courses)
    words = (
        f"around t = {times[0]:.6g} s the motion has one kink behind the other, such as of a "
        "stop that is only just touched, and its gradient is not known there. End the motion "
        "before, or give a smaller max_step."
    )
    raise InputError([words], "motion_gradient")


def _towards(times: Array, reach: Array, shortest: float) -> Array:
    """Return times before and behind others, nearer than they reach, ever closer together."""
    count = 1 + max(0, int(np.log(reach.max(initial=shortest) / shortest) / np.log(_SHORTER)))
    distances = 0.5 * shortest * _SHORTER ** np.arange(count + 1)
    near = distances < reach[:, None]
    return np.concatenate([(times[:, None] + sign * distances)[near] for sign in (-1.0, 1.0)])


def _found(system: System, steps: RetracedSteps, short: float) -> tuple[Array, Array]:
    """Return where steps longer than some length have kinks, and their lengths."""
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
    # what only stages see: the step is halved until they see it no more
    unseen = np.flatnonzero((mixed & ~passes.any(axis=1)).any(axis=1))
    return (
        np.concatenate([steps.time(step, root), steps.time(unseen, np.full(unseen.shape, 0.5))]),
        np.concatenate([steps.length[step], np.full(unseen.size, short)]),
    )


def _roots(
    system: System, steps: RetracedSteps, step: Indices, part: Indices, which: Indices
) -> Array:
    """Return where in its step each kink is, from 0 to 1."""

    def value(at: Array, step: Array, which: Array) -> Array:
        chosen = step.astype(int).ravel()
        values = system.evaluate(_FUNCTION, *steps.point(chosen, at.ravel()))
        found = np.take_along_axis(values, which.astype(int).reshape(-1, 1), axis=1)
        return np.asarray(found.reshape(at.shape))

    ends = part / _PARTS, (part + 1) / _PARTS
    found = find_root(value, ends, args=(step.astype(float), which.astype(float)))
    return np.asarray(found.x)


def _refuse_jumps(system: System, steps: RetracedSteps, step: Indices, root: Array) -> None:
    """Refuse a kink at which the rates themselves jump: its time moves with the parameters."""
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
