"""A road: heights of two tracks at equal spacing."""

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from ...core.named_types import Array, ArrayLike
from ...core.validator import Validator

MOST_POINTS = 4_000_000
"""Number of points that a road has at most: 32 MB a track."""

LEAD = 5.0
"""Least distance over which a road rises to its first heights, for cars that drive [m]."""


@dataclass(frozen=True, eq=False)
class Road:
    """Heights of a road under the left and the right wheels.

    Beyond its ends the road is level.

    Parameters
    ----------
    spacing : float
        Distance along the road between two heights [m].
    left, right : array_like, shape (n,)
        Heights at distances 0, `spacing`, 2 `spacing` and so on, positive up [m]; four or more.
    words : str, optional
        Description in titles.
    stationary : bool, optional
        Whether the roughness has the same statistics all along; `kintrafo.ride.over` then leaves
        out the start of the motion.

    Examples
    --------
    >>> from kintrafo import road_profiles
    >>> road = road_profiles.Road(0.5, [0.0, 0.0, 0.01, 0.01], [0.0, 0.0, 0.0, 0.0])
    >>> road.length
    1.5
    """

    spacing: float
    left: Array
    right: Array
    words: str = "a road of given heights"
    stationary: bool = False

    def __post_init__(self) -> None:
        with Validator("Road") as given:
            spacing = given.number("spacing", self.spacing, "m", above=0.0)
            left = given.array("left", self.left, "m", dimensions=[1])
            right = given.array("right", self.right, "m", dimensions=[1])
            given.text("words", self.words)
            given.flag("stationary", self.stationary)
            if not given.failed and (left.shape != right.shape or left.size < 4):
                given.fail(
                    f"left has {left.size} points and right {right.size}: equal counts are "
                    "needed, four or more."
                )
        for name, value in (("spacing", spacing), ("left", left), ("right", right)):
            object.__setattr__(self, name, value)

    @property
    def length(self) -> float:
        """Distance between the first and the last point [m]."""
        return self.spacing * (self.left.size - 1)

    @property
    def datum(self) -> float:
        """The height that is zero for cars that drive: the mean of both first heights [m]."""
        return float(0.5 * (self.left[0] + self.right[0]))

    @property
    def lead(self) -> float:
        """Distance before the road at which a car on the level begins [m].

        It is zero if both first heights are equal, else as many spacings as make 5 m (`LEAD`).
        """
        return 0.0 if self.left[0] == self.right[0] else self.spacing * self._before

    @property
    def _before(self) -> int:
        """Number of points before the road."""
        return int(np.ceil(LEAD / self.spacing))

    def over_time(self, side: str, speed: float, behind: float, end: float) -> CubicSpline:
        """Return the height under a wheel over time.

        Parameters
        ----------
        side : {'left', 'right'}
        speed : float
            Speed of the car, above zero [m/s].
        behind : float
            Distance of the wheel behind the front wheel of its side, which is at the start of the
            road at time 0 [m].
        end : float
            Last time [s].

        Returns
        -------
        scipy.interpolate.CubicSpline
            Height [m] from time 0 to the last one.
        """
        with Validator("Road.over_time") as given:
            given.among("side", side, ("left", "right"))
            speed = given.number("speed", speed, "m/s", above=0.0)
            behind = given.number("behind", behind, "m")
            end = given.number("end", end, "s", above=0.0)
        heights = self.left if side == "left" else self.right
        step = self.spacing / speed
        before = int(np.ceil(max(behind, 0.0) / self.spacing)) + 1
        after = max(int(np.ceil(end / step)) - heights.size, 0) + 2
        padded = np.pad(heights, (before, after), mode="edge")
        times = (np.arange(padded.size) - before) * step + behind / speed
        inside = (times >= -2.0 * step) & (times <= end + 2.0 * step)
        return CubicSpline(times[inside], padded[inside], extrapolate=False)

    def over_distance(self, side: str) -> CubicSpline:
        """Return the height under the wheels of a side over the distance along the road.

        Parameters
        ----------
        side : {'left', 'right'}

        Returns
        -------
        scipy.interpolate.CubicSpline
            Height above `datum` [m] by distance [m], level at both ends. It begins `LEAD` (5 m) or
            more before the road, rises from zero to the first height, and ends one spacing beyond
            the last height.
        """
        with Validator("Road.over_distance") as given:
            given.among("side", side, ("left", "right"))
        heights = (self.left if side == "left" else self.right) - self.datum
        rising = heights[0] * smooth_step(np.linspace(0.0, 1.0, self._before, endpoint=False))
        every = np.concatenate([rising, heights, heights[-1:]])
        places = self.spacing * (np.arange(every.size) - self._before)
        return CubicSpline(places, every, bc_type="clamped")

    def __add__(self, other: "Road") -> "Road":
        """Return the sum of two roads with equal spacing and length."""
        with Validator("Road") as given:
            given.instance("other", other, Road, "a kintrafo.roads.Road is needed")
            if not given.failed and (other.spacing, other.left.size) != (
                self.spacing,
                self.left.size,
            ):
                given.fail("the roads have other points: equal spacing and number are needed.")
        words = f"{self.words}, and {other.words}"
        left, right = self.left + other.left, self.right + other.right
        return Road(self.spacing, left, right, words, self.stationary and other.stationary)


def smooth_step(share: Array) -> Array:
    """Return a rise from 0 to 1 over shares from 0 to 1, level at both ends."""
    return share * share * (3.0 - 2.0 * share)


def points(length: float, spacing: float) -> Array:
    """Return the positions of the points along a road [m], at most `MOST_POINTS` of them."""
    check_points(length, spacing)
    return np.asarray(spacing * np.arange(int(np.ceil(length / spacing)) + 1), dtype=float)


def check_points(length: float, spacing: float) -> None:
    """Refuse a road of a length and spacing [m] with more than `MOST_POINTS` points."""
    longest = spacing * MOST_POINTS
    with Validator("road") as given:
        if not length <= longest:
            given.fail(
                f"a length of {length:g} m with points {spacing:g} m apart: at most "
                f"{MOST_POINTS:,} points, {longest:g} m, are allowed. Choose a shorter road, or "
                "longer waves or bumps."
            )


def both(spacing: float, heights: ArrayLike, sides: str, words: str) -> Road:
    """Return a road with one profile under the wheels of both sides or of one."""
    with Validator("road") as given:
        given.among("sides", sides, ("both", "left", "right"))
    profile = np.asarray(heights, dtype=float)
    left, right = (profile if sides in ("both", s) else 0.0 * profile for s in ("left", "right"))
    where = "" if sides == "both" else f" under the {sides} wheels"
    return Road(spacing, left, right, words + where)
