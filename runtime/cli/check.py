"""``kintrafo check``: what is wrong with a hardpoint file, or what the suspension is like."""

import math
from typing import TYPE_CHECKING, Any

import typer
from rich.markup import escape
from rich.table import Table

from . import axles, rigid
from .console import console, print_json, say
from .exits import Exit
from .options import File, Json, load

if TYPE_CHECKING:
    from ..study.axles.checkup import AxleCheckup
    from ..study.checkup import Checkup
    from ..study.rigid.checkup import RigidAxleCheckup

EXAMPLES = (
    "kintrafo check reference_car",
    "kintrafo check my_car.toml --json",
    "kintrafo check reference_axle",
    "kintrafo check rigid_axle",
)


def command(file: File, *, json: Json = False) -> None:
    """Say what is wrong with a hardpoint file, or sum the suspension up.

    Geometry at design, reachable travel and what limits it, static equilibrium, wheel-hop mode.
    The exit code is 1 if there is a problem.
    """
    from ..core.errors import InputError
    from ..study.checkup import checkup, readable

    of_axle, of_rigid_axle = axles.is_axle(file), rigid.is_rigid_axle(file)
    if not of_axle and not of_rigid_axle:
        readable(file)
    try:
        if of_rigid_axle:
            found: Checkup | AxleCheckup | RigidAxleCheckup = rigid.looked_at(file)
        else:
            found = axles.looked_at(file) if of_axle else checkup(load(file))
    except InputError as error:
        if json:
            print_json({"problems": list(error.problems)})
        else:
            say(str(error))
        raise typer.Exit(Exit.REFUSED) from None
    if json:
        print_json(_as_dict(found))
    else:
        _print(found, file)
    if found.problems:
        raise typer.Exit(Exit.REFUSED)


def _as_dict(found: "Checkup | AxleCheckup | RigidAxleCheckup") -> dict[str, Any]:
    from ..study.axles.checkup import AxleCheckup
    from ..study.axles.checkup import as_dict as of_axle
    from ..study.checkup import as_dict
    from ..study.rigid.checkup import RigidAxleCheckup
    from ..study.rigid.checkup import as_dict as of_rigid_axle

    if isinstance(found, RigidAxleCheckup):
        return of_rigid_axle(found)
    return of_axle(found) if isinstance(found, AxleCheckup) else as_dict(found)


def _print(found: "Checkup | AxleCheckup | RigidAxleCheckup", file: str) -> None:
    from ..study.axles.checkup import AxleCheckup
    from ..study.rigid.checkup import RigidAxleCheckup

    if isinstance(found, RigidAxleCheckup):
        rigid.print_look(found, file)
    else:
        _print_sides(found, file)
    if isinstance(found, AxleCheckup):
        axles.print_look(found, file)
    for kind, texts in (("problem", found.problems), ("note", found.notes)):
        for text in texts:
            say(f"{kind}: {text}")
    if not found.problems:
        say("No problems found.")


def _print_sides(found: "Checkup | AxleCheckup", file: str) -> None:
    from ..study.axles.checkup import AxleCheckup

    for side in found.sides.values() if isinstance(found, AxleCheckup) else (found,):
        console.print(_table(side, file))


def _table(found: "Checkup", file: str) -> Table:
    table = Table(title=f"{escape(file)}: {found.side} {found.title}", show_header=False)
    for name, text in {**_geometry(found), **_travel(found), **_rest(found)}.items():
        table.add_row(name, escape(text))
    return table


def _geometry(found: "Checkup") -> dict[str, str]:
    from ..core.quantities import display_of

    rows = {}
    for name, value in found.geometry.items():
        shown = display_of({"units": "rad" if name.endswith("_angle") else "m"})
        rows[name.replace("_", " ")] = f"{value * shown.factor:.3f} {shown.units}"
    return rows


def _travel(found: "Checkup") -> dict[str, str]:
    low, high = (1e3 * end for end in found.travel)
    rows = {
        "travel down to": f"{low:.1f} mm: {found.reach.lower_limit}",
        "travel up to": f"{high:.1f} mm: {found.reach.upper_limit}",
    }
    if found.extension_travel is not None:
        rows["strut fully extended"] = f"at {1e3 * found.extension_travel:.1f} mm of travel"
    return rows


def _rest(found: "Checkup") -> dict[str, str]:
    from ..study.checkup import USUAL_HOP, USUAL_RIDE

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
