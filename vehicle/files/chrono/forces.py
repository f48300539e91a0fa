"""Springs and dampers of Project Chrono's templates as sections of a hardpoint file.

Chrono's force pushes the ends apart. With x, the length above the free length, and v, its rate, it
is ``preload - spring(x) - damper(v)``; each of both is a coefficient or a curve. A spring may have
stops.
"""

from typing import Annotated, Any, ClassVar, NamedTuple

from pydantic import Field

from ..fitting import fewer
from .keys import Part, Unread
from .parts import POINTS_ONLY, Finite, Point, millimetres
from .stops import LONGEST, Stops

Curve = tuple[tuple[float, float], ...]
_Points = Annotated[tuple[tuple[Finite, Finite], ...], Field(min_length=2)]

_LAWS = {
    ("Map Data", "Deformation"): "a force over length and speed together",
    ("Degressivity Compression", "Degressivity Expansion"): "a degressive damper",
}
_DIGITS = 12  # decimals of a difference of lengths [m]
_STOPS = ("Minimum Length", "Maximum Length")


class Element(Part):
    """A spring, a damper or both, from the chassis to `end`."""

    NAME: ClassVar[str]
    """The name in the file."""

    chassis: Point = Field(alias="Location Chassis")
    rate: Finite | None = Field(default=None, alias="Spring Coefficient")
    curve: _Points | None = Field(default=None, alias="Spring Curve Data")
    damping: Finite | None = Field(default=None, alias="Damping Coefficient")
    damping_curve: _Points | None = Field(default=None, alias="Damping Curve Data")
    old_curve: _Points | None = Field(default=None, alias="Curve Data")
    map_data: Any = Field(default=None, alias="Map Data")
    deformation: Any = Field(default=None, alias="Deformation")
    in_bump: Finite | None = Field(default=None, alias="Degressivity Compression")
    in_rebound: Finite | None = Field(default=None, alias="Degressivity Expansion")
    preload: Finite = Field(default=0.0, alias="Preload")
    shortest: Finite | None = Field(default=None, alias="Minimum Length")
    longest: Finite | None = Field(default=None, alias="Maximum Length")

    def given(self, *keys: str) -> list[str]:
        """Return those of some keys that the file has."""
        return [key for key in keys if self._fields()[key] in self.model_fields_set]

    def _fields(self) -> dict[str | None, str]:
        return {field.alias: name for name, field in type(self).model_fields.items()}

    def springs(self) -> list[str]:
        """Return the keys of its spring."""
        return self.given("Spring Coefficient", "Spring Curve Data")

    def dampers(self) -> list[str]:
        """Return the keys of its damper."""
        return self.given("Damping Coefficient", "Damping Curve Data")

    def stops(self) -> Stops | None:
        """Return its stops; in Chrono a spring with both lengths has them."""
        if self.shortest is None or self.longest is None or not self.springs():
            return None
        return Stops(self.shortest, self.longest, beside_a_curve=self.rate is None)

    def without_effect(self) -> list[Unread]:
        """Return the keys that Chrono does not use here, with their values."""
        keys = [] if self.stops() else self.given(*_STOPS)
        keys += [] if self.springs() else self.given("Preload")
        return [((self.NAME, key), getattr(self, self._fields()[key])) for key in keys]

    def problems(self) -> list[str]:
        """Return the problems of laws that cannot be read, or exclude each other."""
        lines = [
            f'"{self.NAME} > {given[0]}" is {law}, which cannot be read. Remove it and enter the '
            f'force over the speed as "Damping Curve Data", or {POINTS_ONLY}.'
            for keys, law in _LAWS.items()
            if (given := self.given(*keys))
        ]
        return lines + [
            f'"{self.NAME} > {keys[0]}" and "{keys[1]}" both give its force. Keep one of them.'
            for keys in (self.springs(), self.dampers())
            if len(keys) > 1
        ]


class Spring(Element):
    """The spring."""

    NAME: ClassVar[str] = "Spring"

    free_length: Finite | None = Field(default=None, alias="Free Length")

    def springs(self) -> list[str]:
        """Return the keys of its spring; the last one is of older templates."""
        return self.given("Spring Coefficient", "Spring Curve Data", "Curve Data")


class Shock(Element):
    """The damper."""

    UNREAD: ClassVar[frozenset[str]] = frozenset({"Free Length"})
    NAME: ClassVar[str] = "Shock"

    def dampers(self) -> list[str]:
        """Return the keys of its damper; the last one is of older templates."""
        return self.given("Damping Coefficient", "Damping Curve Data", "Curve Data")


class LineToArm(Part):
    """The ends of a spring or a damper that acts on an arm."""

    chassis: Point = Field(alias="Location Chassis")
    arm: Point = Field(alias="Location Arm")


class SpringOnArm(Spring, LineToArm):
    """The spring on an arm."""


class ShockOnArm(Shock, LineToArm):
    """The damper on an arm."""


class ChronoSpringLaw(NamedTuple):
    """A spring: by its rate, or by its curve, which has the stiffer parts of its stops, too."""

    rate: float  # [N/m]; of a rate with a curve, the rate between its stops
    free_length: float  # length without force, or without compression of a curve [m]
    # compressions [m], rising, and forces that push the ends apart [N]; empty with a rate alone
    curve: Curve = ()
    lost: Curve = ()  # surplus points of the curve, which are left out

    def section(self) -> dict[str, Any]:
        """Return the section of a hardpoint file."""
        free = {"free_length_mm": millimetres(self.free_length)}
        if not self.curve:
            return {"rate_N_per_m": self.rate} | free
        places, forces = zip(*self.curve, strict=True)
        places_mm = [millimetres(place) for place in places]
        return {"compression_mm": places_mm, "force_N": [*forces], "interpolation": "linear"} | free


