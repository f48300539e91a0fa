"""``kintrafo characteristics``: all characteristics over the motions of a rig."""

from math import radians
from typing import TYPE_CHECKING, Annotated

import typer

from ...terminal.console import console, curve_table, print_json, print_table
from . import goals as wanted
from .option_groups import with_groups
from .options import Bump, File, Json, Of, RackExtent, Rebound, Step, among, by_comma, metres
from .outputs import USUAL_OUTPUT, OutputOptions, name_files, named, of_both, only, title_of
from .subject import assembly_of_file

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from xarray import Dataset

    from ..assembly.assembly import Assembly
    from ..studies.goals import Goal

EXAMPLES = (
    "kintrafo characteristics reference_car",
    "kintrafo characteristics my_car.toml -o curves.csv --plot curves.pdf",
    "kintrafo characteristics my_car.toml --figures figures --format svg",
    "kintrafo characteristics my_car.toml --goals goals.toml --plot curves.png",
    "kintrafo characteristics reference_axle --over bump,roll -o axle.csv",
)
# Those of an assembly, where nothing is chosen, are these; what an axle has besides is asked for.
_USUAL = ("travel", "rack", "bump", "roll", "left", "steer")
# Curves that stand in tables of motions of an axle; over parallel travel all are shown at design.
_SHOWN = {
    "roll": (
        "roll_moment",
        "roll_moment_gradient",
        "roll_stiffness",
        "roll_center_height",
        "roll_center_lateral",
        "inclination",
        "axle_steer",
        "axle_lateral",
    ),
    "steer": ("steer", "ackermann", "turning_circle", "steering_ratio"),
    "rack": ("steer", "ackermann", "turning_circle"),
}
_OF_ONE_WHEEL = (
    "wheel_force",
    "bar_torque",
    "track",
    "roll_center_height",
    "axle_steer",
    "axle_lateral",
)


@with_groups
def command(
    file: File,
    *,
    rebound: Rebound = None,
    bump: Bump = None,
    rack_extent: RackExtent = None,
    over: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME,...",
            help="Motions of the rig: of a suspension travel and rack, the default; of an axle "
            "bump, roll, left, right, steer and rack, by default bump,roll,left,steer. What is not "
            "steered has no rack and no steer.",
            callback=by_comma,
        ),
    ] = None,
    roll: Annotated[
        float | None,
        typer.Option(
            metavar="DEG", help="Of an axle: roll to either side. Default: 4, if reached."
        ),
    ] = None,
    step: Step = 2.0,
    travel: Annotated[
        float, typer.Option(metavar="MM", help="Wheel travel, where the rack varies.")
    ] = 0.0,
    rack: Annotated[
        float, typer.Option(metavar="MM", help="Rack displacement, where the travel varies.")
    ] = 0.0,
    of: Of = None,
    goals: wanted.Goals = None,
    output: OutputOptions = USUAL_OUTPUT,
    json: Json = False,
) -> None:
    """All characteristics over the motions of a rig; tables of them at design.

    Data files and pages are written once for each motion, with its name behind theirs: _travel and
    _rack of a suspension, _bump, _roll, _left and _steer of an axle.
    """
    from ...datasets import export
    from ..analysis.characteristics import datasets
    from ..assembly.rig import SweepRange

    if goals and (travel or rack):
        raise typer.BadParameter(wanted.ELSEWHERE)
    assembly = assembly_of_file(file)
    chosen = _motions(assembly, over)
    outputs = output.of(
        inputs=[file, *([goals] if goals else [])],
        suffixes=[f"_{name}" for name in chosen],
    )
    _refuse_options(assembly, roll=roll, rack_extent=rack_extent, travel=travel, rack=rack)
    aims = _aims(goals, chosen, assembly)
    extent = SweepRange(
        rebound=metres(rebound),
        bump=metres(bump),
        roll=None if roll is None else radians(roll),
        rack=metres(rack_extent),
        step=step / 1e3,
    )
    curves = {}
    for name in chosen:
        steers = name in {"rack", "steer"}
        held = {"travel": travel / 1e3} if steers else {"rack_position": rack / 1e3}
        curves[name] = datasets.over(assembly, name, extent=extent, **held)
    assembly.refuse_of_steering(of or ())
    # both wheels of an axle are drawn together
    drawn = named(of_both(of) if len(assembly.wheels) > 1 else of, curves)
    judged = wanted.judged({file: assembly.subject}, aims) if aims else []
    if aims and outputs.drawn:
        wanted.refuse_beyond(aims, curves)
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
        console.print(wanted.table(judged, f"{file}: targets and limits of {goals}"))
    name_files(written)


def _aims(path: "Path | None", chosen: list[str], assembly: "Assembly") -> "list[Goal]":
    """Return the targets and limits of a file that are about the motions."""
    if path is None:
        return []
    from ..studies.sweep_axes import sweep_axes_of

    return wanted.read(path, chosen, sweep_axes_of(assembly.subject))


def _motions(assembly: "Assembly", wanted: list[str] | None) -> list[str]:
    """Return the motions that are asked for, or the usual ones."""
    if not wanted:
        several = [name for name in _USUAL if name in assembly.motions]
        return [name for name in several if name != "rack" or "steer" not in several]
    for name in wanted:
        if name not in assembly.motions:
            assembly.refuse_motion(name)
    return among(wanted, assembly.motions, "--over")


def _refuse_options(
    assembly: "Assembly",
    *,
    roll: float | None,
    rack_extent: float | None,
    travel: float,
    rack: float,
) -> None:
    """Refuse options that a file does not have."""
    if roll is not None and "roll" not in assembly.motions:
        raise typer.BadParameter("--roll is only for the file of an axle")
    if assembly.steered:
        return
    of_rack = {"--rack-extent": rack_extent, "--rack": rack or None, "--travel": travel or None}
    for option, value in of_rack.items():
        if value is not None:
            raise typer.BadParameter(f"{option} is only for what has a rack")


def _title(assembly: "Assembly", file: str, motion: str) -> str:
    """Return what stands above curves."""
    if len(assembly.wheels) == 1:
        return title_of(file)
    return f"{title_of(file)}: {assembly.motions[motion].words}"


def _print(
    assembly: "Assembly", file: str, curves: "Mapping[str, Dataset]", of: list[str] | None
) -> None:
    """Print what is known at design, and of further motions of an axle curves."""
    from ..analysis.characteristics.at_design import at_design
    from ..assembly.by_wheel import flat

    for motion, dataset in curves.items():
        shown = only(of, dataset)
        if len(assembly.wheels) == 1:
            for table in at_design(shown, f"{file}: characteristics over {motion}, "):
                print_table(table)
        elif motion == assembly.usual_motion:
            for table in at_design(shown, f"{file}: "):
                print_table(table)
        else:
            if not of:
                names = _SHOWN.get(motion, _OF_ONE_WHEEL)
                shown = dataset[[name for name in names if name in dataset]]
            flattened = flat(shown)
            if flattened.data_vars:
                words = f"{file}: {assembly.motions[motion].words}"
                console.print(curve_table(flattened, list(map(str, flattened)), words))
