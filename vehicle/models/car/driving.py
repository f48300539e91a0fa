"""The sections of a driving car: rolling tyres, steering column, brakes, air."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import Field, ValidationError, WithJsonSchema

from ....core.errors import InputError
from ....core.validator import shown
from ....core.vectors import Vector, components
from ...input.messages import messages_of
from ...input.section import (
    CHECK_UNIT,
    Flag,
    NonNegative,
    Number,
    Positive,
    Remedy,
    Section,
    Triple,
)
from ...input.units import in_metres
from ...input.vehicle import Share, TyreSection
from ...tyres import LinearSlip, Tyre, load
from ...tyres.loading import packaged_tyres

_TYRE = Annotated[
    Any,
    Field(
        description="property file (.tir) or TMeasy file (.json) beside this one, or the name of a "
        "packaged tyre; or a table with the keys of a linear tyre"
    ),
    WithJsonSchema({"type": ["string", "object"]}),
]


class CarTyres(Section):
    """The tyres on which the car rolls, instead of those of the axles' files."""

    front: _TYRE
    rear: _TYRE
    relaxation: Flag = Field(
        default=True,
        description="true: slips lag by the relaxation lengths of the tyres, with two states of "
        "each tyre; false: forces follow the slips without lag",
    )


# Ranges of a steering column: beyond them the equations are so stiff that a simulation hardly ends.
_TwistRate = Annotated[
    Number, Field(ge=0.01, le=1e4), Remedy("Leave the section out for a rigid column.")
]
_TwistDamping = Annotated[Number, Field(ge=0.0, le=10.0), CHECK_UNIT]
_PinionInertia = Annotated[Number, Field(ge=0.0, le=1.0), CHECK_UNIT]
_ColumnFriction = Annotated[Number, Field(ge=0.0, le=1e3), CHECK_UNIT]
_RackFriction = Annotated[Number, Field(ge=0.0, le=1e5), CHECK_UNIT]
_FrictionVelocity = Annotated[Number, Field(ge=1e-4, le=1.0), CHECK_UNIT]


class SteeringColumn(Section):
    """A steering column that twists between the steering wheel and the rack, and friction.

    Without this section the rack follows the steering wheel.
    """

    stiffness_Nm_per_deg: _TwistRate = Field(  # noqa: N815 (N m is the unit)
        description="torque of the steering wheel over the twist of the column, the rack held; of "
        "column, joints and torsion bar together"
    )
    damping_Nm_s_per_deg: _TwistDamping = Field(  # noqa: N815 (N m is the unit)
        default=0.0, description="damping of the twist"
    )
    pinion_inertia_kg_m2: _PinionInertia = Field(
        default=0.0,
        description="moment of inertia of all that turns with the pinion, at its speed; behind the "
        "column on the side of the rack",
    )
    friction_Nm: _ColumnFriction = Field(  # noqa: N815 (N m is the unit)
        default=0.0,
        description="friction of the column on the side of the steering wheel, in full sliding",
    )
    rack_friction_N: _RackFriction = Field(  # noqa: N815 (N is the newton)
        default=0.0, description="friction of the rack in its housing, in full sliding"
    )
    friction_velocity_m_per_s: _FrictionVelocity = Field(
        default=0.005, description="velocity of the rack at which 71 % of the friction is reached"
    )

    def rate(self) -> float:
        """Return the stiffness [N m/rad]."""
        return float(self.stiffness_Nm_per_deg / np.deg2rad(1.0))

    def parameters(self, travel_per_turn: float, center: Vector) -> dict[str, float]:
        """Return the values by their names in the equations, in SI units.

        `travel_per_turn` is that of the rack for a turn of the steering wheel [m], `center` the
        middle of the axle, where the pinion is drawn, (3,) [m].
        """
        zero = dict.fromkeys(("pinion_mass", "column_free_twist"), 0.0)
        return (
            zero
            | components("pinion_center", center)
            | {
                "pinion_turn": float(2.0 * np.pi / travel_per_turn),
                "pinion_inertia_spin": self.pinion_inertia_kg_m2,
                "pinion_inertia_diametral": 0.5 * self.pinion_inertia_kg_m2,  # of a disc
                "column_rate": self.rate(),
                "column_damper_rate": float(self.damping_Nm_s_per_deg / np.deg2rad(1.0)),
                "rack_friction": self.rack_friction_N,
                "rack_friction_speed": self.friction_velocity_m_per_s,
            }
        )


