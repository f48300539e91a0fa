"""The base of assemblies of axles without sides, such as a rigid axle."""

from collections.abc import Mapping, Sequence
from importlib import import_module
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ...core.named_types import Array
from ...core.validator import Validator
from ..corner.bushes import described_bushings
from ..models.plausibility import Plausibility
from ..models.reach import PositionError
from ..models.sides import SIDES
from ..models.whole_axle import WholeAxle, class_in
from ..models.whole_axle_model import WholeAxleModel
from .assembly import Bushings, WheelNames
from .load import Load
from .motions import MOST_ROLL, USUAL_ROLL, USUAL_ROLL_STEP
from .part_poses import PartPoses
from .rest import settled
from .rig import RestConditions, RigPosition, SweepRange
from .soft_lines import SoftLines, lines_of_beam
from .steered import SteerableAssembly, motions_of_two
from .usual import CLEARANCE, USUAL_RACK, USUAL_TRAVEL, grid
from .whole_axle_kinematics import RISES, WholeAxleKinematics
from .whole_axle_parts import WholeAxleParts

# Greatest travel of both wheels in the search for the range [m].
_FAR = 0.4
_NO_REST = (
    "the axle has no stable equilibrium near its design position. Check the springs' rate and "
    "free length, the tyres' rate and free height, the load of the wheels, or the road."
)
# The loops close up to this multiple of the travel of a loaded axle.
_CLEAR = 1.02


