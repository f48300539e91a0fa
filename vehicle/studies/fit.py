"""Errors of the input file that explain curves measured on a rig."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from ...core.errors import InputError
from ...core.named_types import Array
from ...core.quantities import display_of
from ...core.validator import Validator
from ..analysis.compliance.flexibility import HELD, WheelSupport
from ..assembly.by_wheel import columns_of
from ..assembly.quantity import TRAVEL
from .curves import names_among
from .design_variables import DesignVariable, amounts
from .evaluation import Subject, check_subject
from .goals import GREATEST, LEAST, TargetValue, check_data
from .search import Search, in_words, least
from .sweep_axes import compliances_over, given_axis, known_over, sweep_axes_of, sweep_axis
from .tolerance import SIGMAS

# Default accuracy of a curve, as a part of its range.
_USUAL_ACCURACY = 0.02
# Number of independent points of a curve: errors of neighbours on a rig are alike.
_INDEPENDENT = 10
# Values whose variance is reduced by less than this part are not determined by the measurement.
_LEAST_DETERMINED = 0.1
# Probability that errors of measurement alone exceed the residual of an explained curve.
_CHANCE = 0.01
# Greatest deviation of a constant position [m].
_HELD = 1e-4


@dataclass(frozen=True)
class Fitted:
    """A measured characteristic, and its deviations before and after the fit.

    Attributes
    ----------
    name : str
        Name of the characteristic.
    points : int
        Number of measured positions.
    within : float
        Standard deviation of its errors of measurement, SI units.
    before, after : float
        Root mean square of the deviations, SI units.
    """

    name: str
    points: int
    within: float
    before: float
    after: float

    @property
    def is_explained(self) -> bool:
        """Whether the residual is within that of errors of measurement in 99 of 100 cases.

        Sums of squares of independent errors have the chi-squared distribution.
        """
        from scipy.stats import chi2  # noqa: PLC0415 (slow to import)

        count = min(self.points, _INDEPENDENT)
        most = self.within * np.sqrt(chi2.ppf(1.0 - _CHANCE, count) / count)
        return bool(self.after <= most)


@dataclass(frozen=True)
class Fit:
    """The result of a fit: values that explain measured curves.

    Attributes
    ----------
    suspension : Suspension, Axle, RigidAxle or Car
        The subject with the most probable values.
    start : Suspension, Axle, RigidAxle or Car
        The given subject.
    places : tuple of DesignVariable
        The uncertain values.
    moved : dict of str to float
        The change of each value by its name, in the display unit.
    uncertainty : dict of str to float
        The standard deviation of each value after the measurement, in the same unit.
    determined : dict of str to float
        The fraction by which the measurement reduces the variance of each value, 0 to 1: near 0 the
        curves do not determine the value, and it does not change.
    curves : tuple of Fitted
        Each measured characteristic before and after the fit.
    success : bool
        Whether the solver converged and every curve is explained: the remaining deviations are
        within those by errors of its accuracy in 99 of 100 cases.
    message : str
        Remarks.
    evaluations : int
        Number of evaluated suspensions.
    """

    suspension: Subject
    start: Subject
    places: tuple[DesignVariable, ...]
    moved: dict[str, float]
    uncertainty: dict[str, float]
    determined: dict[str, float]
    curves: tuple[Fitted, ...]
    success: bool
    message: str
    evaluations: int


def fit(
    suspension: Subject,
    measured: xr.Dataset,
    tolerances: Mapping[str, float | str],
    *,
    accuracy: Mapping[str, float] | None = None,
    names: Sequence[str] | None = None,
    held: WheelSupport = "height",
    over: str | None = None,
    progress: Callable[[float], None] | None = None,
) -> Fit:
    """Return the most probable errors of values of the input file that explain measured curves.

    Parameters
    ----------
    suspension : Suspension, Axle, RigidAxle or Car
    measured : xarray.Dataset
        Result of `kintrafo.rig.measured_curves`, with straight steering, or the wheel at design.
        Curves over wheel travel may be compliance by the names of `kintrafo.compliance.linear`, if
        the file has bushes.
    tolerances : mapping of str to float or str
        Tolerance of values to either side, as in `tolerance`: normally distributed with a third of
        it as standard deviation, and a limit of the change. A text such as ``"30 %"`` is a part of
        the value, as of the stiffness of a bush.
    accuracy : mapping of str to float, optional
        Standard deviation of the errors of measurement, by characteristic, in the display unit; by
        default 2 % of the range of the curve.
    names : sequence of str, optional
        The curves to explain; by default all.
    held : {'height', 'tyre', 'spring', 'locked'}, optional
        Support of the wheels in the measurement of compliance, see `kintrafo.compliance.linear`.
    over : str, optional
        Quantity along the curves of a car, with options after a colon:
        ``lateral_acceleration:radius_m=60``. Steady turns are at 100 km/h by default.
    progress : callable, optional
        Called after every step of the solver with the remaining cost, as a fraction of that at the
        start.

    Returns
    -------
    Fit

    Raises
    ------
    InputError
        If an argument cannot be used, or no uncertain value has an effect on a curve.
    PositionError
        If the given suspension does not reach a position.

    Notes
    -----
    The most probable values, by SciPy's ``least_squares``, minimise the sum of squared deviations
    of the curves, each divided by its accuracy, and of the values, each divided by its standard
    deviation. Uncertainties are of first order. Curves of more than 10 points have the weight of
    10, since errors of neighbours on a rig are alike.

    Examples
    --------
    >>> import numpy as np
    >>> from kintrafo import Suspension, characteristics, variation
    >>> car = Suspension.load("reference_car")
    >>> built = car.with_changes({"hardpoints.tie_rod_inner": [-140.0, -310.0, 282.0]})
    >>> rig = characteristics.over(built, "travel", np.linspace(-0.06, 0.06, 7))[["toe"]]
    >>> uncertain = {"hardpoints.tie_rod_inner.z": 5.0, "hardpoints.ball_joint.x": 5.0}
    >>> found = variation.fit(car, rig, uncertain)
    >>> [round(by, 2) for by in found.moved.values()]
    [-0.1, 1.98]
    """
    with Validator("fit") as given:
        check_subject(given, suspension)
        given.function("progress", progress)
        given.dataset(measured)
        accuracies = given.mapping(
            "accuracy", {} if accuracy is None else accuracy, "names and numbers"
        )
        if not given.failed:
            given.among("held", held, HELD)
            how = (accuracies, held, over)
            targets, foreign = _targets(given, suspension, measured, names, how)
        if not given.failed:
            check_data(given, suspension, targets)
            by_pattern = given.mapping("tolerances", tolerances, "places and numbers")
            reach = amounts(given, suspension, by_pattern, "tolerances")
            if not reach:
                given.fail("tolerances: one or more are needed.")
    search = Search(suspension, reach, targets, (), progress, SIGMAS)
    idle = search.idle(np.zeros(len(reach)))
    if len(idle) == len(reach):
        problem = f"tolerances: no value has an effect on a curve: {', '.join(idle)}."
        raise InputError([problem], "fit")
    return _fit(search, *least(search), foreign)


def _targets(
    given: Validator,
    suspension: Subject,
    measured: xr.Dataset,
    names: Any,
    how: tuple[Mapping[str, Any], WheelSupport, Any],
) -> tuple[list[TargetValue], list[str]]:
    """Return the measured curves as targets, without empty cells, and names of others."""
    accuracies, held_by, asked = how
    # parallel travel is the first of the axes over wheel travel
    axes = sweep_axes_of(suspension)
    by_position = {sweep_axis(axis).along.name: axis for axis in reversed(axes)}
    over = [name for name in by_position if name in measured.dims]
    if len(over) != 1:
        given.fail(
            "measured: a result of kintrafo.rig.measured_curves is needed, over "
            f"{' or '.join(reversed(by_position))}."
        )
        return [], []
    (along,) = over
    axis = by_position[along]
    if asked is not None:
        axis = given_axis(given, "over", asked, [axis])
    for name in (other for other in by_position if other != along and other in measured.coords):
        held = measured[name].values
        if not (held.size == 1 and abs(float(held.item())) <= _HELD):
            where = f"held at {1e3 * held.item():g} mm" if held.size == 1 else "not held"
            given.fail(f"measured: {name} is {where}; curves with it at zero are needed.")
    if not np.isfinite(measured[along].values.astype(float)).all():
        given.fail(f"measured: {along} has no number at some points.")
    there = [
        name
        for name in map(str, measured)
        if measured[name].dims == (along,) and np.issubdtype(measured[name].dtype, np.floating)
    ]
    under_loads = compliances_over(axis) if along == TRAVEL.name else {}
    over_axis = known_over(axis, axes[0])
    known = [name for name in there if name in over_axis or name in under_loads]
    foreign = [name for name in there if name not in known] if names is None else []
    chosen = known if names is None else names_among(given, names, known, axis)
    accuracies = {
        column: number
        for name, number in accuracies.items()
        for column in columns_of([name], known)
    }
    if not chosen and not given.failed:
        words = f"; not computed over {axis}: {', '.join(foreign)}" if foreign else ""
        given.fail(f"measured: one curve or more is needed{words}.")
    for name in accuracies:
        given.among("[accuracy]", name, known)
    targets = [
        target
        for name in chosen
        for over in [held_by if name in under_loads else axis]
        if (target := _target(given, measured[name], over, accuracies.get(name))) is not None
    ]
    return targets, foreign


def _target(given: Validator, curve: xr.DataArray, over: str, accuracy: Any) -> TargetValue | None:
    name = str(curve.name)
    fine = np.isfinite(curve.values)
    values, at = curve.values[fine], curve[str(curve.dims[0])].values[fine]
    if not values.size:
        given.fail(f"measured: {name} has no value.")
        return None
    shown = display_of(sweep_axis(over).known[name].attributes())
    if accuracy is not None:
        number = given.number(
            f"[accuracy] {name}", accuracy, shown.units, least=LEAST, below=GREATEST
        )
        within = number / shown.factor
    else:
        within = _USUAL_ACCURACY * float(np.ptp(values))
        if within == 0.0:
            given.fail(
                f"measured: {name} does not vary, and its accuracy does not follow from its "
                f"range. Give the accuracy, in {shown.units or 'its unit'}."
            )
            return None
    return TargetValue(name, over, at, values, within * _repeated(values.size))


def _repeated(points: int) -> float:
    """Return the factor of the accuracy of a point that gives a curve the weight of 10 points."""
    return float(np.sqrt(max(1.0, points / _INDEPENDENT)))


def _fit(search: Search, x: Array, gave_up: str, foreign: list[str]) -> Fit:
    """Return the result with its uncertainty and message."""
    slopes = search.slopes(x)
    variances = np.diag(np.linalg.inv(slopes.T @ slopes))
    # the standard deviation before the measurement is a third of the range
    determined = 1.0 - variances * SIGMAS**2
    curves = _curves(search, x)
    names = [place.name for place in search.places]
    facts = {
        "the solver gave up": [gave_up] if gave_up else [],
        "not explained": [curve.name for curve in curves if not curve.is_explained],
        "at the end of its tolerance": search.at_the_end(x),
        "the curves do not determine": [
            name for name, part in zip(names, determined, strict=True) if part < _LEAST_DETERMINED
        ],
        "not computed, and not fitted": foreign,
    }
    return Fit(
        suspension=search.at(x),
        start=search.suspension,
        places=search.places,
        moved=search.moved(x),
        uncertainty=search.moved(np.sqrt(variances)),
        determined=dict(zip(names, np.clip(determined, 0.0, 1.0).tolist(), strict=True)),
        curves=curves,
        success=not (gave_up or facts["not explained"]),
        message=in_words(facts) or "explained",
        evaluations=search.evaluations,
    )


def _curves(search: Search, x: Array) -> tuple[Fitted, ...]:
    return tuple(
        Fitted(target.name, target.at.size, target.within / _repeated(target.at.size), *deviations)
        for target, *deviations in zip(
            search.targets, _deviations(search, np.zeros_like(x)), _deviations(search, x),
            strict=True,
        )
    )  # fmt: skip


def _deviations(search: Search, x: Array) -> Iterable[float]:
    """Return the root mean square of the deviations of each curve."""
    found = search.values(x)
    if found is None:
        found = [np.full(target.at.size, np.nan) for target in search.targets]
    return [
        float(np.sqrt(np.mean((values - target.value) ** 2)))
        for target, values in zip(search.targets, found, strict=True)
    ]
