"""Fit of coefficients of the Magic Formula to a measurement."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...core.errors import InputError
from ...core.named_types import Array
from ...core.validator import Validator
from ...formulas.coefficients import keys
from . import coefficients as known
from .magic_formula import MagicFormula
from .measured import Measured, measured

if TYPE_CHECKING:
    from xarray import Dataset

_GROUPS: Mapping[str, tuple[str, ...]] = {
    "fx": keys("PCX1 PDX1-2 PEX1-2 PKX1-3 PHX1 PVX1"),
    "fy": keys("PCY1 PDY1-3 PEY1-3 PKY1-3 PKY6-7 PHY1-3 PVY1-4"),
    "mz": keys("QBZ1-2 QBZ9 QCZ1 QDZ1-4 QDZ6-9 QEZ1-2 QEZ4 QHZ1-4"),
    "mx": keys("QSX1-3"),
    "my": keys("QSY1-2"),
}
"""Coefficients that are fitted to each force by default."""
_COMBINED = keys("RBX1-2 RCX1 REX1 RHX1 RBY1-3 RCY1 REY1 RHY1 RVY1 RVY4-6")
_BOUNDS: Mapping[str, tuple[float, float]] = {
    "PCX1": (1.0, 2.5), "PCY1": (0.8, 2.5), "QCZ1": (0.8, 2.5), "RCX1": (0.5, 2.0),
    "RCY1": (0.5, 2.0), "PDX1": (0.05, 4.0), "PDY1": (0.05, 4.0), "PKX1": (1.0, 150.0),
    "PKY1": (-150.0, -1.0), "PKY2": (0.3, 10.0), "PEX1": (-20.0, 1.0), "PEY1": (-20.0, 1.0),
    "QEZ1": (-20.0, 1.0), "REX1": (-10.0, 1.0), "REY1": (-10.0, 1.0),
    "QBZ1": (0.5, 60.0), "QBZ9": (0.0, 100.0),
    "RBX1": (0.5, 100.0), "RBY1": (0.5, 100.0),
}  # fmt: skip
_WIDE = 20.0  # half-width of the bounds of the others, in typical sizes
_SIZES: Mapping[str, float] = {
    "PH": 0.01, "PV": 0.1, "RH": 0.02, "QH": 0.01, "QD": 0.05, "PD": 0.3, "PE": 1.0, "PK": 1.0,
    "QB": 2.0, "QE": 1.0, "RB": 5.0, "RV": 1.0, "RE": 0.5, "SS": 0.05, "QS": 0.05, "PC": 0.3,
}  # fmt: skip
"""Typical sizes of coefficients, by the first two letters of their names."""
_STEP = 1e-5  # of finite differences, in typical sizes
_MOST_ERROR = 0.5  # standard error of a determined coefficient, in half-widths of the bounds


@dataclass(frozen=True)
class TyreFit:
    """Coefficients fitted to a measurement, and their standard errors.

    Attributes
    ----------
    tyre : MagicFormula
        Tyre with the fitted coefficients.
    table : xarray.Dataset
        Over ``coefficient``: ``value``, its ``start``, ``standard_error`` and the bounds ``least``
        and ``most``; over two coefficients the ``correlation`` of their errors.
    residuals : dict of str to ndarray
        Residual of each force: measured minus computed [N, N m].
    at_bounds : tuple of str
        Coefficients that ended at a bound.
    left_out : tuple of str
        Default coefficients that the data do not determine.
    success : bool
        Whether the search converged.
    message : str
        The reason for which the search ended.
    evaluations : int
        Number of evaluated tyres.
    """

    tyre: MagicFormula
    table: "Dataset"
    residuals: dict[str, Array]
    at_bounds: tuple[str, ...]
    left_out: tuple[str, ...]
    success: bool
    message: str
    evaluations: int

    def root_mean_square(self) -> dict[str, float]:
        """Return the root mean square of the residual of each force [N, N m]."""
        return {k: float(np.sqrt(np.mean(v * v))) for k, v in self.residuals.items()}


def fit(
    data: str | Path | Mapping[str, Any],
    start: MagicFormula,
    coefficients: Iterable[str] | None = None,
    *,
    bounds: Mapping[str, tuple[float, float]] | None = None,
    accuracy: Mapping[str, float] | None = None,
) -> TyreFit:
    """Return a tyre whose coefficients are fitted to measured forces.

    All forces are fitted together by least squares within bounds (SciPy's trust region), each
    divided by its accuracy.

    Parameters
    ----------
    data : str, pathlib.Path or mapping
        A CSV file with columns such as ``load_N``, ``slip_angle_deg``, ``slip``, ``camber_deg``,
        ``pressure_bar``, ``fx_N``, ``fy_N``, ``mz_Nm``; or arrays of these names without units, in
        SI units. Axes and signs are those of `Tyre.evaluate`; missing states have its defaults.
    start : MagicFormula
        Tyre at the start of the search, with all data that are not fitted, such as dimensions and
        nominal load.
    coefficients : iterable of str, optional
        Coefficients to fit. Default: those of the measured forces that the data determine.
    bounds : mapping of str to (float, float), optional
        Least and greatest value of coefficients. Others have default bounds.
    accuracy : mapping of str to float, optional
        Standard deviation of each measured force [N, N m], by which residuals are divided and
        standard errors are computed. By default a tenth of the range of the force, with standard
        errors by the residuals.

    Returns
    -------
    TyreFit

    Raises
    ------
    InputError
        If the data cannot be read, or do not determine named coefficients; the message has their
        names, and those of the coefficients with equal effects.

    Examples
    --------
    >>> import numpy as np
    >>> import kintrafo
    >>> truth = kintrafo.tyres.load("passenger_205_55")
    >>> load, angle = np.meshgrid([2000.0, 4000.0, 6000.0], np.radians(np.linspace(-12, 12, 25)))
    >>> data = {"load": load.ravel(), "slip_angle": angle.ravel()}
    >>> data["fy"] = truth.evaluate(**data).fy
    >>> start = truth.with_changes({"PDY1": 1.2, "PKY1": -15.0})
    >>> found = kintrafo.tyres.fit(data, start, ["PDY1", "PKY1"])
    >>> found.table["value"].values.round(4).tolist()
    [0.98, -21.0]
    """
    with Validator("fit") as given:
        given.instance("start", start, MagicFormula, "a tyre of the Magic Formula is needed")
    rows = measured(data)
    _refuse_other_axes(rows, start)
    problem = _Residuals(rows, start, _scales(rows, accuracy))
    chosen, left_out = _chosen(problem, coefficients)
    limits = _limits(chosen, start, bounds)
    return _search(problem, chosen, limits, left_out, known_accuracy=accuracy is not None)


class _Residuals:
    """Residuals as functions of the coefficients."""

    def __init__(self, rows: Measured, start: MagicFormula, scales: Mapping[str, float]) -> None:
        self.rows, self.start, self._scales = rows, start, scales
        self.evaluations = 0

    def tyre(self, names: tuple[str, ...], values: Array) -> MagicFormula:
        """Return the tyre with these values of coefficients."""
        return self.start.with_changes(dict(zip(names, map(float, values), strict=True)))

    def residuals(self, names: tuple[str, ...], values: Array) -> dict[str, Array]:
        """Return measured minus computed forces; for an impossible tyre 1000 times the scale."""
        self.evaluations += 1
        try:
            state = vars(self.tyre(names, values).evaluate(**self.rows.states, extrapolate=True))
        except InputError:
            return {k: np.full_like(v, 1e3 * self._scales[k]) for k, v in self.rows.forces.items()}
        return {k: v - state[k] for k, v in self.rows.forces.items()}

    def scaled(self, names: tuple[str, ...], values: Array) -> Array:
        """Return the residuals of all forces over their scales, in one vector."""
        found = self.residuals(names, values)
        return np.concatenate([v / self._scales[k] for k, v in found.items()])

    def sizes(self, names: tuple[str, ...]) -> Array:
        """Return the greater of start and typical size of each coefficient."""
        return np.array([max(_size(n), abs(self.start.coefficients[n])) for n in names])

    def effects(self, names: tuple[str, ...], values: Array) -> Array:
        """Return the derivatives of `scaled` with respect to coefficients over their sizes."""
        sizes, columns = self.sizes(names), []
        for i, size in enumerate(sizes):
            step = np.zeros(len(names))
            step[i] = _STEP * size
            more, less = self.scaled(names, values + step), self.scaled(names, values - step)
            columns.append((more - less) / (2.0 * _STEP))
        return np.transpose(columns)


def _refuse_other_axes(rows: Measured, start: MagicFormula) -> None:
    """Refuse impossible states, and forces in axes other than those of ISO 8855."""
    there = vars(start.evaluate(**rows.states, extrapolate=True))
    with Validator("fit") as given:
        for name in ("fx", "fy"):
            if name in rows.forces and float(rows.forces[name] @ there[name]) < 0.0:
                given.fail(
                    f"data: {name} is opposite to that of the tyre to start from. The axes are "
                    "those of ISO 8855, x forward, y left, z up: fy is negative at a positive "
                    "slip angle, fx positive at a positive slip. Change the signs of the data."
                )


def _size(name: str) -> float:
    return _SIZES.get(name[:2], 1.0)


def _scales(rows: Measured, accuracy: Mapping[str, float] | None) -> dict[str, float]:
    """Return the divisors of the residuals of each force [N, N m]."""
    with Validator("fit") as given:
        for name in accuracy or {}:
            given.among("accuracy", name, rows.forces)
        given_accuracy = {
            k: given.number(f"accuracy[{k!r}]", v, above=0.0) for k, v in (accuracy or {}).items()
        }
        missing = [name for name in rows.forces if accuracy and name not in accuracy]
        for name in missing:
            given.fail(f"accuracy: {name} is missing. Give one for each force.")
    return {
        k: given_accuracy.get(k, 0.1 * (float(np.std(v)) or 1.0)) for k, v in rows.forces.items()
    }


def _chosen(
    problem: _Residuals, coefficients: Iterable[str] | None
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return the fitted coefficients, and the default ones that the data do not determine."""
    start, forces = problem.start, problem.rows.forces
    if coefficients is not None:
        with Validator("fit") as given:
            names = given.names("coefficients", coefficients, sorted(known.USED))
            if len(set(names)) < len(names):
                given.fail("coefficients: a name is given twice.")
            if not names:
                given.fail("coefficients: there is none; name one or more.")
        _refuse_undetermined(problem, names)
        return names, ()
    states = problem.rows.states
    both = all(np.ptp(states.get(k, np.zeros(1))) > 0.0 for k in ("slip", "slip_angle"))
    usual = [name for force in forces for name in _GROUPS[force]]
    usual += list(_COMBINED) if both and start.form.weighted else []
    only_older, only_newer = {"PHY3"}, {"PKY6", "PKY7"}
    usual = [n for n in usual if n not in (only_older if start.form.newer else only_newer)]
    kept: list[str] = []
    for name in usual:
        if not _doubtful(problem, (*kept, name)):
            kept.append(name)
    if not kept:
        raise InputError(["the data determine no coefficient: let load or slip vary."], "fit")
    return tuple(kept), tuple(n for n in usual if n not in kept)


def _refuse_undetermined(problem: _Residuals, names: tuple[str, ...]) -> None:
    doubtful = _doubtful(problem, names)
    if doubtful:
        words = "; ".join(
            f"{name}{f' (not distinguished from {others})' if (others := ', '.join(rest)) else ''}"
            for name, rest in doubtful.items()
        )
        undetermined = (
            f"the data do not determine {words}. Leave them out, or measure where they matter: at "
            "other loads, slips, cambers or pressures."
        )
        raise InputError([undetermined], "fit")


def _doubtful(problem: _Residuals, names: tuple[str, ...]) -> dict[str, list[str]]:
    """Return coefficients that the data do not determine, with those of nearly equal effects.

    A step of one size along a singular direction changes the scaled forces by the singular value.
    A coefficient is undetermined if an error of one scale moves it beyond a share of its bounds.
    """
    values = np.array([problem.start.coefficients[name] for name in names])
    effects = problem.effects(names, values)
    _, singular, directions = np.linalg.svd(effects, full_matrices=False)
    least = 1.0 / (_MOST_ERROR * _WIDE)
    found: dict[str, list[str]] = {}
    for value, direction in zip(singular, directions, strict=True):
        if value > max(least, 1e-7 * singular[0]):
            continue
        alike = [n for n, part in zip(names, direction, strict=True) if abs(part) > 0.2]
        for name in alike:
            found[name] = [n for n in alike if n != name]
    if len(singular) < len(names):
        return {name: [] for name in names}
    return found


def _limits(
    names: tuple[str, ...],
    start: MagicFormula,
    bounds: Mapping[str, tuple[float, float]] | None,
) -> tuple[Array, Array]:
    """Return least and greatest values; without known bounds, symmetric about the start."""
    least, most = [], []
    with Validator("fit") as given:
        for name in bounds or {}:
            given.among("bounds", name, names)
        for name in names:
            here, size = start.coefficients[name], _WIDE * _size(name)
            usual = _BOUNDS.get(name, (here - size, here + size))
            ends = given.array(
                f"bounds[{name!r}]", (bounds or {}).get(name, usual), dimensions=(1,), last=2
            )
            if not ends[0] < ends[1]:
                given.fail(f"bounds[{name!r}]: the second must be greater than the first.")
            elif not ends[0] <= here <= ends[1]:
                given.fail(
                    f"start: {name} = {here:g} is outside its bounds, {ends[0]:g} and {ends[1]:g}."
                )
            least.append(ends[0])
            most.append(ends[1])
    return np.array(least), np.array(most)


def _search(
    problem: _Residuals,
    names: tuple[str, ...],
    limits: tuple[Array, Array],
    left_out: tuple[str, ...],
    *,
    known_accuracy: bool,
) -> TyreFit:
    from scipy.optimize import least_squares  # noqa: PLC0415 (slow to import)

    sizes = problem.sizes(names)
    start = np.array([problem.start.coefficients[name] for name in names])
    inside = np.clip(start, limits[0] + 1e-9 * sizes, limits[1] - 1e-9 * sizes)

    def scaled(x: Array) -> Array:
        return problem.scaled(names, x)

    def derivatives(x: Array) -> Array:
        return problem.effects(names, x) / sizes

    found = least_squares(
        scaled,
        inside,
        jac=derivatives,
        bounds=limits,
        x_scale=sizes,
        xtol=1e-12,
        ftol=1e-12,
        gtol=1e-12,
    )
    values = np.asarray(found.x)
    effects = problem.effects(names, values)
    covariance = np.linalg.pinv(effects.T @ effects) * np.outer(sizes, sizes)
    freedom = max(len(found.fun) - len(names), 1)
    if not known_accuracy:
        covariance = covariance * float(found.fun @ found.fun) / freedom
    at_bounds = tuple(name for name, active in zip(names, found.active_mask, strict=True) if active)
    return TyreFit(
        problem.tyre(names, values),
        _table(names, start, values, covariance, limits),
        problem.residuals(names, values),
        at_bounds,
        left_out,
        bool(found.success),
        str(found.message),
        problem.evaluations,
    )


def _table(
    names: tuple[str, ...],
    start: Array,
    values: Array,
    covariance: Array,
    limits: tuple[Array, Array],
) -> "Dataset":
    from xarray import Dataset  # noqa: PLC0415 (slow to import)

    errors = np.sqrt(np.diag(covariance))
    both = np.outer(errors, errors)
    correlation = np.divide(covariance, both, out=np.zeros_like(covariance), where=both > 0.0)
    over = "coefficient"
    return Dataset(
        {
            "value": (over, values),
            "start": (over, start),
            "standard_error": (over, errors),
            "least": (over, limits[0]),
            "most": (over, limits[1]),
            "correlation": ((over, "other_coefficient"), correlation),
        },
        {over: list(names), "other_coefficient": list(names)},
        {"title": "coefficients of the Magic Formula, fitted"},
    )
