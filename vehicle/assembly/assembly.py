"""The protocol that every analysis is written for: an assembly has wheels."""

from abc import ABC, abstractmethod
from collections.abc import Container, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from ...core.quantities import variable
from ...core.validator import Validator
from ..corner.bushes import Bush
from ..corner.corner import Array
from ..input.vehicle import TyreSection
from ..models.axle.file import TorqueReaction
from ..models.model import Model
from ..models.plausibility import Plausibility
from .anti_roll_bar import AnyBar
from .coupling import BodyPose
from .held import RestConditions
from .load import Load, known
from .measures.measure import Measure, values
from .part_poses import PartPoses
from .quantity import RACK, Quantity
from .rig import RigMotion, RigPosition, SweepRange, WheelReach
from .soft_lines import SoftLines
from .wheel_names import WheelNames

if TYPE_CHECKING:
    import xarray as xr


NOT_A_CAR = (
    "this is a whole car, and a suspension or an axle is needed. Give "
    'car.axles["front"], car.axles["rear"] or car.corner; at the command line, the file of an axle '
    "or a corner."
)
"""The message if a car is given where a suspension or an axle is needed."""


@dataclass(frozen=True)
class Bushings:
    """The bushes of an assembly, and how far its rack deflects.

    Attributes
    ----------
    by_suffix : mapping of str to list of Bush
        By the suffix of the names of the parts that they connect, as in `HeldAssembly.poses`.
    rack : float
        Displacement of the rack along its axis by a unit force [m/N]; zero where it is held.
    """

    by_suffix: Mapping[str, list[Bush]]
    rack: float

    @property
    def every(self) -> list[Bush]:
        """All bushes."""
        return [bush for bushes in self.by_suffix.values() for bush in bushes]


