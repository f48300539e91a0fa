"""Modes of linear equations ``x' = A x``: eigenvalues, frequencies, damping, shapes."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import cast

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


# A motion that takes part less than that in an eigenvalue has no part in it.
_LEAST_SHARE = 1e-6


@dataclass(frozen=True)
class Mode:
    """One eigenvalue, or two that belong together: a conjugate pair, or an overdamped one.

    Attributes
    ----------
    eigenvalues : tuple of complex
        One or two [1/s]; that with positive imaginary part first, or else the faster one.
    shape : ndarray of complex, shape (states,)
        Eigenvector of the first eigenvalue, its largest element being one. Elements are in the
        units of the state.
    state_names : tuple of str
    """

    eigenvalues: tuple[complex, ...]
    shape: Complex
    state_names: tuple[str, ...]

    @property
    def oscillates(self) -> bool:
        """Whether the mode is underdamped."""
        return self.eigenvalues[0].imag != 0.0

    @property
    def natural_frequency(self) -> float:
        """Undamped natural frequency [Hz]; that of the geometric mean of real eigenvalues.

        NaN where one of two grows and the other one decays: nothing would swing there.
        """
        if self._falls:
            return math.nan
        size = math.prod(map(abs, self.eigenvalues))
        mean: float = size ** (1.0 / len(self.eigenvalues))
        return mean / (2.0 * math.pi)

    @property
    def damping_ratio(self) -> float:
        """Damping ratio; above one for an overdamped pair, negative where the motion grows.

        NaN for an eigenvalue that is zero, and where there is no natural frequency.
        """
        total = sum(self.eigenvalues).real
        size = len(self.eigenvalues) * 2.0 * math.pi * self.natural_frequency
        return 0.0 - total / size if size > 0.0 else float("nan")  # no negative zero

    @property
    def _falls(self) -> bool:
        """Whether one of two real eigenvalues grows and the other one decays."""
        rates = [value.real for value in self.eigenvalues]
        return not self.oscillates and min(rates) < 0.0 < max(rates)

    @property
    def eigenvalues_text(self) -> str:
        """The eigenvalues for a person to read."""
        first = self.eigenvalues[0]
        if self.oscillates:
            return f"{first.real:.4f} +- {abs(first.imag):.4f} i"
        return " and ".join(f"{value.real:.4f}" for value in self.eigenvalues)

    @property
    def text(self) -> str:
        """Frequency and damping for a person to read."""
        if 0.0 in self.eigenvalues:
            return "neither swings nor returns: an eigenvalue is zero"
        text = f"{self.natural_frequency:.2f} Hz, damping ratio {self.damping_ratio:.3f}"
        if self.oscillates:
            return text
        times = [_time(1.0 / abs(value.real)) for value in self.eigenvalues]
        if max(value.real for value in self.eigenvalues) < 0.0:
            return f"{text}: overdamped, time constants {' and '.join(times)}"
        words = [
            f"{'grows' if value.real > 0.0 else 'decays'} by the factor e in {time}"
            for value, time in zip(self.eigenvalues, times, strict=True)
        ]
        return f"does not swing: {', '.join(words)}"


def _time(value: float) -> str:
    return f"{1e3 * value:.3g} ms" if value < 0.9995 else f"{value:.3g} s"


def eigenvalues_of(matrix: Array) -> Complex:
    """Return the eigenvalues of a matrix, those with the largest imaginary part first.

    Parameters
    ----------
    matrix : ndarray, shape (n, n)

    Returns
    -------
    ndarray of complex, shape (n,)
    """
    values: Complex = np.linalg.eigvals(matrix).astype(np.complex128)
    return values[_order(values)]


def modes_of(matrix: Array, names: tuple[str, ...], lift: Array | None = None) -> tuple[Mode, ...]:
    """Return the modes: one for each conjugate pair and for each real eigenvalue.

    Parameters
    ----------
    matrix : ndarray, shape (n, n)
        A.
    names : tuple of str
        Names of the states.
    lift : ndarray, shape (states, n), optional
        From what the matrix is about to changes of the states: they are the same, by default.

    Returns
    -------
    tuple of Mode
    """
    values, _, right = _decompose(matrix)
    shapes = right if lift is None else lift @ right
    return tuple(
        _mode((value, value.conjugate()) if value.imag else (value,), shapes[:, k], names)
        for k, value in enumerate(values)
        if value.imag >= 0.0
    )


def mode_of_states(
    matrix: Array, names: tuple[str, ...], places: Sequence[int], lift: Array | None = None
) -> Mode:
    """Return the pair of eigenvalues, or the only one, in which some states take part most.

    The participation of a state in an eigenvalue is the product of its elements in the left and in
    the right eigenvector, which do not depend on units.

    Parameters
    ----------
    matrix : ndarray, shape (n, n)
        A.
    names : tuple of str
        Names of the states.
    places : sequence of int
        Of those by which the mode is looked for, in the matrix: a coordinate and its rate.
    lift : ndarray, shape (states, n), optional
        As in `modes_of`.

    Returns
    -------
    Mode
        A conjugate pair, or the two real eigenvalues in which the states take part most; one
        where they take part in one alone.
    """
    values, left, right = _decompose(matrix)
    shares = _participation(left, right)[list(places)].sum(axis=0)
    shapes = right if lift is None else lift @ right
    best = int(np.argmax(shares))
    if values[best].imag != 0.0:
        upper = (
            best
            if values[best].imag > 0.0
            else int(np.argmin(np.abs(values - values[best].conj())))
        )
        return _mode((values[upper], values[upper].conjugate()), shapes[:, upper], names)
    # the next one may be of a conjugate pair, or of another motion: with these it makes no pair
    real = np.flatnonzero((values.imag == 0.0) & (shares > _LEAST_SHARE))
    real = real if real.size else np.array([best])
    pair = sorted(real[np.argsort(shares[real])[-2:]], key=lambda k: values[k].real)
    return _mode(tuple(values[k] for k in pair), shapes[:, pair[0]], names)


def modes_of_motions(
    matrix: Array, names: tuple[str, ...], motions: Array, weights: Array
) -> tuple[tuple[Mode, float], ...]:
    """Return a mode for each motion, none of them twice, and the part of the motion in it.

    The part of a motion in a mode is its kinetic energy there, over that of all motions. Modes are
    assigned so that the sum of the parts is greatest; the real eigenvalues of motions that do not
    oscillate are assigned two at a time.

    Parameters
    ----------
    matrix, names
        As in `mode_of_states`.
    motions : ndarray, shape (motions, states)
        Amplitude of each motion by the states. There are no more motions than modes.
    weights : ndarray, shape (motions,)
        The mass or moment of inertia of each.
    """
    from scipy.optimize import linear_sum_assignment  # noqa: PLC0415 (slow to import)

    values, _, right = _decompose(matrix)
    energies = weights[:, None] * np.abs(motions @ right) ** 2
    total = energies.sum(axis=0)
    # without modes in which no motion takes part, such as the zeros of wheels that spin freely;
    # eigenvectors have the length one, rates included
    size = total * (1.0 + np.abs(values) ** 2)
    moving = size > _LEAST_SHARE * size.max()
    shares = np.divide(energies, total, out=np.zeros_like(energies), where=moving)
    upper = np.flatnonzero(moving & (values.imag > 0.0))
    real = np.flatnonzero(moving & (values.imag == 0.0))
    # a motion that does not oscillate takes part most in two of the real eigenvalues
    in_two = 0.5 * np.sort(shares[:, real], axis=1)[:, -2:].sum(axis=1, keepdims=True)
    options = np.hstack([shares[:, upper], np.repeat(in_two, real.size // 2, axis=1)])
    rows, columns = linear_sum_assignment(options, maximize=True)
    damped = rows[columns >= upper.size]
    _, chosen = linear_sum_assignment(np.repeat(shares[damped][:, real], 2, axis=0), maximize=True)
    own = dict(zip(damped.tolist(), real[chosen].reshape(-1, 2).tolist(), strict=True))
    found = []
    for row, column in zip(rows.tolist(), columns.tolist(), strict=True):
        if row in own:
            pair = sorted(own[row], key=lambda k: values[k].real)
            eigenvalues = tuple(values[k] for k in pair)
        else:
            pair = [upper[column]]
            eigenvalues = values[pair[0]], values[pair[0]].conjugate()
        part = float(shares[row, pair].mean())
        found.append((_mode(eigenvalues, right[:, pair[0]], names), part))
    return tuple(found)


def _mode(values: tuple[complex, ...], shape: Complex, names: tuple[str, ...]) -> Mode:
    largest = shape[np.argmax(np.abs(shape))]
    return Mode(tuple(map(complex, values)), shape / largest, names)


def _decompose(matrix: Array) -> tuple[Complex, Complex, Complex]:
    """Return eigenvalues in order, with left and right eigenvectors as columns."""
    from scipy.linalg import eig  # noqa: PLC0415 (slow to import)

    found = cast("tuple[Complex, Complex, Complex]", eig(matrix, left=True, right=True))
    values, left, right = found
    values[np.abs(values) <= _rounding(matrix, left, right)] = 0.0
    order = _order(values)
    return values[order], left[:, order], right[:, order]


def _rounding(matrix: Array, left: Complex, right: Complex) -> Array:
    """Return the error of each eigenvalue from rounding of the matrix, to first order.

    It is the rounding of the matrix over the product of left and right eigenvector, both of length
    one. Two zeros with one eigenvector have an error of the square root of rounding.
    """
    eps, size = float(np.finfo(np.float64).eps), float(np.linalg.norm(matrix))
    product = np.abs(np.einsum("ik,ik->k", left.conj(), right))
    part: Array = eps / np.maximum(product, eps**0.5)
    return size * part


def _order(values: Complex) -> NDArray[np.intp]:
    return np.lexsort((values.real, -np.abs(values), -values.imag))


def _participation(left: Complex, right: Complex) -> Array:
    """Return how much each state (row) takes part in each eigenvalue (column).

    A repeated eigenvalue without eigenvectors enough, such as the zeros of a freely spinning wheel,
    has left and right vectors at right angles; what is not shared out there stays zero.
    """
    shares: Array = np.abs(left.conj() * right)
    total = np.abs(np.einsum("ik,ik->k", left.conj(), right))
    complete = total > np.finfo(np.float64).eps ** 0.5
    parts = np.zeros_like(shares)
    parts[:, complete] = shares[:, complete] / total[complete]
    return parts
