"""HTML displays of suspensions, axles, models and their motions in notebooks."""

from collections.abc import Iterable

import xarray as xr
from matplotlib.figure import Figure

from ..notebook.pages import motion, rows_of
from ..notebook.parts import columns, heading, picture, table
from ..simulation.result import Simulation
from .kinds import Suspension
from .models.axle import Axle
from .models.model import Model
from .models.whole_axle import WholeAxle
from .plots.curves import figure, grouped
from .plots.overview import from_behind
from .plots.whole_axle import views

# Number of groups of curves drawn of a motion: those looked at first.
_GROUPS = 2


def suspension(shown: Suspension) -> str:
    """Return the page of a suspension: seen from behind, beside its hardpoints."""
    return _of_one(Model(shown), _title(shown))


def model(shown: Model) -> str:
    """Return the page of a model: that of its suspension, with its states and inputs."""
    names = {"states": shown.state_names, "inputs": shown.input_names}
    described = table(("equations", shown.equations.NAME), rows_of(names))
    return _of_one(shown, _title(shown.suspension)) + described


def axle(shown: Axle) -> str:
    """Return the page of an axle: both sides from behind, and the hardpoints of the right one."""
    title = shown.heading()
    return heading(f"{title[:1].upper()}{title[1:]}") + columns(
        picture(from_behind([*shown.models.values()])), _points(shown.right)
    )


def whole_axle(shown: WholeAxle) -> str:
    """Return the page of an axle without sides, such as a rigid one: three views."""
    title = shown.KEY.replace("_", " ")
    return heading(f"{title[:1].upper()}{title[1:]}") + picture(views(shown))


def simulation(shown: Simulation) -> str:
    """Return the page of a motion: how it ended, and the curves that are looked at first."""
    return motion(shown, _first)


def _first(curves: xr.Dataset) -> Iterable[Figure]:
    groups = list(grouped(curves).values())[:_GROUPS]
    return (figure(curves, names, alone=False) for names in groups)


def _of_one(shown: Model, title: str) -> str:
    return heading(title) + columns(picture(from_behind([shown])), _points(shown.suspension))


def _title(shown: Suspension) -> str:
    return f"{shown.heading()}, {shown.vehicle.side} side"


def _points(shown: Suspension) -> str:
    points = shown.hardpoints
    rows = (
        (name, *(f"{1e3 * value + 0.0:.1f}" for value in points.metres(name)))
        for name in points.given()
    )
    side = f"hardpoint, {shown.vehicle.side}"
    return table((side, "x [mm]", "y [mm]", "z [mm]"), rows)