class Assembly(ABC):
    """A corner, an axle, a rigid axle or a car.

    All but a car are a `HeldAssembly`; the parts and bushes of a car are those of its axles.

    Its parts may be in several groups that only an anti-roll bar and a rack join, as the two sides
    of an axle are: the members of a group are by the suffix of the names of its parts, ``""``,
    ``"_left"`` or ``"_right"``.

    Attributes
    ----------
    wheels : tuple of str
        The names of the wheels, 'left' and 'right', or the side of a corner; those of the groups
        in turn.
    motions : mapping of str to RigMotion
        What a rig can do with it, the usual motion first.
    model : Model, AxleModel or RigidAxleModel
        Its equations of motion; those of an axle are derived and compiled when they are first
        needed.
    """

    wheels: tuple[str, ...]
    motions: Mapping[str, RigMotion]
    model: Any

    NEEDED: ClassVar[str] = (
        "a kintrafo.Suspension or Model, an Axle, or a RigidAxle is needed; "
        "kintrafo.load reads each of them"
    )

    # -- what it is -------------------------------------------------------------------------------

    @property
    @abstractmethod
    def subject(self) -> Any:
        """What was read from a file: a Suspension, an Axle or a RigidAxle."""

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
    @abstractmethod
    def steered(self) -> bool:
        """Whether it has a rack."""

    @property
    @abstractmethod
    def tyres(self) -> Sequence[TyreSection]:
        """The tyres, by wheel."""

    @property
    @abstractmethod
    def tyre_radii(self) -> Sequence[float | None]:
        """The radii of the wheels as thin discs [m]; None where nothing says it."""

    @property
    def axles(self) -> tuple[str, ...]:
        """The ends at which a car has axles, which have measures of their own."""
        return ()

    @property
    def held_parts(self) -> "Mapping[str, Assembly]":
        """The assemblies whose body is held that make it, by name: itself, without one."""
        return {"": self}

    @property
    def body_moves(self) -> bool:
        """Whether the vehicle's body moves in its equations, or is held."""
        return False

    @property
    def drives(self) -> bool:
        """Whether it is a car that drives on tyres that roll."""
        return False

    @property
    def moves_rigidly(self) -> bool:
        """Whether it moves with rigid joints: five rods hold a rigid axle."""
        return True

    @property
    def simplified(self) -> Sequence[str]:
        """What linear compliance leaves out, in words."""
        return ()

    @property
    def on_a_beam(self) -> bool:
        """Whether one body carries both wheels, so that it has a steer angle of its own."""
        return False

    @property
    def usual_motion(self) -> str:
        """The motion of a rig in which all wheels rise and fall together."""
        return next(iter(self.motions))

    @property
    def symmetric(self) -> bool:
        """Whether one side is the mirror image of the other."""
        return True

    @property
    @abstractmethod
    def words(self) -> str:
        """What it is, in sentences."""

    @property
    def own_sections(self) -> Mapping[str, Any]:
        """What its own file says besides the files of its sides, by section; of an axle."""
        return {}

    # -- where a rig holds it ---------------------------------------------------------------------

    @abstractmethod
    def usual(
        self,
        motion: str,
        extent: SweepRange | None = None,
        *,
        travel: float = 0.0,
        rack: float = 0.0,
    ) -> Array:
        """Return the usual positions of a motion, zero included, in SI units.

        Parameters
        ----------
        motion : str
        extent : SweepRange, optional
            How far it goes, where that is not the usual.
        travel, rack : float, optional
            What is held meanwhile [m].
        """

    @abstractmethod
    def position(
        self, motion: str, along: Array, *, travel: float = 0.0, rack: float = 0.0
    ) -> RigPosition:
        """Return where wheels and rack are along a motion.

        Parameters
        ----------
        motion : str
        along : ndarray, shape (n,)
            What varies, see `RigMotion`.
        travel : float, optional
            Height of the wheels above design where the motion is one of the steering [m].
        rack : float, optional
            Displacement of the rack in other motions [m].

        Raises
        ------
        PositionError
            If a position is out of reach.
        """

    def at_travel(self, travels: Array, rack: Array | float = 0.0) -> RigPosition:
        """Return where all wheels are at some heights above design [m], in parallel."""
        return RigPosition(dict.fromkeys(self.wheels, travels), np.asarray(rack, float))

    def held_in(self, motion: str, travel: float, rack: float) -> dict[Quantity, float]:
        """Return what a motion holds, for the coordinates of its results."""
        del motion, travel
        return {RACK: rack} if self.steered else {}

    @abstractmethod
    def refuse_holding(self, given: Validator, motion: str, travel: float, rack: float) -> None:
        """Refuse what cannot be held in a motion: a travel, or a rack that it moves itself."""

    def refuse_motion(self, motion: str) -> None:
        """Refuse a motion that it does not have, with the reason where there is one.

        Raises
        ------
        InputError
        """
        del motion

    def refuse_of_steering(self, names: Iterable[str]) -> None:
        """Refuse characteristics that it does not have because nothing steers it.

        Raises
        ------
        InputError
        """
        del names

    def refuse_positions(self, given: Validator, motion: str, along: Array) -> None:
        """Refuse positions that a motion does not have, for any reach of the wheels."""
        del given, motion, along

    @property
    def steered_by(self) -> str | None:
        """The motion in which the steering moves, if it has one."""
        return None

    # -- what it is measured by -------------------------------------------------------------------

    @abstractmethod
    def measures(self, motion: str) -> tuple[Measure, ...]:
        """Return its characteristics over a motion."""

    @abstractmethod
    def kinematics(self, position: RigPosition) -> Any:
        """Return what the formulas of its measures take: how wheels are and how they move first.

        Raises
        ------
        PositionError
            If a position is out of reach; the message states the range.
        InputError
            If it does not move with rigid joints, or a drop link does not reach.
        """

    def values(
        self, motion: str, along: Array, names: Container[str] | None = None
    ) -> dict[str, Array]:
        """Return characteristics over a motion by the names of their columns, all or some.

        Parameters
        ----------
        motion : str
        along : ndarray, shape (n,)
            As of `position`.
        names : container of str, optional
            Of columns: ``camber``, of an axle ``camber_left``.

        Returns
        -------
        dict of str to ndarray, each of shape (n,)
            SI units.
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
        """Return what the equations call what belongs to a wheel."""

    def at_rest(self, coordinates: Array, rack: float) -> tuple[Array, Array]:
        """Return states and inputs without rates, (..., states) and (..., inputs).

        Parameters
        ----------
        coordinates : ndarray, shape (..., coordinates)
        rack : float
            Displacement of the rack, if there is one [m].
        """
        model, lead = self.model, coordinates.shape[:-1]
        states = np.broadcast_to(model.design_state, (*lead, model.design_state.size)).copy()
        states[..., [model.state_names.index(name) for name in self.coordinates]] = coordinates
        inputs = np.zeros((*lead, len(model.input_names)))
        if self.steered:
            inputs[..., model.input_names.index("rack_position")] = rack
        return states, inputs

    def require_rigid_motion(self) -> None:  # noqa: B027 (most have nothing to refuse)
        """Refuse an assembly that cannot move with rigid joints.

        Raises
        ------
        InputError
        """

    @abstractmethod
    def coordinates_at(self, position: RigPosition) -> Array:
        """Return the coordinates with rigid joints at positions of a rig, (n, coordinates).

        Raises
        ------
        PositionError
            If a position is out of reach; the message states the range.
        """

    @abstractmethod
    def coordinates_at_rest(self, held: RestConditions) -> Array:
        """Return the coordinates of the stable state of rest, shape (coordinates,).

        Raises
        ------
        PositionError
            If there is none.
        """

    def refuse_unsteered(self, what: str) -> None:
        """Refuse what moves a rack where there is none.

        Raises
        ------
        InputError
            That says so of the kind of suspension.
        """
        del what

    # -- bushes -----------------------------------------------------------------------------------

    @property
    @abstractmethod
    def has_bushes(self) -> bool:
        """Whether its file has bushes."""

    def with_bushings(self, bushings: Mapping[str, Any]) -> Any:
        """Return its subject on other bushes than those of its file, see `bushes`."""
        return self.subject.with_changes({"bushings": dict(bushings)})

    # -- its summary ------------------------------------------------------------------------------

    MODES: ClassVar[Mapping[str, str]] = {}
    """Coordinates of both wheels together, and the names of their modes on the tyres."""

    @property
    @abstractmethod
    def heading(self) -> str:
        """Its name, as the beginning of a heading."""

    @property
    def corners(self) -> Mapping[str, Model]:
        """The models of independent wheels; one for two mirror images."""
        return {}

    def plausibility(self) -> Plausibility:
        """Return its unlikely values, except those of its corners."""
        return Plausibility((), ())

    def described(self) -> dict[str, str]:
        """Return its data at design in words, by their headings, except those of its corners."""
        return {}

    def reach(self) -> dict[str, tuple[float, bool]]:
        """Return the travel of both wheels, 'down' and 'up' [m], and whether it is limited."""
        return {}

    @abstractmethod
    def without_friction(self) -> "Assembly":
        """Return the same without friction.

        Raises
        ------
        InputError
            If it moves only on its bushes.
        """


class HeldAssembly(Assembly):
    """An assembly whose body is held: a corner, an axle, or an axle without sides."""

    # -- its parts ---------------------------------------------------------------------------------

    @abstractmethod
    def coordinates_of(self, suffix: str) -> dict[str, str]:
        """Return the names of the coordinates of a group, by its states in `poses`."""

    @abstractmethod
    def joints(self, suffix: str) -> tuple[str, ...]:
        """Return the moving hardpoints of a group of parts, by their names in `poses`."""

    def coordinates_at(self, position: RigPosition) -> Array:
        """Return the coordinates with rigid joints at positions of a rig, (n, coordinates)."""
        found = [
            poses.states[..., poses.model.state_names.index(state)]
            for suffix, poses in self.poses(position).items()
            for state in self.coordinates_of(suffix)
        ]
        return np.stack(found, axis=-1)

    @abstractmethod
    def wheel_equations(self, wheel: str) -> tuple[Any, str, Mapping[str, str]]:
        """Return equations in which a wheel moves on a body that is held.

        Returns
        -------
        model : Model or WholeAxleModel
        signals : str
            Prefix of the names of the wheel's signals there.
        names : mapping of str to str
            The coordinates that move it there, and their names in `coordinates`.
        """

    @abstractmethod
    def poses(self, position: RigPosition) -> dict[str, PartPoses]:
        """Return its parts with rigid joints, by the suffixes of their names.

        Raises
        ------
        PositionError
            If a position is out of reach; the message states the range.
        InputError
            If a drop link does not reach.
        """

    @abstractmethod
    def soft_lines(self, poses: Mapping[str, PartPoses]) -> dict[str, SoftLines]:
        """Return how springs and stops deflect for a unit force along each.

        Raises
        ------
        InputError
            If the springs hold no wheel there.
        """

    # -- where it rests ----------------------------------------------------------------------------

    ENDS: ClassVar[str] = "the linkage reaches no farther"
    """The end of the wheels' travel, in words."""

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
        """Return the coordinates where some wheels are at heights above design.

        Parameters
        ----------
        travels : sequence of float or None
            By wheel [m]; None: as at design.
        rack : float
            Displacement of the rack [m].

        Returns
        -------
        ndarray, shape (wheels,)

        Raises
        ------
        PositionError
            If a wheel cannot be there.
        """

    @abstractmethod
    def wheel_reach(self, rack: float) -> Sequence[WheelReach] | None:
        """Return how far each wheel goes; None where it depends on the other one.

        Several wheels that have a reach each are groups of their own in `poses`, which nothing but
        the bar joins.

        Raises
        ------
        PositionError
            If the rack [m] cannot be there.
        """

    @abstractmethod
    def at_wheel_coordinates(self, coordinates: Array, racks: Array) -> dict[str, PartPoses]:
        """Return its parts at rest, by the suffixes of their names.

        Parameters
        ----------
        coordinates : ndarray, shape (n, wheels)
            One for each wheel, which increases as the wheel rises.
        racks : ndarray, shape (n,)
            Displacements of the rack [m].
        """

    @abstractmethod
    def has_stop(self, wheel: str, which: Literal["bump_stop", "rebound_stop"]) -> bool:
        """Return whether a wheel has a stop."""

    def reached(self, coordinates: Array, racks: Array) -> NDArray[np.bool_]:
        """Return where parts within the reach of each wheel are together, (n,)."""
        del racks
        return np.ones(len(coordinates), dtype=bool)

    def locked(self, coordinates: Array) -> NDArray[np.bool_]:
        """Return where a linkage is so near the end of its reach that it carries anything, (n,)."""
        return np.zeros(len(coordinates), dtype=bool)

    # -- loads -------------------------------------------------------------------------------------

    def torque_on(self, what: Literal["brakes", "drive"]) -> TorqueReaction | None:
        """Return the part that reacts the torque of brakes or drive; None without a drive."""
        return "carrier" if what == "brakes" else "body"

    @property
    @abstractmethod
    def rules(self) -> tuple[str, ...]:
        """What decides where statics alone does not."""

    def acting(self, poses: Mapping[str, PartPoses]) -> dict[str, list[Load]]:
        """Return weights, and forces of springs, dampers, stops and of an anti-roll bar."""
        return {suffix: known(each) for suffix, each in poses.items()}

    def between(
        self, poses: Mapping[str, PartPoses], loads: Sequence[Load]
    ) -> tuple[list[Load], dict[str, BodyPose]]:
        """Return the loads on what is between the groups and the chassis: rack, anti-roll bar.

        Parameters
        ----------
        poses : mapping
            By suffix.
        loads : sequence of Load
            All others, with the suffixes in their names.

        Returns
        -------
        loads : list of Load
        places : dict of str to BodyPose
            These parts.
        """
        del poses, loads
        return [], {}

    def further(
        self, over: str, poses: Mapping[str, PartPoses], found: "xr.Dataset"
    ) -> "dict[str, xr.Variable]":
        """Return what follows from all loads: forces of rack and rods, torque of the bar.

        Parameters
        ----------
        over : str
            Dimension of the positions.
        poses : mapping
        found : xarray.Dataset
            The loads.
        """
        del found
        if self.bar is None:
            return {}
        words = f"torque of the anti-roll bar, {self.BAR_SIGN}"
        return {"bar_torque": variable(over, self.bar_torque(poses), words, "N m")}

    @abstractmethod
    def in_motion(
        self, states: Array, inputs: Array
    ) -> tuple[dict[str, PartPoses], dict[str, Array]]:
        """Return its parts in states of its equations, and the rates of these, by suffix."""

    @abstractmethod
    def parts_with(self, values: Mapping[str, Array], count: int) -> dict[str, PartPoses]:
        """Return its parts in its own axes, by suffix.

        Parameters
        ----------
        values : mapping of str to ndarray
            States and inputs by their names in its equations, (count,); others are zero.
        count : int
            Of positions.
        """

    # -- bushes ------------------------------------------------------------------------------------

    @abstractmethod
    def bushes(self, given: Validator, bushings: Mapping[str, Any] | None) -> Bushings:
        """Return bushes as a caller describes them, or those of the file.

        Parameters
        ----------
        given : Validator
            Gets what is wrong.
        bushings : mapping or None
            By hardpoint; of an axle those of one side, and the other has their image.
        """

    # -- the coupling of the wheels ----------------------------------------------------------------

    BAR_SIGN: ClassVar[str] = ""
    """When the torque of the anti-roll bar is positive."""

    @property
    def bar(self) -> AnyBar | None:
        """The anti-roll bar, if it has one."""
        return None

    def bar_loads(self, poses: Mapping[str, PartPoses]) -> dict[str, list[Load]]:
        """Return what a unit torque of the bar does to each group; empty without a bar."""
        del poses
        return {}

    def bar_twist(self, poses: Mapping[str, PartPoses]) -> dict[str, Array]:
        """Return what each group adds to the twist of the bar, (n,) [rad]; empty without one."""
        del poses
        return {}

    def bar_torque(self, poses: Mapping[str, PartPoses]) -> Array:
        """Return the torque of the bar with rigid joints, (n,) [N m]; zero without one."""
        twist = sum(
            self.bar_twist(poses).values(), np.zeros(len(next(iter(poses.values())).states))
        )
        return twist if self.bar is None else self.bar.torque(twist)
