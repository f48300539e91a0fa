"""``kintrafo import``: a suspension or a car of another program, or hardpoints of a table."""

from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from textwrap import wrap
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from ...terminal.console import note, say
from ..data.starter import kinds
from .options import FILE, Force, argument, complete_file, option

EXAMPLES = (
    "kintrafo import points.csv new_car.toml --from my_car.toml",
    "kintrafo import left_side.xlsx new_car.toml --from my_car.toml --mirror",
    (
        "kintrafo import cad.csv new_car.toml --from my_car.toml --unit in "
        '--axes "rearward right up" --name "ball_joint=FLCA outboard"'
    ),
    "kintrafo import MacPhersonStrut.json new_car.toml --tire RigidTire.json --side right",
    "kintrafo import DoubleWishbone.json new_car.toml --points-only",
    "kintrafo import Vehicle_DoubleWishbones_ARB.json vehicle.toml --tire RigidTire.json",
    "kintrafo import front_suspension.sub new_car.toml",
    "kintrafo import front_suspension.sub right.toml --side right --from my_wishbones.toml",
    "kintrafo import own.sub new_car.toml --name lower_ball_joint=my_lca_outer",
)

_WIDTH = 98  # of a comment's text
_TABLES, _ADAMS, _CHRONO = "Of tables", "Of Adams/Car", "Of Project Chrono"

# the choices are read from the files of the kinds
if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from ..files.formats import Format

    Kind = str
else:
    Kind = Literal[kinds()]
Side = Literal["left", "right"]


@dataclass(frozen=True)
class _Options:
    """The options of formats; each format has some of them."""

    base: Annotated[
        str | None,
        option(
            "Hardpoint file with all values that SOURCE lacks. A table needs one; for Adams/Car "
            "the default is a packaged one.",
            "FILE",
            "--from",
            autocompletion=complete_file,
        ),
    ] = None
    name: Annotated[
        list[str] | None,
        option("Name of a hardpoint in the table or in Adams/Car. May be repeated.", "OURS=THEIRS"),
    ] = None
    side: Annotated[
        Side | None,
        option(
            "Of Adams/Car and Project Chrono: side of the car. Default: that of --from, or left."
        ),
    ] = None
    mirror: Annotated[bool, option("The table is of the other side of the car.", panel=_TABLES)] = (
        False
    )
    unit: Annotated[
        str | None,
        option("If the table gives no unit: mm, cm, m, in or ft.", "UNIT", panel=_TABLES),
    ] = None
    axes: Annotated[
        str | None,
        option(
            "Directions of x, y and z: three of forward, rearward, left, right, up, down. Default: "
            "forward left up (ISO 8855).",
            "WORDS",
            panel=_TABLES,
        ),
    ] = None
    left_handed: Annotated[bool, option("The axes of --axes are left-handed.", panel=_TABLES)] = (
        False
    )
    sheet: Annotated[
        str | None, option("Sheet of a workbook that has several.", "NAME", panel=_TABLES)
    ] = None
    kind: Annotated[
        Kind | None,
        option("Type of suspension. Default: by the hardpoints.", panel=_ADAMS),
    ] = None
    tire: Annotated[
        Path | None,
        option("File of a tire: radius, mass and inertia.", "JSON", panel=_CHRONO, **FILE),
    ] = None
    points_only: Annotated[
        bool,
        option(
            "Read only hardpoints, camber and toe; other values are those of the packaged file.",
            panel=_CHRONO,
        ),
    ] = False


def command(
    source: Annotated[
        Path,
        argument(
            "Subsystem of Adams/Car as text (.sub); suspension or vehicle of Project Chrono "
            "(.json); table .csv, .txt or .xlsx with a row for each point and columns point, "
            "x [mm], y [mm], z [mm], also an export of OptimumK or a text of Lotus Suspension "
            "Analysis.",
            "SOURCE",
            **FILE,
        ),
    ],
    path: Annotated[Path, argument("File to write; ends in .toml.", "PATH")],
    *,
    given: _Options,
    force: Force = False,
) -> None:
    """Write the file of a suspension or a car from another program, or from a table of points.

    The format follows from the ending or the content of SOURCE. A table has hardpoints; all other
    values, and the comments, are those of the file after --from. A file of Adams/Car has
    hardpoints, camber, toe and a spring. Data that files of Project Chrono lack are assumed. A
    whole vehicle of Project Chrono becomes five files: PATH is that of the car, and the files of
    its axles and suspensions are in the same folder. The output lists the data that were read,
    assumed and left out.
    """
    from ...core.errors import InputError
    from ...core.files import refuse
    from ..files.formats import NAMES, format_of

    inputs = [source, *(file for file in (given.base, given.tire) if file is not None)]
    refuse([path], force=force, inputs=inputs, endings=[".toml"])
    found = format_of(source)
    read, options = _READERS[found]
    for key, value in vars(given).items():
        if value and key not in options:
            spelled = "--from" if key == "base" else f"--{key.replace('_', '-')}"
            raise typer.BadParameter(f"{spelled} is not for {NAMES[found]}, as {source} is read")
    try:
        read(source, path, {"force": force, "inputs": inputs}, given)
    except InputError:
        note(f"{source} is read as {NAMES[found]}.")
        raise
    say(f"Check it: kintrafo check {path}")


