"""The protocol of assemblies with wheels, for which every analysis is written."""

from abc import ABC, abstractmethod
from collections.abc import Container, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from ...core.named_types import Array
from ...core.quantities import variable
from ...core.validator import Validator
from ..corner.bushes import Bush
from ..corner.wheeled import NOT_STEERED, WheeledSection
from ..input.vehicle import TyreSection
from ..models.axle.file import TorqueReaction
from ..models.model import Model
from ..models.plausibility import Plausibility
from .anti_roll_bar import AnyBar
from .coupling import BodyPose
from .load import Load, known
from .measures.measure import Measure, values
from .part_poses import PartPoses, states_with
from .quantity import RACK, TRAVEL, Quantity, displaced_by
from .rig import STEERING, RestConditions, RigMotion, RigPosition, SweepRange, WheelReach
from .soft_lines import SoftLines

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True)
class WheelNames:
    """Names of one wheel in the equations of motion."""

    prefix: str  # prefix of its inputs: empty for a corner, `left_` for an axle
    signals: str  # prefix of its signals and events: `left_front_` for an axle
    spin: str  # state: the angle of the wheel about its axis
    actuator: str  # input: the force of the actuator beside its spring
    tyre: str = "tyre_force"  # signal of the tyre's load, without this prefix

    @property
    def road(self) -> str:
        """Input: the height of the road under the wheel."""
        return f"{self.prefix}road_height"

    @property
    def load(self) -> str:
        """Signal: the load of the tyre."""
        return f"{self.signals}{self.tyre}"

    @property
    def hub_torque(self) -> str:
        """Input of a model with loads on the wheel: the torque of the brake at the hub."""
        return f"{self.prefix}hub_torque"

    @property
    def events(self) -> tuple[str, str]:
        """The events at which the wheel leaves and touches the ground."""
        leaves, touches = (f"{self.signals}wheel_{what}_ground" for what in ("leaves", "touches"))
        return leaves, touches


NOT_A_CAR = (
    "this is a whole car, and a suspension or an axle is needed. Give "
    'car.axles["front"], car.axles["rear"] or car.corner; at the command line, the file of an axle '
    "or a corner."
)
"""The message if a car is given where a suspension or an axle is needed."""


@dataclass(frozen=True)
class Bushings:
    """The bushes of an assembly, and the flexibility of its rack."""

    # by the suffix of the names of the parts that they connect, as in `HeldAssembly.poses`
    by_suffix: Mapping[str, list[Bush]]
    # displacement of the rack along its axis for a unit force [m/N]; zero for a rigid rack
    rack: float

    @property
    def every(self) -> list[Bush]:
        """All bushes."""
        return [bush for bushes in self.by_suffix.values() for bush in bushes]


