"""``kintrafo deflection``: how far wheels give way on their bushes, by any amount."""

from functools import partial
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from .axles import is_axle, refuse_options
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
    "kintrafo deflection reference_axle bushes.toml --motion roll --plot roll.png",
    "kintrafo deflection reference_axle bushes.toml --under braking --wheels opposed",
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
    wheels: Annotated[
        Literal["parallel", "opposed", "left", "right"] | None,
        typer.Option(help="Of an axle, which wheels have the load. Default: parallel."),
    ] = None,
    motion: Annotated[
        Literal["bump", "roll", "left", "right", "steer"] | None,
        typer.Option(help="Of an axle, over which motion without a load. Default: bump."),
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
    far the wheel gives way, beside what is told in proportion to the load. Of an axle both wheels
    in one equilibrium, also over roll and steering.
    """
    from ..plots import curves as plots
    from ..study import export
    from ..study.loads.sheets import deflections, deflections_of_axle

    inputs: list[str | Path] = [file, *([] if bushes is None else [bushes])]
    outputs = Outputs.of(out, plot, force=force, inputs=inputs)
    on_axle = is_axle(file)
    if not on_axle:
        refuse_options("the file of an axle", {"--wheels": wheels, "--motion": motion})
    if under is None:
        if most is not None or held != "height" or wheels is not None:
            raise typer.BadParameter("--most, --held and --wheels go with --under")
        extent = {"rebound": rebound, "bump": bump}
        over: Any = partial(_axle_over, motion=motion or "bump") if on_axle else _over_travel
        found = over(file, described(file, bushes), (at, rack), extent, hardpoints)
    else:
        if rebound is not None or bump is not None or motion is not None:
            raise typer.BadParameter("--rebound, --bump and --motion are for curves over a motion")
        usual = _USUAL_TORQUE if under == "aligning" else _USUAL
        size = usual if most is None else most
        how: Any = {"held": held, "hardpoints": hardpoints}
        if on_axle:
            how["wheels"] = wheels or "parallel"
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
    sheets = deflections_of_axle(found, title) if on_axle else [deflections(found, title)]
    for sheet in sheets:
        print_table(sheet)
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


def _axle_over(
    file: str,
    bushings: "Mapping[str, Any] | None",
    where: tuple[float, float],
    extent: dict[str, float | None],
    hardpoints: Any,
    *,
    motion: str,
) -> "Dataset":
    from ..study.axles import Extent, elastokinematics
    from ..suspension.axle import Axle

    (at, rack), far = where, {f"--{name}": end for name, end in extent.items()}
    if motion in ("roll", "steer"):
        refuse_options("curves over wheel travel", far)
    ends: Any = {name: None if end is None else end / 1e3 for name, end in extent.items()}
    return elastokinematics(
        Axle.load(file), bushings, motion, extent=Extent(**ends),
        travel=at / 1e3, rack_position=rack / 1e3, hardpoints=hardpoints,
    )  # fmt: skip


def _under(
    file: str,
    bushings: "Mapping[str, Any] | None",
    where: tuple[float, float],
    load_on_it: tuple[Any, float],
    how: "Mapping[str, Any]",
) -> "Dataset":
    import numpy as np

    from ..core.errors import InputError
    from ..study import axles, loads

    (at, rack), (under, most) = where, load_on_it
    if not 0.0 < most < np.inf:
        raise InputError([f"--most {most}: a load of more than 0 is needed."], "deflection")
    amounts = np.linspace(-most, most, _STEPS)
    where_it_is: Any = {"travel": at / 1e3, "rack_position": rack / 1e3}
    if is_axle(file):
        from ..suspension.axle import Axle

        return axles.deflection(Axle.load(file), bushings, under, amounts, **where_it_is, **how)
    return loads.deflection(load(file), bushings, under, amounts, **where_it_is, **how)
