"""Twist-beam axles: the data of a file, the joints and the equations of motion."""

from collections.abc import Iterator, Mapping
from types import ModuleType
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import Field

from ...core.named_types import Array, ArrayLike
from ...core.validator import Validator
from ...core.vectors import components
from ...generated import twist_beam as equations
from ..corner.bushes import Bush, Bushings, bushes_of
from ..corner.coil_sprung import ApartDamper
from ..corner.structure import (
    FixedJoint,
    PartJoint,
    Points,
    SphericalJoint,
    Structure,
)
from ..input.bodies import Bodies, RigidBody
from ..input.section import CHECK_UNIT, Number, Section, Triple
from ..input.spring import SpringSection
from ..input.stop import StopSection
from ..input.units import in_metres
from ..input.vehicle import GravitySection, TyreSection, WheelSection
from .axle.file import Brakes, End
from .sides import LEFT, RIGHT, SIDES
from .whole_axle import CHASSIS, WholeAxle, lines_of_sides, on_both_sides
from .whole_axle_file import AxleDrive, WholeAxleHardpoints, WholeAxleVehicle
from .whole_axle_model import WholeAxleModel, solved_for_two

LIFT, TWIST = "lift", "twist"
"""The coordinates: angle of both arms about the pivots, and of each about its line to the beam."""

CENTER, PIVOT, SHEAR_CENTER = "wheel_center", "pivot", "shear_center"
ACROSS = np.array([0.0, 1.0, 0.0])
"""The direction of the line through both pivots."""

_UPRIGHT = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
# Least distance of pivots and shear centre from the wheels' line, and from each other [m].
_SHORTEST = 0.05
# Greatest last step of Newton's method [rad], which converges quadratically.
_CLOSE, _MOST_STEPS = 1e-14, 20
_ARMS, _BEAM = "#4a525a", "#d55e00"

_Rate = Annotated[Number, Field(ge=0.0, le=1e5), CHECK_UNIT]


# -- the file -------------------------------------------------------------------------------------


class TwistBeamHardpoints(WholeAxleHardpoints):
    """The points of the right side at the design position; the left one is its mirror image.

    All points are in chassis axes (ISO 8855: x forward, y left, z up), in the unit that `unit`
    names.
    """

    pivot: Triple = Field(description="bush of the arm on the chassis")


class BeamSection(Section):
    """The beam between both arms."""

    shear_center_x_mm: Number = Field(
        description="x of the shear centre of the beam's section in the vehicle's centre plane"
    )
    shear_center_z_mm: Number = Field(description="z of the shear centre there")
    rate_Nm_per_deg: _Rate = Field(  # noqa: N815 (N is the newton)
        description="torque per twist of the beam, with warping and a bar inside the beam"
    )

    @property
    def rate(self) -> float:
        """The torque of the beam per twist [N m/rad]."""
        return float(np.degrees(self.rate_Nm_per_deg))


class TwistBeamArmBody(RigidBody):
    """The right arm with hub, brake and half of the beam; the left one is its mirror image."""

    POINTS: ClassVar[tuple[str, ...]] = (PIVOT, CENTER)


class TwistBeamBodies(Bodies):
    """The bodies; a half of the beam belongs to each arm."""

    arm: TwistBeamArmBody = Field(description="the right arm with hub, brake and half of the beam")


