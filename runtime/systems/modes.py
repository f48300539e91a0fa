"""Modes of linear equations ``x' = A x``: eigenvalues, frequencies, damping, shapes."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import cast

import numpy as np
from numpy.typing import NDArray

from ..core.named_types import Array

Complex = NDArray[np.complex128]


# A smaller participation counts as none.
_LEAST_SHARE = 1e-6


@dataclass(frozen=True)
class Mode:
    """A mode: one real eigenvalue, or a pair, conjugate or of an overdamped motion.

    Attributes
    ----------
    eigenvalues : tuple of complex
        One or two [1/s]; the first has a positive imaginary part, or is the faster of two real
        ones.
    shape : ndarray of complex, shape (states,)
        Eigenvector of the first eigenvalue with one as its largest element. Elements are in the
        units of the state.
    state_names : tuple of str
        Names of the elements of `shape`.
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

        NaN if one of two grows and the other one decays, which is no oscillation.
        """
        if self._falls:
            return math.nan
        size = math.prod(map(abs, self.eigenvalues))
        mean: float = size ** (1.0 / len(self.eigenvalues))
        return mean / (2.0 * math.pi)

    @property
    def damping_ratio(self) -> float:
        """Damping ratio; above one for an overdamped pair, negative for a growing motion.

        NaN for an eigenvalue of zero, and without a natural frequency.
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
        """The eigenvalues as text."""
        first = self.eigenvalues[0]
        if self.oscillates:
            return f"{first.real:.4f} +- {abs(first.imag):.4f} i"
        return " and ".join(f"{value.real:.4f}" for value in self.eigenvalues)

    @property
    def text(self) -> str:
        """Frequency and damping as text."""
        if 0.0 in self.eigenvalues:
            return "neither oscillates nor decays: an eigenvalue is zero"
        text = f"{self.natural_frequency:.2f} Hz, damping ratio {self.damping_ratio:.3f}"
        if self.oscillates:
            return text
        seconds = [1.0 / abs(value.real) for value in self.eigenvalues]
        times = [f"{1e3 * t:.3g} ms" if t < 0.9995 else f"{t:.3g} s" for t in seconds]
        if max(value.real for value in self.eigenvalues) < 0.0:
            return f"{text}: overdamped, time constants {' and '.join(times)}"
        words = [
            f"{'grows' if value.real > 0.0 else 'decays'} by the factor e in {time}"
            for value, time in zip(self.eigenvalues, times, strict=True)
        ]
        return f"does not oscillate: {', '.join(words)}"


def eigenvalues_of(matrix: Array) -> Complex:
    """Return the eigenvalues of a matrix, those with the largest imaginary part first."""
    values: Complex = np.linalg.eigvals(matrix).astype(np.complex128)
    return values[_order(values)]


def modes_of(matrix: Array, names: tuple[str, ...], lift: Array | None = None) -> tuple[Mode, ...]:
    """Return the modes of a matrix, (n, n): one for each conjugate pair and each real eigenvalue.

    `names` are those of the states; `lift`, (states, n), leads from the coordinates of the matrix
    to changes of the states, by default the identity.
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
    """Return the pair of eigenvalues, or the only one, with the largest participation of states.

    The participation of a state in an eigenvalue is the product of its elements in the left and in
    the right eigenvector, which does not depend on units. Matrix [1/s], names and `lift` are as in
    `modes_of`; `places` are indices of the states in the matrix: a coordinate and its rate. The
    pair is conjugate, or the two real eigenvalues with the largest participation; one if the states
    take part in no other.
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
    # the second real eigenvalue, unless it belongs to another motion
    real = np.flatnonzero((values.imag == 0.0) & (shares > _LEAST_SHARE))
    real = real if real.size else np.array([best])
    pair = sorted(real[np.argsort(shares[real])[-2:]], key=lambda k: values[k].real)
    return _mode(tuple(values[k] for k in pair), shapes[:, pair[0]], names)


def modes_of_motions(
    matrix: Array, names: tuple[str, ...], motions: Array, weights: Array
) -> tuple[tuple[Mode, float], ...]:
    """Return a distinct mode for each motion, and the part of the motion in it.

    The part of a motion in a mode is its kinetic energy there, over that of all motions. Modes are
    assigned so that the sum of the parts is greatest; the real eigenvalues of motions that do not
    oscillate are assigned in pairs. The matrix is that of the linear equations [1/s], with the
    names of the states. `motions`, (motions, states), lead from the states to the amplitude of each
    motion, of which there are at most as many as modes; `weights` are the mass [kg] or moment of
    inertia [kg m^2] of each.
    """
    from scipy.optimize import linear_sum_assignment  # noqa: PLC0415 (slow to import)

    values, _, right = _decompose(matrix)
    energies = weights[:, None] * np.abs(motions @ right) ** 2
    total = energies.sum(axis=0)
    # modes without these motions, such as the zeros of freely spinning wheels, are left out;
    # eigenvectors have the length one, rates included
    size = total * (1.0 + np.abs(values) ** 2)
    moving = size > _LEAST_SHARE * size.max()
    shares = np.divide(energies, total, out=np.zeros_like(energies), where=moving)
    upper = np.flatnonzero(moving & (values.imag > 0.0))
    real = np.flatnonzero(moving & (values.imag == 0.0))
    # a motion that does not oscillate has two real eigenvalues
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

    It is the rounding error of the matrix over the product of left and right eigenvector, both of
    length one. Two zeros with one eigenvector have an error of the square root of rounding.
    """
    eps, size = float(np.finfo(np.float64).eps), float(np.linalg.norm(matrix))
    product = np.abs(np.einsum("ik,ik->k", left.conj(), right))
    part: Array = eps / np.maximum(product, eps**0.5)
    return size * part


def _order(values: Complex) -> NDArray[np.intp]:
    return np.lexsort((values.real, -np.abs(values), -values.imag))


def _participation(left: Complex, right: Complex) -> Array:
    """Return the participation of each state (row) in each eigenvalue (column).

    A repeated eigenvalue with too few eigenvectors, such as the zeros of a freely spinning wheel,
    has orthogonal left and right vectors; its participations are zero.
    """
    shares: Array = np.abs(left.conj() * right)
    total = np.abs(np.einsum("ik,ik->k", left.conj(), right))
    complete = total > np.finfo(np.float64).eps ** 0.5
    parts = np.zeros_like(shares)
    parts[:, complete] = shares[:, complete] / total[complete]
    return parts