def _table(source: Path, path: Path, rule: Any, given: _Options) -> None:
    from ..files.point_names import read_names
    from ..files.point_table import as_words, doubts, merged, read_points, write_merged

    if given.base is None:
        raise typer.BadParameter(
            "a table of hardpoints needs --from FILE, a hardpoint file that the rest is taken from"
        )
    names = read_names(given.name or ())
    how: Any = {key: getattr(given, key) for key in ("unit", "axes", "left_handed", "sheet")}
    table = read_points(source, **how)
    found = merged(table, given.base, mirrored=given.mirror, names=names)
    say(f"  {write_merged(found, path, **rule)}")
    for head, text in as_words(found, table).items():
        say(f"  {head}: {text}")
    if doubt := doubts(found):
        note(f"note: {doubt}")


def _adams(source: Path, path: Path, rule: Any, given: _Options) -> None:
    from ..files.adams_car import imported, read, read_names
    from ..files.point_table import write_merged

    how: Any = {key: getattr(given, key) for key in ("side", "kind", "base")}
    found = imported(read(source), names=read_names(given.name or ()), **how)
    say(f"  {write_merged(found, path, **rule)}")
    for head, text in found.words():
        say(f"  {head:<8}  {text}")


def _chrono(source: Path, path: Path, rule: Any, given: _Options) -> None:
    from ..files.chrono import read
    from ..files.chrono.vehicle import is_vehicle
    from ..input.toml_writer import write_toml

    if is_vehicle(source):
        _chrono_vehicle(source, path, rule, given)
        return
    found = read(source, tire=given.tire, points_only=given.points_only)
    files = f"{source.name} and {given.tire.name}" if given.tire else source.name
    suspension = found.suspension.mirrored() if given.side == "right" else found.suspension
    write_toml(suspension, path, head=_head(files, found), **rule)
    say(f"  {path}")
    _lists(found)


def _chrono_vehicle(source: Path, path: Path, rule: Any, given: _Options) -> None:
    from ..files.car_files import car_files
    from ..files.chrono import read_vehicle
    from ..input.toml_writer import write_several

    for name, value in (("--side", given.side), ("--points-only", given.points_only)):
        if value:
            raise typer.BadParameter(f"{name} is not for a whole vehicle, as {source} is")
    found = read_vehicle(source, tire=given.tire)
    rule = rule | {"inputs": [*rule["inputs"], *found.files]}
    named = f"{source.name} and the files that it names"
    heads = {path: _head(named, found)}
    other = [_from(named), f"What was assumed and left out is listed in {path.name}."]
    files = {f: (part, heads.get(f, other)) for f, part in car_files(found.car, path).items()}
    for file in write_several(files, **rule):
        say(f"  {file}")
    _lists(found)


def _head(files: str, found: Any) -> list[str]:
    """Return the comment at the top of a file."""
    head = [_from(files)]
    for title, lines in (("Assumed:", found.assumptions), ("Left out:", found.left_out)):
        parts = (wrap(x, _WIDTH, initial_indent="  ", subsequent_indent="    ") for x in lines)
        head += [title, *chain.from_iterable(parts)] if lines else []
    return head


def _from(files: str) -> str:
    return f"From {files} of Project Chrono (https://projectchrono.org)."


def _lists(found: Any) -> None:
    for line in found.assumptions:
        say(f"  assumed   {line}")
    for line in found.left_out:
        say(f"  left out  {line}")


# The reader of each format, and its options.
_READERS: "Mapping[Format, tuple[Callable[..., None], frozenset[str]]]" = {
    "table": (
        _table,
        frozenset({"base", "name", "mirror", "unit", "axes", "left_handed", "sheet"}),
    ),
    "adams": (_adams, frozenset({"base", "name", "side", "kind"})),
    "chrono": (_chrono, frozenset({"side", "tire", "points_only"})),
}
