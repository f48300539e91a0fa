"""``kintrafo characteristics``: characteristics, or positions, over the motions of a rig."""

from dataclasses import dataclass
from math import radians
from typing import TYPE_CHECKING, Annotated

import typer

from ...terminal.console import console, print_curves, print_json, print_table, problems, say
from . import goals as wanted
from .loading import assembly_of_file
from .options import Bump, File, Of, Rebound, among, metres, option, refuse_options
from .outputs import CurveOptions, Outputs, name_files, named, of_both, only, title_of

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from xarray import Dataset

    from ..assembly.assembly import Assembly
    from ..assembly.rig import SweepRange
    from ..studies.goals import Goal

EXAMPLES = (
    "kintrafo characteristics reference_car",
    "kintrafo characteristics my_car.toml -o curves.csv --plot curves.pdf",
    "kintrafo characteristics my_car.toml --figures figures --format svg",
    "kintrafo characteristics my_car.toml --goals goals.toml --plot curves.png",
    "kintrafo characteristics reference_axle --over bump,roll -o axle.csv",
    "kintrafo characteristics my_car.toml --positions --bump 60 --rebound 90 -o path.csv",
    "kintrafo characteristics my_car.toml --positions --over both --step 10 -o map.nc",
)
# Default motions, where an assembly has them.
_USUAL = ("travel", "rack", "bump", "heave", "pitch", "roll", "left", "steer")
# Curves in the tables of an axle; over parallel travel a table has all of them at design.
_SHOWN = {
    "roll": (
        "roll_moment", "roll_moment_gradient", "roll_stiffness", "roll_center_height",
        "roll_center_lateral", "inclination", "axle_steer", "axle_lateral",
    ),
    "steer": ("steer", "ackermann", "turning_circle", "steering_ratio"),
    "rack": ("steer", "ackermann", "turning_circle"),
}  # fmt: skip
_OF_ONE_WHEEL = (
    "wheel_force", "bar_torque", "track", "roll_center_height", "axle_steer", "axle_lateral",
)  # fmt: skip


_POSITIONS = ("wheel_center_x", "wheel_center_y", "wheel_center_z", "camber", "toe", "steer")
_BOTH = "both"


@dataclass(frozen=True)
class RigOptions:
    """The ends of the motions of a rig, and the constant travel and rack displacement."""

    rebound: Rebound = None
    bump: Bump = None
    rack_extent: Annotated[
        float | None, option("Rack displacement to either side. Default: 60, if reached.", "MM")
    ] = None
    roll: Annotated[
        float | None,
        option("Of an axle: roll angle to either side. Default: 4, if reached.", "DEG"),
    ] = None
    step: Annotated[float, option("Distance between two positions.", "MM")] = 2.0
    travel: Annotated[float, option("Wheel travel, where the rack varies.", "MM")] = 0.0
    rack: Annotated[float, option("Rack displacement in motions of the wheels.", "MM")] = 0.0

    @property
    def extent(self) -> "SweepRange":
        """The ends, in SI units."""
        from ..assembly.rig import SweepRange

        return SweepRange(
            rebound=metres(self.rebound),
            bump=metres(self.bump),
            roll=None if self.roll is None else radians(self.roll),
            rack=metres(self.rack_extent),
            step=self.step / 1e3,
        )

    @property
    def held(self) -> dict[str, float]:
        """The travel of the wheels and the displacement of the rack [m]."""
        return {"travel": self.travel / 1e3, "rack": self.rack / 1e3}

    def refuse_without_effect(self, assembly: "Assembly") -> None:
        """Refuse options without effect on a file."""
        if self.roll is not None and "roll" not in assembly.motions:
            raise typer.BadParameter("--roll is only for the file of an axle")
        if not assembly.steered:
            of_rack = {"--rack": self.rack or None, "--travel": self.travel or None}
            refuse_options("steered wheels", {"--rack-extent": self.rack_extent} | of_rack)


