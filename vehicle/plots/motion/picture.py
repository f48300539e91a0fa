"""Frames of a car in motion: a view from the front and above, and its path from above."""

from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.patches import Polygon
from scipy.spatial import ConvexHull

from ....core.named_types import Array
from ....pictures.animation import save_frames, seen_from, start_frame
from .scene import LOOKED_AT, WIDTH, CarScene

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Draws = Callable[[float], None]
# Distance towards the viewer, and a function that draws.
Item = tuple[float, Draws]

INK, TYRE, RIM, BODY, LINK, SPRING, FORCE, PATH, CONE = (
    "#222222", "#4a4a4a", "#d9d9d9", "#0072b2", "#7b5ea7", "#8a8a8a", "#d55e00", "#009e73",
    "#d55e00",
)  # fmt: skip
_TURN, _TILT = np.radians(-38.0), np.radians(22.0)
# Length of the arrow of a force [m/N], distance of the lines on the road [m].
PER_NEWTON, GRID = 1.0 / 5000.0, 2.0
_ARROW = {"arrowstyle": "-|>", "color": FORCE, "lw": 2.0, "shrinkA": 0, "shrinkB": 0}
_LEAST_ARROW = 0.03  # shorter arrows would have no shaft [m]
_AROUND = np.linspace(0.0, 2.0 * np.pi, 37)
_SPOKES = 5
# Half the width of the drawn road around the car, relative to that of the view.
_FAR = 4.0


def write_gif(path: Path, scene: CarScene, title: str, fps: float) -> None:
    """Write a motion as a GIF, with a number of frames per second."""
    drawer = Drawer(scene, title)
    save_frames(path, drawer.figure, drawer.draw, len(scene.times), fps)


