"""A coil spring, by a rate or by a curve of force over length."""

from collections.abc import Mapping
from itertools import pairwise
from typing import Any

import numpy as np
from pydantic import Field

from ...core.columns import each
from ...core.named_types import Array
from .curve import SEGMENTS, WAYS, Curve, Interpolation, Numbers, no_curve, point_problems
from .section import NonNegative, Number, Positive, Section
from .units import in_metres

TABLE = "spring_table"
"""The name of the curve in the equations."""

SEATS = ("spring_seat", "spring_top")
"""The hardpoints at the ends of the spring."""

_FREE = ("free_length_mm", "force_at_design_N")
_BY_CURVE = ("length_mm", "compression_mm", "force_N", "interpolation")


class SpringSection(Section):
    """The spring.

    Its force, positive when it pushes its ends apart, is ``rate (free_length - length)``; the free
    length is given directly or by the force at the design position. Alternatively the spring has a
    curve through measured points: over the distance of its ends, ``length_mm``, or over
    ``compression_mm``, measured from ``free_length_mm`` or such that ``force_at_design_N`` is the
    force at the design position.
    """

    rate_N_per_m: NonNegative | None = Field(  # noqa: N815 (N is the newton)
        default=None, description="rate of the spring, unless it has a curve"
    )
    free_length_mm: Positive | None = Field(
        default=None,
        description="distance of spring_seat and spring_top at which the force is zero; for a "
        "curve over compression_mm, at which the compression is zero",
    )
    force_at_design_N: Number | None = Field(  # noqa: N815
        default=None, description="force of the spring at the design position"
    )
    length_mm: Numbers | None = Field(
        default=None,
        description="curve instead of a rate: distances of spring_seat and spring_top, rising",
    )
    compression_mm: Numbers | None = Field(
        default=None, description="curve, instead of length_mm: compressions, rising"
    )
    force_N: Numbers | None = Field(  # noqa: N815
        default=None,
        description="forces at these lengths or compressions, positive when the spring pushes; "
        "they rise with the compression",
    )
    interpolation: Interpolation | None = Field(
        default=None, description=f"{WAYS}; by default cubic"
    )

    @property
    def by_curve(self) -> bool:
        """Whether it has a curve."""
        return self.force_N is not None

    def problems(self) -> list[str]:
        by_curve = [key for key in _BY_CURVE if getattr(self, key) is not None]
        if self.rate_N_per_m is None and by_curve:
            return self._problems_of_curve()
        if self.rate_N_per_m is None:
            problem = (
                "rate_N_per_m is missing: rate of the spring, unless force_N and length_mm or "
                "compression_mm give its curve. Add a line `rate_N_per_m = ...`, in N/m."
            )
            return [problem]
        if by_curve:
            problem = (
                f"rate_N_per_m = {self.rate_N_per_m} N/m and {by_curve[0]} both describe the "
                "spring; one is allowed. Remove the other."
            )
            return [problem]
        problems = self._problems_of_free(f"{' and '.join(_FREE)} is needed")
        if not problems and self.force_at_design_N is not None and self.rate_N_per_m == 0.0:
            problem = (
                f"force_at_design_N = {self.force_at_design_N} N needs a spring, but rate_N_per_m "
                "= 0.0 N/m; more than 0 N/m is needed. Enter the rate, or a free length."
            )
            return [problem]
        return problems

    def _problems_of_free(self, ways: str) -> list[str]:
        """Return the problem of a free state that is described twice, or not."""
        given = [key for key in _FREE if getattr(self, key) is not None]
        if len(given) == 1:
            return []
        found = "both are given. Keep one." if given else "neither is given. Add one."
        return [f"exactly one of {ways}; {found}"]

    def _problems_of_curve(self) -> list[str]:
        """Return the problems of the points of a curve, and of its zero."""
        over = [key for key in _BY_CURVE[:2] if getattr(self, key) is not None]
        if len(over) != 1 or self.force_N is None:
            found = ", ".join(key for key in _BY_CURVE if getattr(self, key) is not None)
            problem = (
                "a curve needs force_N, and either length_mm or compression_mm; given are "
                f"{found}. Enter the missing key, or remove the extra one."
            )
            return [problem]
        (key,) = over
        places, force = getattr(self, key), self.force_N
        problems = point_problems(key, "mm", places, force) or _problems_of_spring(
            key, places, force
        )
        if problems:
            return problems
        if key == "length_mm":
            return [
                f"{free} = {getattr(self, free)}: a curve over length_mm gives the force at every "
                f"length. Leave {free} out, or give the curve over compression_mm."
                for free in _FREE
                if getattr(self, free) is not None
            ]
        problems = self._problems_of_free(
            "free_length_mm and force_at_design_N is needed, for the zero of compression_mm"
        )
        return problems or self._problems_of_force(places, force)

    def _problems_of_force(self, places: tuple[float, ...], force: tuple[float, ...]) -> list[str]:
        """Return the problem of an ambiguous or impossible zero of the compression."""
        wanted = self.force_at_design_N
        if wanted is None:
            if self.free_length_mm is not None and self.free_length_mm <= places[-1]:
                problem = (
                    f"compression_mm goes to {places[-1]} mm and free_length_mm = "
                    f"{self.free_length_mm} mm: the spring has no length left. Correct one."
                )
                return [problem]
            return []
        if not force[0] <= wanted <= force[-1]:
            problem = (
                f"force_at_design_N = {wanted} N is not on the curve, whose force_N goes from "
                f"{force[0]} to {force[-1]} N. Enter a force of the curve, or free_length_mm."
            )
            return [problem]
        if any(a == b == wanted for a, b in pairwise(force)):
            problem = (
                f"force_at_design_N = {wanted} N: the curve has that force at many compressions. "
                "Enter free_length_mm."
            )
            return [problem]
        return []

    def parameters(self, at_design: float, *, general: bool) -> dict[str, Any]:
        """Return rate, free length and curve by the names in the equations, in SI units.

        `at_design` is the length at the design position [m]; `general` equations have a curve.
        """
        values = {
            "spring_rate": self.rate_N_per_m or 0.0,
            "spring_free_length": self.free_length(at_design),
        }
        return values | (self.table(at_design) if general else {})

    def table(self, at_design: float) -> dict[str, Any]:
        """Return the coefficients of its curve by the names in the equations, in SI units."""
        found = self._curve()
        if found is None:
            return dict(NO_CURVE)
        longest, curve, compressions = self.free_length(at_design), *found
        return curve.parameters(TABLE, [longest - compression for compression in compressions])

    def _curve(self) -> tuple[Curve, list[float]] | None:
        """Return force over compression [m], and the compressions; None with a rate."""
        if self.force_N is None:
            return None
        force = np.array(self.force_N)
        if self.compression_mm is not None:
            places = 1e-3 * np.array(self.compression_mm)
        else:
            assert self.length_mm is not None  # refused with the section
            places = 1e-3 * (self.length_mm[-1] - np.array(self.length_mm[::-1]))
            force = force[::-1]
        curve = Curve(places, force, self.interpolation or "cubic", as_secants=True)
        return curve, places.tolist()

    def free_length(self, at_design: float) -> float:
        """Return the length without force, from the length at the design position [m].

        For a curve it is the length of zero compression: the longest of a curve over lengths.
        """
        if self.length_mm is not None:
            return in_metres(self.length_mm[-1], "mm")
        if self.free_length_mm is not None:
            return in_metres(self.free_length_mm, "mm")
        if self.force_at_design_N is None:  # refused with the section
            return at_design
        found = self._curve()
        if found is None:
            assert self.rate_N_per_m is not None  # a spring without a curve
            return at_design + self.force_at_design_N / self.rate_N_per_m
        curve, _ = found
        compression: float = each(curve.place, self.force_at_design_N)
        return at_design + compression


