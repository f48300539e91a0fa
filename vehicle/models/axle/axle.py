"""`Axle`: the data of an axle's file, with the suspensions that it names."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any, ClassVar, Self

import numpy as np

from ....core.errors import InputError
from ....core.named_types import Array
from ....core.suggestions import suggestion
from ....core.vectors import components, unit_vector
from ....systems.allowed import LengthLimit
from ...corner.bushes import RACK
from ...data import data_sets
from ...data.starter import AXLE, AXLES, CAR, not_of_a_suspension, whole_axle_in
from ...input.described import DescribedParts, described_by, parts_of
from ...input.pitman_arm import PitmanLinkage
from ...input.vehicle import GravitySection, Steering, TyreSection, VehicleSection
from ...kinds import Suspension
from ..model import Model
from ..sides import LEFT, RIGHT
from .bar import AntiRollBar, HalfBar, mirrored_points
from .file import SECTIONS_OF_SIDES, AxleFile, Brakes, Drive, End
from .steering import SteeringCurve

# Bodies to which a drop link cannot be joined.
_NEVER_PULLED = ("tie_rod", "rack")
# Greatest difference of the rack axes in the files of both sides.
_SAME_AXIS = 1e-9
# Data of the whole vehicle in the files of both sides.
_OF_THE_VEHICLE = (
    ("vehicle", "wheelbase_mm"),
    ("vehicle", "center_of_gravity_height_mm"),
    ("vehicle", "front_brake_share"),
    ("gravity", "acceleration_m_per_s2"),
)
_OF_THE_RACK = (("rack", "travel_per_turn_mm"),)


@dataclass(frozen=True)
class Axle(DescribedParts):
    """The data of an axle of two suspensions, with a common rack and an anti-roll bar. Immutable.

    Make one with `load` or `from_dict`.

    Attributes
    ----------
    end : str
        'front' or 'rear'.
    right, left : Suspension
        The suspensions of both sides.
    symmetric : bool
        Whether the file describes one side only, and the other one is its mirror image.
    bar : AntiRollBar or None
        The section of the anti-roll bar; None without one.
    bar_side : str
        The side on which the points of the bar are given, 'left' or 'right'.
    steering : SteeringCurve or None
        None: the ``travel_per_turn_mm`` of the suspension applies.
    brakes : Brakes
        The section of the brakes.
    drive : Drive or None
        The section of the drive; None for an axle that is not driven.

    Examples
    --------
    >>> from kintrafo import Axle
    >>> axle = Axle.load("reference_axle")
    >>> axle.left.vehicle.side, axle.bar.link_on
    ('left', 'control_arm')
    """

    end: End
    right: Suspension
    left: Suspension
    symmetric: bool
    bar: AntiRollBar | None
    bar_side: str
    steering: SteeringCurve | None
    brakes: Brakes
    drive: Drive | None

    NEEDED = 'a kintrafo.Axle, such as Axle.load("reference_axle"), is needed'

    KEY = AXLE
    FILE = AxleFile
    PACKAGE = AXLES

    @classmethod
    def _of_parts(cls, described: AxleFile, folder: Path, source: str) -> Self:
        makers = dict.fromkeys(SECTIONS_OF_SIDES, _suspension)
        sides = parts_of(described, makers, folder, source)
        bar_side = sides["side"].vehicle.side if "side" in sides else RIGHT
        if "side" in sides:
            one = sides["side"]
            sides = {one.vehicle.side: one}
            sides[LEFT if bar_side == RIGHT else RIGHT] = one.mirrored()
        axle = cls(
            end=described.axle,
            right=sides[RIGHT],
            left=sides[LEFT],
            symmetric=described.side is not None,
            bar=described.anti_roll_bar,
            bar_side=bar_side,
            steering=described.steering,
            brakes=described.brakes,
            drive=described.drive,
        )
        problems = [*_problems_of_sides(axle), *_problems_of_bar(axle)]
        if problems:
            raise InputError(problems, source)
        return axle

    @classmethod
    def _without_key(cls, data: Mapping[str, Any]) -> str:
        other = whole_axle_in(data)
        if other is not None:
            return not_of_a_suspension(other)
        if CAR in data:
            return (
                "this is the file of a car, and that of an axle is needed. Give a file that it "
                "names as `front` or `rear`."
            )
        if "hardpoints" in data:
            return (
                "this is the file of one suspension, not of an axle. Name it in an axle's file, as "
                "`side`; `kintrafo new FILE --axle` writes one."
            )
        return f'{AXLE} is missing: where the axle is. Add a line `{AXLE} = "front"` or "rear".'

    def to_dict(self, *, exclude_defaults: bool = False) -> dict[str, Any]:
        """Return the sections as nested dictionaries, which `from_dict` takes back unchanged.

        The sections of a side are nested in ``side``, or in ``right`` and ``left``, instead of the
        name of its file.
        """
        sides = {"side": self.sides[self.bar_side]} if self.symmetric else self._apart()
        sections: dict[str, Any] = sides | {
            "anti_roll_bar": self.bar,
            "steering": self.steering,
            "brakes": self.brakes,
            "drive": self.drive,
        }
        how: Any = {"mode": "json", "exclude_none": True, "exclude_defaults": exclude_defaults}
        written = {name: s.model_dump(**how) for name, s in sections.items() if s is not None}
        return {AXLE: self.end} | {name: values for name, values in written.items() if values}

    def with_changes(self, changes: Mapping[str, Any]) -> Self:
        """Return an axle that differs in some values; all checks are made again.

        Parameters
        ----------
        changes : mapping of str to Any
            New values, in the units of the file, by section and key with dots between them:
            ``anti_roll_bar.rate_Nm_per_deg``. Names of values of a hardpoint file begin with
            ``side``, and the other side stays its mirror image, or with ``right`` or ``left``, and
            the sides then differ. None removes an optional key.

        Raises
        ------
        InputError
            If there is no such value, or the data are not valid.

        Examples
        --------
        >>> from kintrafo import Axle
        >>> axle = Axle.load("reference_axle")
        >>> lower = axle.with_changes({"left.hardpoints.ball_joint.z": 190.0})
        >>> lower.left.hardpoints.ball_joint[2], lower.right.hardpoints.ball_joint[2]
        (190.0, 180.0)
        """
        data, of_side, source = self._changed_data(changes, ("side", RIGHT, LEFT))
        if of_side["side"] and not self.symmetric:
            raise InputError(["side: the file gives right and left. Name one of these."], "axle")
        apart = self._changed(of_side)
        if self.symmetric and not (of_side[RIGHT] or of_side[LEFT]):
            apart = {"side": apart[self.bar_side]}
        elif "anti_roll_bar" in data and self.bar_side == LEFT:  # whose points are the right side's
            data["anti_roll_bar"] = mirrored_points(data["anti_roll_bar"])
        return self.from_dict(
            {n: v for n, v in data.items() if n not in SECTIONS_OF_SIDES} | apart, source
        )

    def _changed(self, changes: Mapping[str, Mapping[str, Any]]) -> dict[str, Suspension]:
        """Return both sides with changes of one and its image, followed by those of each."""
        sides = self._apart()
        if changes["side"]:
            one = sides[self.bar_side].with_changes(changes["side"])
            sides = {side.vehicle.side: side for side in (one, one.mirrored())}
        return {
            side: sides[side].with_changes(changes[side]) if changes[side] else sides[side]
            for side in (RIGHT, LEFT)
        }

    def _apart(self) -> dict[str, Suspension]:
        """Return the sides by the keys of a file with both of them."""
        return {RIGHT: self.right, LEFT: self.left}

    @property
    def sides(self) -> dict[str, Suspension]:
        """The suspensions by their sides, the left one first."""
        return {LEFT: self.left, RIGHT: self.right}

    @cached_property
    def models(self) -> dict[str, Model]:
        """The compiled equations of each side, the left one first."""
        return {side: Model(suspension) for side, suspension in self.sides.items()}

    @cached_property
    def halves(self) -> dict[str, HalfBar]:
        """The halves of the anti-roll bar by their sides; empty without a bar."""
        if self.bar is None:
            return {}
        return {side: self.bar.half(mirrored=side != self.bar_side) for side in self.sides}

    def steered(self) -> bool:
        """Return whether the wheels are steered, by a rack or a Pitman arm."""
        return self.right.steered()

    @property
    def steered_by(self) -> str:
        """The key of the section of its steering, the same in the files of both sides."""
        return self.right.steered_by

    @property
    def steering_gear(self) -> Steering | PitmanLinkage:
        """The section of its steering, that of the right side."""
        return self.right.steering_gear

    @property
    def rack_name(self) -> str:
        """The name of the displacement of its rack in the equations; empty without steering."""
        return self.right.NAMES.rack

    # -- interface for a car ----------------------------------------------------------------------

    whole: ClassVar[bool] = False
    """Whether it has no sides."""
    overheld: ClassVar[bool] = False
    """Whether it moves only as its bushes deflect."""

    @property
    def vehicle(self) -> VehicleSection:
        """The data of the whole vehicle, the same in the files of both sides."""
        return self.right.vehicle

    @property
    def gravity(self) -> GravitySection:
        """Gravity, the same in the files of both sides."""
        return self.right.gravity

    @property
    def wheel_centers(self) -> dict[str, Array]:
        """The wheel centres at design by side [m]."""
        return {side: one.hardpoints.metres("wheel_center") for side, one in self.sides.items()}

    @property
    def equations_name(self) -> str:
        """The name of the equations of a side, which are the same for both sides.

        Raises
        ------
        InputError
            If the sides have different equations.
        """
        names = {str(model.equations.NAME): side for side, model in self.models.items()}
        if len(names) != 1:
            problem = (
                f"the sides have different equations, {' and '.join(names)}. Stops, curves and "
                "other optional sections must be in both files. Add those that one file lacks."
            )
            raise InputError([problem], "AxleModel")
        return next(iter(names))

    @property
    def link_part(self) -> str:
        """The part to which the drop links of the anti-roll bar are joined; empty without a bar."""
        return self.bar.link_on if self.bar else ""

    def allowed_lengths(self) -> tuple[LengthLimit, ...]:
        """Return the lengths that the file of each side allows."""
        return tuple(
            one._replace(signal=f"{side}_{one.signal}", part=f"{side} {one.part}")
            for side, own in self.sides.items()
            for one in own.allowed_lengths()
        )

    def parameters_of_masses(self) -> list[Mapping[str, float]]:
        """Return the parameters of each side, with the names of the right one for both."""
        return [side.parameters() for side in self.sides.values()]

    def parameters_by_side(self) -> dict[str, dict[str, float]]:
        """Return the parameters of each side with its half of the anti-roll bar, in SI units."""
        found = {side: dict(model.parameters) for side, model in self.models.items()}
        for side, half in self.halves.items():
            for name, vector in (
                ("bar_bush", half.bush),
                ("bar_axis", half.axis),
                ("link_top", half.top),
                ("link_foot", half.foot),
            ):
                found[side] |= components(name, vector)
        return found

    def parameters_of_bar(self) -> dict[str, float]:
        """Return the parameters of the anti-roll bar, in SI units; none without one."""
        if self.bar is None:
            return {}
        return {"bar_rate": self.bar.rate(), "bar_free_angle": self.bar.free_twist()}

    def parameters_in_a_car(self) -> dict[str, float]:
        """Return the parameters of both sides, by their names in the equations of a car."""
        sides = self.parameters_by_side()
        by_name = {f"{side}_{n}": value for side, own in sides.items() for n, value in own.items()}
        # both sides have one rack, whose values are those of the right one
        return self.parameters_of_bar() | sides[RIGHT] | by_name

    def on_tyre(self, tyre: TyreSection) -> Self:
        """Return the axle on another tyre, see `Suspension.on_tyre`."""
        return replace(self, right=self.right.on_tyre(tyre), left=self.left.on_tyre(tyre))

    def in_vehicle(self, known: Mapping[str, float | None]) -> Self:
        """Return the axle in a vehicle, see `WheeledSection.in_vehicle`."""
        return replace(self, right=self.right.in_vehicle(known), left=self.left.in_vehicle(known))

    def heading(self) -> str:
        """Return the name of the axle."""
        kinds = " and ".join(dict.fromkeys(side.TITLE for side in self.sides.values()))
        return f"{self.end} axle, {kinds}"


def _suspension(given: Any, folder: Path, key: str) -> Suspension:
    by_path = isinstance(given, str | Path) and given not in data_sets()
    if by_path and described_by(folder / given) == AXLE:
        raise InputError([f"{given} is itself an axle. Name a hardpoint file."], key)
    return Suspension.given(given, folder, key)


def _problems_of_sides(axle: Axle) -> list[str]:
    problems = [
        f'{side}: its file has [vehicle] side = "{suspension.vehicle.side}". Exchange the two '
        "files, or correct this one."
        for side, suspension in axle.sides.items()
        if suspension.vehicle.side != side
    ]
    problems += [
        f'{side}: its file has [vehicle] end = "{suspension.vehicle.end}", and this is the '
        f"{axle.end} axle. Correct one of the two."
        for side, suspension in axle.sides.items()
        if suspension.vehicle.end not in (None, axle.end)
    ]
    if axle.right.suspension != axle.left.suspension:
        problems.append(
            f"right is a {axle.right.TITLE} and left a {axle.left.TITLE}: both sides of an axle "
            "are of one kind."
        )
    steered = axle.right.steered() and axle.left.steered()
    if axle.steering is not None and not steered:
        problems.append(f"[steering]: a {axle.right.TITLE} is not steered. Remove this section.")
    if steered:
        problems += _problems_of_steering(axle.right, axle.left)
    problems += [
        f"{side}: [bodies.{body}] mass_kg = {mass:g} kg: the rack of an axle is prescribed, and "
        "tie rod, rack and upper strut have no mass in its equations. Set it to zero."
        for side, suspension in axle.sides.items()
        for body, mass in suspension.neglected_masses().items()
    ]
    if (axle.right.bushings or {}).get(RACK) != (axle.left.bushings or {}).get(RACK):
        problems.append(
            f"[bushings.{RACK}] differs in the files of both sides: they have one rack. Make them "
            "equal."
        )
    on_racks = steered and axle.right.rack is not None and axle.left.rack is not None
    for section, key in [*_OF_THE_VEHICLE, *(_OF_THE_RACK if on_racks else ())]:
        right, left = (getattr(getattr(s, section), key) for s in (axle.right, axle.left))
        if right != left:
            problems.append(
                f"[{section}] {key} is {_in_words(right)} in the file of the right side and "
                f"{_in_words(left)} in that of the left. Make them equal."
            )
    return problems


def _problems_of_steering(right: Suspension, left: Suspension) -> list[str]:
    """Return the problem of sides with different racks or Pitman arms."""
    if right.rack is not None and left.rack is not None:
        axes = [unit_vector(rack.axis) for rack in (right.rack, left.rack)]
        if np.abs(axes[0] - axes[1]).max() <= _SAME_AXIS:
            return []
        problem = (
            f"[rack] axis is {list(right.rack.axis)} of the right side and "
            f"{list(left.rack.axis)} of the left: they have one rack. Make them equal."
        )
    elif right.pitman_arm == left.pitman_arm:
        return []
    else:
        problem = (
            "[pitman_arm] differs in the files of both sides: they have one relay rod, and its "
            "points are the same in both files. Make them equal."
        )
    return [problem]


def _in_words(value: float | None) -> str:
    return "not given" if value is None else f"{value:g}"


def _problems_of_bar(axle: Axle) -> list[str]:
    if axle.bar is None:
        return []
    bodies = axle.right.bodies.rigid()
    known = [name for name in bodies if name not in _NEVER_PULLED]
    problems = []
    if axle.bar.link_on not in known:
        meant = suggestion(axle.bar.link_on, known)
        problems.append(
            f'[anti_roll_bar] link_on = "{axle.bar.link_on}" is not a part of a '
            f"{axle.right.TITLE} that a drop link can be joined to. {meant}"
        )
    sign = axle.sides[axle.bar_side].vehicle.sign
    across = [
        name for name in ("bush", "link_top", "link_foot") if sign * axle.bar.metres(name)[1] <= 0.0
    ]
    if across:
        listed = ", ".join(f"{name} = {list(getattr(axle.bar, name))}" for name in across)
        problems.append(
            f"[anti_roll_bar] {listed} {axle.bar.unit}: not on the {axle.bar_side} side, whose "
            "points the section has. y points left: correct the sign of y."
        )
    return problems
