"""Parameters that declarations need again and again: of points, directions and bodies."""

from __future__ import annotations

from ..program.vectors import ELEMENTS
from .assembly import Parameter
from .declared import Name, Number, checked

Three = tuple[Number, Number, Number]


@checked
def point(name: Name, position: Three, meaning: str) -> list[Parameter]:
    """Coordinates of a point at the design position, axes of the world."""
    return [
        Parameter(f"{name}_{axis}", value, "m", f"{meaning}, {axis} at the design position")
        for axis, value in zip("xyz", position, strict=True)
    ]


@checked
def direction(name: Name, components: Three, meaning: str) -> list[Parameter]:
    """Components of a direction, of any length, axes of the world."""
    return [
        Parameter(f"{name}_{axis}", value, "1", f"{meaning}, {axis} component")
        for axis, value in zip("xyz", components, strict=True)
    ]


@checked
def rigid_body(
    name: Name,
    mass: Number,
    com: Three,
    inertia: Three = (0.0, 0.0, 0.0),
) -> list[Parameter]:
    """Mass, centre of mass, inertia tensor about it (axes of the world, at the design position)."""
    tensor = (*inertia, 0.0, 0.0, 0.0)
    return [
        Parameter(f"{name}_mass", mass, "kg", f"mass of the {name}"),
        *point(f"{name}_com", com, f"centre of mass of the {name}"),
        *(
            Parameter(
                f"{name}_inertia_{element}",
                value,
                "kg m^2",
                f"{element} element of the inertia tensor of the {name}",
            )
            for element, value in zip(ELEMENTS, tensor, strict=True)
        ),
    ]


@checked
def rotor(name: Name, mass: Number, spin: Number, diametral: Number) -> list[Parameter]:
    """Mass of a body of revolution, and its inertia about its axis and across it."""
    return [
        Parameter(f"{name}_mass", mass, "kg", f"mass of the {name}"),
        Parameter(
            f"{name}_inertia_spin", spin, "kg m^2", f"inertia of the {name} about its spin axis"
        ),
        Parameter(
            f"{name}_inertia_diametral",
            diametral,
            "kg m^2",
            f"inertia of the {name} across its axis",
        ),
    ]
