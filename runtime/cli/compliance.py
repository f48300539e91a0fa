"""``kintrafo compliance``: how the wheels give way on their bushes."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, NamedTuple

import typer

from . import goals as wanted
from .axles import refuse_options
from .console import console, note, print_json, print_table, say
from .options import Bump, File, Force, Json, Of, Rebound, metres
from .outputs import Out, Outputs, Plot, name_files, named, of_both, only, title_of
from .subject import described_by
from .variation_options import At, with_position

if TYPE_CHECKING:
    from xarray import Dataset

    from ..suspension.axle import Axle
    from ..suspension.model import Model
    from ..suspension.rigid import RigidAxle

EXAMPLES = (
    "kintrafo compliance my_car.toml bushes.toml",
    "kintrafo compliance my_car.toml bushes.toml --held spring --plot curves.png -o curves.csv",
    "kintrafo compliance my_car.toml bushes.toml --goals goals.toml --plot goals.png",
    "kintrafo compliance my_car.toml bushes.toml --of toe_by_lateral --plot lateral.png",
    "kintrafo compliance reference_axle bushes.toml",
    "kintrafo compliance rigid_axle axle_bushes.toml",
)

Held = Literal["height", "tyre", "spring", "locked"]
Bushes = Annotated[
    Path | None,
    typer.Argument(
        metavar="[BUSHES]",
        help="TOML: [bushings.POINT] with stiffnesses. Default: those of FILE.",
        show_default=False,
    ),
]


class _Where(NamedTuple):
    """At which positions, and what holds the wheels: lengths in m, but for `at` in mm."""

    at: float
    rack: float
    rebound: float | None
    bump: float | None
    held: Held


def command(
    file: File,
    bushes: Bushes = None,
    *,
    held: Annotated[
        Held,
        typer.Option(help="What holds the wheel: see docs/loads.md."),
    ] = "height",
    at: At = 0.0,
    rack: Annotated[float, typer.Option(metavar="MM", help="Rack held there.")] = 0.0,
    rebound: Rebound = None,
    bump: Bump = None,
    of: Of = None,
    goals: wanted.Goals = None,
    out: Out = None,
    plot: Plot = None,
    force: Force = False,
    json: Json = False,
) -> None:
    """Tell toe, camber and displacement of the wheel per kN and per 100 N m, on its bushes.

    The table is about one position; data files and curves go over wheel travel. Of an axle both
    wheels are loaded, in one direction and oppositely.
    """
    from ..study import export
    from ..study.axles import by_side
    from ..study.loads.sheets import compliances, compliances_of_axle
    from ..study.variation.ways import ways_of, with_bushes
    from ..suspension.model import Model

    if goals and rack:
        raise typer.BadParameter(wanted.ELSEWHERE)
    inputs: list[str | Path] = [file, *(read for read in (bushes, goals) if read is not None)]
    outputs = Outputs.of(out, plot, force=force, inputs=inputs)
    where = _Where(at, rack / 1e3, metres(rebound), metres(bump), held)
    on_bushes = described_by(file)
    bushings = described(file, bushes)
    found = _found(on_bushes, bushings, where)
    curves = found.drop_dims(["moved", "by"])
    alone = isinstance(on_bushes, Model)
    drawn = curves if alone else by_side(curves)
    names = named(of if alone else of_both(of), {held: drawn})[held]
    subject = wanted.subject_of(on_bushes)
    aims = wanted.read(goals, [held], ways_of(subject))
    judged = wanted.judged({file: with_bushes(subject, bushings)}, aims) if aims else []
    if outputs.drawn:
        wanted.refuse_beyond(aims, {held: curves})
    written = outputs.write_data(found, rows=curves)
    if outputs.pages:
        from ..plots import curves as plots

        title = f"{title_of(file)}: compliance, {found.attrs['held']}"
        written += [
            plots.write_overview(drawn, path, names, title, goals=aims, force=force, inputs=inputs)
            for path in outputs.pages
        ]
    if json:
        print_json(export.as_dict(found) | ({"goals": judged} if aims else {}))
        return
    title = f"{file}: compliance, at {at:g} mm of wheel travel"
    told = only(of, curves)
    of_wheels = compliances(told, title, at / 1e3)
    for table in (of_wheels, *compliances_of_axle(told, f"{title}, the axle", at / 1e3)):
        if table.rows:
            print_table(table)
    if aims:
        console.print(wanted.table(judged, f"{file}: targets and limits of {goals}"))
    without = found.attrs["left_out"]
    say(f"{found.attrs['held']}; relaxed bushes, linear{without and f'; without {without}'}.")
    name_files(written)


def described(file: str, bushes: Path | None) -> dict[str, Any] | None:
    """Return the bushes of a file of their own, where one is given in place of those of the car."""
    from ..study.loads import read_bushes

    if bushes is None:
        return None
    note(f"bushes: those of {bushes}, in place of any that {file} has.")
    return read_bushes(bushes)


def _found(
    of: "Model | Axle | RigidAxle", bushes: Mapping[str, Any] | None, where: _Where
) -> "Dataset":
    """Return the compliance of what a file describes."""
    from ..assembly.motions import travels
    from ..assembly.rig import Extent
    from ..study import axles, loads, rigid, sweep
    from ..study.rigid.datasets import usual
    from ..suspension.axle import Axle
    from ..suspension.rigid import RigidAxle

    extent = Extent(rebound=where.rebound, bump=where.bump)
    if isinstance(of, RigidAxle):
        refuse_options("files with a rack", {"--rack": where.rack or None})
        usually = usual(of, "bump", extent)
        return rigid.compliance(of, bushes, with_position(usually, where.at), held=where.held)
    if isinstance(of, Axle):
        usually = with_position(travels(of, extent), where.at)
        return axles.compliance(of, bushes, usually, rack_position=where.rack, held=where.held)
    usually = sweep.usual_travel(of, rebound=where.rebound, bump=where.bump, rack=where.rack)
    usually = with_position(usually, where.at)
    return loads.compliance(of, bushes, usually, rack_position=where.rack, held=where.held)
