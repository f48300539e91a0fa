"""What a notebook shows of suspensions, axles, models and motions, as HTML."""

from collections.abc import Iterable, Mapping

from ..plots.animation import still
from ..plots.curves import figure, grouped
from ..plots.overview import from_behind
from ..plots.rigid_axle import views
from ..simulation.result import Simulation
from ..study.recording import dataset_of
from ..suspension.axle import Axle
from ..suspension.kinds import Suspension
from ..suspension.model import Model
from ..suspension.rigid import RigidAxle
from ..systems.linearisation import Linearisation
from ..systems.skeleton import Skeleton
from ..systems.system import System
from .parts import columns, heading, picture, table

# Of a motion so many groups of curves are drawn, those that are looked at first.
_GROUPS = 2


def suspension(shown: Suspension) -> str:
    """Return the page of a suspension: seen from behind, beside its hardpoints."""
    return _of_one(Model(shown), _title(shown))


def model(shown: Model) -> str:
    """Return the page of a model: that of its suspension, with its states and inputs."""
    names = {"states": shown.state_names, "inputs": shown.input_names}
    told = table(("equations", shown.equations.NAME), _listed(names))
    return _of_one(shown, _title(shown.suspension)) + told


def system(shown: System) -> str:
    """Return the page of any mechanism with numbers in it: how it stands at design, its names."""
    name, skeleton = str(shown.equations.NAME), Skeleton(shown)
    places = skeleton.places(shown.design_state[None])
    names = {
        "degrees of freedom": (str(shown.equations.MOBILITY),),
        "states": shown.state_names,
        "inputs": shown.input_names,
        "signals": shown.signal_names,
    }
    told = table((name, ""), _listed(names))
    return heading(name.replace("_", " ")) + columns(picture(still(skeleton, places, 0, "")), told)


def linearisation(shown: Linearisation) -> str:
    """Return the page of linear equations: their modes, and what goes in and comes out."""
    modes = ((f"mode {i}", mode.text) for i, mode in enumerate(shown.modes, 1))
    names = {
        "states": shown.state_names,
        "inputs": shown.input_names,
        "signals": shown.output_names,
    }
    return table(("linear equations", ""), [*modes, *_listed(names)])


def axle(shown: Axle) -> str:
    """Return the page of an axle: both sides from behind, and the hardpoints of the right one."""
    title = shown.heading()
    return heading(f"{title[:1].upper()}{title[1:]}") + columns(
        picture(from_behind([*shown.models.values()])), _points(shown.right)
    )


def rigid_axle(shown: RigidAxle) -> str:
    """Return the page of a rigid axle: three views."""
    return heading("Rigid axle") + picture(views(shown))


def simulation(shown: Simulation) -> str:
    """Return the page of a motion: how it ended, and its first curves."""
    told = {
        "ended": shown.message,
        "time": f"{shown.t[0]:g} s to {shown.t[-1]:g} s, {shown.t.size} outputs",
        "by": f"{shown.solver}, {shown.get('steps', 0)} steps, {shown.nfev} evaluations",
        **{f"warning {i}": str(found) for i, found in enumerate(shown.validity, 1)},
    }
    whole = table(("motion", "" if shown.success else "failed"), told.items())
    if shown.t.size < 2:
        return whole
    curves = dataset_of(shown.signals.model, shown)
    groups = list(grouped(curves).values())[:_GROUPS]
    return whole + "".join(picture(figure(curves, names, alone=False)) for names in groups)


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


def _listed(names: Mapping[str, Iterable[str]]) -> list[tuple[str, str]]:
    return [(what, ", ".join(listed)) for what, listed in names.items()]