class TwistBeamAxle(WholeAxle):
    """Two trailing arms and a twisting beam between them, at design; see `WholeAxle`.

    Examples
    --------
    >>> import kintrafo
    >>> axle = kintrafo.load("twist_beam")
    >>> axle.heading(), axle.beam.rate_Nm_per_deg
    ('twist-beam rear axle', 25.0)
    """

    KEY: ClassVar[str] = "twist_beam"
    NEEDED: ClassVar[str] = 'a twist-beam axle, such as kintrafo.load("twist_beam"), is needed'
    PAGE: ClassVar[str] = """\
A file of its own, of two arms and the beam between them; `kintrafo new FILE --suspension
twist_beam` writes one. See [Twist-beam axles](../suspension/twist-beam.md). The other sections are
those of every suspension: `[tyre]`, `[gravity]`, the stops, and `[wheel]`, which may be left out;
and `[bushings.POINT]`, whose points are `pivot` and `wheel_center`, on both sides, and
`shear_center`.
"""

    twist_beam: End = Field(description='where the axle is: "front" or "rear"')
    vehicle: WholeAxleVehicle = Field(
        default=WholeAxleVehicle(), description="data of the whole vehicle"
    )
    hardpoints: TwistBeamHardpoints = Field(description="the points of the right side")
    beam: BeamSection = Field(description="the beam between both arms")
    wheel: WheelSection = Field(
        default=WheelSection(camber_deg=0.0, toe_deg=0.0), description="alignment of the wheels"
    )
    spring: SpringSection = Field(description="the springs, between chassis and arms")
    damper: ApartDamper = Field(description="the dampers, between chassis and arms")
    bump_stop: StopSection | None = Field(
        default=None, description="the stops in bump, of the dampers"
    )
    rebound_stop: StopSection | None = Field(
        default=None, description="the stops in rebound, of the dampers"
    )
    tyre: TyreSection = Field(description="the tyres")
    gravity: GravitySection = Field(description="gravity")
    bodies: TwistBeamBodies = Field(description="masses and inertia")
    brakes: Brakes = Field(default=Brakes(), description="reaction of the brake torque")
    drive: AxleDrive | None = Field(default=None, description="the drive of the axle")
    bushings: Bushings | None = Field(
        default=None, description="the bushings at hardpoints, for compliance: see Compliance"
    )

    def heading(self) -> str:
        return f"twist-beam {self.twist_beam} axle"

    @property
    def shear_center(self) -> Array:
        """The shear centre of the beam in its middle [m]."""
        x, z = self.beam.shear_center_x_mm, self.beam.shear_center_z_mm
        return np.array([in_metres(x, "mm"), 0.0, in_metres(z, "mm")])

    @property
    def pivot(self) -> Array:
        """The pivot of the right arm [m]."""
        return np.asarray(self.hardpoints.metres(PIVOT))

    @property
    def twist_ratio(self) -> float:
        """The twist of the beam per rotation of an arm about its line to the shear centre [1]."""
        return (
            2.0 * abs(float(self.pivot[1])) / float(np.linalg.norm(self.pivot - self.shear_center))
        )

    def drawn_lines(self) -> Iterator[tuple[str, str, float, Array]]:
        for side in SIDES:
            points = self.points(side)
            arm = points[CENTER] - points[PIVOT]
            back = (self.shear_center - points[PIVOT])[0] / arm[0] if arm[0] else 0.0
            root = points[PIVOT] + np.clip(back, 0.0, 1.0) * arm  # where the beam meets the arm
            yield "arms", _ARMS, 5.0, np.array([points[PIVOT], points[CENTER]])
            yield "beam", _BEAM, 2.4, np.array([self.shear_center, root])

    @property
    def joint_names(self) -> tuple[str, ...]:
        own = ("spring_seat", "damper_seat", CENTER)
        return (SHEAR_CENTER, *(f"{name}_{side}" for name in own for side in SIDES))

    def structure(self) -> Structure:
        joints: list[PartJoint] = []
        for side in SIDES:
            arm = f"arm_{side}"
            joints.append(PivotJoint(CHASSIS, arm, (f"{PIVOT}_{side}",)))
            joints.append(FixedJoint(arm, f"wheel_{side}", (f"{CENTER}_{side}",)))
        joints.append(BeamJoint(f"arm_{RIGHT}", f"arm_{LEFT}", (SHEAR_CENTER,)))
        lines = lines_of_sides({side: f"arm_{side}" for side in SIDES})
        return Structure(joints, lines)

    def bushes(self, given: Validator, described: Mapping[str, Any]) -> list[Bush]:
        joints = (
            PivotJoint(CHASSIS, "arm", (PIVOT,)),
            FixedJoint("arm", "wheel", (CENTER,)),
            BeamJoint("arm", "arm", (SHEAR_CENTER,)),
        )
        points = {name: self.hardpoints.metres(name) for name in (PIVOT, CENTER)}
        points[SHEAR_CENTER] = self.shear_center
        spin = -self.wheel.spin_axis(-1.0)
        found = bushes_of(given, described, Structure(joints, ()), points, spin)
        return [
            own
            for bush in found
            for own in ([bush] if bush.point == SHEAR_CENTER else on_both_sides(bush))
        ]

    def parameters(self) -> dict[str, float]:
        """Return the parameters of the equations of motion by name, in SI units.

        The power of the beam's torque T is T times the rate of the twist, which is that of an arm's
        rotation times `twist_ratio`; the rate per rotation has the square of this.
        """
        rate = self.beam.rate * self.twist_ratio**2
        values = {
            **components(SHEAR_CENTER, self.shear_center),
            **components(PIVOT, self.pivot),
            "gravity": self.gravity.acceleration_m_per_s2,
            "beam_rate": rate,
            "opposite": -1.0,
        }
        own = self._of_bodies("arm")
        return values | {name: value for name, value in own.items() if PIVOT not in name}

    def parameters_of_masses(self) -> list[Mapping[str, float]]:
        """Return the parameters of each side, with the names of the right one for both.

        The equations have those of the right arm alone; the left arm is its mirror image.
        """
        right, left = super().parameters_of_masses()
        arm = {name: right[name] for name in ("arm_mass", "arm_com_x", "arm_com_y", "arm_com_z")}
        return [right, {**arm, "arm_com_y": -arm["arm_com_y"], **left}]

    # -- its checks -----------------------------------------------------------------------------

    def _own_problems(self) -> list[str]:
        problems = []
        pivot, shear, wheel = self.pivot, self.shear_center, self.hardpoints.metres(CENTER)
        if float(np.hypot(*(wheel - pivot)[[0, 2]])) < _SHORTEST:
            problems.append(
                f"{self.hardpoints.text(PIVOT)}: the wheels are less than {1e3 * _SHORTEST:g} mm "
                "from the line through the pivots, about which they rise. Move pivot or "
                "wheel_center."
            )
        line = pivot - shear
        lever = abs(float(np.cross(line / np.linalg.norm(line), wheel - shear)[2]))
        if lever < _SHORTEST:
            problems.append(
                "[beam] shear_center: the lateral distance of the wheel from the line through its "
                f"pivot and the shear centre, about which it turns in roll, is {1e3 * lever:.3g} "
                f"mm; at least {1e3 * _SHORTEST:g} mm are needed. Move the shear centre, or pivot."
            )
        return problems

    def _unlikely(self) -> Iterator[str]:
        arm = self.bodies.arm
        yield from self._unlikely_of({}, {"arm": arm}, 0.0, arm.mass_kg)
        if self.twist_beam == "rear" and self.pivot[0] < self.center[0]:
            yield (
                f"{self.hardpoints.text(PIVOT)}: the pivots are behind the wheels, so that no arm "
                "trails. Correct the sign of x."
            )


