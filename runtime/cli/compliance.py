"""``kintrafo compliance``: how the wheel gives way on its bushes."""

from pathlib import Path
from typing import Annotated, Literal

import typer

from .console import print_json, print_table, say
from .options import Bump, File, Force, Json, Rebound, load, metres
from .outputs import Out, Outputs, Plot, name_files
from .variation_options import At, with_position

EXAMPLES = (
    "kintrafo compliance my_car.toml bushes.toml",
    "kintrafo compliance my_car.toml bushes.toml --held spring --plot curves.png -o curves.csv",
)


def command(
    file: File,
    bushes: Annotated[
        Path,
        typer.Argument(metavar="BUSHES", help="TOML: [bushings.POINT] with stiffnesses."),
    ],
    *,
    held: Annotated[
        Literal["height", "spring", "locked"],
        typer.Option(help="What holds the wheel: see docs/loads.md."),
    ] = "height",
    at: At = 0.0,
    rack: Annotated[float, typer.Option(metavar="MM", help="Rack held there.")] = 0.0,
    rebound: Rebound = None,
    bump: Bump = None,
    out: Out = None,
    plot: Plot = None,
    force: Force = False,
    json: Json = False,
) -> None:
    """Tell toe, camber and displacement of the wheel per kN and per 100 N m, on its bushes.

    The table is about one position; data files and curves go over wheel travel.
    """
    from ..study import export, sweep
    from ..study import loads as study
    from ..study.loads.sheets import compliances

    outputs = Outputs.of(out, plot, force=force, inputs=[file, bushes])
    model = load(file)
    described = study.read_bushes(bushes)
    usual = sweep.usual_travel(model, rebound=metres(rebound), bump=metres(bump), rack=rack / 1e3)
    travels = with_position(usual, at)
    found = study.compliance(model, described, travels, rack_position=rack / 1e3, held=held)
    curves = found.drop_dims(["moved", "by"])
    written = outputs.write_data(found, rows=curves)
    if outputs.pages:
        from ..plots import curves as plots

        title = f"{file}: compliance, {found.attrs['held']}"
        written += [
            plots.write_overview(curves, path, (), title, force=force, inputs=[file, bushes])
            for path in outputs.pages
        ]
    if json:
        print_json(export.as_dict(found))
        return
    title = f"{file}: compliance, at {at:g} mm of wheel travel"
    print_table(compliances(curves, title, at / 1e3))
    say(f"{found.attrs['held']}; relaxed bushes, linear.")
    name_files(written)
