"""Pages of a notebook about mechanisms, linear equations and motions, as HTML."""

from collections.abc import Callable, Iterable, Mapping

import xarray as xr
from matplotlib.figure import Figure

from ..datasets.recording import dataset_of
from ..pictures.animation import still
from ..pictures.curves import draw, varying
from ..simulation.result import Simulation
from ..systems.linearisation import Linearisation
from ..systems.skeleton import Skeleton
from ..systems.system import System
from .parts import columns, heading, picture, table

_MOST = 12  # curves of a motion


def system(shown: System) -> str:
    """Return the page of a mechanism: its picture in the design position, and its names."""
    name, skeleton = str(shown.equations.NAME), Skeleton(shown)
    places = skeleton.places(shown.design_state[None])
    names = {
        "degrees of freedom": (str(shown.equations.MOBILITY),),
        "states": shown.state_names,
        "inputs": shown.input_names,
        "signals": shown.signal_names,
    }
    text = table((name, ""), rows_of(names))
    return heading(name.replace("_", " ")) + columns(picture(still(skeleton, places, 0, "")), text)


def linearisation(shown: Linearisation) -> str:
    """Return the page of linear equations: their modes and names."""
    modes = ((f"mode {i}", mode.text) for i, mode in enumerate(shown.modes, 1))
    names = {
        "states": shown.state_names,
        "inputs": shown.input_names,
        "signals": shown.output_names,
    }
    return table(("linear equations", ""), [*modes, *rows_of(names)])


def simulation(shown: Simulation) -> str:
    """Return the page of a motion: its end, and the curves that vary."""
    return motion(shown, lambda curves: [draw(curves, varying(curves)[:_MOST], alone=False)])


def motion(shown: Simulation, drawn: Callable[[xr.Dataset], Iterable[Figure]]) -> str:
    """Return the page of a motion; `drawn` returns figures of the dataset of the motion."""
    entries = {
        "ended": shown.message,
        "time": f"{shown.t[0]:g} s to {shown.t[-1]:g} s, {shown.t.size} outputs",
        "by": f"{shown.solver}, {shown.get('steps', 0)} steps, {shown.nfev} evaluations",
        **{f"warning {i}": str(found) for i, found in enumerate(shown.validity, 1)},
    }
    whole = table(("motion", "" if shown.success else "failed"), entries.items())
    if shown.t.size < 2:
        return whole
    curves = dataset_of(shown.signals.model, shown)
    return whole + "".join(map(picture, drawn(curves)))


def rows_of(names: Mapping[str, Iterable[str]]) -> list[tuple[str, str]]:
    """Return rows of a table: the kind of each group of names, and these."""
    return [(what, ", ".join(listed)) for what, listed in names.items()]
