"""Kinematics of both axles of a car, for the formulas of their measures."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...core.named_types import Array
from ..models.sides import SIDES
from .measures.measure import Measure
from .quantity import Quantity


@dataclass(frozen=True)
class CarKinematics:
    """Positions and first derivatives of the wheels of a car."""

    axles: Mapping[str, Any]  # by end, the front one first
    count: int  # number of positions

    @property
    def vehicles(self) -> tuple[Any, ...]:
        """The data of the vehicle, by wheel."""
        return tuple(vehicle for axle in self.axles.values() for vehicle in axle.vehicles)

    def of_wheel(self, measures: Mapping[str, Measure], wheel: str) -> Array:
        """Return the measure of a wheel, from those by end; NaN if its axle does not have it."""
        end, _, side = wheel.partition("_")
        return self._of(measures, end, side)

    def of_axles(self, measures: Mapping[str, Measure]) -> Array:
        """Return the measure of the axles, from those by end, (axles, n)."""
        return np.stack([self._of(measures, end, SIDES[0]) for end in self.axles])

    def _of(self, measures: Mapping[str, Measure], end: str, side: str) -> Array:
        axle, measure = self.axles[end], measures.get(end)
        if measure is None or not measure.defined_for(axle):
            return np.full(self.count, np.nan)
        return np.broadcast_to(measure.at(axle, side), (self.count,))

    def has(self, measures: Mapping[str, Measure]) -> bool:
        """Return whether an axle has a measure."""
        return any(one.defined_for(self.axles[end]) for end, one in measures.items())


def measures_of_axles(by_end: Mapping[str, tuple[Measure, ...]]) -> tuple[Measure, ...]:
    """Return the measures of a car from those of its axles, each of which may lack some."""
    quantities: dict[str, tuple[Quantity, Any]] = {}
    for measures in by_end.values():
        for one in measures:
            quantities.setdefault(one.name, (one.quantity, one.scope))
    return tuple(
        _together(
            quantity,
            scope,
            {
                end: one
                for end, measures in by_end.items()
                for one in measures
                if one.name == name and one.scope == scope
            },
        )
        for name, (quantity, scope) in quantities.items()
    )


def _together(quantity: Quantity, scope: Any, by_end: Mapping[str, Measure]) -> Measure:
    def of_wheel(of: CarKinematics, wheel: str) -> Array:
        return of.of_wheel(by_end, wheel)

    def of_axles(of: CarKinematics) -> Array:
        return of.of_axles(by_end)

    formula = of_wheel if scope == "wheel" else of_axles
    return Measure(quantity, formula, scope, (), lambda of: of.has(by_end))
