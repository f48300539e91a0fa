"""Rough roads of ISO 8608, with two tracks.

The one-sided power spectral density of the heights over the spatial frequency n is ::

    G(n) = G(n0) (n / n0)^-2,    n0 = 0.1 1/m

and a class has G(n0) of 4^k 1e-6 m^3: A 16, B 64, C 256 and so on (the geometric means of ISO
8608:2016). An isotropic road has the same statistics in all directions; its two tracks at the
distance t have the normalised cross-spectrum (Dodds and Robson, Journal of Sound and Vibration 31,
1973) ::

    g(n) = x K_1(x),    x = 2 pi n t

with the modified Bessel function K_1: long waves are under both wheels, short ones are independent.
"""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.named_types import Array, ArrayLike
from ...core.validator import Validator
from .road import MOST_POINTS, Road, smooth_step

REFERENCE = 0.1
"""Spatial frequency n0 of the definition of a class [1/m]."""

CLASSES = {name: 4.0**k * 1e-6 for k, name in enumerate("ABCDEFGH", start=2)}
"""G(n0) of the classes [m^3]: geometric means."""

WAVES = (0.01, 10.0)
"""Range of spatial frequencies of a road [1/m]: waves of 100 m to 0.1 m."""


def iso8608(
    roughness: str | float,
    *,
    length: float,
    seed: int,
    track: float = 1.5,
    spacing: float = 0.05,
    fade: float = 20.0,
) -> Road:
    """Return a rough road of a class of ISO 8608.

    Parameters
    ----------
    roughness : str or float
        A class, 'A' to 'H', or the spectral density of the heights G(n0) at n0 = 0.1 1/m [m^3].
    length : float
        Length of the road [m].
    seed : int
        Seed of the random phases, zero or more: equal seeds give equal roads.
    track : float, optional
        Distance between the two tracks [m]; 0 for one profile under both.
    spacing : float, optional
        Distance along the road between two heights, at most 0.05 m: half the shortest wave [m].
    fade : float, optional
        Distance at the beginning over which the heights grow from zero [m].

    Returns
    -------
    Road
        Sum of all waves of 0.01 to 10 1/m that fit into its length, each with the amplitude of the
        class and a random phase. Both tracks have the coherence of `isotropic_coherence`.

    Raises
    ------
    InputError
        If an argument cannot be used.

    Examples
    --------
    >>> from kintrafo import road_profiles
    >>> road = road_profiles.iso8608("B", length=100.0, seed=1)
    >>> float(road.left[0]), road.words
    (0.0, 'a road of class B of ISO 8608, seed 1')
    """
    with Validator("iso8608") as given:
        at_reference = roughness_of(given, roughness)
        length = given.number("length", length, "m", above=0.0)
        seed = given.whole("seed", seed, least=0)
        track = given.number("track", track, "m", least=0.0)
        spacing = given.number("spacing", spacing, "m", above=0.0)
        fade = given.number("fade", fade, "m", least=0.0)
        if not given.failed and spacing > 0.5 / WAVES[1]:
            given.fail(f"spacing = {spacing:g} m: at most {0.5 / WAVES[1]:g} m is allowed.")
        if not given.failed and not 1.0 / WAVES[0] <= length <= spacing * MOST_POINTS:
            given.fail(
                f"length = {length:g} m: {1.0 / WAVES[0]:g} m, the longest wave, to "
                f"{spacing * MOST_POINTS:g} m are allowed."
            )
        if not given.failed and fade > length:
            given.fail(f"fade = {fade:g} m: at most the length, {length:g} m, is allowed.")
    count = math.ceil(length / spacing)
    n = np.arange(count // 2 + 1) / (count * spacing)
    density = np.where((n >= WAVES[0]) & (n <= WAVES[1]), spectrum(at_reference, n), 0.0)
    shared = isotropic_coherence(n, track)
    rng = np.random.default_rng(seed)
    # two independent profiles; a wave of the amplitude a is two of a / 2 in a discrete transform
    size = count * np.sqrt(0.5 * density / (count * spacing))
    one, other = (size * np.exp(2j * np.pi * rng.random(n.size)) for _ in range(2))
    common, apart = np.sqrt(0.5 * (1.0 + shared)), np.sqrt(0.5 * (1.0 - shared))
    grown = _grown(spacing * np.arange(count), fade)
    left, right = (
        np.fft.irfft(common * one + sign * apart * other, n=count) * grown for sign in (1.0, -1.0)
    )
    named = f"of class {roughness}" if isinstance(roughness, str) else f"of {at_reference:g} m^3"
    words = f"a road {named} of ISO 8608, seed {seed}"
    return Road(spacing, left, right, words, stationary=True)


def _grown(x: NDArray[Any], fade: float) -> Array:
    """Return the factor of the heights at a distance, from 0 to 1 over the fade."""
    part = np.ones_like(x) if fade == 0.0 else np.clip(x / fade, 0.0, 1.0)
    return smooth_step(part)


def roughness_of(given: Validator, roughness: str | float) -> float:
    """Return the given G(n0), or that of a class [m^3]."""
    if isinstance(roughness, str):
        given.among("roughness", roughness, CLASSES)
        return CLASSES.get(roughness, math.nan)
    return given.number("roughness", roughness, "m^3", above=0.0)


def spectrum(at_reference: float, n: ArrayLike) -> Array:
    """Return the one-sided power spectral density of the heights [m^3].

    `at_reference` is G(n0) [m^3], `n` are spatial frequencies [1/m].
    """
    with np.errstate(divide="ignore"):
        found: Array = at_reference * (np.asarray(n, float) / REFERENCE) ** -2.0
    return found


def isotropic_coherence(n: ArrayLike, track: float) -> Array:
    """Return the cross-spectrum of two tracks of an isotropic road over the spectrum of one.

    Parameters
    ----------
    n : array_like
        Spatial frequencies [1/m]; 1 at zero and below.
    track : float
        Distance between the tracks [m].

    Returns
    -------
    ndarray
        x K_1(x) with x = 2 pi n track and the modified Bessel function K_1, from 1 for long waves
        to 0 for short ones. It follows from a spectrum proportional to n^-2, as of ISO 8608
        (Dodds and Robson, Journal of Sound and Vibration 31, 1973).

    Raises
    ------
    InputError
        If an argument is not a finite number, or the distance is negative.
    """
    from scipy.special import k1  # noqa: PLC0415 (slow to import)

    with Validator("isotropic_coherence") as given:
        frequencies = given.array("n", n, "1/m")
        track = given.number("track", track, "m", least=0.0)
    x = 2.0 * np.pi * frequencies * track
    with np.errstate(invalid="ignore"):
        return np.where(x > 0.0, x * k1(np.where(x > 0.0, x, 1.0)), 1.0)
