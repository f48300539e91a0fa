"""``kintrafo deflection``: how far wheels give way on their bushes, by any amount."""

from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from .axles import is_axle
from .compliance import Bushes, Held, described
from .console import print_json, print_table, say
from .options import Bump, File, Force, Json, Rebound, load
from .outputs import Out, Outputs, Plot, name_files
from .variation_options import At, with_position

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from xarray import Dataset

EXAMPLES = (
    "kintrafo deflection my_car.toml bushes.toml --plot curves.png",
    "kintrafo deflection my_car.toml bushes.toml --under lateral --most 6000 --plot lateral.png",
)

# Loads that a suspension meets, N and N m.
_USUAL, _USUAL_TORQUE = 5000.0, 250.0
_STEPS = 41


def command(
    file: File,
    bushes: Bushes = None,
    *,
    under: Annotated[
        Literal["lateral", "braking", "recession", "aligning"] | None,
        typer.Option(help="Under which load. Default: over wheel travel, without one."),
    ] = None,
    most: Annotated[
        float | None,
        typer.Option(metavar="N", help="Greatest load, N or N m. Default: 5000, aligning 250."),
    ] = None,
    held: Annotated[
        Held, typer.Option(help="What holds the wheel under a load: see docs/loads.md.")
    ] = "height",
    hardpoints: Annotated[
        Literal["loaded", "relaxed"],
        typer.Option(
            help="Whether the joints are at the hardpoints under the static load at design, or "
            "with relaxed bushes."
        ),
    ] = "loaded",
    at: At = 0.0,
    rack: Annotated[float, typer.Option(metavar="MM", help="Rack held there.")] = 0.0,
    rebound: Rebound = None,
    bump: Bump = None,
    out: Out = None,
    plot: Plot = None,
    force: Force = False,
    json: Json = False,
) -> None:
    """Tell what bushes do to a wheel by equilibrium, however far they give way.

    Over wheel travel: toe, camber and path with rigid joints and on the bushes. Under a load: how
    far the wheel gives way, beside what is told in proportion to the load.
    """
    from ..plots import curves as plots
    from ..study import export
    from ..study.loads.sheets import deflections

    inputs: list[str | Path] = [file, *([] if bushes is None else [bushes])]
    outputs = Outputs.of(out, plot, force=force, inputs=inputs)
    if is_axle(file):
        raise typer.BadParameter("the file of one suspension is needed; give a side of the axle")
    if under is None:
        if most is not None or held != "height":
            raise typer.BadParameter("--most and --held go with --under")
        extent = {"rebound": rebound, "bump": bump}
        found = _over_travel(file, described(file, bushes), (at, rack), extent, hardpoints)
    else:
        if rebound is not None or bump is not None:
            raise typer.BadParameter("--rebound and --bump are for curves over travel")
        usual = _USUAL_TORQUE if under == "aligning" else _USUAL
        size = usual if most is None else most
        how: Any = {"held": held, "hardpoints": hardpoints}
        found = _under(file, described(file, bushes), (at, rack), (under, size), how)
    title = f"{file}: {found.attrs['title']}"
    written = outputs.write_data(found, rows=found)
    written += [
        plots.write_overview(found, path, (), title, force=force, inputs=inputs)
        for path in outputs.pages
    ]
    if json:
        print_json(export.as_dict(found))
        return
    print_table(deflections(found, title))
    told = [found.attrs[key] for key in ("held", "hardpoints") if key in found.attrs]
    say(f"{'; '.join(told)}.")
    name_files(written)


def _over_travel(
    file: str,
    bushings: "Mapping[str, Any] | None",
    where: tuple[float, float],
    extent: dict[str, float | None],
    hardpoints: Any,
) -> "Dataset":
    from ..study import sweep
    from ..study.loads import elastokinematics

    model, (at, rack) = load(file), where
    ends: Any = {name: None if end is None else end / 1e3 for name, end in extent.items()}
    travels = with_position(sweep.usual_travel(model, rack=rack / 1e3, **ends), at)
    return elastokinematics(
        model, bushings, travels, rack_position=rack / 1e3, hardpoints=hardpoints
    )


def _under(
    file: str,
    bushings: "Mapping[str, Any] | None",
    where: tuple[float, float],
    load_on_it: tuple[Any, float],
    how: "Mapping[str, Any]",
) -> "Dataset":
    import numpy as np

    from ..core.errors import InputError
    from ..study.loads import deflection

    (at, rack), (under, most) = where, load_on_it
    if not 0.0 < most < np.inf:
        raise InputError([f"--most {most}: a load of more than 0 is needed."], "deflection")
    amounts = np.linspace(-most, most, _STEPS)
    model = load(file)
    return deflection(
        model, bushings, under, amounts, travel=at / 1e3, rack_position=rack / 1e3, **how
    )
