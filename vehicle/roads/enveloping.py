"""The effective profile of a road with short waves and edges: two elliptical cams in tandem.

A tyre touches the road along a patch, deforms around short obstacles, and climbs an edge before
its centre reaches it. In the model of Schmeitz (A Semi-Empirical Three-Dimensional Model of the
Pneumatic Tyre Rolling over Arbitrarily Uneven Road Surfaces, TU Delft, 2004; Pacejka, Tire and
Vehicle Dynamics, third edition, section 10.1.6) two rigid cams with the contour ::

    (|x| / a)^c + (|z| / b)^c = 1

and the distance l_s slide over the road. The effective height of the road under the wheel is the
mean of both cams' heights, relative to those on a flat road.
"""

from dataclasses import replace

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from ...core.named_types import Array
from ...core.validator import Validator
from .road import Road, both, check_points, points

LENGTH, HEIGHT, ORDER, SHIFT = 1.0, 1.0, 1.8, 0.8
"""Default cams: a and b over the radius of the tyre, c, and l_s over the length of the contact."""

_POINTS = 60  # of half a cam
_AT_ONCE = 4096  # positions of a cam


def enveloped(road: Road, *, radius: float, contact_length: float) -> Road:
    """Return the effective road of a tyre that envelops short obstacles, by two elliptical cams.

    Long waves remain, short ones are lowered, and an edge becomes a ramp that begins before it.
    Effective inclinations and longitudinal forces are not modelled.

    Parameters
    ----------
    road : Road
    radius : float
        Unloaded radius of the tyre [m].
    contact_length : float
        Length of the loaded contact on a flat road [m]; 100 to 150 mm for a passenger car.

    Returns
    -------
    Road
        Road of the same length, with a spacing that resolves the cams.

    Raises
    ------
    InputError
        If an argument cannot be used.

    Notes
    -----
    Two cams ``(|x| / radius)^1.8 + (|z| / radius)^1.8 = 1``, at a distance of 0.8 `contact_length`,
    slide over the road; the effective height is the mean of their heights relative to those on a
    flat road (Pacejka, Tire and Vehicle Dynamics, third edition, section 10.1.6).

    Examples
    --------
    >>> from kintrafo import road_profiles
    >>> flat = road_profiles.Road(0.1, [0.0] * 50, [0.0] * 50)
    >>> float(road_profiles.enveloped(flat, radius=0.3, contact_length=0.12).left.max())
    0.0
    """
    with Validator("enveloped") as given:
        given.instance("road", road, Road, "a kintrafo.road_profiles.Road is needed")
        radius = given.number("radius", radius, "m", above=0.0)
        contact_length = given.number("contact_length", contact_length, "m", above=0.0)
        if not given.failed and contact_length >= 2.0 * radius:
            given.fail(
                f"contact_length = {contact_length:g} m: less than the diameter of the tyre, "
                f"{2.0 * radius:g} m, is needed."
            )
    half = LENGTH * radius
    parts = max(int(np.ceil(road.spacing * _POINTS / half)), 1)
    spacing = road.spacing / parts
    check_points(road.length, spacing)
    at = np.arange(parts * (road.left.size - 1) + 1) / parts
    left, right = (
        _effective(np.interp(at, np.arange(h.size), h), spacing, radius, contact_length)
        for h in (road.left, road.right)
    )
    words = f"{road.words}, enveloped by a tyre with {1e3 * contact_length:g} mm of contact"
    return replace(road, spacing=spacing, left=left, right=right, words=words)


def kerb(
    height: float,
    *,
    radius: float,
    contact_length: float,
    at: float = 5.0,
    end: float = 50.0,
    sides: str = "both",
) -> Road:
    """Return the effective road of an edge, such as a kerb, under a tyre.

    Parameters
    ----------
    height : float
        Height of the road beyond the edge, negative for a drop [m].
    radius, contact_length : float
        As in `enveloped`.
    at, end : float, optional
        Distance from the start of the road to the edge, and length of the road [m].
    sides : {'both', 'left', 'right'}, optional
        Wheels that meet the edge.

    Returns
    -------
    Road

    Raises
    ------
    InputError
        If an argument cannot be used.

    Examples
    --------
    >>> from kintrafo import road_profiles
    >>> round(float(road_profiles.kerb(0.1, radius=0.3, contact_length=0.12).left[-1]), 12)
    0.1
    """
    with Validator("kerb") as given:
        height = given.number("height", height, "m")
        radius = given.number("radius", radius, "m", above=0.0)
        at = given.number("at", at, "m", least=0.0)
        end = given.number("end", end, "m", above=0.0)
        if not given.failed and abs(height) >= HEIGHT * radius:
            given.fail(
                f"height = {height:g} m: less than the radius of the tyre, {radius:g} m, is "
                "needed; a wheel does not climb more."
            )
        if not given.failed and at >= end:
            given.fail(f"at = {at:g} m is beyond the end of {end:g} m.")
    spacing = LENGTH * radius / _POINTS
    heights = np.where(points(end, spacing) >= at, height, 0.0)
    edge = both(spacing, heights, sides, f"a kerb of {1e3 * height:g} mm")
    return enveloped(edge, radius=radius, contact_length=contact_length)


def _effective(heights: Array, spacing: float, radius: float, contact_length: float) -> Array:
    """Return the mean height of both cams above those on a flat road [m]."""
    from scipy.ndimage import shift  # noqa: PLC0415 (slow to import)

    half = int(LENGTH * radius / spacing)
    x = spacing * np.abs(np.arange(-half, half + 1))
    # height of a cam's contour above its lowest point
    rise = HEIGHT * radius * (1.0 - (1.0 - (x / (LENGTH * radius)) ** ORDER) ** (1.0 / ORDER))
    windows = sliding_window_view(np.pad(heights, half, mode="edge"), rise.size)
    parts = (windows[i : i + _AT_ONCE] for i in range(0, len(windows), _AT_ONCE))
    lifted = np.concatenate([np.max(part - rise, axis=1) for part in parts])
    away = 0.5 * SHIFT * contact_length / spacing
    first, second = (shift(lifted, s, order=1, mode="nearest") for s in (away, -away))
    return 0.5 * (first + second)