class Assembly(ABC):
    """A corner, an axle, a rigid axle or a car.

    All but a car are a `HeldAssembly`; the parts and bushes of a car are those of its axles.

    The parts are in one group, or in several that only an anti-roll bar and a rack join, such as
    the two sides of an axle. The key of a group is the suffix of the names of its parts: ``""``,
    ``"_left"`` or ``"_right"``.
    """

    # names of the wheels, 'left' and 'right', or the side of a corner; those of the groups in turn
    wheels: tuple[str, ...]
    motions: Mapping[str, RigMotion]  # motions on a rig, the usual one first
    subject: Any  # data of its files
    # equations of motion; those of an axle or a car are derived and compiled at first use
    model: Any
    wheeled: Sequence[WheeledSection]  # data of the file that describes each wheel, by wheel
    own_sections: Mapping[str, Any] = {}  # those of an axle's own file, besides those of its sides
    axles: tuple[str, ...] = ()  # ends at which a car has axles, which have measures of their own
    body_moves = False  # whether the vehicle's body moves in the equations; otherwise it is held
    drives = False  # whether it is a car on rolling tyres
    moves_rigidly = True  # whether it moves with rigid joints; a rigid axle on five rods does not
    on_a_beam = False  # whether one body carries both wheels and has a steer angle of its own
    symmetric = True  # whether one side is the mirror image of the other

    NEEDED: ClassVar[str] = (
        "a kintrafo.Suspension or Model, an Axle, or a RigidAxle is needed; "
        "kintrafo.load reads each of them"
    )

    # -- its data ---------------------------------------------------------------------------------

    @property
    def design_sections(self) -> dict[str, dict[str, Any]]:
        """The sections of its files, whose numbers studies vary, by the prefix of their places."""
        return {"": self.subject.to_dict()}

    @property
    def input_sections(self) -> Mapping[str, Any]:
        """The content of its files, by the prefix of the names of sections.

        An axle has its own file and those of its sides, of two mirror images one.
        """
        alone = len(self.wheels) == 1
        sides = {"" if alone else n: model.suspension for n, model in self.corners.items()}
        return (sides or {"": self.subject}) | dict(self.own_sections)

    @property
    def steered(self) -> bool:
        """Whether its wheels are steered, by a rack or a Pitman arm."""
        return bool(self.subject.steered())

    @property
    def steering_displacement(self) -> Quantity:
        """The displacement of the rack, or of the ball of a Pitman arm."""
        return displaced_by(next((f.steered_by for f in self.wheeled if f.steered_by), ""))

    def motion_of_steering(self, wheels: str) -> RigMotion:
        """Return the motion of the rack or the Pitman arm, with `wheels` at one height."""
        along = self.steering_displacement
        moves = ("rack", "moves") if along is RACK else ("Pitman arm", "turns")
        return RigMotion(along, f"the {' '.join(moves)}, {wheels} at one height", f"the {moves[0]}")

    @property
    def tyres(self) -> Sequence[TyreSection]:
        """The tyres, by wheel."""
        return [file.tyre for file in self.wheeled]

    @property
    def tyre_radii(self) -> Sequence[float | None]:
        """The radii of the wheels as thin discs, by wheel [m]; None if not known."""
        return [file.tyre_radius() for file in self.wheeled]

    @property
    def has_bushes(self) -> bool:
        """Whether a file has bushes."""
        return any(file.bushings for file in self.wheeled)

    @property
    @abstractmethod
    def held_parts(self) -> "Mapping[str, HeldAssembly]":
        """The assemblies with a held body of which it consists, by name."""

    @property
    def simplified(self) -> Sequence[str]:
        """Effects that linear compliance neglects, for a sentence."""
        return ()

    @property
    def usual_motion(self) -> str:
        """The motion of a rig in which all wheels rise and fall together."""
        return next(iter(self.motions))

    @property
    @abstractmethod
    def words(self) -> str:
        """A description in sentences."""

    # -- its positions on a rig -------------------------------------------------------------------

    @abstractmethod
    def usual(
        self, motion: str, ends: SweepRange | None = None, *, travel: float = 0.0, rack: float = 0.0
    ) -> Array:
        """Return the default positions of a motion, zero included, in SI units.

        `ends` replaces default ends of the motion; `travel` and `rack` [m] are held in motions of
        the steering and of the wheels.
        """

    @abstractmethod
    def position(
        self, motion: str, along: Array, *, travel: float = 0.0, rack: float = 0.0
    ) -> RigPosition:
        """Return the positions of wheels and rack along a motion.

        `along` are values of `RigMotion.along`. `travel` [m] is held in a motion of the steering,
        `rack` [m] in others. Raises `PositionError` if a position is out of reach.
        """

    def at_travel(self, travels: Array, rack: Array | float = 0.0) -> RigPosition:
        """Return the positions with all wheels at the same heights above design [m]."""
        return RigPosition(dict.fromkeys(self.wheels, travels), np.asarray(rack, float))

    def held_in(self, motion: str, travel: float, rack: float) -> dict[Quantity, float]:
        """Return the constant quantities of a motion, for the coordinates of its results."""
        if motion in STEERING:
            return {TRAVEL: travel}
        return {self.steering_displacement: rack} if self.steered else {}

    def refuse_holding(self, given: Validator, motion: str, travel: float, rack: float) -> None:
        """Refuse a constant travel, or a constant rack, that the motion itself moves."""
        if rack:
            self.refuse_unsteered(given, "rack_position")
        if motion in STEERING and rack:
            given.fail(f"rack_position: the motion {motion!r} moves the rack. Leave it out.")
        if motion not in STEERING and travel:
            given.fail(f"travel: in the motion {motion!r} wheels move by along. Leave it out.")

    def refuse_motion(self, motion: str) -> None:
        """Raise an `InputError` for a motion of the steering if its wheels are not steered."""
        if motion in STEERING:
            with Validator(self.heading) as given:
                self.refuse_unsteered(given, f"the motion {motion!r}")

    def refuse_of_steering(self, names: Iterable[str]) -> None:
        """Raise an `InputError` for characteristics that only a steered wheel has."""
        del names

    def refuse_unsteered(self, given: Validator, what: str) -> None:
        """Refuse an option of the steering if its wheels are not steered."""
        if not self.steered:
            given.fail(NOT_STEERED.format(what))

    def refuse_positions(self, given: Validator, motion: str, along: Array) -> None:
        """Refuse positions that a motion does not have, for any range of the wheels."""
        del given, motion, along

    @property
    def steering_motion(self) -> str | None:
        """The motion in which the steering moves, if it has one."""
        return None

    # -- its characteristics ----------------------------------------------------------------------

    @abstractmethod
    def measures(self, motion: str) -> tuple[Measure, ...]:
        """Return its characteristics over a motion."""

    @abstractmethod
    def kinematics(self, position: RigPosition) -> Any:
        """Return positions and first derivatives of the wheels, for the formulas of its measures.

        Raises `PositionError` if a position is out of reach, with the range; `InputError` if it
        does not move with rigid joints, or a drop link does not reach.
        """

    def values(
        self, motion: str, along: Array, names: Container[str] | None = None
    ) -> dict[str, Array]:
        """Return all or some characteristics over a motion, by the names of their columns.

        `along` are values of `RigMotion.along`, (n,); `names` are those of columns: ``camber``, of
        an axle ``camber_left``. Values have the shape (n,), SI units.
        """
        of = self.kinematics(self.position(motion, along))
        return values(self.measures(motion), of, self.wheels, names)

    # -- its equations of motion ------------------------------------------------------------------

    @property
    @abstractmethod
    def coordinates(self) -> tuple[str, ...]:
        """The states that move the wheels up and down, by name."""

    @abstractmethod
    def names_of(self, wheel: str) -> WheelNames:
        """Return the names of a wheel in the equations."""

    def at_rest(self, coordinates: Array, rack: Array | float) -> tuple[Array, Array]:
        """Return states and inputs with zero rates, (..., states) and (..., inputs).

        `coordinates` has the shape (..., coordinates); `rack` is the displacement of a rack, or
        those of all states [m].
        """
        model, lead = self.model, coordinates.shape[:-1]
        states = np.broadcast_to(model.design_state, (*lead, model.design_state.size)).copy()
        states[..., [model.state_names.index(name) for name in self.coordinates]] = coordinates
        inputs = np.zeros((*lead, len(model.input_names)))
        if self.steered:
            inputs[..., model.input_names.index("rack_position")] = rack
        return states, inputs

    def require_rigid_motion(self) -> None:  # noqa: B027 (most have nothing to refuse)
        """Raise an `InputError` if it cannot move with rigid joints."""

    @abstractmethod
    def coordinates_at(self, position: RigPosition) -> Array:
        """Return the coordinates with rigid joints at positions of a rig, (n, coordinates).

        Raises `PositionError` if a position is out of reach; the message states the range.
        """

    @abstractmethod
    def coordinates_at_rest(self, held: RestConditions) -> Array:
        """Return the coordinates of the stable state of rest, shape (coordinates,).

        Raises `PositionError` if there is none.
        """

    # -- bushes -----------------------------------------------------------------------------------

    def with_bushings(self, bushings: Mapping[str, Any]) -> Any:
        """Return its subject with other bushes than those of its file, see `bushes`."""
        return self.subject.with_changes({"bushings": dict(bushings)})

    # -- its summary ------------------------------------------------------------------------------

    MODES: ClassVar[Mapping[str, str]] = {}
    """Coordinates of both wheels together, and the names of their modes on the tyres."""

    @property
    def heading(self) -> str:
        """Its name, as the beginning of a heading."""
        return str(self.subject.heading())

    @property
    def corners(self) -> Mapping[str, Model]:
        """The models of independent wheels; one for two mirror images."""
        return {}

    def plausibility(self) -> Plausibility:
        """Return its unlikely values, except those of its corners."""
        return Plausibility((), ())

    def described(self) -> dict[str, str]:
        """Return its data at design as text, by heading, except those of its corners."""
        return {}

    def reach(self) -> dict[str, tuple[float, bool]]:
        """Return the travel of both wheels, 'down' and 'up' [m], and whether it is limited."""
        return {}

    @abstractmethod
    def without_friction(self) -> "Assembly":
        """Return the assembly without friction.

        Raises `InputError` if it moves only on its bushes.
        """


