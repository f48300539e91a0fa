"""``kintrafo kinematics``: positions over wheel travel and rack."""

from typing import TYPE_CHECKING, Annotated, Literal

import typer

from .console import console, curve_table, print_json, say
from .options import Bump, File, Force, Json, RackExtent, Rebound, Step, load, metres
from .outputs import Figures, Formats, Out, Outputs, Plot, name_files, title_of

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

EXAMPLES = (
    "kintrafo kinematics reference_car",
    "kintrafo kinematics my_car.toml --bump 60 --rebound 90 -o path.csv --plot path.pdf",
    "kintrafo kinematics my_car.toml --over rack --travel 20 --json",
    "kintrafo kinematics my_car.toml --over both --step 10 -o map.nc",
)

_SHOWN = ("wheel_center_x", "wheel_center_y", "wheel_center_z", "camber", "toe", "steer")


def command(
    file: File,
    *,
    over: Annotated[
        Literal["travel", "rack", "both"], typer.Option(help="What varies; both make a grid.")
    ] = "travel",
    rebound: Rebound = None,
    bump: Bump = None,
    rack_extent: RackExtent = None,
    step: Step = 2.0,
    travel: Annotated[
        float, typer.Option(metavar="MM", help="Wheel travel, where the rack varies.")
    ] = 0.0,
    rack: Annotated[
        float, typer.Option(metavar="MM", help="Rack displacement, where the travel varies.")
    ] = 0.0,
    out: Out = None,
    plot: Plot = None,
    figures: Figures = None,
    formats: Formats = None,
    force: Force = False,
    json: Json = False,
) -> None:
    """Positions of wheel and joints over wheel travel and rack displacement."""
    from ..study import export, sweep

    if (travel and over != "rack") or (rack and over != "travel"):
        raise typer.BadParameter(f"--travel and --rack are for what is held; --over is {over}")
    outputs = Outputs.of(out, plot, figures, formats, force=force, inputs=[file])
    model = load(file)
    travels: ArrayLike = travel / 1e3
    racks: ArrayLike = rack / 1e3
    if over != "rack":
        ends = {"rebound": metres(rebound), "bump": metres(bump)}
        travels = sweep.usual_travel(model, **ends, step=step / 1e3, rack=rack / 1e3)
    if over != "travel":
        racks = sweep.usual_rack(
            model, extent=metres(rack_extent), step=step / 1e3, travel=travel / 1e3
        )
    dataset = sweep.positions(model, travels, racks)
    written = outputs.write(dataset, title=title_of(file))
    if json:
        print_json(export.as_dict(dataset))
        return
    if over == "both":
        counts = " x ".join(f"{size} {name}" for name, size in dataset.sizes.items())
        say(f"{counts}, {len(dataset)} variables; write them with --out")
    else:
        console.print(curve_table(dataset, _SHOWN, f"{file}: positions over {over}"))
    name_files(written)