class Drawer:
    """Frames of one motion on one figure."""

    def __init__(self, scene: CarScene, title: str) -> None:
        self._scene, self._title = scene, title
        self._view = seen_from(_TURN, _TILT)
        turned, tilted = np.array([np.cos(_TURN), np.sin(_TURN)]), np.cos(_TILT)
        self._towards = np.array([*(tilted * turned), np.sin(_TILT)])
        everywhere = np.concatenate([scene.places, scene.cones])
        low, high = everywhere.min(axis=0) - 4.0, everywhere.max(axis=0) + 4.0
        self._limits = (low, high)
        wide = 7.2
        strip = float(np.clip(wide * (high - low)[1] / (high - low)[0], 0.5, 2.6))
        whole = 4.6 + (strip := strip * scene.turns)
        self.figure = Figure(figsize=(wide, whole))
        self._axes: Axes = self.figure.add_axes((0.0, strip / whole, 1.0, 4.6 / whole))
        if scene.turns:
            self._above: Axes = self.figure.add_axes((0.0, 0.0, 1.0, strip / whole))
        self._half = np.array([1.3, 0.83]) * scene.size

    def draw(self, index: int) -> None:
        """Draw one frame instead of the previous one."""
        self._follow(index)
        if self._scene.turns:
            self._from_above(index)

    def _follow(self, index: int) -> None:
        axes, scene = self._axes, self._scene
        self._from = np.array([*scene.outline[index].mean(axis=(0, 1))[:2], LOOKED_AT])
        start_frame(axes, np.array([-1.0, -0.9]) * self._half, np.array([1.0, 1.1]) * self._half)
        self._road(index)
        items = [*self._bodywork(index), *self._links(index), *self._rolling(index), *self._cones()]
        for order, (_, draw) in enumerate(sorted(items, key=lambda item: item[0])):
            draw(3.0 + 0.01 * order)
        self._arrows(index)
        words = f"t = {scene.times[index]:.2f} s    {scene.words[index]}"
        axes.text(0.02, 0.97, self._title, transform=axes.transAxes, va="top", size=11)
        axes.text(0.02, 0.91, words, transform=axes.transAxes, va="top", size=9.5)

    def _on(self, points: Array) -> Array:
        return (np.asarray(points) - self._from) @ self._view.T

    def _depth(self, points: Array) -> float:
        return float((points.reshape(-1, 3).mean(axis=0) - self._from) @ self._towards)

    def _flat(self, places: Array) -> Array:
        return self._on(np.concatenate([places, np.zeros((len(places), 1))], axis=1))

    def _road(self, index: int) -> None:
        far = _FAR * float(self._half[0])
        x, y = self._from[:2]
        along, across = (
            GRID * np.arange(np.ceil((at - far) / GRID), (at + far) / GRID) for at in (x, y)
        )
        lines = [
            *([(at, y - far), (at, y + far)] for at in along),
            *([(x - far, at), (x + far, at)] for at in across),
        ]
        on = [self._flat(np.array(line)) for line in lines]
        axes, scene = self._axes, self._scene
        axes.add_collection(LineCollection(on, colors="#e4e4e4", linewidths=0.8, zorder=1))
        for track in scene.tracks:
            near = track[np.abs(track[:, 0] - x) < far]
            axes.plot(*self._on(near).T, color=INK, lw=1.2, zorder=1.5)
        if scene.turns:
            axes.plot(*self._flat(scene.places).T, color=PATH, lw=0.8, zorder=1.5)
            axes.plot(*self._flat(scene.places[: index + 1]).T, color=PATH, lw=2.4, zorder=1.6)

    def _cones(self) -> Iterator[Item]:
        foot = 0.15 * np.array([np.cos(_AROUND[::4]), np.sin(_AROUND[::4]), 0.0 * _AROUND[::4]]).T
        shape = np.concatenate([foot, [[0.0, 0.0, 0.5]]])
        for x, y in self._scene.cones:
            at = shape + np.array([x, y, 0.0])
            if np.abs(self._on(at)).max() < 2.0 * self._half[0]:
                yield self._depth(at), self._filler(_hull(self._on(at)), CONE, 0.9, 0.3)

    def _bodywork(self, index: int) -> Iterator[Item]:
        left, right = self._scene.outline[index]
        for side in (left, right):
            yield self._depth(side), self._filler(self._on(side), BODY, 0.10, 1.2)
        for k, (a, b) in enumerate(zip(left, right, strict=True)):
            ahead = (k + 1) % len(left)
            panel = np.array([a, b, right[ahead], left[ahead]])
            yield self._depth(panel), self._filler(self._on(panel), BODY, 0.07, 0.8)

    def _links(self, index: int) -> Iterator[Item]:
        scene = self._scene
        for points in scene.parts.values():
            at = np.unique(points[index].round(6), axis=0)
            if len(at) > 1:
                yield self._depth(at), self._link(self._on(at))
        for spring in scene.springs:
            at = spring[index]
            yield self._depth(at), self._liner(self._on(at), SPRING, 3.0)

    def _rolling(self, index: int) -> Iterator[Item]:
        scene = self._scene
        for wheel, radius in enumerate(scene.radii):
            center, axis = scene.centers[index, wheel], scene.axes[index, wheel]
            first = scene.spokes[index, wheel]
            second = np.cross(axis, first)
            circle = np.outer(np.cos(_AROUND), first) + np.outer(np.sin(_AROUND), second)
            near = np.sign(axis @ self._towards) or 1.0
            face = center + near * 0.5 * WIDTH * radius * axis
            back = center - near * 0.5 * WIDTH * radius * axis
            ends = np.linspace(0.0, 2.0 * np.pi, _SPOKES, endpoint=False)
            spokes = np.outer(np.cos(ends), first) + np.outer(np.sin(ends), second)

            both = np.concatenate([back + radius * circle, face + radius * circle])
            tread = _hull(self._on(both))
            rim = self._on(face + 0.64 * radius * circle)
            ends = self._on(face + 0.60 * radius * spokes)
            yield self._depth(face), partial(self._wheel, tread, rim, ends, self._on(face))

    def _wheel(self, tread: Array, rim: Array, spokes: Array, middle: Array, z: float) -> None:
        self._filler(tread, TYRE, 1.0, 0.6)(z)
        self._filler(rim, RIM, 1.0, 0.8)(z)
        lines = [np.array([middle, spoke]) for spoke in spokes]
        self._axes.add_collection(LineCollection(lines, colors=INK, linewidths=1.4, zorder=z))

    def _arrows(self, index: int) -> None:
        scene = self._scene
        for contact, force in zip(scene.contacts[index], scene.forces[index], strict=True):
            start, end = self._on(np.array([contact, contact + PER_NEWTON * force]))
            if np.hypot(*(end - start)) > _LEAST_ARROW:
                self._axes.annotate("", end, start, arrowprops=_ARROW, zorder=9)
        left, low = -0.95 * self._half[0], -0.84 * self._half[1]
        self._axes.annotate("", (left + 1.0, low), (left, low), arrowprops=_ARROW)
        words = "force of the road, 5 kN"
        self._axes.text(left + 1.1, low, words, va="center", size=9, color="#5c5c5c")

    def _filler(self, on: Array, colour: str, alpha: float, width: float) -> Draws:
        def draw(z: float) -> None:
            edge = INK if alpha == 1.0 else to_rgba(colour, 0.55)
            patch = Polygon(on, fc=to_rgba(colour, alpha), ec=edge, lw=width, zorder=z)
            self._axes.add_patch(patch)

        return draw

    def _liner(self, on: Array, colour: str, width: float) -> Draws:
        def draw(z: float) -> None:
            self._axes.plot(*on.T, color=colour, lw=width, zorder=z, solid_capstyle="round")

        return draw

    def _link(self, on: Array) -> Draws:
        """Return the function that draws a part: a line, or lines from its centre."""
        center = on.mean(axis=0)
        lines = [on] if len(on) == 2 else [np.array([center, point]) for point in on]

        def draw(z: float) -> None:
            made = LineCollection(lines, colors=LINK, linewidths=2.2, zorder=z, capstyle="round")
            self._axes.add_collection(made)

        return draw

    def _from_above(self, index: int) -> None:
        axes, scene = self._above, self._scene
        start_frame(axes, *self._limits)
        axes.plot(*scene.places.T, color=PATH, lw=0.8)
        axes.plot(*scene.places[: index + 1].T, color=PATH, lw=2.4)
        axes.plot(*scene.cones.T, "^", color=CONE, ms=3)
        around = _hull(scene.outline[index].reshape(-1, 3)[:, :2])
        axes.add_patch(Polygon(around, fc=BODY, ec=INK, lw=0.6, zorder=4))


def _hull(points: Array) -> Array:
    """Return the convex hull of points in a plane, shape (corners, 2)."""
    return points[ConvexHull(points).vertices]
