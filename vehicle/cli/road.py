"""The road of ``kintrafo ride`` and ``drive``: a rough or measured road, a bump or a kerb."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from .options import option, refuse_options

if TYPE_CHECKING:
    from ..assembly.car import CarAssembly
    from ..roads import Road

DURATION = 30.0
"""Default duration of a simulation, except on a measured road [s]."""

_BUMP_LENGTH = 0.5  # [m]


@dataclass(frozen=True)
class RoadOptions:
    """The options of a road; None is an option that is not given."""

    road: Annotated[
        str | None,
        option(
            "Rough road, a class of ISO 8608 from A to H; or the file of a measured one: CSV with "
            "distance_m, left_height_mm and right_height_mm, or OpenCRG (.crg). Default: B for a "
            "ride; a level road for manoeuvres.",
            "CLASS|FILE",
        ),
    ] = None
    seed: Annotated[
        int | None,
        option("Seed of the rough road: equal seeds give equal roads. Default: 1.", "N"),
    ] = None
    bump_height: Annotated[
        float | None,
        option("Height of one bump instead of the rough road; negative: a pothole.", "MM"),
    ] = None
    bump_length: Annotated[float | None, option("Length of the bump. Default: 0.5 m.", "M")] = None
    kerb: Annotated[
        float | None,
        option("Height of an edge instead of the rough road; negative: a drop.", "MM"),
    ] = None
    wheels: Annotated[
        Literal["both", "left", "right"] | None,
        option("Wheels that meet the bump or the kerb. Default: both."),
    ] = None
    contact_length: Annotated[
        float | None,
        option(
            "Length of the contact patch of a tyre, which then envelops short waves and edges "
            "(two elliptical cams). A kerb needs it. Default: the contact is a point.",
            "MM",
        ),
    ] = None

    def __post_init__(self) -> None:
        from ...core.validator import Validator

        roads = {"--road": self.road, "--bump-height": self.bump_height, "--kerb": self.kerb}
        chosen = [name for name, value in roads.items() if value is not None]
        if len(chosen) > 1:
            raise typer.BadParameter(f"{' and '.join(chosen)} are given: choose one of them")
        if self.bump_height is None:
            refuse_options("--bump-height", {"--bump-length": self.bump_length})
        if not self.is_obstacle:
            refuse_options("--bump-height and --kerb", {"--wheels": self.wheels})
        if not self.is_rough:
            refuse_options("a rough road", {"--seed": self.seed})
        lengths = {
            "--bump-length": (self.bump_length, "m"),
            "--contact-length": (self.contact_length, "mm"),
        }
        with Validator("road") as given:
            for name, (length, unit) in lengths.items():
                if length is not None:
                    given.number(name, length, unit, above=0.0)
            if self.seed is not None:
                given.whole("--seed", self.seed, least=0)
        if self.kerb is not None and self.contact_length is None:
            raise typer.BadParameter(
                "--kerb needs --contact-length, as a wheel does not touch an edge at a point"
            )

    @property
    def is_given(self) -> bool:
        """Whether an option chooses a road."""
        return any(each is not None for each in (self.road, self.bump_height, self.kerb))

    def refuse_without_road(self) -> None:
        """Refuse options of a road if no option chooses one."""
        if not self.is_given:
            named = {"--seed": self.seed, "--contact-length": self.contact_length}
            refuse_options("--road, --bump-height and --kerb", named)

    @property
    def name(self) -> str:
        """The class of a rough road, or the file of a measured one."""
        return self.road or "B"

    @property
    def sides(self) -> Literal["both", "left", "right"]:
        """Wheels that meet an obstacle."""
        return self.wheels or "both"

    @property
    def is_obstacle(self) -> bool:
        """Whether the road is level with a bump or a kerb."""
        return self.bump_height is not None or self.kerb is not None

    @property
    def is_rough(self) -> bool:
        """Whether the road is a class of ISO 8608."""
        from ..roads import CLASSES

        return not self.is_obstacle and self.name in CLASSES

    @property
    def is_measured(self) -> bool:
        """Whether the road is a file."""
        return not self.is_obstacle and not self.is_rough

    def for_time(
        self, assembly: "CarAssembly", speed: float, duration: float | None
    ) -> "tuple[Road, float]":
        """Return the road, and the duration of the simulation [s].

        By default it lasts until the last wheel reaches the end of a measured road, else
        `DURATION`.
        """
        found = self.for_distance(assembly, speed * (duration or DURATION))
        if duration is None and self.is_measured:
            return found, (found.length + max(assembly.behind().values())) / speed
        return found, duration or DURATION

    def for_distance(self, assembly: "CarAssembly", distance: float) -> "Road":
        """Return a road for a travelled distance [m]."""
        from .. import roads

        sides = {wheel.rpartition("_")[2] for wheel in assembly.wheels}
        if self.is_obstacle and self.sides in {"left", "right"} - sides:
            raise typer.BadParameter(
                f"--wheels {self.sides}: this car has its wheel on the other side"
            )
        if self.kerb is not None:
            at = min(5.0, 0.2 * distance)
            how: Any = {**self._tyre(assembly), "sides": self.sides}
            return roads.kerb(self.kerb / 1e3, at=at, end=max(distance, 2.0 * at), **how)
        if self.bump_height is not None:
            at = min(5.0, 0.1 * distance)
            length = _BUMP_LENGTH if self.bump_length is None else self.bump_length
            end = max(distance, at + length)
            found = roads.bump(self.bump_height / 1e3, length, at=at, end=end, sides=self.sides)
        elif self.is_rough:
            longest = max(distance, 1.01 / roads.rough.WAVES[0])
            seed = 1 if self.seed is None else self.seed
            found = roads.iso8608(self.name, length=longest, seed=seed, track=assembly.track)
        else:
            found = self._measured(assembly)
        if self.contact_length is None:
            return found
        return roads.enveloped(found, **self._tyre(assembly))

    def _measured(self, assembly: "CarAssembly") -> "Road":
        from ...core.errors import InputError
        from .. import roads

        if not Path(self.name).suffix and not Path(self.name).is_file():
            raise typer.BadParameter(
                f"--road {self.name}: a class of ISO 8608, {', '.join(roads.CLASSES)}, or a file "
                "is needed"
            )
        found = roads.read(self.name, track=assembly.track)
        least = max(assembly.behind().values())
        if found.length <= least:
            problem = (
                f"the road is {found.length:g} m long, and the wheelbase {least:g} m: the rear "
                "wheels would not reach it. Give a longer road."
            )
            raise InputError([problem], self.name)
        return found

    def _tyre(self, assembly: "CarAssembly") -> dict[str, float]:
        """Return the mean radius and the contact length of the tyres [m], for `roads.enveloped`."""
        from ...core.errors import InputError

        radii = [radius for radius in assembly.tyre_radii if radius]
        if not radii:
            problem = "no tyre has a radius, which --contact-length needs: enter [tyre] radius_mm."
            raise InputError([problem], "--contact-length")
        assert self.contact_length is not None
        return {
            "radius": sum(radii) / len(radii),
            "contact_length": self.contact_length / 1e3,
        }
