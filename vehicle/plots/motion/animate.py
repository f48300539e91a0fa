"""Animations of the motion of a car, as a GIF or as a page with a player."""

from pathlib import Path

import numpy as np
import xarray as xr
from markupsafe import Markup

from ....core.errors import InputError
from ....core.files import Paths, refuse, replacing
from ....core.validator import Validator
from ....pages.animation import MOST_FRAMES, frames
from ...analysis.handling.result import HandlingResult
from ...analysis.run import Run
from .charts import charts_of
from .page import motion_page, player
from .picture import write_gif
from .scene import scene_of

ENDINGS = (".gif", ".html", ".htm")
_FPS = 25.0
# Most positions of a page: one for each tenth of a second of a manoeuvre of 100 s.
_MOST_POSITIONS = 1000
_ROUNDING = 1e-9


def animate(
    result: HandlingResult | Run,
    path: str | Path,
    *,
    title: str = "",
    force: bool = False,
    inputs: Paths = (),
) -> Path:
    """Write an animation of a car, in real time, and return its path.

    Links, springs and wheels are drawn at their solved positions, with the forces of the road on
    the tyres. A car that drives is shown with the path of its reference point and cones, other cars
    with the road under the wheels. The outline of the body is schematic: it has the wheelbase and
    track of the car.

    Parameters
    ----------
    result : HandlingResult or Run
        Result of `kintrafo.handling.drive` or `kintrafo.ride.run`. Of several simulations of a
        manoeuvre the last one is shown.
    path : str or pathlib.Path
        ``.gif`` for an animated picture with 25 frames per second, fewer for a motion longer than a
        minute; or ``.html`` for a page with a player, a view that turns, and curves.
    title : str, optional
    force : bool, optional
        Whether a file that kintrafo did not write is replaced, see `kintrafo.core.files`.
    inputs : iterable of str or pathlib.Path, optional
        Files that are never replaced.

    Returns
    -------
    pathlib.Path

    Raises
    ------
    InputError
        If nothing was simulated, as in steady turns; or if the file must not be written.
    """
    with Validator("animate") as given:
        given.instance("result", result, (HandlingResult, Run), _NEEDED)
        given.text("title", title)
    refuse([path], force=force, inputs=inputs, endings=ENDINGS)
    run, cones = _shown(result)
    picture = Path(path).suffix.lower() == ".gif"
    per_second = _per_second(run, MOST_FRAMES if picture else _MOST_POSITIONS)
    if picture:  # which counts the time of a frame in hundredths of a second
        per_second = 100.0 / np.ceil(100.0 / per_second - _ROUNDING)
    rows = frames(run.motion["time"].values, per_second)[1]
    scene = scene_of(run, rows, cones=cones)
    with replacing(path, force=force, inputs=inputs) as temporary:
        if picture:
            write_gif(temporary, scene, title, per_second)
        else:
            page = motion_page(scene, charts_of(run.motion, rows), title)
            temporary.write_text(page, encoding="utf-8", newline="\n")
    return Path(path)


def played(result: HandlingResult | Run) -> Markup:
    """Return the part of a page that plays a manoeuvre or a ride; see `page.player`."""
    run, cones = _shown(result)
    rows = frames(run.motion["time"].values, _per_second(run, _MOST_POSITIONS))[1]
    return player(scene_of(run, rows, cones=cones), charts_of(run.motion, rows))


def _shown(result: HandlingResult | Run) -> tuple[Run, xr.Dataset | None]:
    """Return the simulation that is shown, and its cones."""
    if isinstance(result, Run):
        return result, None
    if not result.runs:
        problem = "steady turns and parking have no simulation, and so no motion to show."
        raise InputError([problem], "animate")
    return result.runs[-1], result.curves.get("_cones")


def _per_second(run: Run, most: int) -> float:
    """Return the number of frames per second for at most `most` frames."""
    times = run.motion["time"].values
    return min(_FPS, (most - 1) / max(float(times[-1] - times[0]), 1.0))


_NEEDED = "a result of kintrafo.handling.drive or kintrafo.ride.run is needed"