class HeldAssembly(Assembly):
    """An assembly whose body is held: a corner, an axle, or an axle without sides."""

    PARTS: ClassVar[Any]  # the class of a group of its parts

    # -- its parts ---------------------------------------------------------------------------------

    @property
    def held_parts(self) -> "Mapping[str, HeldAssembly]":
        """Itself."""
        return {"": self}

    @abstractmethod
    def coordinates_of(self, suffix: str) -> dict[str, str]:
        """Return the names of the coordinates of a group, by its states in `poses`."""

    @abstractmethod
    def joints(self, suffix: str) -> tuple[str, ...]:
        """Return the moving hardpoints of a group of parts, by their names in `poses`."""

    def coordinates_at(self, position: RigPosition) -> Array:
        found = [
            poses.states[..., poses.model.state_names.index(state)]
            for suffix, poses in self.poses(position).items()
            for state in self.coordinates_of(suffix)
        ]
        return np.stack(found, axis=-1)

    @abstractmethod
    def wheel_equations(self, wheel: str) -> tuple[Any, str, Mapping[str, str]]:
        """Return equations in which a wheel moves and the body is held, with their names for it.

        These are the model, the prefix of the names of the wheel's signals there, and the
        coordinates that move it there with their names in `coordinates`.
        """

    @abstractmethod
    def poses(self, position: RigPosition) -> dict[str, PartPoses]:
        """Return the parts with rigid joints, by the suffixes of their names.

        Raises `PositionError` if a position is out of reach, with the range; `InputError` if a drop
        link does not reach.
        """

    @abstractmethod
    def soft_lines(self, poses: Mapping[str, PartPoses]) -> dict[str, SoftLines]:
        """Return the deflections of springs and stops for a unit force along each.

        Raises `InputError` if the springs have no positive rate at the wheel there.
        """

    # -- its equilibrium ---------------------------------------------------------------------------

    ENDS: ClassVar[str] = "the linkage reaches no farther"
    """The reason for the end of the wheels' travel, for a sentence."""

    @property
    def independent(self) -> Sequence["HeldAssembly"]:
        """The assemblies that rest independently of each other, in the order of the wheels."""
        return (self,)

    @property
    @abstractmethod
    def design_wheel_coordinates(self) -> Array:
        """The coordinates at design, see `at_wheel_coordinates`."""

    @abstractmethod
    def wheel_coordinates(self, travels: Sequence[float | None], rack: float) -> Array:
        """Return the coordinates for heights of the wheels above design, (wheels,).

        `travels` are by wheel [m], None for the design position; `rack` is the displacement of the
        rack [m]. Raises `PositionError` if a wheel cannot be there.
        """

    @abstractmethod
    def wheel_reach(self, rack: float) -> Sequence[WheelReach] | None:
        """Return the range of each wheel; None if it depends on the other wheel.

        Wheels with a range each belong to different groups of `poses`, which only the bar joins.

        Raises `PositionError` if the rack [m] cannot be there.
        """

    @abstractmethod
    def at_wheel_coordinates(self, coordinates: Array, racks: Array) -> dict[str, PartPoses]:
        """Return the parts at rest, by the suffixes of their names.

        `coordinates`, (n, wheels), has one for each wheel, which increases as the wheel rises;
        `racks` are displacements of the rack, (n,) [m].
        """

    def has_stop(self, wheel: str, which: Literal["bump_stop", "rebound_stop"]) -> bool:
        """Return whether a wheel has a stop."""
        return getattr(self.wheeled[self.wheels.index(wheel)], which) is not None

    def reached(self, coordinates: Array, racks: Array) -> NDArray[np.bool_]:
        """Return whether the loops close, for wheels within the range of each, (n,)."""
        return np.ones(len(coordinates), dtype=bool)

    def locked(self, coordinates: Array, racks: Array) -> NDArray[np.bool_]:
        """Return whether a linkage is at the end of its range, where it carries any load, (n,)."""
        return np.zeros(len(coordinates), dtype=bool)

    # -- loads -------------------------------------------------------------------------------------

    def torque_on(self, what: Literal["brakes", "drive"]) -> TorqueReaction | None:
        """Return the part that reacts the torque of brakes or drive; None without a drive."""
        part = getattr(self.subject, what)
        return None if part is None else part.torque_on

    @property
    @abstractmethod
    def rules(self) -> tuple[str, ...]:
        """The assumptions that resolve statical indeterminacy, as sentences."""

    def acting(self, poses: Mapping[str, PartPoses]) -> dict[str, list[Load]]:
        """Return weights, and forces of springs, dampers, stops and of an anti-roll bar."""
        return {suffix: known(each) for suffix, each in poses.items()}

    def between(
        self, poses: Mapping[str, PartPoses], loads: Sequence[Load]
    ) -> tuple[list[Load], dict[str, BodyPose]]:
        """Return the loads on the parts between groups and chassis, and poses of these by part.

        The parts are rack and anti-roll bar. `poses` are by suffix; `loads` are all others, with
        the suffixes in their names.
        """
        return [], {}

    def further(
        self, over: str, poses: Mapping[str, PartPoses], found: "xr.Dataset"
    ) -> "dict[str, xr.Variable]":
        """Return further results: forces of rack and rods, torque of the bar.

        `over` is the dimension of the positions, and `found` has the loads.
        """
        if self.bar is None:
            return {}
        words = f"torque of the anti-roll bar, {self.BAR_SIGN}"
        return {"bar_torque": variable(over, self.bar_torque(poses), words, "N m")}

    def in_motion(
        self, states: Array, inputs: Array
    ) -> tuple[dict[str, PartPoses], dict[str, Array]]:
        """Return the parts in states of the equations, and the rates of these, by suffix."""
        rates = self.model.evaluate("rhs", states, inputs)
        return {"": self.PARTS.of(self.model, states, inputs)}, {"": rates}

    def parts_with(self, values: Mapping[str, Array], count: int) -> dict[str, PartPoses]:
        """Return the parts in chassis axes, by suffix, at `count` positions.

        `values` are states and inputs by their names in the equations, (count,); others are zero.
        """
        return {"": self.PARTS.of(self.model, *states_with(self.model, values, count))}

    # -- bushes ------------------------------------------------------------------------------------

    @abstractmethod
    def bushes(self, given: Validator, bushings: Mapping[str, Any] | None) -> Bushings:
        """Return the bushes described by hardpoint in `bushings`, or those of the file.

        Those of an axle describe one side, and are mirrored for the other one.
        """

    # -- the coupling of the wheels ----------------------------------------------------------------

    BAR_SIGN: ClassVar[str] = ""
    """The sign of the torque of the anti-roll bar."""

    @property
    def bar(self) -> AnyBar | None:
        """The anti-roll bar, if it has one."""
        return None

    def bar_loads(self, poses: Mapping[str, PartPoses]) -> dict[str, list[Load]]:
        """Return the loads of a unit torque of the bar on each group; empty without a bar."""
        return {}

    def bar_twist(self, poses: Mapping[str, PartPoses]) -> dict[str, Array]:
        """Return the part of each group in the twist of the bar, (n,) [rad]; empty without one."""
        return {}

    def bar_torque(self, poses: Mapping[str, PartPoses]) -> Array:
        """Return the torque of the bar with rigid joints, (n,) [N m]; zero without one."""
        twist = sum(
            self.bar_twist(poses).values(), np.zeros(len(next(iter(poses.values())).states))
        )
        return twist if self.bar is None else self.bar.torque(twist)