class WholeAxleAssembly(SteerableAssembly):
    """An axle whose two coordinates determine the heights of both wheels.

    Its equations are `model`, if they exist already. The classes are those of the data of a file,
    of their equations, of its parts, and of the first derivatives of their motion.
    """

    AXLE: ClassVar[type[WholeAxle]]
    MODEL: ClassVar[type[WholeAxleModel]]
    PARTS: ClassVar[type[WholeAxleParts]]
    KINEMATICS: ClassVar[type[WholeAxleKinematics]] = WholeAxleKinematics
    BAR_SIGN = "positive with the left wheel up"

    axle: Any

    def __init__(self, axle: Any, model: Any = None) -> None:
        self.subject = self.axle = axle
        self.model = self._model() if model is None else model
        self.wheeled = [axle] * len(SIDES)
        self.moves_rigidly = not axle.overheld
        self.motions = motions_of_two() | self.of_steering()

    def _model(self) -> WholeAxleModel:
        """Return its equations."""
        return self.MODEL(self.axle)

    def usual_travel(self, motion: str, far: SweepRange) -> Array:
        if motion == "roll":
            with Validator("roll") as given:
                amount = 0.0 if far.roll is None else far.roll
                given.number("roll", amount, "rad", least=0.0, below=MOST_ROLL)
            most = self._ends(motion, USUAL_ROLL) if far.roll is None else [-amount, amount]
            both = min(-most[0], most[1])
            return grid(-both, both, USUAL_ROLL_STEP)
        with Validator("wheel travel") as given:
            for name in ("rebound", "bump"):
                value = getattr(far, name)
                given.number(name, 0.0 if value is None else value, "m", least=0.0)
        low, high = self._ends(motion, USUAL_TRAVEL)
        low = low if far.rebound is None else -far.rebound
        high = high if far.bump is None else far.bump
        return grid(low, high, far.step)

    def usual_racks(self, far: SweepRange) -> Array:
        with Validator("sweep") as given:
            given.number("extent", 0.0 if far.rack is None else far.rack, "m", least=0.0)
        most = far.rack
        if most is None:
            parts = [self.model.farthest(0.0, 0.0, sign * USUAL_RACK) for sign in (-1.0, 1.0)]
            part = min(parts)
            most = USUAL_RACK if part == 1.0 else (1.0 - CLEARANCE) * part * USUAL_RACK
        return grid(-most, most, far.step)

    def _ends(self, motion: str, most: float) -> list[float]:
        """Return the ends of a motion either way, at most `most`, before the ends of its range."""
        ends = []
        for value in (-most, most):
            left, right = self._travels(motion, np.array(value))
            part = self.model.farthest(float(left), float(right))
            ends.append(value if part == 1.0 else (1.0 - CLEARANCE) * part * value)
        return ends

    def _travels(self, motion: str, along: Array) -> tuple[Array, Array]:
        """Return the travels of the left and the right wheel along a motion [m]."""
        if motion == "roll":
            half = self.axle.half_track * np.sin(along)
            return -half, half
        left, right = RISES[motion]
        return left * along, right * along

    def travels_in(self, motion: str, along: Array, rack: float) -> tuple[Array, Array]:
        if motion == "roll" and np.abs(along).max(initial=0.0) >= MOST_ROLL:
            worst = np.degrees(np.abs(along).max())
            message = f"roll of {worst:.4g} deg: less than 45 deg is needed; Python's unit is rad."
            raise PositionError(message)
        return self._travels(motion, along)

    @property
    def coordinates(self) -> tuple[str, ...]:
        return self.model.COORDINATES

    def coordinates_at_rest(self, held: RestConditions) -> Array:
        found = settled(self, held, np.zeros(2), _NO_REST)
        signals = self.model.signals(*self.at_rest(found, held.rack))
        design = self.axle.center[2]
        names = (f"{self.names_of(wheel).signals}wheel_center_z" for wheel in self.wheels)
        left, right = (float(signals[name] - design) for name in names)
        if self.model.farthest(left, right, held.rack) < 1.0:
            raise PositionError(_NO_REST)
        return found

    def names_of(self, wheel: str) -> WheelNames:
        prefix = f"{wheel}_"
        return WheelNames(
            prefix, f"{prefix}axle_", f"{prefix}spin_angle", f"{prefix}spring_actuator"
        )

    def wheel_equations(self, wheel: str) -> tuple[WholeAxleModel, str, Mapping[str, str]]:
        return self.model, self.names_of(wheel).signals, {name: name for name in self.coordinates}

    def coordinates_of(self, suffix: str) -> dict[str, str]:
        return {name: name for name in self.coordinates}

    def joints(self, suffix: str) -> tuple[str, ...]:
        return self.axle.joint_names

    def kinematics(self, position: RigPosition) -> WholeAxleKinematics:
        self.require_rigid_motion()
        return self.KINEMATICS(self._at(position), position.per_turn)

    def poses(self, position: RigPosition) -> dict[str, PartPoses]:
        return {"": self._at(position)}

    def _at(self, position: RigPosition) -> WholeAxleParts:
        left, right = (np.asarray(position.travels[side]) for side in SIDES)
        left, right, racks = np.broadcast_arrays(left, right, position.rack)
        states = self.model.states_at(left, right, racks)
        return self.PARTS.of(self.model, states, self.model.inputs_at(racks))

    def soft_lines(self, poses: Mapping[str, Any]) -> dict[str, SoftLines]:
        return {"": lines_of_beam(self.KINEMATICS(poses[""]))}

    @property
    def design_wheel_coordinates(self) -> Array:
        """Travels of zero."""
        return np.zeros(len(SIDES))

    def wheel_coordinates(self, travels: Sequence[float | None], rack: float) -> Array:
        """Return the travels, if the axle can be there [m]."""
        found = np.array([travel or 0.0 for travel in travels])
        self.model.states_at(*found, rack)
        return found

    def wheel_reach(self, rack: float) -> None:
        """Return None: the range of a wheel depends on the other one."""

    def at_wheel_coordinates(self, coordinates: Array, racks: Array) -> dict[str, PartPoses]:
        """Return the parts at rest; the coordinates are the travels of both wheels [m]."""
        return {"": self._parts(coordinates, racks)}

    def _parts(self, travels: Array, racks: Array) -> WholeAxleParts:
        states = self.model.placed(*travels.T, racks)
        return self.PARTS.of(self.model, states, self.model.inputs_at(racks))

    def reached(self, coordinates: Array, racks: Array) -> NDArray[np.bool_]:
        """Return whether axle and dampers are within range, springs and dampers upright, (n,)."""
        states = self.model.placed(*coordinates.T, racks)
        margins = self.model.margins(states, self.model.inputs_at(racks))
        found = np.asarray((margins > 0.0).all(axis=-1))
        found[found] = self._parts(coordinates[found], racks[found]).upright()
        return found

    def locked(self, coordinates: Array, racks: Array) -> NDArray[np.bool_]:
        """Return whether the axle is at the end of its range, or not reached from design, (n,)."""
        beyond = self.model.parts_of_ways(*coordinates.T, racks) < 1.0
        states = self.model.placed(*(_CLEAR * coordinates).T, racks)
        margins = self.model.margins(states, self.model.inputs_at(racks))
        # margins of the loops only: a damper may be near the end of its stroke
        closing = margins[:, : len(self.model.equations.GUARDS)]
        return np.asarray(beyond | ~(closing > 0.0).all(axis=-1))

    @property
    def rules(self) -> tuple[str, ...]:
        return self.axle.structure().rules

    def acting(self, poses: Mapping[str, Any]) -> dict[str, list[Load]]:
        return {"": poses[""].acting()}

    def bar_loads(self, poses: Mapping[str, Any]) -> dict[str, list[Load]]:
        return {"": poses[""].by_torque()} if poses[""].rate_of_twist else {}

    def bar_twist(self, poses: Mapping[str, Any]) -> dict[str, Array]:
        return {"": poses[""].twist}

    def bushes(self, given: Validator, bushings: Mapping[str, Any] | None) -> Bushings:
        described = described_bushings(given, bushings, self.axle.bushings)
        return Bushings({"": self.axle.bushes(given, described)}, 0.0)

    def plausibility(self) -> Plausibility:
        return self.axle.plausibility()

    def reach(self) -> dict[str, tuple[float, bool]]:
        found = {}
        for name, far in (("down", -_FAR), ("up", _FAR)):
            part = self.model.farthest(far, far)
            found[name] = far * part, part < 1.0
        return found

    def without_friction(self) -> "WholeAxleAssembly":
        smooth = self.axle.with_changes({"damper.friction_N": 0.0})
        return type(self)(smooth, self.MODEL(smooth))


def whole_axle_assembly(key: str) -> type[WholeAxleAssembly]:
    """Return the class of an axle without sides, from the module with its key."""
    module = import_module(f".{key}", __package__)
    return class_in(module, WholeAxleAssembly)
