"""Analytic roads: a single bump or pothole, and waves."""

import numpy as np

from ...core.validator import Validator
from .road import Road, both, points

_POINTS = 40  # of a bump or a wave, at least
_SPACING = 0.02  # greatest [m]
_HIGHEST = 1.0  # greatest height that a wheel climbs [m]


def bump(
    height: float, length: float, *, at: float = 5.0, end: float = 50.0, sides: str = "both"
) -> Road:
    """Return a road with a bump, ``height (1 - cos) / 2`` over its length.

    Parameters
    ----------
    height : float
        Height of its middle, negative for a pothole; less than 1 m in size [m].
    length : float
        Length of the bump, above zero [m].
    at : float, optional
        Distance from the start of the road to the bump [m].
    end : float, optional
        Length of the road [m].
    sides : {'both', 'left', 'right'}, optional
        Wheels that meet the bump.

    Returns
    -------
    Road

    Raises
    ------
    InputError
        If an argument cannot be used, or the bump does not end before the road.

    Examples
    --------
    >>> from kintrafo import road_profiles
    >>> round(float(road_profiles.bump(0.05, 1.0).left.max()), 12)
    0.05
    """
    with Validator("bump") as given:
        height = given.number("height", height, "m", least=-_HIGHEST, below=_HIGHEST)
        length = given.number("length", length, "m", above=0.0)
        at = given.number("at", at, "m", least=0.0)
        end = given.number("end", end, "m", above=0.0)
        if not given.failed and at + length > end:
            given.fail(f"at + length = {at + length:g} m is beyond the end of {end:g} m.")
    spacing = min(_SPACING, length / _POINTS)
    x = points(end, spacing)
    phase = np.clip((x - at) / length, 0.0, 1.0)
    heights = 0.5 * height * (1.0 - np.cos(2.0 * np.pi * phase))
    kind = "pothole" if height < 0.0 else "bump"
    words = f"a {kind} of {1e3 * abs(height):g} mm over {length:g} m"
    return both(spacing, heights, sides, words)


def sine(amplitude: float, wavelength: float, *, end: float = 200.0, sides: str = "both") -> Road:
    """Return a sinusoidal road, which begins at zero height and rises.

    Parameters
    ----------
    amplitude : float
        Amplitude, half the height from valley to crest [m].
    wavelength : float
        Wavelength, above zero [m].
    end : float, optional
        Length of the road [m].
    sides : {'both', 'left', 'right'}, optional
        Wheels that meet the waves.

    Returns
    -------
    Road

    Raises
    ------
    InputError
        If an argument cannot be used.
    """
    with Validator("sine") as given:
        amplitude = given.number("amplitude", amplitude, "m")
        wavelength = given.number("wavelength", wavelength, "m", above=0.0)
        end = given.number("end", end, "m", above=0.0)
    spacing = min(_SPACING, wavelength / _POINTS)
    x = points(end, spacing)
    heights = amplitude * np.sin(2.0 * np.pi * x / wavelength)
    words = f"waves of {1e3 * amplitude:g} mm, {wavelength:g} m long"
    return both(spacing, heights, sides, words)
