"""``kintrafo characteristics``: all characteristics over wheel travel and over the rack."""

from math import radians
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.markup import escape
from rich.table import Table

from ..core.tabulated import significant
from . import axles, rigid
from . import goals as wanted
from .console import console, print_json
from .options import Bump, File, Force, Json, Of, RackExtent, Rebound, Step, among, load, metres
from .outputs import Figures, Formats, Out, Outputs, Plot, name_files, named, only, title_of

if TYPE_CHECKING:
    from xarray import Dataset

EXAMPLES = (
    "kintrafo characteristics reference_car",
    "kintrafo characteristics my_car.toml -o curves.csv --plot curves.pdf",
    "kintrafo characteristics my_car.toml --figures figures --format svg",
    "kintrafo characteristics my_car.toml --goals goals.toml --plot curves.png",
    "kintrafo characteristics reference_axle --motion bump --motion roll -o axle.csv",
)


def command(
    file: File,
    *,
    rebound: Rebound = None,
    bump: Bump = None,
    rack_extent: RackExtent = None,
    motion: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME",
            help="Of an axle: what the rig does, of bump, roll, left, right, steer. May be "
            "repeated. Default: bump, roll, left, steer. A rigid axle is not steered.",
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
    out: Out = None,
    plot: Plot = None,
    figures: Figures = None,
    formats: Formats = None,
    force: Force = False,
    json: Json = False,
) -> None:
    """All characteristics over wheel travel, and over a rack; a table of them at design.

    Data files and pages are written twice, with _travel and _rack behind their names. Of an axle
    they go over the motions of a rig, with _bump, _roll, _left and _steer.
    """
    from ..assembly.motions import MOTIONS
    from ..assembly.rig import Extent
    from ..study import characteristics, export, sweep
    from ..study.characteristics.datasets import refuse_of_steering
    from ..suspension.axle import Axle
    from ..suspension.kinds import Suspension

    if goals and (travel or rack):
        raise typer.BadParameter(wanted.ELSEWHERE)
    of_axle, of_rigid_axle = axles.is_axle(file), rigid.is_rigid_axle(file)
    if of_rigid_axle:
        steered, chosen = False, rigid.motions(motion)
    else:
        steered = (Axle if of_axle else Suspension).load(file).steered()
        usual = ["bump", "roll", "left", *(["steer"] if steered else [])]
        chosen = among(motion or usual, MOTIONS, "--motion")
    ways = ["travel", "rack"] if steered else ["travel"]
    outputs = Outputs.of(
        out,
        plot,
        figures,
        formats,
        force=force,
        inputs=[file, *([goals] if goals else [])],
        suffixes=[f"_{name}" for name in (chosen if of_axle or of_rigid_axle else ways)],
    )
    if of_axle or of_rigid_axle:
        extent = Extent(
            rebound=metres(rebound),
            bump=metres(bump),
            roll=None if roll is None else radians(roll),
            rack=metres(rack_extent),
            step=step / 1e3,
        )
        if of_rigid_axle:
            steering = {"--rack-extent": rack_extent, "--rack": rack or None}
            axles.refuse_options("what has a rack", steering | {"--travel": travel or None})
            rigid.characteristics(file, chosen, extent, outputs, of=of, goals=goals, json=json)
            return
        held = {"travel": travel / 1e3, "rack": rack / 1e3}
        axles.characteristics(file, chosen, extent, held, outputs, of=of, goals=goals, json=json)
        return
    axles.refuse_options("the file of an axle", {"--motion": motion, "--roll": roll})
    aims = wanted.read(goals, ways)
    model = load(file)
    ends: dict[str, Any] = {"rebound": metres(rebound), "bump": metres(bump)}
    at_travel, at_rack, spacing = travel / 1e3, rack / 1e3, step / 1e3
    travels = sweep.usual_travel(model, **ends, step=spacing, rack=at_rack)
    curves = {"travel": characteristics.travel(model, travels, rack_position=at_rack)}
    if steered or rack_extent is not None or travel:
        racks = sweep.usual_rack(model, extent=metres(rack_extent), step=spacing, travel=at_travel)
        curves["rack"] = characteristics.steering(model, racks, travel=at_travel)
    refuse_of_steering(model.suspension, of or ())
    drawn = named(of, curves)
    judged = wanted.judged({file: model.suspension}, aims)
    if outputs.drawn:
        wanted.refuse_beyond(aims, curves)
    written = [
        path
        for over, dataset in curves.items()
        for path in outputs.write(
            dataset, title=title_of(file), suffix=f"_{over}", names=drawn[over], goals=aims
        )
    ]
    if json:
        found = {f"over_{over}": export.as_dict(curves[over]) for over in curves}
        print_json(found | ({"goals": judged} if aims else {}))
        return
    told = {over: only(of, dataset) for over, dataset in curves.items()}
    for over in filter(told.get, told):
        console.print(_at_design(told[over], f"{file}: characteristics over {over}, at design"))
    if aims:
        console.print(wanted.table(judged, f"{file}: targets and limits of {goals}"))
    name_files(written)


def _at_design(dataset: "Dataset", title: str) -> Table:
    """Return the table of all variables at zero of the dataset's dimension."""
    from ..core.quantities import displayed, long_name, unit_or_stroke

    (along,) = dataset.sizes
    index = int(abs(dataset[along].values).argmin())
    table = Table(title=escape(title))
    table.add_column("characteristic")
    table.add_column("value", justify="right")
    table.add_column("unit")
    table.add_column("sign")
    for data in dataset.values():
        unit = unit_or_stroke(data.attrs)
        value = significant(float(displayed(data)[index]))
        table.add_row(long_name(data), value, unit, str(data.attrs.get("sign", "")))
    return table