# -- its joints -----------------------------------------------------------------------------------


class PivotJoint(SphericalJoint):
    """The bush of an arm, with a force; its axis is the line through both pivots."""

    def axis(self, points: Points) -> Array | None:
        """Return the direction through both pivots."""
        return np.broadcast_to(ACROSS, points[self.at[0]].shape)


class BeamJoint(PartJoint):
    """The joint of both halves of the beam, with all loads but the torque about the pivots' line.

    This torque is that of the beam's spring. A force along the beam, and with it the shares of the
    pivots in a lateral force, is statically indeterminate: it has the least energy of the bushes,
    or without bushes the least forces.
    """

    def axis(self, points: Points) -> Array | None:
        """Return the direction through both pivots."""
        return np.broadcast_to(ACROSS, points[self.at[0]].shape)

    def unit_loads(self, points: Points, turned: Mapping[str, Array], design: Points) -> Array:
        """Return three forces and two moments."""
        loads = np.zeros((*points[self.at[0]].shape[:-1], 1, 6, 5))
        loads[..., 0, :3, :3] = np.eye(3)
        loads[..., 0, 3:, 3:] = _UPRIGHT.T
        return loads

    def right_angles(
        self, points: Points, turned: Mapping[str, Array], design: Points, spin: Array
    ) -> list[tuple[Array, Array]]:
        """Return the direction of the pivots with both perpendicular directions."""
        shape = points[self.at[0]].shape
        return [
            (np.broadcast_to(ACROSS, shape), np.broadcast_to(across, shape)) for across in _UPRIGHT
        ]


# -- its equations --------------------------------------------------------------------------------