def rate_key(part: str, spring: SpringSection | None) -> str:
    """Return the key of the rate of a part, "spring" or "damper", or of its curve."""
    if part == "spring" and spring is not None and spring.by_curve:
        return "[spring] force_N: the rate at design"
    return {"spring": "[spring] rate_N_per_m", "damper": "[damper] rate_N_s_per_m"}[part]


def _problems_of_spring(key: str, places: tuple[float, ...], force: tuple[float, ...]) -> list[str]:
    """Return the problem of lengths or compressions [mm] and forces [N] of a spring."""
    if key == "length_mm" and not places[0] > 0.0:
        return [f"length_mm begins with {places[0]} mm; more than 0 mm is needed. Correct it."]
    sense, words = (-1.0, "longer") if key == "length_mm" else (1.0, "more compressed")
    for (a, f), (b, g) in pairwise(zip(places, force, strict=True)):
        if sense * (g - f) < 0.0:
            problem = (
                f"force_N = {f} N at {a} mm and {g} N at {b} mm: a spring that is {words} does not "
                f"push {'more' if sense < 0.0 else 'less'}. Correct the forces; they are positive "
                "when the spring pushes."
            )
            return [problem]
    if force[0] == force[-1]:
        return [f"force_N = {force[0]} N everywhere: this is not a spring. Enter its forces."]
    return []


NO_CURVE = no_curve(TABLE)
"""The coefficients of a spring without a curve."""


def force_and_rate(parameters: Mapping[str, float], length: Array) -> tuple[Array, Array]:
    """Return the force [N] of a spring's curve and its rate [N/m]; zero without a curve.

    `parameters` are those of the equations, `length` the distance of the spring's ends [m].
    """
    if ends_of_table(parameters) is None:
        return np.zeros_like(length), np.zeros_like(length)
    knots, inverse, a, b, c = (
        np.array([parameters[f"{TABLE}_{what}_{i}"] for i in range(SEGMENTS + more)])
        for what, more in (
            ("knot", 1),
            ("inverse_width", 0),
            ("linear", 0),
            ("quadratic", 0),
            ("cubic", 0),
        )
    )
    first, last = (parameters[f"{TABLE}_{end}_slope"] for end in ("first", "last"))
    beyond = knots - length[..., None]
    passed = np.maximum(beyond, 0.0)
    part = (passed[..., :-1] - passed[..., 1:]) * inverse
    inside = (beyond[..., :-1] > 0.0) & (beyond[..., 1:] <= 0.0)
    force = parameters[f"{TABLE}_first_force"] + first * np.minimum(beyond[..., 0], 0.0)
    force = force + last * passed[..., -1] + (part * (a + part * (b + part * c))).sum(-1)
    slopes = np.where(inside, (a + part * (2.0 * b + 3.0 * part * c)) * inverse, 0.0)
    ends = first * (beyond[..., 0] <= 0.0) + last * (beyond[..., -1] > 0.0)
    return force, slopes.sum(-1) + ends


def rate_at(parameters: Mapping[str, float], length: Array) -> Array:
    """Return the rate of a spring at some lengths [N/m]."""
    _, of_curve = force_and_rate(parameters, length)
    return parameters["spring_rate"] + of_curve


def ends_of_table(parameters: Mapping[str, float]) -> tuple[float, float] | None:
    """Return the shortest and the longest length of a curve [m], if there is one."""
    if f"{TABLE}_first_force" not in parameters:
        return None
    shortest, longest = (parameters[f"{TABLE}_knot_{i}"] for i in (SEGMENTS, 0))
    return (shortest, longest) if shortest < longest else None
