"""``kintrafo check``: errors of a file, or a summary of its suspension, axle or car."""

import math
from pathlib import Path
from typing import TYPE_CHECKING

import typer
from rich.markup import escape
from rich.table import Table

from ...terminal.console import console, print_json, say
from ...terminal.exits import Exit
from .loading import assembly_of_file
from .options import File, Json

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ..analysis.checkup import Checkup, WheelFacts

EXAMPLES = (
    "kintrafo check reference_car",
    "kintrafo check my_car.toml --json",
    "kintrafo check reference_axle",
    "kintrafo check rigid_axle",
    "kintrafo check reference_vehicle",
)


def command(file: File, *, json: Json = False) -> None:
    """List the errors of a file, or summarise its suspension, axle or car.

    The summary has the geometry at design, the range of travel with its limits, the static
    equilibrium and the wheel-hop mode; for a car those of each axle with the body held, and the
    centre of gravity. The exit code is 1 if there is a problem.
    """
    from ...core.errors import InputError
    from ..analysis.checkup import as_dict, checkup

    _refuse_missing(file)
    try:
        assembly = assembly_of_file(file)
        found = {part: checkup(one) for part, one in assembly.held_parts.items()}
    except InputError as error:
        if json:
            print_json({"problems": list(error.problems)})
        else:
            say(str(error))
        raise typer.Exit(Exit.REFUSED) from None
    wrong = any(one.problems for one in found.values())
    more = assembly.described() if assembly.body_moves else {}
    of_body = assembly.plausibility().problems if assembly.body_moves else ()
    if json:
        written = {part: as_dict(one) for part, one in found.items()}
        named = {"problems": list(of_body)} if of_body else {}
        print_json(written | more | named if more else written[""])
    else:
        for part, one in found.items():
            _print(one, f"{file}, {part}" if part else file)
        if more:
            console.print(_table(f"{file}: {assembly.heading}", more))
        for text in of_body:
            say(f"problem: {text}")
        if not (of_body or wrong):
            say("No problems found.")
    if of_body or wrong:
        raise typer.Exit(Exit.REFUSED)


def _refuse_missing(file: str) -> None:
    """Refuse a missing file, so that problems of a check are about its content."""
    from ..data.starter import all_packaged
    from ..files.loading import load

    if file not in all_packaged() and not Path(file).is_file():
        load(file)  # raises, and suggests a name


def _print(found: "Checkup", file: str) -> None:
    for wheel in found.wheels:
        rows = {**_geometry(wheel), **_travel(wheel), **_rest(wheel)}
        console.print(_table(f"{file}: {wheel.side} {wheel.title}", rows))
    if found.axle is not None:
        console.print(_table(f"{file}: {found.axle.heading}", found.axle.rows))
    for kind, texts in (("problem", found.problems), ("note", found.notes)):
        for text in texts:
            say(f"{kind}: {text}")


def _table(title: str, rows: "Mapping[str, str]") -> Table:
    table = Table(title=escape(title), show_header=False)
    for name, text in rows.items():
        table.add_row(name, escape(text))
    return table


def _geometry(found: "WheelFacts") -> dict[str, str]:
    from ...core.quantities import display_of

    rows = {}
    for name, value in found.geometry.items():
        shown = display_of({"units": "rad" if name.endswith("_angle") else "m"})
        rows[name.replace("_", " ")] = f"{value * shown.factor:.3f} {shown.units}"
    return rows


def _travel(found: "WheelFacts") -> dict[str, str]:
    low, high = (1e3 * end for end in found.travel)
    rows = {
        "travel down to": f"{low:.1f} mm: {found.reach.lower_limit}",
        "travel up to": f"{high:.1f} mm: {found.reach.upper_limit}",
    }
    if found.extension_travel is not None:
        rows["strut fully extended"] = f"at {1e3 * found.extension_travel:.1f} mm of travel"
    return rows


def _rest(found: "WheelFacts") -> dict[str, str]:
    from ..analysis.checkup import USUAL_HOP, USUAL_RIDE

    rest = found.equilibrium
    if rest is None:
        return {"equilibrium": "none"}
    forces = rest.signals
    rows = {
        "equilibrium": f"wheel centre at {rest.height * 1e3:.3f} mm, "
        f"{rest.travel * 1e3 + 0.0:+.3f} mm from design",
        "forces there": f"tyre {forces['tyre_force']:.0f} N, spring {forces['spring_force']:.0f} N",
        "wheel-hop mode": f"{_frequency(rest.frequency, USUAL_HOP)}, "
        f"damping ratio {rest.damping_ratio:.3f}",
    }
    if not math.isfinite(rest.frequency):
        rows["wheel-hop mode"] = "none"
    if rest.damping_ratio_with_friction is not None:
        rows["wheel-hop mode"] += " without friction"
        rows["below the friction velocity"] = (
            f"damping ratio {rest.damping_ratio_with_friction:.3f}, with the slope of the friction"
        )
    if rest.ride_frequency is not None:
        rows["ride frequency"] = _frequency(rest.ride_frequency, USUAL_RIDE)
    return rows


def _frequency(value: float, usual: tuple[float, float]) -> str:
    return f"{value:.2f} Hz (passenger cars: {usual[0]:g} to {usual[1]:g})"
