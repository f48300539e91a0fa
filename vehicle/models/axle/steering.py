"""The rack displacement over the steering-wheel angle: a curve of the file."""

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from pydantic import Field

from ....core.errors import InputError
from ....core.named_types import Array
from ...input.curve import LEAST_GAP, Numbers
from ...input.section import Section

if TYPE_CHECKING:
    from scipy.interpolate import PchipInterpolator


_LEAST_POINTS = 2


class SteeringCurve(Section):
    """Displacement of the rack over the angle of the steering wheel, through measured points.

    Between the points the curve is a monotone cubic (Fritsch and Carlson), straight for two points.
    The angle is positive to the left, the rack along its axis.
    """

    angle_deg: Numbers = Field(description="angles of the steering wheel, rising; positive to left")
    rack_mm: Numbers = Field(description="rack displacements at these angles, positive along axis")

    def problems(self) -> list[str]:
        """Return problems of the points, which must be an invertible curve."""
        angles, racks = self.angle_deg, self.rack_mm
        if len(angles) != len(racks) or len(angles) < _LEAST_POINTS:
            problem = (
                f"angle_deg has {len(angles)} values and rack_mm {len(racks)}; equal counts are "
                f"needed, {_LEAST_POINTS} or more. Give one displacement for each angle."
            )
            return [problem]
        problems = [
            f"angle_deg: {b} deg follows {a} deg; angles must rise, by {LEAST_GAP:g} deg at least. "
            "Sort the points."
            for a, b in pairwise(angles)
            if not b - a >= LEAST_GAP
        ]
        steps = np.diff(racks)
        if not (np.all(steps > 0.0) or np.all(steps < 0.0)):
            problems.append(
                "rack_mm must rise all the way, or fall all the way: a rack does not turn back. "
                "Correct the points."
            )
        if not angles[0] <= 0.0 <= angles[-1]:
            problems.append(
                f"angle_deg goes from {angles[0]} deg to {angles[-1]} deg, and the middle position "
                "0 deg is not within. Add points on its other side."
            )
        return problems

    def limits(self) -> tuple[float, float]:
        """Return the first and the last angle of the curve [rad]."""
        low, high = np.deg2rad([self.angle_deg[0], self.angle_deg[-1]])
        return float(low), float(high)

    def beyond(self, angle: Array) -> str:
        """Return the problem of steering-wheel angles [rad] beyond the curve, or an empty text."""
        low, high = self.limits()
        outside = np.ravel(angle)[~((angle >= low) & (angle <= high)).ravel()]
        if not outside.size:
            return ""
        return (
            f"angle = {np.degrees(outside[0]):g} deg is beyond the curve of [steering], from "
            f"{np.degrees(low):g} deg to {np.degrees(high):g} deg. Add points to it."
        )

    def rack(self, angle: Array) -> Array:
        """Return the displacement of the rack at steering-wheel angles [m].

        An angle beyond the points raises an `InputError`, here and in the derivatives.
        """
        return np.asarray(self._curve(angle)(angle), dtype=np.float64)

    def travel_per_turn(self, angle: Array) -> Array:
        """Return the signed rack travel for one turn of the steering wheel at angles [m]."""
        return np.asarray(2.0 * np.pi * self._curve(angle).derivative()(angle), dtype=np.float64)

    def bend(self, angle: Array) -> Array:
        """Return the second derivative of the displacement with respect to the angle [m/rad^2]."""
        return np.asarray(self._curve(angle).derivative(2)(angle), dtype=np.float64)

    def travel_per_turn_at(self, rack: Array) -> Array:
        """Return the rack travel per turn at rack displacements [m]; NaN beyond the points."""
        curve = self._interpolated()
        # the curve is monotone: it has each displacement once, or twice at a knot
        roots = [curve.solve(float(one), extrapolate=False) for one in rack]
        angles = np.array([root[0] if root.size else np.nan for root in roots])
        return np.asarray(2.0 * np.pi * curve.derivative()(angles), dtype=np.float64)

    def _curve(self, angle: Array) -> "PchipInterpolator":
        """Return the curve; refuse angles beyond it."""
        problem = self.beyond(np.asarray(angle))
        if problem:
            raise InputError([problem], "axle")
        return self._interpolated()

    def _interpolated(self) -> "PchipInterpolator":
        from scipy.interpolate import PchipInterpolator  # noqa: PLC0415 (slow to import)

        return PchipInterpolator(np.deg2rad(self.angle_deg), np.asarray(self.rack_mm) / 1e3)