@dataclass(frozen=True)
class ShownOptions:
    """The shown characteristics."""

    of: Of = None
    every: Annotated[
        bool,
        option("Draw all curves in groups, not only the eight main ones.", None, "--all"),
    ] = False
    goals: wanted.Goals = None


def command(
    file: File,
    *,
    over: Annotated[
        list[str] | None,
        option(
            "Motions of the rig. Suspension: travel, rack (default: both). Axle: bump, roll, left, "
            "right, steer, rack (default: bump,roll,left,steer). Car: heave, pitch, roll. Wheels "
            "that are not steered have no rack and no steer. With --positions: travel (the "
            "default; bump of an axle), rack, or both, which make a grid.",
            "NAME,...",
        ),
    ] = None,
    rig: RigOptions,
    shown: ShownOptions,
    positions: Annotated[
        bool, option("Positions of wheels, joints and coordinates instead of characteristics.")
    ] = False,
    output: CurveOptions,
) -> None:
    """Print characteristics at design, and write their curves over the motions of a rig.

    Each motion has its own data files and pages, whose names end in the name of the motion: _travel
    and _rack of a suspension, _bump, _roll, _left and _steer of an axle. With --positions both
    wheels of an axle travel in parallel.
    """
    if shown.goals and (rig.travel or rig.rack):
        raise typer.BadParameter(wanted.ELSEWHERE)
    assembly = assembly_of_file(file)
    chosen = _motions(assembly, over, positions=positions)
    outputs = output.files(file, shown.goals, suffixes=[f"_{name}" for name in chosen])
    rig.refuse_without_effect(assembly)
    if positions:
        if shown.of or shown.goals:
            raise typer.BadParameter("--of and --goals are about characteristics, not --positions")
        _positions(assembly, file, chosen, rig, outputs, json=output.json)
    else:
        _characteristics(assembly, file, chosen, rig, shown, outputs, json=output.json)


def _characteristics(
    assembly: "Assembly",
    file: str,
    motions: list[str],
    rig: RigOptions,
    shown: ShownOptions,
    outputs: Outputs,
    *,
    json: bool,
) -> None:
    """Write and print characteristics over motions."""
    from ...datasets import export
    from ..analysis.characteristics import datasets

    of, aims, held, extent = shown.of, _aims(shown.goals, motions, assembly), rig.held, rig.extent
    curves = {}
    for name in motions:
        steers = name in {"rack", "steer"}
        still = {"travel": held["travel"]} if steers else {"rack_position": held["rack"]}
        with problems.status(f"characteristics over {name}"):
            curves[name] = datasets.over(assembly, name, extent=extent, **still)
    assembly.refuse_of_steering(of or ())
    # both wheels of an axle are drawn together
    drawn = named(of_both(of) if len(assembly.wheels) > 1 else of, curves)
    if outputs.pages and not (of or shown.every or aims):
        from ..plots import first_curves

        drawn = {name: list(first_curves(dataset)) for name, dataset in curves.items()}
    judged = wanted.judged({file: assembly.subject}, aims, shown.goals) if aims else []
    if aims and outputs.drawn:
        wanted.refuse_beyond(aims, curves, shown.goals)
    written = [
        path
        for name, dataset in curves.items()
        for path in outputs.write(
            dataset,
            title=_title(assembly, file, name),
            suffix=f"_{name}",
            names=drawn[name],
            goals=[goal for goal in aims if goal.over == name],
        )
    ]
    if json:
        found = {f"over_{name}": export.as_dict(curves[name]) for name in curves}
        print_json(found | ({"goals": judged} if aims else {}))
        return
    _print(assembly, file, curves, of)
    if aims:
        console.print(wanted.table(judged, f"{file}: targets and limits of {shown.goals}"))
    name_files(written)


