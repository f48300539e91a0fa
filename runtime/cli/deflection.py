"""``kintrafo deflection``: how far wheels give way on their bushes, by any amount."""

from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from .axles import refuse_options
from .compliance import Bushes, Held, described
from .console import print_json, print_table, say
from .options import Bump, File, Force, Json, Rebound
from .outputs import Out, Outputs, Plot, name_files, title_of
from .subject import described_by
from .variation_options import At, with_position

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from xarray import Dataset

    from ..suspension.axle import Axle
    from ..suspension.model import Model
    from ..suspension.rigid import RigidAxle

EXAMPLES = (
    "kintrafo deflection my_car.toml bushes.toml --plot curves.png",
    "kintrafo deflection my_car.toml bushes.toml --under lateral --most 6000 --plot lateral.png",
    "kintrafo deflection reference_axle bushes.toml --motion roll --plot roll.png",
    "kintrafo deflection reference_axle bushes.toml --under braking --wheels opposed",
    "kintrafo deflection rigid_axle axle_bushes.toml --motion roll --plot roll.png",
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
    from ..suspension.model import Model

    inputs: list[str | Path] = [file, *([] if bushes is None else [bushes])]
    outputs = Outputs.of(out, plot, force=force, inputs=inputs)
    of = described_by(file)
    on_axle = not isinstance(of, Model)
    if not on_axle:
        refuse_options("the file of an axle", {"--wheels": wheels, "--motion": motion})
    if under is None:
        if most is not None or held != "height" or wheels is not None:
            raise typer.BadParameter("--most, --held and --wheels go with --under")
        extent = {"rebound": rebound, "bump": bump}
        found = _over(
            of, described(file, bushes), (at, rack), extent, (motion or "bump", hardpoints)
        )
    else:
        if rebound is not None or bump is not None or motion is not None:
            raise typer.BadParameter("--rebound, --bump and --motion are for curves over a motion")
        usual = _USUAL_TORQUE if under == "aligning" else _USUAL
        size = usual if most is None else most
        how: Any = {"held": held, "hardpoints": hardpoints}
        if on_axle:
            how["wheels"] = wheels or "parallel"
        found = _under(of, described(file, bushes), (at, rack), (under, size), how)
    title = f"{file}: {found.attrs['title']}"
    heading = f"{title_of(file)}: {found.attrs['title']}"
    written = outputs.write_data(found, rows=found)
    written += [
        plots.write_overview(found, path, (), heading, force=force, inputs=inputs)
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


def _over(
    of: "Model | Axle | RigidAxle",
    bushings: "Mapping[str, Any] | None",
    where: tuple[float, float],
    extent: dict[str, float | None],
    how: tuple[str, Any],
) -> "Dataset":
    """Return what bushes do over a motion; lengths in mm."""
    from ..study import axles, loads, rigid, sweep
    from ..suspension.axle import Axle
    from ..suspension.rigid import RigidAxle

    (at, rack), (motion, hardpoints) = where, how
    if motion in ("roll", "steer"):
        far = {f"--{name}": end for name, end in extent.items()}
        refuse_options("curves over wheel travel", far)
    ends: Any = {name: None if end is None else end / 1e3 for name, end in extent.items()}
    if isinstance(of, RigidAxle):
        refuse_options("files with a rack", {"--rack": rack or None})
        refuse_options("the file of one suspension, or a load", {"--at": at or None})
        reach = axles.Extent(**ends)
        return rigid.elastokinematics(of, bushings, motion, extent=reach, hardpoints=hardpoints)
    if isinstance(of, Axle):
        return axles.elastokinematics(
            of, bushings, motion, extent=axles.Extent(**ends),
            travel=at / 1e3, rack_position=rack / 1e3, hardpoints=hardpoints,
        )  # fmt: skip
    travels = with_position(sweep.usual_travel(of, rack=rack / 1e3, **ends), at)
    return loads.elastokinematics(
        of, bushings, travels, rack_position=rack / 1e3, hardpoints=hardpoints
    )


def _under(
    of: "Model | Axle | RigidAxle",
    bushings: "Mapping[str, Any] | None",
    where: tuple[float, float],
    load_on_it: tuple[Any, float],
    how: "Mapping[str, Any]",
) -> "Dataset":
    """Return how far loads move what a file describes; lengths in mm."""
    import numpy as np

    from ..core.errors import InputError
    from ..study import axles, loads, rigid
    from ..suspension.axle import Axle
    from ..suspension.rigid import RigidAxle

    (at, rack), (under, most) = where, load_on_it
    if not 0.0 < most < np.inf:
        raise InputError([f"--most {most}: a load of more than 0 is needed."], "deflection")
    amounts = np.linspace(-most, most, _STEPS)
    if isinstance(of, RigidAxle):
        refuse_options("files with a rack", {"--rack": rack or None})
        return rigid.deflection(of, bushings, under, amounts, travel=at / 1e3, **how)
    where_it_is: Any = {"travel": at / 1e3, "rack_position": rack / 1e3}
    if isinstance(of, Axle):
        return axles.deflection(of, bushings, under, amounts, **where_it_is, **how)
    return loads.deflection(of, bushings, under, amounts, **where_it_is, **how)
