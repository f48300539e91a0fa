"""Percentiles, and spectra by Welch's method, of whole series of outputs.

The operations on a series and their order do not depend on other series, nor do its bits.
"""

import numpy as np

from ..core.named_types import Array

USUAL_SEGMENT, LEAST_SEGMENT = 256, 8
"""Outputs in a segment of a spectrum: the default, as in SciPy, and the least allowed."""

# Largest error of times at equal distances, relative to a step; that of a spectrum is smaller.
_OFF = 1e-6
# Series of one transform: a fixed number, since the grouping within a transform depends on it.
TOGETHER = 64


def uniform_step(times: Array) -> float | None:
    """Return the step of times at equal distances [s]; None for other times."""
    step = (times[-1] - times[0]) / (times.size - 1)
    off = np.abs(times - (times[0] + step * np.arange(times.size))).max()
    return float(step) if off <= _OFF * step else None


def frequencies(times: Array, segment: int) -> Array:
    """Return the frequencies of a spectrum, from zero to half of the sampling rate [Hz]."""
    step = uniform_step(times)
    assert step is not None  # the arguments have been checked
    return np.arange(segment // 2 + 1) / (segment * step)


def spectra(series: Array, times: Array, segment: int) -> Array:
    """Return one-sided power spectral densities by Welch's method, (count, segment // 2 + 1).

    Segments overlap by half, each without its mean and under Hann's window; their periodograms are
    averaged: Welch, The use of fast Fourier transform for the estimation of power spectra, IEEE
    Transactions on Audio and Electroacoustics 15 (1967). The times of the series, (count, number of
    times), are at equal distances [s]; a segment has `segment` outputs. The unit is the square of
    that of the series over Hz. The integral over the frequencies is the variance within the
    segments.
    """
    from scipy.signal import welch  # noqa: PLC0415 (slow to import)

    rate = 1.0 / (uniform_step(times) or np.nan)
    found = np.empty((len(series), segment // 2 + 1))
    together = np.zeros((TOGETHER, times.size))
    for first in range(0, len(series), TOGETHER):
        some = series[first : first + TOGETHER]
        together[: len(some)] = some
        density = welch(
            together, rate, window="hann", nperseg=segment, noverlap=segment // 2,
            detrend="constant", scaling="density", return_onesided=True, axis=-1,
        )[1]  # fmt: skip
        found[first : first + len(some)] = density[: len(some)]
    return found


def percentile(series: Array, percent: float) -> Array:
    """Return a percentile of each series, linearly interpolated; the series are reordered."""
    return np.percentile(series, percent, axis=-1, overwrite_input=True)
