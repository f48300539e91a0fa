"""Curves of a tyre: forces and moment over slip, by load and camber, and combined slip."""

from pathlib import Path
from typing import TYPE_CHECKING, Unpack

import numpy as np
from matplotlib.axes import Axes

from ...pictures.figures import BLUE, GREEN, ORANGE
from ..tyres import Tyre
from .panels import FigureOptions, write_panels

if TYPE_CHECKING:
    from collections.abc import Callable

_POINTS = 241
_COLOURS = (BLUE, ORANGE, GREEN, "#cc79a7")
_LENGTHS = "#7b4ea3"  # colour of curves with the axis at the right
_LOADS = (0.5, 1.0, 1.5)  # in nominal loads
_ANGLES = (0.0, 2.0, 4.0, 8.0)  # slip angles of combined slip [deg]
_CAMBERS = (-4.0, 0.0, 4.0)  # [deg]
_WIDEST = 20.0  # greatest drawn slip angle [deg]
_DASHES = ("-", "--", ":", "-.")


def write_tyre(tyre: Tyre, path: str | Path, **how: Unpack[FigureOptions]) -> Path:
    """Write curves of a tyre: forces and aligning moment over slip, by load and camber."""
    drawn = _Curves(tyre)
    panels: dict[str, Callable[[Axes], None]] = {
        "side": drawn.side, "along": drawn.along, "moment": drawn.moment,
        "combined": drawn.combined, "camber": drawn.camber, "stiffness": drawn.stiffness,
    }  # fmt: skip
    return write_panels(lambda axes, name: panels[name](axes), [*panels], path, height=3.2, **how)


class _Curves:
    """The panels of a tyre, with a colour for each load and a dash for each angle."""

    def __init__(self, tyre: Tyre) -> None:
        low, high = tyre.ranges.get("load", (0.0, np.inf))
        loads = np.clip(np.multiply(_LOADS, tyre.nominal_load), max(low, 1.0), high)
        self._tyre, self._loads = tyre, list(dict.fromkeys(loads.tolist()))
        ends = tyre.ranges.get("slip_angle", (-0.5, 0.5))
        widest = min(_WIDEST, float(np.degrees(min(map(abs, ends)))))
        self._angles = np.linspace(-widest, widest, _POINTS)
        slips = tyre.ranges.get("slip", (-1.0, 1.0))
        self._slips = np.linspace(max(slips[0], -1.0), min(slips[1], 1.0), _POINTS)

    def _over_angle(self, axes: Axes, what: str, label: str) -> None:
        for load, colour in zip(self._loads, _COLOURS, strict=False):
            found = vars(self._tyre.evaluate(load, np.radians(self._angles)))[what]
            scale = 1.0 if what == "mz" else 1e-3
            axes.plot(self._angles, found * scale, color=colour, label=f"{load:.0f} N")
        axes.set_xlabel("slip angle [deg], positive moving left")
        axes.set_ylabel(label)

    def side(self, axes: Axes) -> None:
        """Draw the lateral force over the slip angle."""
        self._over_angle(axes, "fy", "lateral force [kN], positive left")

    def moment(self, axes: Axes) -> None:
        """Draw the aligning moment over the slip angle."""
        self._over_angle(axes, "mz", "aligning moment [N m]")

    def along(self, axes: Axes) -> None:
        """Draw the longitudinal force over the slip."""
        for load, colour in zip(self._loads, _COLOURS, strict=False):
            found = self._tyre.evaluate(load, slip=self._slips).fx
            axes.plot(100.0 * self._slips, 1e-3 * found, color=colour, label=f"{load:.0f} N")
        axes.set_xlabel("slip [%], positive in driving")
        axes.set_ylabel("longitudinal force [kN]")

    def combined(self, axes: Axes) -> None:
        """Draw lateral over longitudinal force at the nominal load, at several slip angles."""
        load = self._tyre.nominal_load
        for angle, dash in zip(_ANGLES, _DASHES, strict=True):
            found = self._tyre.evaluate(load, np.radians(angle), self._slips)
            label = f"slip angle {angle:g} deg"
            axes.plot(1e-3 * found.fx, 1e-3 * found.fy, dash, color="black", label=label)
        axes.set_xlabel("longitudinal force [kN]")
        axes.set_ylabel(f"lateral force [kN], at {load:.0f} N")
        axes.set_aspect("equal", adjustable="datalim")
        axes.legend(fontsize=8, ncols=2, loc="lower center")

    def camber(self, axes: Axes) -> None:
        """Draw the lateral force over small slip angles at several cambers."""
        load, small = self._tyre.nominal_load, self._angles[np.abs(self._angles) <= 6.0]
        low, high = self._tyre.ranges.get("camber", (-np.inf, np.inf))
        for camber, dash in zip(_CAMBERS, _DASHES, strict=False):
            if low <= np.radians(camber) <= high:
                found = self._tyre.evaluate(load, np.radians(small), camber=np.radians(camber))
                label = f"camber {camber:g} deg"
                axes.plot(small, 1e-3 * found.fy, dash, color="#777777", label=label)
        axes.set_xlabel("slip angle [deg]; camber is positive with the top to the right")
        axes.set_ylabel(f"lateral force [kN], at {load:.0f} N")
        axes.legend(fontsize=8)

    def stiffness(self, axes: Axes) -> None:
        """Draw cornering stiffness and relaxation length over the load."""
        loads = np.linspace(0.1, 1.0, 60) * self._loads[-1] / _LOADS[-1] * 2.0
        low, high = self._tyre.ranges.get("load", (0.0, np.inf))
        loads = loads[(loads >= low) & (loads <= high)]
        found = self._tyre.evaluate(loads)
        per_degree = np.pi / 180.0
        lines = axes.plot(
            1e-3 * loads, per_degree * found.cornering_stiffness, color="black",
            label="cornering stiffness",
        )  # fmt: skip
        axes.set_xlabel("load [kN]")
        axes.set_ylabel("cornering stiffness [N/deg]")
        axes.set_ylim(bottom=0.0)
        if np.isfinite(found.relaxation_y).all():
            lengths = axes.twinx()
            lines += lengths.plot(
                1e-3 * loads, 1e3 * found.relaxation_y, "--", color=_LENGTHS,
                label="lateral relaxation length (right axis)",
            )  # fmt: skip
            lengths.set_ylabel("lateral relaxation length [mm]", color=_LENGTHS)
            lengths.tick_params(axis="y", colors=_LENGTHS)
            lengths.spines["right"].set(visible=True, color=_LENGTHS)
            lengths.set_ylim(bottom=0.0)
            lengths.grid(visible=False)
        axes.legend(handles=lines, fontsize=8, loc="lower right")
