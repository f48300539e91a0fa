"""Characteristics with tolerances of the input file: bands, yield and shares of the variance."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ...core.named_types import Array, ArrayLike
from ...core.quantities import variable
from ...core.validator import Validator
from ..analysis.compliance.flexibility import WheelSupport
from ..assembly.of import assembly_of
from .batch import curves_of_many, moved_by
from .curves import Curves, curves_of, refuse_bushes
from .design_variables import DesignVariable, amounts
from .evaluation import Subject, check_subject
from .goals import check_data, limits_of, of_columns
from .sensitivity import PLACE, ROUNDING, derivatives
from .sweep_axes import sweep_axes_of

Distribution = Literal["normal", "uniform"]

QUANTILE, CAR = "quantile", "car"
"""Dimensions of the bands, and of the cars."""

SIGMAS = 3.0
"""Standard deviations in a tolerance of the normal distribution, with 99.7 % of the values."""

QUANTILES = (0.0, 0.05, 0.5, 0.95, 1.0)

_MOST_CARS = 1_000_000
# They take 0.8 GB.
_MOST_NUMBERS = 100_000_000


def tolerance(
    suspension: Subject,
    tolerances: Mapping[str, float],
    *,
    distribution: Distribution = "normal",
    correlation: ArrayLike | None = None,
    limits: Mapping[str, Any] | None = None,
    count: int = 500,
    seed: int = 1,
    over: str | None = None,
    positions: ArrayLike | None = None,
    names: Sequence[str] | None = None,
    held: WheelSupport | None = None,
    progress: Callable[[float], None] | None = None,
) -> xr.Dataset:
    """Return the characteristics of many cars with random values within tolerances.

    Parameters
    ----------
    suspension : Suspension, Axle, RigidAxle or Car
    tolerances : mapping of str to float
        Tolerance of values to either side, in display units (mm, deg, N/m, ...), by their places as
        in `sensitivity`. Of several entries that name a value the last one applies.
    distribution : {'normal', 'uniform'}, optional
        Distribution of each value: normal with a third of the tolerance as standard deviation, so
        that three in a thousand deviate by more, or uniform within the tolerance.
    correlation : array_like, shape (values, values), optional
        Correlation matrix of the values, in the order of the file, for the normal distribution; by
        default they are independent.
    limits : mapping, optional
        By characteristic: ``at_mm``, ``least`` and ``most``, in mm and the display unit, as in a
        file of limits.
    count : int, optional
        Number of cars.
    seed : int, optional
        Seed of the generator of random numbers: the same cars for the same seed.
    over, positions, names, held, progress
        Motion, positions along it, characteristics, support of the wheels for compliance, and a
        function of the completed fraction; see `sensitivity`.

    Returns
    -------
    xarray.Dataset
        Each characteristic over ``quantile`` and the positions: 0 and 1 are the least and the
        greatest value of all cars. ``..._nominal`` is that of the nominal suspension. ``..._share``
        over ``place`` and the positions is the part of its variance by each value to first order,
        NaN if it does not vary or has no derivative, as at a kink; ``..._first_order`` is the
        first-order standard deviation as a part of that of the cars: if it is far from 1, as where
        stops act in some cars only, shares have little meaning. Over ``car``: ``within_limits``,
        ``reason`` for a car that cannot be built or does not reach a position, and its values in
        ``value_of``. The attribute ``yield`` is the part of cars within all limits.

    Raises
    ------
    InputError
        If an argument cannot be used.

    Examples
    --------
    >>> from kintrafo import Suspension, variation
    >>> car = Suspension.load("reference_car")
    >>> limits = {"toe": {"at_mm": [-50.0, 50.0], "least": -0.3, "most": 0.3}}
    >>> found = variation.tolerance(
    ...     car, {"hardpoints": 1.0}, count=50, positions=[-0.05, 0.0, 0.05], limits=limits
    ... )
    >>> 0.0 < found.attrs["yield"] < 1.0
    True
    """
    with Validator("tolerance") as given:
        check_subject(given, suspension)
        given.function("progress", progress)
        count = given.whole("count (--cars)", count, least=2, most=_MOST_CARS)
        seed = given.whole("seed", seed, least=0)
        given.among("distribution", distribution, ("normal", "uniform"))
        described = given.mapping("limits", {} if limits is None else limits, "names and limits")
        bounds = limits_of(given, described, sweep_axes_of(suspension))
        if not given.failed:
            curves = curves_of(given, suspension, over, positions, names, held)
            check_data(given, suspension, bounds)
            bounds = of_columns(suspension, bounds)
            by_pattern = given.mapping("tolerances", tolerances, "places and numbers")
            spread = amounts(given, suspension, by_pattern, "tolerances")
            refuse_bushes(given, spread, [curves.over, *(limit.over for limit in bounds)])
            if not spread:
                given.fail("tolerances: one or more are needed.")
            root = _root_of(given, correlation, len(spread), distribution)
            numbers = count * len(curves.names) * curves.positions.size
            if numbers > _MOST_NUMBERS:
                given.fail(
                    f"count = {count}: {len(curves.names)} characteristics at "
                    f"{curves.positions.size} positions make {numbers:.3g} numbers, and at most "
                    f"{_MOST_NUMBERS:.3g} are allowed. Choose fewer characteristics or positions."
                )
    off = _drawn(distribution, root, count, seed) * np.array([*spread.values()])
    places, nominal = [*spread], curves.of(assembly_of(suspension))
    parts = _parts(suspension, spread, root, distribution, curves)
    looks = [curves, *(limit.curves for limit in bounds)]
    (values, *limited), reasons = curves_of_many(
        suspension, moved_by(places, off), looks, progress=progress
    )
    seen = within = np.array(reasons == "")
    for limit, found in zip(bounds, limited, strict=True):
        within = within & limit.kept(found[:, 0]).all(axis=1)
    cars = _Sample(places, off, curves, nominal, values, seen, reasons.astype(str), within)
    return _dataset(cars, parts)


def _root_of(given: Validator, correlation: Any, size: int, distribution: str) -> Array:
    """Return a matrix whose product with independent numbers has a correlation."""
    if correlation is None:
        return np.eye(size)
    matrix = given.array("correlation", correlation, dimensions=[2])
    if distribution != "normal":
        given.fail("correlation: values vary together by a normal distribution only.")
    if matrix.shape != (size, size):
        given.fail(f"correlation has the shape {matrix.shape}: ({size}, {size}) is needed.")
    elif not (np.array_equal(matrix, matrix.T) and (np.diag(matrix) == 1.0).all()):
        given.fail("correlation: it must be symmetric, with ones on its diagonal.")
    elif np.linalg.eigvalsh(matrix)[0] < -1e-12 * size:
        given.fail("correlation: this is not a correlation matrix (an eigenvalue is negative).")
    if given.failed:
        return np.eye(size)
    sizes, vectors = np.linalg.eigh(matrix)
    return vectors * np.sqrt(np.maximum(sizes, 0.0))


def _drawn(distribution: str, root: Array, count: int, seed: int) -> Array:
    """Return random deviations of the values of each car, in parts of their tolerances."""
    random = np.random.default_rng(seed)
    if distribution == "uniform":
        return random.uniform(-1.0, 1.0, (count, len(root)))
    return random.standard_normal((count, len(root))) @ root.T / SIGMAS


@dataclass(frozen=True)
class _Sample:
    """The cars of a study with their curves."""

    places: Sequence[DesignVariable]
    off: Array  # deviations of values, (cars, places), SI units
    curves: Curves
    nominal: Array  # curves of the nominal car, (names, positions)
    values: Array  # of all cars, (cars, names, positions)
    seen: NDArray[np.bool_]  # whether a car has curves, (cars,)
    reasons: Array  # why not, (cars,)
    within: NDArray[np.bool_]  # whether it is within all limits, (cars,)


def _parts(
    suspension: Subject,
    spread: Mapping[DesignVariable, float],
    root: Array,
    distribution: str,
    curves: Curves,
) -> Array:
    """Return the first-order part of the variance by each value, (places, names, positions).

    Parts of correlated values may be negative.
    """
    sigma = np.array([*spread.values()]) / (np.sqrt(3.0) if distribution == "uniform" else SIGMAS)
    moved = sigma[:, None, None] * derivatives(suspension, [*spread], curves)[0]
    return moved * np.einsum("ij,jnp->inp", root @ root.T, moved)


def _dataset(cars: _Sample, parts: Array) -> xr.Dataset:
    curves = cars.curves
    along = curves.along
    seen = cars.seen
    nothing = np.full(cars.nominal.shape, np.nan)
    with np.errstate(invalid="ignore", divide="ignore"):  # a turning circle may be infinite
        bands = np.quantile(cars.values[seen], QUANTILES, axis=0) if seen.any() else [nothing] * 5
        variance = parts.sum(axis=0)
        shares = np.where(variance > 0.0, parts / variance, np.nan)
        deviation = cars.values[seen].std(axis=0) if seen.any() else nothing
        varies = deviation > ROUNDING * np.maximum(np.abs(cars.nominal), 1.0)
        first_order = np.where(varies, np.sqrt(variance) / deviation, np.nan)
    data: dict[Any, Any] = {}
    for i, name in enumerate(curves.names):
        quantity = curves.quantity(name)
        attributes = quantity.attributes()
        data[name] = xr.Variable((QUANTILE, along.name), [band[i] for band in bands], attributes)
        data[f"{name}_nominal"] = xr.Variable(along.name, cars.nominal[i], attributes)
        meaning = f"part of the variance of {quantity.long_name}"
        data[f"{name}_share"] = variable((PLACE, along.name), shares[:, i], meaning, "1")
        meaning = f"standard deviation of {quantity.long_name} to first order over that of the cars"
        data[f"{name}_first_order"] = variable(along.name, first_order[i], meaning, "1")
    data["within_limits"] = variable(CAR, cars.within, "whether the car is within all limits", "1")
    data["reason"] = variable(CAR, cars.reasons, "why a car has no curves", "1")
    values = np.array([p.value * p.to_si for p in cars.places]) + cars.off
    data["value_of"] = variable((CAR, PLACE), values, "value that the car has, in place_unit", "SI")
    coordinates = {
        QUANTILE: variable(QUANTILE, np.array(QUANTILES), "fraction of the cars below it", "1"),
        PLACE: [place.name for place in cars.places],
        "place_unit": (PLACE, [place.si_unit for place in cars.places]),
        along.name: xr.Variable(along.name, curves.positions, along.attributes()),
    }
    attributes = {
        "title": f"tolerances over {along.long_name}",
        "over": curves.over,
        "yield": float(cars.within.mean()),
        "message": f"{int(seen.sum())} of {seen.size} cars have curves",
    }
    return xr.Dataset(data, coordinates, attributes)
