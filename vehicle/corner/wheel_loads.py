"""Loads of road, drive shaft and brake on a wheel, as inputs of the equations of motion."""

from types import ModuleType

from ...core.errors import InputError
from ...systems.compile.build import compile_mechanism, require_generator

_VECTORS = {"contact_force": "N", "center_force": "N", "wheel_moment": "N m"}

UNITS = {
    **{f"{name}_{axis}": unit for name, unit in _VECTORS.items() for axis in "xyz"},
    "shaft_torque": "N m",
    "hub_torque": "N m",
}
"""The unit of each of these inputs, by name."""


def needed_radius(radius: float | None) -> float:
    """Return the radius of a wheel [m], or raise an `InputError` if it is not known."""
    if radius is None:
        problem = (
            "[tyre] radius_mm is missing, and does not follow from the height of the wheel centre: "
            "loads at the lowest point of the wheel need it. Enter it."
        )
        raise InputError([problem], "wheel_loads")
    return radius


def with_wheel_loads(equations: ModuleType) -> ModuleType:
    """Return the equations with these inputs, derived and compiled at first use."""
    require_generator()
    from ...generator.mechanisms import model_named  # noqa: PLC0415 (an extra)
    from ...generator.mechanisms.suspension import with_wheel_loads as loaded  # noqa: PLC0415

    return compile_mechanism(loaded(model_named(equations.NAME)))
