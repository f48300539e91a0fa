"""Figures 4, 5 and 6 of the paper, for print: PNG and SVG."""

from pathlib import Path

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ...core.files import refuse
from ...core.legible import legible
from ...core.named_types import Array
from ...pictures.figures import BLUE, GREEN, ORANGE, STYLE, save
from ..analysis.paper import PaperDynamics, PaperKinematics

_NAMES = ("figure_4_wheel_path", "figure_5_wheel_angles", "figure_6_wheel_motion")
_ENDINGS = ("png", "svg")
_CONDITIONS = ("", "", "Released with the wheel centre at 325 mm, spin 14.8 rev/s. ")


def figure_files(folder: Path) -> list[Path]:
    """Return the files that `write_figures` writes."""
    return [folder / f"{name}.{ending}" for name in _NAMES for ending in _ENDINGS]


def write_figures(
    kinematics: PaperKinematics,
    dynamics: PaperDynamics,
    folder: Path,
    data: str,
    *,
    force: bool = False,
) -> list[Path]:
    """Write the three figures as PNG and SVG, with the name of the data set below each."""
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


def wheel_path(kinematics: PaperKinematics) -> Figure:
    """Return Figure 4: the path of the wheel centre, seen from the side and from the front."""
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


def wheel_angles(kinematics: PaperKinematics) -> Figure:
    """Return Figure 5: camber and steer angle over wheel height."""
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


def _mark_design(axes: Axes, x: Array, y: Array, kinematics: PaperKinematics) -> None:
    index = kinematics.design
    axes.plot(x[index], y[index], "o", color="black", markersize=5, label="design position")
    axes.legend(frameon=False, fontsize=9, loc="best")


def wheel_motion(dynamics: PaperDynamics) -> Figure:
    """Return Figure 6: height, velocity and acceleration of the wheel centre."""
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
