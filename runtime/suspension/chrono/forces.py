"""Springs and dampers of Project Chrono's templates, and what becomes of them.

Chrono's force pushes the ends apart. With x, the length above the free length, and v, its rate, it
is ``preload - spring(x) - damper(v)``; each of both is a coefficient or a curve.
"""

from typing import Annotated, Any, ClassVar, NamedTuple

from pydantic import Field

from .keys import Part
from .parts import POINTS_ONLY, Finite, Point, millimetres

Curve = Annotated[tuple[tuple[Finite, Finite], ...], Field(min_length=2)]

_LAWS = {
    ("Map Data", "Deformation"): "a force over length and speed together",
    ("Degressivity Compression", "Degressivity Expansion"): "a degressive damper",
}
_STOPS = frozenset({"Minimum Length", "Maximum Length"})


class Element(Part):
    """A spring, a damper or both, from the chassis to `end`."""

    UNREAD: ClassVar[frozenset[str]] = _STOPS

    NAME: ClassVar[str]
    """What the file calls it."""

    chassis: Point = Field(alias="Location Chassis")
    rate: Finite | None = Field(default=None, alias="Spring Coefficient")
    curve: Curve | None = Field(default=None, alias="Spring Curve Data")
    damping: Finite | None = Field(default=None, alias="Damping Coefficient")
    damping_curve: Curve | None = Field(default=None, alias="Damping Curve Data")
    old_curve: Curve | None = Field(default=None, alias="Curve Data")
    map_data: Any = Field(default=None, alias="Map Data")
    deformation: Any = Field(default=None, alias="Deformation")
    in_bump: Finite | None = Field(default=None, alias="Degressivity Compression")
    in_rebound: Finite | None = Field(default=None, alias="Degressivity Expansion")

    def given(self, *keys: str) -> list[str]:
        """Return those of some keys that the file has."""
        names = {field.alias: name for name, field in type(self).model_fields.items()}
        return [key for key in keys if names[key] in self.model_fields_set]

    def springs(self) -> list[str]:
        """Return the keys of its spring."""
        return self.given("Spring Coefficient", "Spring Curve Data")

    def dampers(self) -> list[str]:
        """Return the keys of its damper."""
        return self.given("Damping Coefficient", "Damping Curve Data")

    def problems(self) -> list[str]:
        """Say which of its laws there is no place for, and which exclude each other."""
        told = [
            f'"{self.NAME} > {given[0]}" is {law}, which cannot be read. Remove it and enter the '
            f'force over the speed as "Damping Curve Data", or {POINTS_ONLY}.'
            for keys, law in _LAWS.items()
            if (given := self.given(*keys))
        ]
        return told + [
            f'"{self.NAME} > {keys[0]}" and "{keys[1]}" both give its force. Keep one of them.'
            for keys in (self.springs(), self.dampers())
            if len(keys) > 1
        ]


class Spring(Element):
    """The spring."""

    NAME: ClassVar[str] = "Spring"

    free_length: Finite | None = Field(default=None, alias="Free Length")
    preload: Finite = Field(default=0.0, alias="Preload")

    def springs(self) -> list[str]:
        """Return the keys of its spring; the last one is of older templates."""
        return self.given("Spring Coefficient", "Spring Curve Data", "Curve Data")


class Shock(Element):
    """The damper."""

    UNREAD: ClassVar[frozenset[str]] = _STOPS | {"Free Length", "Preload"}
    NAME: ClassVar[str] = "Shock"

    def dampers(self) -> list[str]:
        """Return the keys of its damper; the last one is of older templates."""
        return self.given("Damping Coefficient", "Damping Curve Data", "Curve Data")


class SpringLaw(NamedTuple):
    """A spring.

    Attributes
    ----------
    rate : float
        In N/m.
    free_length : float
        Of no force [m].
    """

    rate: float
    free_length: float


class DamperLaw(NamedTuple):
    """A damper: by its rate, or by its curve.

    Attributes
    ----------
    rate : float
        In N s/m.
    curve : tuple of (float, float)
        Velocities [m/s], positive in bump, and forces that resist bump [N]; empty with a rate.
    """

    rate: float
    curve: tuple[tuple[float, float], ...] = ()

    def scaled(self, ratio: float) -> "DamperLaw":
        """Return the damper that does the same along a line with 1/ratio of the speed."""
        curve = tuple((velocity / ratio, force * ratio) for velocity, force in self.curve)
        return DamperLaw(self.rate * ratio**2, curve)


def problems_of(spring: Spring, shock: Shock) -> list[str]:
    """Say why a spring and a damper have no place in this project's suspensions."""
    told = [*spring.problems(), *shock.problems()]
    if not spring.springs():
        told.append('"Spring > Spring Coefficient" or "Spring Curve Data" is missing. Add one.')
    elif spring.springs() != ["Spring Coefficient"]:
        told.append(
            f'"Spring > {spring.springs()[0]}" is a spring by a curve, which cannot be read. Enter '
            f'its rate as "Spring Coefficient" in N/m, or {POINTS_ONLY}.'
        )
    elif spring.free_length is None:
        told.append('"Spring > Free Length" is missing. Add it, in m.')
    if spring.rate == 0.0 and spring.preload:
        told.append(
            f'"Spring > Preload" = {spring.preload:g} N without a rate is a constant force, which '
            "has no place here. Remove it, or enter a rate."
        )
    if shock.rate or shock.curve:
        told.append(
            f'"Shock > {shock.springs()[0]}" is a second spring, which has no place here. Remove '
            'it, as older versions of Chrono did not use it, or add it to the spring of "Spring".'
        )
    if spring.damping or spring.damping_curve:
        if shock.dampers():
            told.append(
                f'"Spring > {spring.dampers()[0]}" is a second damper, beside that of "Shock". '
                "Remove it, as older versions of Chrono did not use it, or add it to the other."
            )
    elif not (shock.dampers() or shock.given("Map Data")):
        told.append('"Shock > Damping Coefficient" or "Damping Curve Data" is missing. Add one.')
    return told


def spring_law(spring: Spring) -> SpringLaw:
    """Return the spring of a file without `problems_of`; its preload is in the free length."""
    rate, free = spring.rate or 0.0, spring.free_length or 0.0
    return SpringLaw(rate, free + spring.preload / rate if spring.preload else free)


def damper_law(spring: Spring, shock: Shock) -> DamperLaw:
    """Return the damper of a file without `problems_of`.

    Chrono's curve is over the rate of the length, and positive in rebound.
    """
    of = shock if shock.dampers() else spring
    points = of.damping_curve or of.old_curve or ()
    curve = sorted((-velocity + 0.0, -force + 0.0) for velocity, force in points)
    return DamperLaw(of.damping or 0.0, tuple(curve))


def damper_section(law: DamperLaw) -> dict[str, Any]:
    """Return the damper of a hardpoint file."""
    if not law.curve:
        return {"rate_N_s_per_m": law.rate}
    return {
        "velocity_m_per_s": [velocity for velocity, _ in law.curve],
        "force_N": [force for _, force in law.curve],
    }


def free_length_mm(law: SpringLaw) -> float:
    """Return the length of no force, in mm."""
    return millimetres(law.free_length)
