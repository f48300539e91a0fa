"""The masses and inertia tensors of parts, from the parameters of their equations."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ...core.named_types import Array
from ...core.physical import ELEMENTS


@dataclass(frozen=True)
class PartMass:
    """Mass and inertia of a part."""

    body: str  # name of the part in the equations
    mass: float  # [kg]
    tensor: Array  # inertia about its centre of mass at design, chassis axes, (3, 3) [kg m^2]

    @classmethod
    def of(
        cls, parameters: Mapping[str, float], name: str, body: str, spin_axis: Array | None = None
    ) -> "PartMass":
        """Return mass and inertia of a body.

        `name` is the prefix of its parameters in the equations. `spin_axis`, (3,), is that of a
        wheel at design: its parameters are the inertia about this axis and across it.
        """
        tensor = (
            _tensor(parameters, name)
            if spin_axis is None
            else _of_wheel(parameters, name, spin_axis)
        )
        return cls(body, parameters[f"{name}_mass"], tensor)


def _tensor(parameters: Mapping[str, float], name: str) -> Array:
    xx, yy, zz, xy, xz, yz = (parameters[f"{name}_inertia_{element}"] for element in ELEMENTS)
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def _of_wheel(parameters: Mapping[str, float], name: str, axis: Array) -> Array:
    spin, across = (parameters[f"{name}_inertia_{part}"] for part in ("spin", "diametral"))
    return across * np.eye(3) + (spin - across) * np.outer(axis, axis)
