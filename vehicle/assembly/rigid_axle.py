"""A rigid axle as an assembly: one beam carries both wheels."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from ...core.arguments import Arguments
from ...core.quantities import variable
from ..corner.bushes import described_bushings
from ..corner.corner import Array
from ..input.vehicle import Tyre
from ..models.axle.file import TorqueReaction
from ..models.plausibility import Plausibility
from ..models.reach import PositionError
from ..models.rigid.axle import RigidAxle
from ..models.rigid.model import HEAVE, ROLL, RigidAxleModel
from ..models.rigid.plausibility import plausibility
from ..models.rigid.structure import BEAM
from ..models.sides import SIDES
from .anti_roll_bar import RollBar
from .assembly import Assembly, Bushings
from .axle import motions_of_two
from .held import RestConditions
from .load import Load
from .measures.measure import Measure
from .measures.rigid_axle import MEASURES
from .motions import MOTIONS, USUAL_ROLL, USUAL_ROLL_STEP
from .part_poses import PartPoses
from .rest import settled
from .rig import RigPosition, SweepRange
from .rigid_axle_kinematics import RigidAxleKinematics
from .rigid_axle_parts import RigidAxleParts
from .soft_lines import SoftLines, lines_by_rates, lines_of_beam
from .usual import USUAL_TRAVEL, grid
from .wheel_names import WheelNames

if TYPE_CHECKING:
    import xarray as xr

# What each wheel travels per metre of what varies; in roll it is the half track times the sine.
_SHARES = {"bump": (1.0, 1.0), "left": (1.0, 0.0), "right": (0.0, 1.0)}
_MOST_ROLL = np.pi / 4.0
# A sweep that is not told otherwise keeps clear of the ends of the motion by this part of them.
_CLEARANCE = 0.02
# So far both wheels are moved when its reach is looked for [m].
_FAR = 0.4
_NO_REST = (
    "the axle has no stable equilibrium near its design position. Check the springs' rate and "
    "free length, the tyres' rate and free height, the load of the wheels, or the road."
)
# Where the axle stands under a load, it could go as many times as far.
_CLEAR = 1.02


class RigidAxleAssembly(Assembly):
    """A rigid axle.

    Parameters
    ----------
    axle : RigidAxle
    model : RigidAxleModel, optional
        Its equations, where there are some already.
    """

    wheels = SIDES
    ENDS = (
        "a rod or a damper reaches no farther, or a spring or a damper has turned by a right angle"
    )
    motions = motions_of_two(MOTIONS)
    MODES: ClassVar[Mapping[str, str]] = {HEAVE: "axle hop", ROLL: "axle tramp"}
    BAR_SIGN = "positive with the left wheel up"

    def __init__(self, axle: RigidAxle, model: RigidAxleModel | None = None) -> None:
        self.axle = axle
        self.model = RigidAxleModel(axle, guided=axle.overheld) if model is None else model

    @property
    def subject(self) -> RigidAxle:
        """The axle."""
        return self.axle

    @property
    def steered(self) -> bool:
        """No rack steers it."""
        return False

    @property
    def tyres(self) -> Sequence[Tyre]:
        """The tyres."""
        return [self.axle.tyre] * len(SIDES)

    @property
    def tyre_radii(self) -> Sequence[float | None]:
        """The radii of the wheels [m]."""
        return [self.axle.tyre_radius()] * len(SIDES)

    @property
    def has_bushes(self) -> bool:
        """Whether its file has bushes."""
        return bool(self.axle.bushings)

    @property
    def moves_rigidly(self) -> bool:
        """Whether it moves with rigid joints: five rods let it move only by their bushes."""
        return not self.axle.overheld

    @property
    def simplified(self) -> Sequence[str]:
        """What linear compliance leaves out of an axle on five rods, in words."""
        if not self.axle.overheld:
            return ()
        (fifth,) = {*self.axle.rods} - {*self.axle.guides}
        return "what springs do as they turn", f"what {fifth} does to where the axle is"

    @property
    def on_a_beam(self) -> bool:
        """One body carries both wheels."""
        return True

    @property
    def words(self) -> str:
        """What it is, in a sentence."""
        rods = ", ".join(self.axle.rods).replace("_", " ")
        return f"A {self.axle.heading()} on {len(self.axle.rods)} rods, {rods}."

    def usual(
        self,
        motion: str,
        extent: SweepRange | None = None,
        *,
        travel: float = 0.0,
        rack: float = 0.0,
    ) -> Array:
        """Return the usual positions of a motion, zero included [m] or [rad]."""
        del travel, rack
        far = extent or SweepRange()
        if motion == "roll":
            with Arguments("roll") as given:
                amount = 0.0 if far.roll is None else far.roll
                given.number("roll", amount, "rad", least=0.0, below=_MOST_ROLL)
            most = self._ends(motion, USUAL_ROLL) if far.roll is None else [-amount, amount]
            both = min(-most[0], most[1])
            return grid(-both, both, USUAL_ROLL_STEP)
        with Arguments("wheel travel") as given:
            for name in ("rebound", "bump"):
                value = getattr(far, name)
                given.number(name, 0.0 if value is None else value, "m", least=0.0)
        low, high = self._ends(motion, USUAL_TRAVEL)
        low = low if far.rebound is None else -far.rebound
        high = high if far.bump is None else far.bump
        return grid(low, high, far.step)

    def _ends(self, motion: str, most: float) -> list[float]:
        """Return how far a motion goes either way, at most so far and clear of its ends."""
        ends = []
        for value in (-most, most):
            left, right = self._travels(motion, np.array(value))
            part = self.model.farthest(float(left), float(right))
            ends.append(value if part == 1.0 else (1.0 - _CLEARANCE) * part * value)
        return ends

    def _travels(self, motion: str, along: Array) -> tuple[Array, Array]:
        """Return the travels of the left and the right wheel along a motion [m]."""
        if motion == "roll":
            half = self.axle.half_track * np.sin(along)
            return -half, half
        left, right = _SHARES[motion]
        return left * along, right * along

    def position(
        self, motion: str, along: Array, *, travel: float = 0.0, rack: float = 0.0
    ) -> RigPosition:
        """Return where the wheels are along a motion."""
        del travel, rack
        if motion == "roll" and np.abs(along).max(initial=0.0) >= _MOST_ROLL:
            worst = np.degrees(np.abs(along).max())
            message = f"roll of {worst:.4g} deg: less than 45 deg is needed; Python's unit is rad."
            raise PositionError(message)
        travels = self._travels(motion, along)
        return RigPosition(dict(zip(SIDES, travels, strict=True)), np.zeros(()))

    def refuse_holding(self, given: Arguments, motion: str, travel: float, rack: float) -> None:
        """Refuse a travel that is for steering, and a rack."""
        if rack:
            given.refuse("rack_position: a rigid axle has no rack. Leave it out.")
        if travel:
            given.refuse(f"travel: the motion {motion!r} moves the wheels by along. Leave it out.")

    @property
    def coordinates(self) -> tuple[str, ...]:
        """Heave and roll of the axle."""
        return HEAVE, ROLL

    def names_of(self, wheel: str) -> WheelNames:
        """Return what its equations call what belongs to a wheel."""
        prefix = f"{wheel}_"
        return WheelNames(
            prefix, f"{prefix}axle_", f"{prefix}spin_angle", f"{prefix}spring_actuator"
        )

    def coordinates_at_rest(self, held: RestConditions) -> Array:
        """Return heave and roll of the state of rest near the design position [m] and [rad]."""
        heave, roll = found = settled(self, held, np.zeros(2), _NO_REST)
        rise = self.axle.half_track * np.sin(roll)
        if self.model.farthest(heave + rise, heave - rise) < 1.0:
            raise PositionError(_NO_REST)
        return found

    def coordinates_of(self, suffix: str) -> dict[str, str]:
        """Return what heave and roll are called."""
        del suffix
        return {HEAVE: HEAVE, ROLL: ROLL}

    def joints(self, suffix: str) -> tuple[str, ...]:
        """Return the ends of rods and the seats on the axle."""
        del suffix
        ends = [f"{name}_axle" for name in self.axle.rods]
        own = [name for name in self.axle.points(SIDES[0]) if not name.endswith("_top")]
        return (*ends, *(f"{name}_{side}" for name in own for side in SIDES))

    def measures(self, motion: str) -> tuple[Measure, ...]:
        """Return its characteristics, the same over all motions."""
        del motion
        return MEASURES

    def kinematics(self, position: RigPosition) -> RigidAxleKinematics:
        """Return how the axle is and how it moves first."""
        model = self.model if self.moves_rigidly else RigidAxleModel(self.axle)
        return RigidAxleKinematics(
            model, model.states_at(*(position.travels[side] for side in SIDES))
        )

    def poses(self, position: RigPosition) -> dict[str, PartPoses]:
        """Return its parts with rigid joints."""
        left, right = (position.travels[side] for side in SIDES)
        return {"": RigidAxleParts.of(self.model, self.model.states_at(left, right))}

    def soft_lines(self, poses: Mapping[str, PartPoses]) -> dict[str, SoftLines]:
        """Return how springs and stops deflect."""
        beam = RigidAxleKinematics(self.model, poses[""].states)
        return {"": lines_by_rates(beam) if self.axle.overheld else lines_of_beam(beam)}

    def require_rigid_motion(self) -> None:
        """Refuse an axle on five rods."""
        if self.axle.overheld:
            RigidAxleModel(self.axle)

    @property
    def design_wheel_coordinates(self) -> Array:
        """Travels of zero."""
        return np.zeros(len(SIDES))

    def wheel_coordinates(self, travels: Sequence[float | None], rack: float) -> Array:
        """Return the travels, if the axle can be there [m]."""
        del rack
        found = np.array([travel or 0.0 for travel in travels])
        self.model.states_at(*found)
        return found

    def wheel_reach(self, rack: float) -> None:
        """Return None: how far a wheel goes depends on the other one."""
        del rack

    def at_wheel_coordinates(self, coordinates: Array, racks: Array) -> dict[str, PartPoses]:
        """Return its parts at rest; the coordinates are the travels of both wheels [m]."""
        del racks
        return {"": self._parts(coordinates)}

    def _parts(self, travels: Array) -> RigidAxleParts:
        return RigidAxleParts.of(self.model, self.model.placed(*travels.T))

    def reached(self, coordinates: Array, racks: Array) -> NDArray[np.bool_]:
        """Return where its rods and dampers reach, with springs and dampers upright."""
        del racks
        margins = self.model.margins(self.model.placed(*coordinates.T))
        found = np.asarray((margins > 0.0).all(axis=-1))
        found[found] = self._parts(coordinates[found]).upright()
        return found

    def locked(self, coordinates: Array) -> NDArray[np.bool_]:
        """Return where its rods lock, or where it does not come from design."""
        beyond = self.model.parts_of_ways(*coordinates.T) < 1.0
        margins = self.model.margins(self.model.placed(*(_CLEAR * coordinates).T))
        # those of the rods; a damper may be near the end of its length
        closing = margins[:, : len(self.model.equations.GUARDS)]
        return np.asarray(beyond | ~(closing > 0.0).all(axis=-1))

    def has_stop(self, wheel: str, which: Literal["bump_stop", "rebound_stop"]) -> bool:
        """Return whether it has a stop, of both wheels."""
        del wheel
        return getattr(self.axle, which) is not None

    def torque_on(self, what: Literal["brakes", "drive"]) -> TorqueReaction | None:
        """Return what holds the torque of brakes or drive."""
        part = getattr(self.axle, what)
        return None if part is None else part.torque_on

    @property
    def rules(self) -> tuple[str, ...]:
        """Nothing: statics decides all."""
        return ()

    def acting(self, poses: Mapping[str, Any]) -> dict[str, list[Load]]:
        """Return what acts on its parts, and the couple of the anti-roll bar."""
        return {"": poses[""].acting()}

    def further(
        self, over: str, poses: Mapping[str, Any], found: "xr.Dataset"
    ) -> "dict[str, xr.Variable]":
        """Return the forces along the rods, and the torque of the bar."""
        from xarray import Variable  # noqa: PLC0415 (slow to import)

        rods = [*self.axle.rods]
        forces = (found["force"].sel(load=f"{BEAM} at {rod}_axle by {rod}").values for rod in rods)
        pulls = [
            np.einsum("ni,ni->n", force, poses[""].rod(rod))
            for rod, force in zip(rods, forces, strict=True)
        ]
        words = "force along a rod, positive in tension"
        return {
            "rod": Variable("rod", rods),
            "rod_force": variable((over, "rod"), np.stack(pulls, axis=-1), words, "N"),
        } | super().further(over, poses, found)

    def in_motion(
        self, states: Array, inputs: Array
    ) -> tuple[dict[str, PartPoses], dict[str, Array]]:
        """Return its parts in some states, and the rates of these."""
        rates = self.model.evaluate("rhs", states, inputs)
        return {"": RigidAxleParts.of(self.model, states, inputs)}, {"": rates}

    def bushes(self, given: Arguments, bushings: Mapping[str, Any] | None) -> Bushings:
        """Return bushes as a caller describes them, or those of the file."""
        described = described_bushings(given, bushings, self.axle.bushings)
        return Bushings({"": self.axle.bushes(given, described)}, 0.0)

    @property
    def heading(self) -> str:
        """What it is called."""
        return self.axle.heading()

    def plausibility(self) -> Plausibility:
        """Return what is unlikely of its file."""
        return plausibility(self.axle)

    def described(self) -> dict[str, str]:
        """Return its track and its rods in words."""
        rods = ", ".join(
            f"{name.replace('_', ' ')} {1e3 * float(np.linalg.norm(outer - inner)):.1f} mm"
            for name, (inner, outer) in self.axle.ends().items()
        )
        return {"track": f"{2e3 * self.axle.half_track:.4g} mm", "rods": rods}

    def reach(self) -> dict[str, tuple[float, bool]]:
        """Return how far it goes up and down, and whether something ends that."""
        found = {}
        for name, far in (("down", -_FAR), ("up", _FAR)):
            part = self.model.farthest(far, far)
            found[name] = far * part, part < 1.0
        return found

    def without_friction(self) -> "RigidAxleAssembly":
        """Return the same without the friction of its dampers."""
        smooth = self.axle.with_changes({"damper.friction_N": 0.0})
        return RigidAxleAssembly(smooth, RigidAxleModel(smooth))

    @property
    def bar(self) -> RollBar | None:
        """The anti-roll bar, if it has one."""
        if self.axle.anti_roll_bar is None:
            return None
        return RollBar(BEAM, self.model.parameters["bar_rate"])

    def bar_loads(self, poses: Mapping[str, Any]) -> dict[str, Load]:
        """Return the couple of a unit torque of the bar."""
        return {"": poses[""].bar_by_torque()} if self.bar and self.bar.rate else {}

    def bar_twist(self, poses: Mapping[str, Any]) -> dict[str, Array]:
        """Return the roll of the axle, (n,) [rad]."""
        return {"": poses[""].roll}
