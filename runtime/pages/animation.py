"""A motion of any mechanism as a GIF, or as a page that plays it."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..core.errors import InputError
from ..core.files import Paths, refuse, replacing
from ..core.named_types import Array
from ..core.validator import Validator
from ..pictures.animation import write_gif
from ..simulation.result import Simulation
from ..systems.skeleton import Skeleton
from .mechanism.page import motion_page

Indices = NDArray[np.intp]

ENDINGS = (".gif", ".html", ".htm")
_QUICKEST = 50.0  # frames per second: no viewer of GIFs is quicker
MOST_FRAMES = 1500
"""A GIF with more frames is too long for viewers."""


def animate(
    result: Simulation,
    path: str | Path,
    *,
    fps: float = 25.0,
    slower: float = 1.0,
    title: str | None = None,
    force: bool = False,
    inputs: Paths = (),
) -> Path:
    """Write a motion of a mechanism or a suspension as a GIF or a page, and return its path.

    Parameters
    ----------
    result : Simulation
        A result of `kintrafo.simulate`.
    path : str or pathlib.Path
        Ends in ``.gif``, for an animated picture, or ``.html``, for a page that plays the motion
        and turns the picture.
    fps : float, optional
        Frames per second of a GIF, from 1 to 50. A frame shows the output nearest in time.
    slower : float, optional
        Factor by which a GIF plays slower than real time, above zero.
    title : str, optional
        Heading of a page; by default the title of the mechanism.
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
        If an argument cannot be used, or the file must not be written.

    Examples
    --------
    >>> from kintrafo import animate
    >>> import tempfile
    >>> import numpy as np
    >>> import kintrafo
    >>> from kintrafo.generated import four_bar
    >>> system = kintrafo.System(four_bar)
    >>> times = np.linspace(0.0, 0.2, 6)
    >>> result = kintrafo.simulate(system, (0.0, 0.2), system.design_state, t_eval=times)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     animate(result, f"{folder}/linkage.html").name
    'linkage.html'
    """
    with Validator("animate") as given:
        given.instance("result", result, Simulation, "a result of kintrafo.simulate is needed")
        fps = given.number("fps", fps, "1/s", least=1.0, below=_QUICKEST + 1e-9)
        slower = given.number("slower", slower, "", above=0.0)
        if title is not None:
            given.text("title", title)
    refuse([path], force=force, inputs=inputs, endings=ENDINGS)
    if len(result.t) < 2:
        raise InputError(["the motion has one output only; nothing moves"], "animate")
    with replacing(path, force=force, inputs=inputs) as temporary:
        if Path(path).suffix.lower() == ".gif":
            _write_gif(temporary, result, fps, slower)
        else:
            temporary.write_text(motion_page(result, title), encoding="utf-8", newline="\n")
    return Path(path)


def _write_gif(path: Path, result: Simulation, fps: float, slower: float) -> None:
    skeleton = Skeleton(result.signals.model)
    wanted, rows = frames(result.t, fps, slower)
    places = skeleton.places(result.y.T[rows], result.inputs[rows])
    write_gif(path, skeleton, wanted, places, fps)


def frames(times: Array, fps: float, slower: float = 1.0) -> tuple[Array, Indices]:
    """Return the times of the frames of a GIF [s], and the indices of the nearest outputs.

    `times` are those of the outputs [s]; `fps` are frames per second, and the motion is `slower` by
    a factor, see `frames_in`.
    """
    count = frames_in(abs(float(times[-1] - times[0])), fps, slower)
    wanted = np.linspace(times[0], times[-1], count)
    return wanted, np.abs(times[None, :] - wanted[:, None]).argmin(axis=1)


def frames_in(seconds: float, fps: float, slower: float = 1.0) -> int:
    """Return the number of frames of a GIF of a motion that takes some seconds.

    Raises `InputError` if there are more frames than viewers show.
    """
    count = max(2, round(slower * seconds * fps) + 1)
    if count > MOST_FRAMES:
        least = MOST_FRAMES / fps / slower
        words = (
            f"a GIF of {count} frames is too long for viewers: allowed are {MOST_FRAMES}. Take "
            f"fewer per second (fps), a motion of at most {least:g} s, or a page (.html)."
        )
        raise InputError([words], "animate")
    return count