class DamperLaw(NamedTuple):
    """A damper: by its rate, or by its curve."""

    rate: float  # [N s/m]
    # velocities [m/s], positive in bump, and forces that resist bump [N]; empty with a rate
    curve: Curve = ()

    def scaled(self, ratio: float) -> "DamperLaw":
        """Return the equivalent damper on a line with 1/ratio of the speed."""
        curve = tuple((velocity / ratio, force * ratio) for velocity, force in self.curve)
        return DamperLaw(self.rate * ratio**2, curve)

    def section(self) -> dict[str, Any]:
        """Return the section of a hardpoint file."""
        if not self.curve:
            return {"rate_N_s_per_m": self.rate}
        velocities, forces = zip(*self.curve, strict=True)
        return {
            "velocity_m_per_s": [*velocities],
            "force_N": [*forces],
            "interpolation": "linear",
        }


def problems_of(spring: Spring, shock: Shock) -> list[str]:
    """Return the problems of a spring and a damper that cannot be read."""
    lines = [*spring.problems(), *shock.problems()]
    if not spring.springs():
        lines.append('"Spring > Spring Coefficient" or "Spring Curve Data" is missing. Add one.')
    elif spring.free_length is None:
        lines.append('"Spring > Free Length" is missing. Add it, in m.')
    if spring.rate == 0.0 and spring.preload:
        lines.append(
            f'"Spring > Preload" = {spring.preload:g} N without a rate is a constant force, which '
            "cannot be read. Remove it, or enter a rate."
        )
    lines += _problems_of_stops(spring)
    second = shock.springs() if shock.rate or shock.curve else []
    if shock.springs() and not second:  # without a rate, Chrono still has preload and stops
        second = [*(["Preload"] if shock.preload else []), *(_STOPS if shock.stops() else ())]
    if second:
        lines.append(
            f'"Shock > {second[0]}" is a second spring, which cannot be read. Remove '
            'it, as older versions of Chrono did not use it, or add it to the spring of "Spring".'
        )
    if spring.damping or spring.damping_curve:
        if shock.dampers():
            lines.append(
                f'"Spring > {spring.dampers()[0]}" is a second damper, beside that of "Shock". '
                "Remove it, as older versions of Chrono did not use it, or add it to the other."
            )
    elif not (shock.dampers() or shock.given("Map Data")):
        lines.append('"Shock > Damping Coefficient" or "Damping Curve Data" is missing. Add one.')
    return lines


def _problems_of_stops(spring: Spring) -> list[str]:
    """Return the problem of stops that cannot be read."""
    stops = spring.stops()
    if stops is None:
        return []
    if LONGEST < stops.shortest < stops.longest:
        return []
    given = f'"Spring > Minimum Length" = {stops.shortest} m and "Maximum Length" = {stops.longest}'
    problem = (
        f"{given} m: the first must be more than {LONGEST:g} m, by which a stop of Chrono can be "
        f"pressed in, and less than the other. Correct them, or {POINTS_ONLY}."
    )
    return [problem]


def spring_law(spring: Spring) -> ChronoSpringLaw:
    """Return the spring of a file without `problems_of`, with its preload.

    Chrono's curve is over the length above the free one, and positive if the spring pulls.
    """
    free, points = spring.free_length or 0.0, spring.curve or spring.old_curve
    if points is None:
        rate = spring.rate or 0.0
        free += spring.preload / rate if spring.preload else 0.0
        stops = spring.stops()
        lengths = stops.stiffer() if stops else ()
        stiffer = [(round(free - at, _DIGITS), more) for at, more in lengths]
        return ChronoSpringLaw(rate, free, tuple((x, rate * x + more) for x, more in stiffer))
    curve = sorted((-longer + 0.0, spring.preload - force) for longer, force in points)
    kept = fewer(curve)
    return ChronoSpringLaw(0.0, free, kept, tuple(point for point in curve[: -len(kept)]))


def damper_law(spring: Spring, shock: Shock) -> DamperLaw:
    """Return the damper of a file without `problems_of`.

    Chrono's curve is over the rate of the length, and positive in rebound.
    """
    of = shock if shock.dampers() else spring
    points = of.damping_curve or of.old_curve or ()
    curve = sorted((-velocity + 0.0, -force + 0.0) for velocity, force in points)
    return DamperLaw(of.damping or 0.0, tuple(curve))


def words_of_curves(stops: Stops | None, spring: ChronoSpringLaw, damper: DamperLaw) -> list[str]:
    """Return assumptions on stops, on the ends of curves and on points that are left out."""
    lines = [stops.words()] if stops else []
    beside = stops is None or stops.beside_a_curve
    curves = {"spring": spring.curve if beside else (), "damper": damper.curve}
    named = [name for name, curve in curves.items() if curve]
    if named:
        lines.append(
            f"{' and '.join(named)}: beyond its curve the force goes on straight, where that of "
            "Chrono stays as at the end"
        )
    if spring.lost:
        points = ", ".join(f"{1e3 * x:g} mm: {force:g} N" for x, force in spring.lost)
        lines.append(
            f"spring: by {len(spring.curve)} points, as many as a curve may have; left out are "
            f"those of the greatest extension ({points})"
        )
    return lines
