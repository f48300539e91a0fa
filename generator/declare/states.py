"""The state of a formulation: positions q, speeds v, internal states z, and their names.

A hinge or a guide has one coordinate and its rate. A body that moves freely has seven positions, of
which four are a unit quaternion, and six speeds in its own axes. Velocities, the mass matrix and
the forces refer to the speeds; positions change by ``q' = N(q) v``, which is ``q' = v`` but for
bodies that move freely (`kinematics.base`). Forces may have internal states, of first order.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from .joints import Free, Joint

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from .internal_states import InternalState
    from .joints import RelativeCoordinate


@dataclass(frozen=True)
class Entry:
    """One element of an array: its name, unit and meaning; of a state, also its value at design.

    That value is a constant: see `equations.design` for values that depend on parameters.
    """

    name: str
    unit: str
    meaning: str
    at_design: int = 0


@dataclass(frozen=True)
class JointStates:
    """The part of the state that belongs to an independent joint."""

    joint: Joint
    # elements of q and of v
    positions: tuple[Entry, ...]
    speeds: tuple[Entry, ...]
    # names under which velocities per unit of each speed are stored: the coordinate of a hinge or a
    # guide; of a free body, which has no such coordinates, the speeds themselves
    coordinates: tuple[str, ...]
    # for each position, the index of the speed that changes it most directly; None for the scalar
    # part of a quaternion
    partners: tuple[int | None, ...]

    @property
    def entries(self) -> tuple[Entry, ...]:
        """Positions, then speeds."""
        return (*self.positions, *self.speeds)


@dataclass(frozen=True)
class DeclaredStates:
    """The state x = [q, v, z] of a formulation."""

    joints: tuple[JointStates, ...]  # part of each independent joint, in their order
    internal: tuple[Entry, ...] = ()  # those of forces
    # names of speeds that constraints determine, and that are not states
    eliminated: tuple[str, ...] = ()

    @classmethod
    def of(
        cls,
        independent: Iterable[Joint],
        coordinates: Sequence[RelativeCoordinate],
        internal: Iterable[InternalState],
        eliminated: tuple[str, ...],
    ) -> DeclaredStates:
        """Return the layout for independent joints, with the names of reported coordinates."""
        joints = tuple(_states_of(joint, coordinates) for joint in independent)
        return cls(joints, tuple(Entry(s.name, s.unit, s.meaning) for s in internal), eliminated)

    @property
    def positions(self) -> tuple[Entry, ...]:
        """The elements of q."""
        return tuple(entry for part in self.joints for entry in part.positions)

    @property
    def speeds(self) -> tuple[Entry, ...]:
        """The elements of v."""
        speeds = (entry for part in self.joints for entry in part.speeds)
        return tuple(entry for entry in speeds if entry.name not in self.eliminated)

    @property
    def entries(self) -> tuple[Entry, ...]:
        """All elements, in the order of the state."""
        return (*self.positions, *self.speeds, *self.internal)

    @property
    def coordinates(self) -> tuple[str, ...]:
        """The coordinates whose rates are the speeds, in their order."""
        return tuple(k for k, name in self.speed_of.items() if name not in self.eliminated)

    @property
    def eliminated_coordinates(self) -> tuple[str, ...]:
        """The coordinates whose rates are the eliminated speeds."""
        return tuple(k for k, name in self.speed_of.items() if name in self.eliminated)

    @property
    def partners(self) -> list[int | None]:
        """For each position, the index of the speed that changes it most directly."""
        places = {entry.name: place for place, entry in enumerate(self.speeds)}
        return [
            None if speed is None else places.get(part.speeds[speed].name)
            for part in self.joints
            for speed in part.partners
        ]

    @property
    def speed_of(self) -> dict[str, str]:
        """The name of the speed of each coordinate, also of eliminated ones."""
        return {
            k: entry.name
            for part in self.joints
            for k, entry in zip(part.coordinates, part.speeds, strict=True)
        }

    @property
    def free(self) -> tuple[JointStates, ...]:
        """The parts of bodies that move freely."""
        return tuple(part for part in self.joints if isinstance(part.joint, Free))

    def part_of(self, joint: Joint) -> JointStates:
        """Return the part of an independent joint."""
        return next(part for part in self.joints if part.joint == joint)


def _states_of(joint: Joint, coordinates: Sequence[RelativeCoordinate]) -> JointStates:
    if isinstance(joint, Free):
        return free_states(joint)
    # the same coordinate may be reported again, under another name
    c = next(c for c in coordinates if c.joint == joint)
    position = Entry(c.name, c.unit, c.meaning)
    rate = Entry(f"{c.name}_rate", f"{c.unit}/s", f"rate of {c.name}")
    return JointStates(joint, (position,), (rate,), (c.name,), (0,))


def free_states(joint: Free) -> JointStates:
    """Return the part of the state that belongs to a body that moves freely."""
    body = joint.second.name
    place = f"of the centre of mass of the {body} from design, in the world"
    turn = f"of the unit quaternion that turns the {body} from design"
    own = f"in axes of the {body}"
    positions = (
        *(Entry(f"{body}_{a}", "m", f"displacement {place}, {a}") for a in "xyz"),
        Entry(f"{body}_e0", "1", f"scalar part {turn}", at_design=1),
        *(Entry(f"{body}_e{i}", "1", f"{a} component {turn}") for i, a in enumerate("xyz", 1)),
    )
    speeds = (
        *(
            Entry(f"{body}_{s}", "m/s", f"velocity of the centre of mass of the {body} {own}, {a}")
            for s, a in zip("uvw", "xyz", strict=True)
        ),
        *(
            Entry(f"{body}_{s}", "rad/s", f"angular velocity of the {body} {own}, {a}")
            for s, a in zip("pqr", "xyz", strict=True)
        ),
    )
    names = tuple(entry.name for entry in speeds)
    return JointStates(joint, positions, speeds, names, (0, 1, 2, None, 3, 4, 5))
