"""The bodies of a suspension: masses, centres of mass and inertia tensors."""

from collections.abc import Mapping
from typing import ClassVar

import numpy as np
from pydantic import Field

from ...core.columns import greatest, sorted_moments
from ...core.physical import ELEMENTS
from ...core.vectors import Vector, components
from .hardpoints import Hardpoints
from .section import NonNegative, Number, Positive, Section, Triple
from .units import point_in_metres

# Rounding of a principal moment of inertia, relative to the largest element.
_ROUNDING = 1e-9

_REMEDY = (
    "Check the diagonal, and the signs of xy, xz and yz (elements of the tensor: minus the "
    "products of inertia); all zero make a point mass."
)


class RigidBody(Section):
    """Mass, centre of mass and inertia of a body at the design position.

    The inertia is the tensor about the body's centre of mass in chassis axes. Its *elements* are
    given: ``xy`` is the entry of the matrix, ``-integral of x y dm``, which is minus the product of
    inertia that some programs print. All left out, or zero, make the body a point mass.
    """

    mass_kg: NonNegative = Field(description="mass of the body")
    com_mm: Triple | None = Field(
        default=None,
        description="centre of mass at design; by default from the hardpoints of the body",
    )
    inertia_xx_kg_m2: Number = Field(default=0.0, description="element xx of the inertia tensor")
    inertia_yy_kg_m2: Number = Field(default=0.0, description="element yy of the inertia tensor")
    inertia_zz_kg_m2: Number = Field(default=0.0, description="element zz of the inertia tensor")
    inertia_xy_kg_m2: Number = Field(default=0.0, description="element xy of the inertia tensor")
    inertia_xz_kg_m2: Number = Field(default=0.0, description="element xz of the inertia tensor")
    inertia_yz_kg_m2: Number = Field(default=0.0, description="element yz of the inertia tensor")

    POINTS: ClassVar[tuple[str, ...]]
    """The hardpoints whose centroid is the default centre of mass."""

    def elements(self) -> dict[str, float]:
        """Return the elements of the inertia tensor by name [kg m^2]."""
        return {name: getattr(self, f"inertia_{name}_kg_m2") for name in ELEMENTS}

    def centre_of_mass(self, points: Hardpoints) -> Vector:
        """Return the centre of mass at design, chassis axes [m]."""
        if self.com_mm is None:
            return self.default_centre_of_mass(points)
        return point_in_metres(self.com_mm, "mm")

    def default_centre_of_mass(self, points: Hardpoints) -> Vector:
        """Return the centre of mass of a body whose file leaves it out [m]."""
        total: Vector = np.sum([points.metres(name) for name in self.POINTS], axis=0)
        return total / len(self.POINTS)

    def problems(self) -> list[str]:
        elements = self.elements()
        scale = greatest(abs(value) for value in elements.values())
        if scale == 0.0:
            return []
        names = ", ".join(f"inertia_{name}_kg_m2 = {value}" for name, value in elements.items())
        if self.mass_kg == 0.0:
            problem = (
                f"mass_kg = 0.0 kg, but {names} kg m^2: a body without mass has no inertia. "
                "Enter its mass, or set the inertia to 0."
            )
            return [problem]
        reason = impossible_inertia(elements)
        if not reason:
            return []
        diagonal = [f"inertia_{name}_kg_m2" for name in ("xx", "yy", "zz")]
        missing = [key for key in diagonal if key not in self.model_fields_set]
        if missing:
            return [
                f"{key} is missing, and 0 kg m^2 is no body's with the others. Enter it, in kg m^2."
                for key in missing
            ]
        return [f"{names} kg m^2: {reason}. {_REMEDY}"]


class TieRod(RigidBody):
    """The tie rod."""

    POINTS: ClassVar[tuple[str, ...]] = ("tie_rod_outer", "tie_rod_inner")


class Rack(RigidBody):
    """The rack of the steering."""

    POINTS: ClassVar[tuple[str, ...]] = ("tie_rod_inner",)


