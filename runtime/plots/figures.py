"""Figures 4, 5 and 6 of the paper, for print: PNG and SVG."""

from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.text import Text
from numpy.typing import NDArray

from ..core.files import Paths, refuse, replacing
from ..core.legible import legible
from ..study.paper import Dynamics, Kinematics

if TYPE_CHECKING:
    from matplotlib.typing import RcKeyType

Array = NDArray[np.float64]

BLUE, ORANGE, GREEN = "#0072b2", "#d55e00", "#009e73"
STYLE: "dict[RcKeyType, Any]" = {
    "font.size": 10.0,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.titlesize": 10.5,
    "grid.color": "#dddddd",
    "grid.linewidth": 0.7,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "lines.linewidth": 1.8,
    "svg.hashsalt": "kintrafo",  # the same identifiers in every file
}
# Neither date nor version in the files: the same curves make the same bytes.
METADATA: dict[str, dict[str, Any]] = {
    "png": {"Software": None},
    "svg": {"Date": None},
    "pdf": {"CreationDate": None},
}
_NAMES = ("figure_4_wheel_path", "figure_5_wheel_angles", "figure_6_wheel_motion")
_ENDINGS = ("png", "svg")
_CONDITIONS = ("", "", "Released with the wheel centre at 325 mm, spin 14.8 rev/s. ")


def save(figure: Figure, path: str | Path, *, force: bool = False, inputs: Paths = ()) -> Path:
    """Write a figure; the ending of the file's name is its format.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
    path : str or pathlib.Path
    force : bool, optional
        Whether a file that somebody else wrote is replaced, see `kintrafo.core.files`.
    inputs : iterable of str or pathlib.Path, optional
        Files that are never replaced.

    Returns
    -------
    pathlib.Path

    Raises
    ------
    InputError
        If the file must not or cannot be written.
    """
    ending = Path(path).suffix.lower().removeprefix(".")
    drawn = BytesIO()  # what cannot be written later leaves no open file behind
    lay_out(figure)
    figure.savefig(drawn, dpi=160, format=ending, metadata=METADATA.get(ending))
    with replacing(path, force=force, inputs=inputs) as temporary:
        temporary.write_bytes(drawn.getvalue())
    return Path(path)


def written_plainly(figure: Figure) -> Figure:
    """Let what a person wrote stand there as it was written, dollars and all."""
    for text in figure.findobj(Text):
        text.set_parse_math(False)
        text.set_text("\n".join(map(legible, text.get_text().split("\n"))))
    return figure


def lay_out(figure: Figure) -> Figure:
    """Find the places of all that is drawn, once: else each file is drawn twice for them."""
    engine = figure.get_layout_engine()
    if engine is not None:
        engine.execute(figure)
        figure.set_layout_engine(None)
    return figure


def figure_files(folder: Path) -> list[Path]:
    """Return the files that `write_figures` writes."""
    return [folder / f"{name}.{ending}" for name in _NAMES for ending in _ENDINGS]


def write_figures(
    kinematics: Kinematics, dynamics: Dynamics, folder: Path, data: str, *, force: bool = False
) -> list[Path]:
    """Write the three figures.

    Parameters
    ----------
    kinematics, dynamics
        What they show.
    folder : Path
        Created if it does not exist.
    data
        Name of the data set, for the line below each figure.
    force
        Whether files that somebody else wrote are replaced, see `kintrafo.core.files`.

    Returns
    -------
    list of Path
        The files written, PNG and SVG of each figure.
    """
    files = figure_files(folder)
    refuse(files, force=force)
    with rc_context(STYLE):
        drawn = wheel_path(kinematics), wheel_angles(kinematics), wheel_motion(dynamics)
        for figure, what in zip(drawn, _CONDITIONS, strict=True):
            below = f"{what}Data: {legible(data)}, since the paper gives no hardpoints."
            figure.supxlabel(below, fontsize=8, color="#666666", parse_math=False)
        for path, figure in zip(files, [f for f in drawn for _ in _ENDINGS], strict=True):
            save(figure, path, force=force)
    return files


def wheel_path(kinematics: Kinematics) -> Figure:
    """Draw Figure 4: the path of the wheel centre, seen from the side and from the front."""
    figure = Figure(figsize=(8.4, 4.4), layout="constrained")
    side, front = figure.subplots(1, 2, sharey=True)
    # y grows to the right of the drawing, so a left wheel has its outboard side there
    outboard = "outboard to the right" if kinematics.side == "left" else "outboard to the left"
    for axes, across, name, sign in (
        (side, kinematics.x, "x", "positive forward"),
        (front, kinematics.y, "y", f"positive left ({outboard} here)"),
    ):
        axes.plot(across * 1e3, kinematics.z * 1e3, color=BLUE)
        _mark_design(axes, across * 1e3, kinematics.z * 1e3, kinematics)
        axes.set_xlabel(f"wheel centre {name} [mm]\n{sign}")
    side.set_ylabel("wheel centre height z [mm]")
    return figure


def wheel_angles(kinematics: Kinematics) -> Figure:
    """Draw Figure 5: camber and steer angle over wheel height."""
    figure = Figure(figsize=(8.4, 4.4), layout="constrained")
    camber, steer = figure.subplots(1, 2)
    for axes, angle, colour in (
        (camber, kinematics.camber, BLUE),
        (steer, kinematics.steer, ORANGE),
    ):
        axes.plot(kinematics.z * 1e3, np.degrees(angle), color=colour)
        _mark_design(axes, kinematics.z * 1e3, np.degrees(angle), kinematics)
        axes.axhline(0.0, color="#888888", linewidth=0.8)
        axes.set_xlabel("wheel centre height z [mm]")
    camber.set_ylabel("camber [deg], positive with the top outboard")
    sense = "toe-out" if kinematics.side == "left" else "toe-in"
    steer.set_ylabel(f"steer angle [deg], positive to the left ({sense})")
    return figure


def _mark_design(axes: Axes, x: Array, y: Array, kinematics: Kinematics) -> None:
    index = kinematics.design
    axes.plot(x[index], y[index], "o", color="black", markersize=5, label="design position")
    axes.legend(frameon=False, fontsize=9, loc="best")


def wheel_motion(dynamics: Dynamics) -> Figure:
    """Draw Figure 6: height, velocity and acceleration of the wheel centre."""
    result = dynamics.result
    figure = Figure(figsize=(8.4, 7.6), layout="constrained")
    rows = figure.subplots(3, 1, sharex=True)
    curves = (
        (result.signals["wheel_center_z"] * 1e3, "wheel centre\nheight [mm]", BLUE),
        (result.signals["wheel_velocity"], "wheel centre\nvelocity [m/s], up", ORANGE),
        (result.signals["wheel_acceleration"], "wheel centre\nacceleration [m/s$^2$], up", GREEN),
    )
    for axes, (values, label, colour) in zip(rows, curves, strict=True):
        axes.plot(result.t, values, color=colour)
        axes.set_ylabel(label)
        axes.margins(x=0.01)
    rows[-1].set_xlabel("time [s]")
    figure.align_ylabels(rows)
    return figure
