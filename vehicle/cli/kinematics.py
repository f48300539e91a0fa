"""``kintrafo kinematics``: positions over wheel travel and rack."""

from typing import TYPE_CHECKING, Annotated, Literal

import typer

from ...terminal.console import console, curve_table, print_json, say
from .option_groups import with_groups
from .options import Bump, File, Json, RackExtent, Rebound, Step, metres
from .outputs import USUAL_OUTPUT, OutputOptions, name_files, title_of
from .subject import assembly_of_file

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

EXAMPLES = (
    "kintrafo kinematics reference_car",
    "kintrafo kinematics my_car.toml --bump 60 --rebound 90 -o path.csv --plot path.pdf",
    "kintrafo kinematics my_car.toml --over rack --travel 20 --json",
    "kintrafo kinematics my_car.toml --over both --step 10 -o map.nc",
    "kintrafo kinematics reference_axle -o axle_path.csv",
)

_SHOWN = ("wheel_center_x", "wheel_center_y", "wheel_center_z", "camber", "toe", "steer")


@with_groups
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
    output: OutputOptions = USUAL_OUTPUT,
    json: Json = False,
) -> None:
    """Positions of wheels and joints over wheel travel and rack displacement.

    Both wheels of an axle travel in parallel.
    """
    from ...datasets import export
    from ..analysis import sweep
    from ..assembly.by_wheel import flat
    from ..assembly.rig import SweepRange

    if (travel and over != "rack") or (rack and over != "travel"):
        raise typer.BadParameter(f"--travel and --rack are for what is held; --over is {over}")
    outputs = output.of(inputs=[file])
    assembly = assembly_of_file(file)
    extent = SweepRange(
        rebound=metres(rebound), bump=metres(bump), rack=metres(rack_extent), step=step / 1e3
    )
    held = {"travel": travel / 1e3, "rack": rack / 1e3}
    travels: ArrayLike = held["travel"]
    racks: ArrayLike = held["rack"]
    if over != "travel" and not assembly.steered:
        assembly.refuse_motion("rack")
        raise typer.BadParameter(f"--over {over}: this axle has no rack")
    if over != "rack":
        travels = assembly.usual(assembly.usual_motion, extent, **held)
    if over != "travel":
        racks = assembly.usual("rack", extent, **held)
    dataset = sweep.positions(assembly, travels, racks)
    written = outputs.write(dataset, title=title_of(file))
    if json:
        print_json(export.as_dict(dataset))
        return
    if over == "both":
        sizes = {name: size for name, size in dataset.sizes.items() if name != "wheel"}
        counts = " x ".join(f"{size} {name}" for name, size in sizes.items())
        say(f"{counts}, {len(flat(dataset))} variables; write them with --out")
    else:
        for wheel in assembly.wheels:
            own, title = dataset, f"{file}: positions over {over}"
            if "wheel" in dataset.dims:
                own, title = dataset.sel(wheel=wheel, drop=True), f"{title}, {wheel}"
            console.print(curve_table(own, [name for name in _SHOWN if name in own], title))
    name_files(written)