def _positions(
    assembly: "Assembly",
    file: str,
    motions: list[str],
    rig: RigOptions,
    outputs: Outputs,
    *,
    json: bool,
) -> None:
    """Write and print positions of wheels and joints over travel, the rack, or both."""
    from ...datasets import export
    from ..analysis import sweep
    from ..assembly.by_wheel import flat

    held, extent = rig.held, rig.extent
    if (rig.travel and "rack" not in motions) or (
        rig.rack and assembly.usual_motion not in motions
    ):
        over = ", ".join(motions)
        raise typer.BadParameter(
            f"--travel is for motions of the rack, --rack for those of wheels; --over is {over}"
        )
    found, written = {}, []
    for motion in motions:
        along = {
            name: assembly.usual(name, extent, **held)
            for name in ([assembly.usual_motion, "rack"] if motion == _BOTH else [motion])
        }
        travels = along.get(assembly.usual_motion, held["travel"])
        found[motion] = sweep.positions(assembly, travels, along.get("rack", held["rack"]))
        written += outputs.write(found[motion], title=title_of(file), suffix=f"_{motion}")
    if json:
        print_json({f"over_{name}": export.as_dict(dataset) for name, dataset in found.items()})
        return
    for motion, dataset in found.items():
        if motion == _BOTH:
            sizes = {name: size for name, size in dataset.sizes.items() if name != "wheel"}
            counts = " x ".join(f"{size} {name}" for name, size in sizes.items())
            say(f"{counts}, {len(flat(dataset))} variables; write them with --out")
            continue
        for wheel in assembly.wheels:
            own, title = dataset, f"{file}: positions over {motion}"
            if "wheel" in dataset.dims:
                own, title = dataset.sel(wheel=wheel, drop=True), f"{title}, {wheel}"
            print_curves(own, [name for name in _POSITIONS if name in own], title)
    name_files(written)


def _aims(path: "Path | None", chosen: list[str], assembly: "Assembly") -> "list[Goal]":
    """Return the targets and limits of a file that are over the chosen motions."""
    if path is None:
        return []
    from ..studies.sweep_axes import sweep_axes_of

    return wanted.read(path, chosen, sweep_axes_of(assembly.subject))


def _motions(assembly: "Assembly", wanted: list[str] | None, *, positions: bool) -> list[str]:
    """Return the wanted motions, or the default ones."""
    if positions:
        usual = assembly.usual_motion
        if not {"rack", _BOTH}.isdisjoint(wanted or ()):
            assembly.refuse_motion("rack")
        steering = ["rack", _BOTH] if assembly.steered else []
        return among(wanted or [usual], [usual, *steering], "--over")
    if not wanted:
        several = [name for name in _USUAL if name in assembly.motions]
        return [name for name in several if name != "rack" or "steer" not in several]
    for name in wanted:
        assembly.refuse_motion(name)
    return among(wanted, assembly.motions, "--over")


def _title(assembly: "Assembly", file: str, motion: str) -> str:
    if len(assembly.wheels) == 1:
        return title_of(file)
    return f"{title_of(file)}: {assembly.motions[motion].words}"


def _print(
    assembly: "Assembly", file: str, curves: "Mapping[str, Dataset]", of: list[str] | None
) -> None:
    """Print characteristics at design, and curves over further motions of an axle."""
    from ..analysis.characteristics.at_design import at_design
    from ..assembly.by_wheel import flat

    for motion, dataset in curves.items():
        shown, alone = only(of, dataset), len(assembly.wheels) == 1
        if alone or motion == assembly.usual_motion:
            words = f"characteristics over {motion}, " if alone else ""
            for table in at_design(shown, f"{file}: {words}"):
                print_table(table)
        else:
            if not of:
                names = _SHOWN.get(motion, _OF_ONE_WHEEL)
                shown = dataset[[name for name in names if name in dataset]]
            flattened = flat(shown)
            if flattened.data_vars:
                words = f"{file}: {assembly.motions[motion].words}"
                print_curves(flattened, list(map(str, flattened)), words)
