"""Checked arguments about tolerances, steps and times of an integration."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..core.named_types import Array
from ..core.validator import Validator, shown

_MOST_STEPS = 2**62
# Times are refused if their rounding exceeds the first number [s] and they are more than the second
# number of time spans from zero. Times of a computer's clock, from 1970, are 2e-7 s apart.
_COARSE, _FAR = 1e-9, 1e3
_SMALLEST_RTOL = 100.0 * np.finfo(float).eps  # the limit of double precision


@dataclass(frozen=True, kw_only=True)
class Accuracy:
    """Tolerances and steps of an integration; the names are those of SciPy."""

    rtol: float
    atol: Array  # of each element of the state, in its SI unit
    max_step: float  # [s], may be infinite
    first_step: float | None  # [s]; None: chosen by the method
    max_steps: int


def accuracy_of(
    given: Validator,
    size: int,
    *,
    rtol: float,
    atol: ArrayLike,
    max_step: float,
    first_step: float | None,
    max_steps: int,
) -> Accuracy:
    """Return the checked accuracy of an integration, for a state of some size."""
    absolute = given.array("atol", atol)
    if not (absolute.shape in ((), (size,)) and (absolute > 0.0).all()):
        given.fail(
            f"atol = {shown(atol)}: one positive number, or one for each of the {size} elements of "
            "the state."
        )
        absolute = np.ones(())
    return Accuracy(
        rtol=given.number("rtol", rtol, least=_SMALLEST_RTOL, below=1.0, advice="Try 1e-6."),
        atol=np.full(size, absolute),
        max_step=given.step("max_step", max_step, "s"),
        first_step=None if first_step is None else given.number(
            "first_step", first_step, "s", above=0.0
        ),
        max_steps=given.count("max_steps", max_steps, most=_MOST_STEPS),
    )  # fmt: skip


def span_of(given: Validator, t_span: Any) -> tuple[float, float]:
    """Return the checked first and last time [s]; the last may be the earlier one."""
    span = given.array("t_span", t_span, "s", finite=False)
    first, last = span.tolist() if span.shape == (2,) else (0.0, 0.0)
    if not (math.isfinite(first) and math.isfinite(last) and first != last):
        given.fail(f"t_span = {shown(t_span)}: two different finite times are needed.")
        return 0.0, 1.0
    farthest = max(abs(first), abs(last))
    apart = math.ulp(farthest)
    if apart > _COARSE and farthest > _FAR * abs(last - first):
        given.fail(
            f"t_span = {shown(t_span)}: times of this size are rounded to {apart:.1g} s, "
            "which is an error of every step. Measure all times from the first one, which is "
            "zero."
        )
    return first, last


def outputs_of(given: Validator, t_eval: Any, span: tuple[float, float]) -> Array:
    """Return the checked times of outputs [s], which are in the direction of the time span."""
    times = given.array("t_eval", t_eval, "s", dimensions=[1])
    if given.failed:
        return times
    sign = math.copysign(1.0, span[1] - span[0])
    first, last = float(times[0]), float(times[-1])
    inside = sign * first >= sign * span[0] and sign * last <= sign * span[1]
    if not (inside and (sign * (times[1:] - times[:-1]) > 0.0).all()):
        given.fail(
            f"t_eval: times from {span[0]:g} s to {span[1]:g} s are needed, in that order, each of "
            "them once."
        )
    return times
