"""Writing the motion of a car that drives as a GIF, or as a page that plays it."""

from pathlib import Path

from ....core.errors import InputError
from ....core.files import Paths, refuse, replacing
from ....core.validator import Validator
from ....pages.animation import frames
from ...analysis.handling.result import HandlingResult
from .page import driving_page
from .picture import write_gif
from .scene import scene_of

ENDINGS = (".gif", ".html", ".htm")
_FPS = 25.0
# Positions of a page at most: one for a tenth of a second of a manoeuvre of 100 s.
_MOST_POSITIONS = 1000


def animate(
    result: HandlingResult,
    path: str | Path,
    *,
    title: str | None = None,
    force: bool = False,
    inputs: Paths = (),
) -> Path:
    """Write an animation of a car in a manoeuvre, in real time, and return its path.

    Links, springs and wheels are drawn at their solved positions, with the forces of the road on
    the tyres, the path of the reference point and cones. The outline of the body is schematic: it
    has the wheelbase and track of the car. Of several simulations the last one is shown.

    Parameters
    ----------
    result : HandlingResult
        What `kintrafo.handling.drive` returned.
    path : str or pathlib.Path
        Ends in ``.gif``, for an animated picture with 25 frames per second, or ``.html``, for a
        page to play, stop and turn.
    title : str, optional
        By default that of the manoeuvre.
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
        If nothing was simulated, as in steady turns; if a GIF would have too many frames; or if the
        file must not be written.
    """
    with Validator("animate") as given:
        given.instance("result", result, HandlingResult, "what kintrafo.handling.drive returns")
        if title is not None:
            given.text("title", title)
    refuse([path], force=force, inputs=inputs, endings=ENDINGS)
    if not result.runs:
        raise InputError(["steady turns are not simulated: there is no motion to show"], "animate")
    run = result.runs[-1]
    times, picture = run.motion["time"].values, Path(path).suffix.lower() == ".gif"
    seconds = float(times[-1] - times[0])
    per_second = _FPS if picture else min(_FPS, (_MOST_POSITIONS - 1) / max(seconds, 1.0))
    _, rows = frames(times, per_second)
    scene = scene_of(run, rows, cones=result.curves.get("_cones"))
    heading = title or str(result.metrics.attrs["title"])
    with replacing(path, force=force, inputs=inputs) as temporary:
        if picture:
            write_gif(temporary, scene, heading, _FPS)
        else:
            page = driving_page(scene, heading)
            temporary.write_text(page, encoding="utf-8", newline="\n")
    return Path(path)