# Brakes of cars can decelerate them by some 10 m/s^2, air has 1.2 kg/m^3, and a car a drag area of
# some 0.7 m^2; the wheels of a car at 1 km/h turn at 1 rad/s.
_WEAKEST_BRAKES, _DENSITY, _LARGEST_AREA, _FASTEST_STANDSTILL = 0.3, (0.04, 40.0), 100.0, 30.0


class CarBrakes(Section):
    """The brakes."""

    torque_Nm: NonNegative = Field(  # noqa: N815 (N m is the unit)
        description="torque of the brakes of all wheels together, with the pedal fully down"
    )
    front_share: Share | None = Field(
        default=None,
        description="fraction of that torque at the front wheels; by default front_brake_share of "
        "the axles' files",
    )
    standstill_rad_per_s: Positive = Field(
        default=0.5,
        description="spin at which 71 % of the torque acts; the torque vanishes with the spin",
    )


class Air(Section):
    """Drag and lift of still air."""

    drag_area_m2: NonNegative = Field(default=0.0, description="drag coefficient times area")
    front_lift_area_m2: Number = Field(
        default=0.0, description="lift coefficient times area at the front axle, positive upward"
    )
    rear_lift_area_m2: Number = Field(
        default=0.0, description="lift coefficient times area at the rear axle, positive upward"
    )
    density_kg_per_m3: Positive = Field(default=1.2, description="density of the air")
    center_mm: Triple | None = Field(
        default=None,
        description="point of the body at which the drag acts; by default its centre of mass",
    )


class LinearTyreSection(Section):
    """A tyre whose forces are linear at small slip and approach the limit of friction."""

    radius_mm: Positive = Field(description="radius without load")
    effective_radius_mm: Positive = Field(
        description="speed over rate of spin of a wheel that rolls freely"
    )
    vertical_stiffness_N_per_mm: Positive = Field(  # noqa: N815 (N is the newton)
        description="vertical stiffness"
    )
    vertical_damping_N_s_per_m: NonNegative = Field(  # noqa: N815 (N is the newton)
        default=0.0, description="vertical damping"
    )
    slip_stiffness_N: Positive = Field(  # noqa: N815 (N is the newton)
        description="longitudinal force over longitudinal slip"
    )
    cornering_stiffness_N_per_rad: Positive = Field(  # noqa: N815 (N is the newton)
        description="lateral force over the tangent of the slip angle"
    )
    camber_stiffness_N_per_rad: Number = Field(  # noqa: N815 (N is the newton)
        default=0.0, description="lateral force over the sine of the inclination"
    )
    friction: Positive = Field(default=1.0, description="greatest horizontal force over the load")
    trail_mm: Number = Field(
        default=0.0, description="distance of the lateral force behind the contact, without sliding"
    )
    rolling_resistance: NonNegative = Field(
        default=0.0, description="longitudinal force of rolling resistance over the load"
    )
    relaxation_x_mm: Positive = Field(default=300.0, description="longitudinal relaxation length")
    relaxation_y_mm: Positive = Field(default=500.0, description="lateral relaxation length")
    lowest_speed_m_per_s: Positive = Field(
        default=1.0, description="speed below which slips are smoothed"
    )

    def tyre(self) -> LinearSlip:
        """Return the tyre."""
        return LinearSlip(
            radius=in_metres(self.radius_mm, "mm"),
            effective_radius=in_metres(self.effective_radius_mm, "mm"),
            trail=in_metres(self.trail_mm, "mm"),
            relaxation_x=in_metres(self.relaxation_x_mm, "mm"),
            relaxation_y=in_metres(self.relaxation_y_mm, "mm"),
            vertical_stiffness=1e3 * self.vertical_stiffness_N_per_mm,
            vertical_damping=self.vertical_damping_N_s_per_m,
            slip_stiffness=self.slip_stiffness_N,
            cornering_stiffness=self.cornering_stiffness_N_per_rad,
            camber_stiffness=self.camber_stiffness_N_per_rad,
            friction=self.friction,
            rolling_resistance=self.rolling_resistance,
            lowest_speed=self.lowest_speed_m_per_s,
        )