class TwistBeamModel(WholeAxleModel):
    """The compiled equations of a twist-beam axle: arms, wheels, springs, dampers, stops and tyres.

    The states are ``lift`` [rad], positive with the wheels up, ``twist`` [rad], positive with the
    left wheel up, and the angles of the wheels; see `WholeAxleModel`.

    Examples
    --------
    >>> import kintrafo
    >>> model = kintrafo.model_of(kintrafo.load("twist_beam"))
    >>> model.state_names[:2]
    ('lift', 'twist')
    """

    NEEDED = "the equations of a twist-beam axle are needed"
    AXLE = TwistBeamAxle
    EQUATIONS: ClassVar[ModuleType] = equations
    COORDINATES: ClassVar[tuple[str, str]] = (LIFT, TWIST)
    ENDS = "a damper is at the end of its length, or an arm has turned by 45 deg"

    axle: TwistBeamAxle

    def placed(self, left: Array, right: Array, rack: ArrayLike = 0.0) -> Array:
        """Return the states at rest at wheel travels; NaN if no angles are found.

        The height of a wheel is ``z cos(lift) - x sin(lift)`` with its position x, z relative to
        the pivots after the rotation about the line to the shear centre. Newton's method solves
        for both angles from design.
        """
        states = np.broadcast_to(self.design_state, (*left.shape, self.design_state.size)).copy()
        wanted = np.stack(np.broadcast_arrays(left, right), axis=-1)
        with np.errstate(all="ignore"):
            found = _angles(self.axle, wanted)
        for name, angle in zip(self.COORDINATES, found, strict=True):
            states[..., self.state_names.index(name)] = angle
        return states

    def moved(self, states: Array, left: Array, right: Array, inputs: Array | None = None) -> Array:
        lift, twist = (states[..., self.state_names.index(name)] for name in self.COORDINATES)
        with np.errstate(all="ignore"):
            _, slopes = _heights(self.axle, lift, twist)
            rates = solved_for_two(slopes, np.stack(np.broadcast_arrays(left, right), axis=-1))
        return self.with_rates(states, rates)

    def turned(self, states: Array) -> Array:
        """Return the larger of both angles [rad]; pi for NaN."""
        both = [np.abs(states[..., self.state_names.index(name)]) for name in self.COORDINATES]
        return np.nan_to_num(np.maximum(*both), nan=np.pi)


def _angles(axle: TwistBeamAxle, wanted: Array) -> tuple[Array, Array]:
    """Return lift and twist at heights of both wheels above design, (..., 2) [m], or NaN."""
    lift, twist = np.zeros(wanted.shape[:-1]), np.zeros(wanted.shape[:-1])
    change = np.full(wanted.shape[:-1], np.inf)
    for _ in range(_MOST_STEPS):
        heights, slopes = _heights(axle, lift, twist)
        steps = solved_for_two(slopes, wanted - heights)
        lift, twist = lift + steps[..., 0], twist + steps[..., 1]
        change = np.abs(steps).max(axis=-1)
        if not (change > _CLOSE).any():
            break
    lost = ~(change < np.sqrt(_CLOSE))
    return np.where(lost, np.nan, lift), np.where(lost, np.nan, twist)


def _heights(axle: TwistBeamAxle, lift: Array, twist: Array) -> tuple[Array, Array]:
    """Return the heights of both wheels above design, (..., 2), and their slopes, (..., 2, 2)."""
    up, down = np.cos(lift), np.sin(lift)
    values, by_lift, by_twist = [], [], []
    for side in SIDES:
        points = axle.points(side)
        line = points[PIVOT] - axle.shear_center
        # positive with the left wheel up: about the left line outward, and the right one inward
        axis = line / np.linalg.norm(line)
        arm = points[CENTER] - points[PIVOT]
        along, across = axis * (axis @ arm), np.cross(axis, arm)
        aside = arm - along
        angle = twist[..., None]
        turned = along + np.cos(angle) * aside + np.sin(angle) * across
        slope = np.cos(angle) * across - np.sin(angle) * aside
        values.append(up * turned[..., 2] - down * turned[..., 0] - arm[2])
        by_lift.append(-down * turned[..., 2] - up * turned[..., 0])
        by_twist.append(up * slope[..., 2] - down * slope[..., 0])
    return np.stack(values, -1), np.stack([np.stack(by_lift, -1), np.stack(by_twist, -1)], -1)
