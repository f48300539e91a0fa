"""Simulations of a suspension over a grid of values of its file."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from ...core.errors import InputError, KintrafoError
from ...core.named_types import Array, ArrayLike
from ...core.validator import Validator
from ...ensembles import ensemble
from ...ensembles.variants import without_mass
from ..analysis.scenario import Scenario, started
from ..assembly.of import AnyModel, model_of
from ..corner.wheel_loads import UNITS
from .curves import changed, refuse_bushes
from .design_variables import DesignVariable, matching
from .evaluation import Subject, check_held_subject

_CAR = "car"
_MOST_CARS = 1_000_000


def sweep(
    suspension: Subject,
    values: Mapping[str, ArrayLike],
    scenario: Scenario | None = None,
    *,
    signals: list[str] | tuple[str, ...] = (),
    reductions: Mapping[str, Any] | None = None,
    rtol: float = 1e-6,
    atol: ArrayLike = 1e-9,
    max_steps: int = 1_000_000,
    progress: Callable[[float], None] | None = None,
) -> xr.Dataset:
    """Return simulations of a suspension with all combinations of values of the input file.

    Parameters
    ----------
    suspension : Suspension, Axle or RigidAxle
    values : mapping of str to array_like
        By section and key with a dot between them, the values, in the unit of the file (mm, deg,
        N/m, ...): ``{"strut.spring_rate_N_per_m": [20e3, 25e3]}``.
    scenario : Scenario, optional
        Road, rack and start; by default a second at rest. Without a height each suspension starts
        at its own rest. A rigid axle has the road under both wheels, or inputs by the names of its
        model, such as ``left_road_height``.
    signals, reductions
        Results, as in `kintrafo.ensemble`: signals at the output times, and numbers.
    rtol, atol, max_steps
        Tolerances and greatest number of steps of each motion.
    progress : callable, optional
        Called with the fraction of suspensions that are prepared, up to 1; preparation takes most
        of the time.

    Returns
    -------
    xarray.Dataset
        As from `kintrafo.ensemble`, over one dimension for each of `values`, in SI units.
        Suspensions that cannot be built, or have no equilibrium, have a ``reason``.

    Raises
    ------
    InputError
        If an argument cannot be used, or the values need different equations.

    Examples
    --------
    >>> from kintrafo import Suspension, roads, scenario, variation
    >>> bump = scenario.Scenario(inputs={"road_height": roads.step(0.02, at=0.1, end=1.0)})
    >>> rates = {"strut.damper_rate_N_s_per_m": [1000.0, 1500.0, 2000.0]}
    >>> car = Suspension.load("reference_car")
    >>> found = variation.sweep(car, rates, bump, reductions={"wheel_acceleration": "max"})
    >>> found["wheel_acceleration_max"].dims
    ('strut.damper_rate_N_s_per_m',)
    """
    with Validator("sweep") as given:
        check_held_subject(given, suspension)
        scenario = Scenario() if scenario is None else scenario
        given.instance("scenario", scenario, Scenario, "a Scenario is needed")
        given.function("progress", progress)
        grid = given.mapping("values", values, "places and numbers")
        if not given.failed:
            axes = _axes(given, suspension, grid)
    cars = _SweptCars(suspension, axes, scenario)
    for car in range(cars.count):
        cars.prepare(car)
        if progress is not None:
            progress((car + 1) / cars.count)
    found = ensemble(
        cars.model, cars.variants(), (0.0, scenario.duration), cars.starts(), inputs=cars.inputs,
        signals=signals, reductions=reductions, t_eval=scenario.times(), rtol=rtol, atol=atol,
        max_steps=max_steps,
    )  # fmt: skip
    return cars.over_the_grid(found)


def _axes(
    given: Validator, suspension: Subject, grid: Mapping[Any, Any]
) -> dict[DesignVariable, Array]:
    """Return the checked values of each place in SI units."""
    axes: dict[DesignVariable, Array] = {}
    for name, along in grid.items():
        places = matching(given, suspension, [name] if isinstance(name, str) else name)
        refuse_bushes(given, places.values(), ())
        if len(places) > 1:
            given.fail(f"{name} names {len(places)} numbers: name one of them.")
            continue
        for place in places.values():
            numbers = given.array(f"values of {name}", along, place.unit, dimensions=[0, 1])
            if np.unique(numbers).size != numbers.size:
                given.fail(f"values of {name}: each is needed once.")
            if place in axes:
                given.fail(f"{name} is {place.name}, which is named twice.")
            axes[place] = np.atleast_1d(numbers) * place.to_si
    if not grid:
        given.fail("values: one place or more is needed.")
    count = np.prod([along.size for along in axes.values()], dtype=float)
    if count > _MOST_CARS:
        given.fail(f"values: they make {count:g} combinations, and {_MOST_CARS:g} are allowed.")
    return axes


class _SweptCars:
    """Suspensions over a grid, prepared one after the other."""

    def __init__(
        self, suspension: Subject, axes: Mapping[DesignVariable, Array], scenario: Scenario
    ) -> None:
        self._suspension, self._scenario, self._axes = suspension, scenario, dict(axes)
        on_wheel = any(name.endswith(tuple(UNITS)) for name in scenario.inputs)
        self.model = model_of(suspension, wheel_loads=on_wheel)
        self.inputs: Mapping[str, Any] = scenario.inputs
        self._shape = tuple(along.size for along in axes.values())
        self.count = int(np.prod(self._shape))
        self._parameters: dict[int, dict[str, float]] = {}
        self._starts: dict[int, Array] = {}
        self._reasons = np.full(self.count, "", dtype=object)

    def prepare(self, car: int) -> None:
        """Store the parameters and the start of one suspension, or a reason."""
        changes: dict[str, float] = {}
        places = np.unravel_index(car, self._shape)
        for (place, along), at in zip(self._axes.items(), places, strict=True):
            changes |= place.moved(float(along[at]) - place.value * place.to_si)
        try:
            model = model_of(changed(self._suspension, changes), wheel_loads=self.model.wheel_loads)
            self._check_equations(model)
            start, self.inputs = started(model, self._scenario)
            self._starts[car] = np.array(start)
            self._parameters[car] = dict(model.parameters)
        except _OtherEquationsError as error:
            raise InputError([str(error)], "sweep") from None
        except KintrafoError as error:
            self._reasons[car] = str(error)

    def _check_equations(self, model: AnyModel) -> None:
        if model.equations is not self.model.equations:
            raise _OtherEquationsError(
                f"values: some need the equations {model.equations.NAME}, and the file has "
                f"{self.model.equations.NAME}. Give small nonzero values in the file to keys that "
                "are zero or left out."
            )
        if model.allowed_lengths() != self.model.allowed_lengths():
            raise _OtherEquationsError(
                "values: length_min_mm and length_max_mm end motions and move nothing. Sweep "
                "another value, and simulate the cars with other lengths one by one."
            )

    def variants(self) -> dict[str, Array]:
        """Return the parameters in which the suspensions differ."""
        model = self.model
        given = {n: v for n, v in model.parameters.items() if not without_mass(model, n)}
        rows = {n: np.array([own[n] for own in self._parameters.values()]) for n in given}
        return {n: row for n, row in rows.items() if (row != given[n]).any()}

    def starts(self) -> Array:
        """Return the states at the start, a row for each possible suspension."""
        if not self._starts:
            problems = [str(reason) for reason in dict.fromkeys(self._reasons)]
            raise InputError(["none of the suspensions can be simulated", *problems[:3]], "sweep")
        return np.array([*self._starts.values()])

    def over_the_grid(self, found: xr.Dataset) -> xr.Dataset:
        """Return the results of the possible suspensions over the grid."""
        found = found.drop_vars([*self.variants()])
        nothing: dict[Any, Any] = {
            "success": False, "valid": False, "reason": "", "solver": "", "steps": 0
        }  # fmt: skip
        filled = found.assign_coords({_CAR: [*self._starts]}).reindex(
            {_CAR: np.arange(self.count)}, fill_value=nothing | dict.fromkeys(
                set(found.data_vars) - set(nothing), np.nan
            )
        )  # fmt: skip
        reason = filled["reason"].values
        filled["reason"].values = np.where(self._reasons == "", reason, self._reasons)
        names = [place.name for place in self._axes]
        coordinates = {
            place.name: xr.Variable(place.name, along, place.attributes())
            for place, along in self._axes.items()
        }
        data = {name: self._shaped(variable.variable, names) for name, variable in filled.items()}
        rest = {name: c.variable for name, c in filled.coords.items() if name != _CAR}
        done = int(filled["success"].sum())
        text = f"{done} of {self.count} reached the end of the time"
        text += "." if done == self.count else ", `reason` has the cause for the others."
        facts = {"title": "motion over a grid of values", "message": text}
        return xr.Dataset(data, {**rest, **coordinates}, facts)

    def _shaped(self, variable: xr.Variable, names: Sequence[str]) -> xr.Variable:
        moved = variable.transpose(_CAR, ...)
        values = moved.values.reshape(*self._shape, *moved.shape[1:])
        return xr.Variable((*names, *moved.dims[1:]), values, variable.attrs)


class _OtherEquationsError(Exception):
    """A suspension needs other equations than the first."""