def tyre_of(given: Any, end: str, folder: Path) -> Tyre:
    """Return the tyre of an axle, 'front' or 'rear', from its value in [tyres].

    The value is a name, a path relative to `folder`, the table of a linear tyre, or a tyre.
    """
    if isinstance(given, Tyre):
        return given
    if isinstance(given, Mapping):
        try:
            return LinearTyreSection(**given).tyre()
        except ValidationError as error:
            raise InputError(messages_of(error, LinearTyreSection, given), end) from None
    if isinstance(given, str | Path):
        return load(named(given, folder))
    problem = f"{shown(given)}: the name of a tyre's file, or a table of a linear one, is needed."
    raise InputError([problem], end)


def under_load(tyre: Tyre, load: float) -> TyreSection:
    """Return a tyre under a load [N], as the ``[tyre]`` of an axle's file.

    Its radius is the loaded one, its rate the vertical stiffness, at a load; the free height is
    that at which this rate has the load at this radius. Lateral and longitudinal rates are the
    cornering stiffness and the slip stiffness over the relaxation lengths, if these are known.
    """
    at = tyre.evaluate(load, speed=0.0, extrapolate=True)
    radius, rate = float(at.loaded_radius), float(at.vertical_stiffness)
    across = float(at.cornering_stiffness / at.relaxation_y)
    along = float(at.slip_stiffness / at.relaxation_x)
    return TyreSection.model_construct(
        rate_N_per_m=rate,
        free_height_mm=1e3 * (radius + load / rate),
        radius_mm=1e3 * radius,
        lateral_rate_N_per_m=across if np.isfinite(across) else None,
        longitudinal_rate_N_per_m=along if np.isfinite(along) else None,
        damper_rate_N_s_per_m=tyre.vertical_damping,
        lifts_off=True,
    )


def carries(tyre: Tyre, load: float) -> bool:
    """Return whether a tyre has a radius and a stiffness under a load [N]."""
    at = tyre.evaluate(load, speed=0.0, extrapolate=True)
    return bool(at.loaded_radius > 0.0 and at.vertical_stiffness > 0.0)


def named(given: Any, folder: Path) -> Any:
    """Return a packaged name as it is, a path relative to `folder`, and other objects unchanged."""
    if not isinstance(given, str | Path) or given in packaged_tyres():
        return given
    return str(folder / given)


def unlikely_driving(brakes: CarBrakes | None, air: Air | None, moment: float) -> Iterator[str]:
    """Yield problems of brakes and air; `moment` is the mass times the tyres' radius [kg m]."""
    if brakes is not None:
        if 0.0 < brakes.torque_Nm < _WEAKEST_BRAKES * moment:
            yield (
                f"[brakes] torque_Nm = {brakes.torque_Nm:g} N m: the car brakes by at most "
                f"{brakes.torque_Nm / moment:.2g} m/s^2 by it, cars by some 10. Is it in kN m?"
            )
        if brakes.standstill_rad_per_s > _FASTEST_STANDSTILL:
            yield (
                f"[brakes] standstill_rad_per_s = {brakes.standstill_rad_per_s:g} rad/s: below "
                "this spin the brakes act as dampers, and wheels at 100 km/h turn at some 90 "
                "rad/s. Enter 0.5, or leave it out."
            )
    if air is not None:
        least, most = _DENSITY
        if not least <= air.density_kg_per_m3 <= most:
            yield (
                f"[air] density_kg_per_m3 = {air.density_kg_per_m3:g} kg/m^3: air has 1.2. Is it "
                "in another unit?"
            )
        for name in ("drag_area_m2", "front_lift_area_m2", "rear_lift_area_m2"):
            area = getattr(air, name)
            if abs(area) > _LARGEST_AREA:
                yield f"[air] {name} = {area:g} m^2: cars have up to 10. Is it in cm^2?"