class WheelBody(Section):
    """The wheel with tyre, hub and disc: symmetric about its spin axis, balanced at its centre.

    A drive shaft, which rotates with the wheel about this axis only, adds to the moment about it.
    """

    mass_kg: Positive = Field(description="mass of the wheel")
    inertia_spin_kg_m2: Positive = Field(description="moment of inertia about the spin axis")
    inertia_diametral_kg_m2: Positive = Field(
        description="moment of inertia about any diameter through the wheel's centre"
    )
    inertia_shaft_kg_m2: NonNegative = Field(
        default=0.0,
        description="spin inertia of a drive shaft, as a part of inertia_spin_kg_m2; it adds "
        "nothing to inertia_diametral_kg_m2",
    )

    def problems(self) -> list[str]:
        spin, shaft = self.inertia_spin_kg_m2, self.inertia_shaft_kg_m2
        if not shaft < spin:
            problem = (
                f"inertia_shaft_kg_m2 = {shaft} kg m^2 is part of inertia_spin_kg_m2 = {spin} "
                "kg m^2; allowed is less than that. Add the moment of the wheel to the second."
            )
            return [problem]
        most = 2.0 * self.inertia_diametral_kg_m2
        # the moment about the axis is a sum, with a relative rounding
        if spin - shaft > most + _ROUNDING * spin:
            of_shaft = f" without inertia_shaft_kg_m2 = {shaft} kg m^2" if shaft > 0.0 else ""
            problem = (
                f"inertia_spin_kg_m2 = {spin} kg m^2{of_shaft} is more than any wheel with "
                f"inertia_diametral_kg_m2 = {self.inertia_diametral_kg_m2} kg m^2 can have; "
                f"allowed is at most twice that, {most:.4g} kg m^2 (a flat disc). Lower the first "
                "or raise the second; inertia_shaft_kg_m2 is what a drive shaft adds to the first."
            )
            return [problem]
        return []


class Bodies(Section):
    """All bodies that may carry mass: those of a suspension are its `RigidBody` attributes."""

    # bodies that the equations of the suspension leave without mass
    MASSLESS: ClassVar[tuple[str, ...]] = ()

    wheel: WheelBody = Field(description="the wheel")

    def problems(self) -> list[str]:
        heavy = {name: getattr(self, name).mass_kg for name in self.MASSLESS}
        return [
            f"{name}.mass_kg = {mass} kg: the equations of this suspension leave this body without "
            "mass; allowed is 0 kg. Set it to 0, and add the part that moves with the knuckle to "
            "the knuckle."
            for name, mass in heavy.items()
            if mass > 0.0
        ]

    def rigid(self) -> dict[str, RigidBody]:
        """Return all bodies except the wheel, by name."""
        found = {name: getattr(self, name) for name in type(self).model_fields}
        return {name: body for name, body in found.items() if isinstance(body, RigidBody)}

    def parameters(self, points: Hardpoints) -> dict[str, float]:
        """Return masses [kg], centres of mass [m] and inertia [kg m^2], such as ``wheel_mass``."""
        values: dict[str, float] = {}
        for name, body in self.rigid().items():
            values[f"{name}_mass"] = body.mass_kg
            values |= components(f"{name}_com", body.centre_of_mass(points))
            for element, value in body.elements().items():
                values[f"{name}_inertia_{element}"] = value
        values["wheel_mass"] = self.wheel.mass_kg
        values["wheel_inertia_spin"] = self.wheel.inertia_spin_kg_m2
        values["wheel_inertia_diametral"] = self.wheel.inertia_diametral_kg_m2
        return values


def impossible_inertia(elements: Mapping[str, float]) -> str:
    """Return why a tensor with elements ``xx`` to ``yz`` [kg m^2] is not an inertia, or ""."""
    scale = greatest(abs(value) for value in elements.values())
    if scale == 0.0:
        return ""
    xx, yy, zz, xy, xz, yz = (elements[name] / scale for name in ELEMENTS)
    moments = sorted_moments([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    small, middle, large = moments
    listed = ", ".join(f"{scale * moment:.4g}" for moment in moments)
    if small < -_ROUNDING:
        return (
            f"the principal moments {listed} kg m^2 include a negative one; allowed is 0 or "
            "more (the tensor must be positive definite)"
        )
    if large > small + middle + _ROUNDING:
        return (
            f"the principal moments are {listed} kg m^2; allowed is at most the sum of the other "
            f"two, {scale * (small + middle):.4g} kg m^2, for the largest"
        )
    return ""
