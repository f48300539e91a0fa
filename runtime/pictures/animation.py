"""A motion of a mechanism as an animated picture."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

from ..core.named_types import Array
from ..systems.skeleton import Skeleton

COLOURS = (
    "#0072b2",
    "#d55e00",
    "#009e73",
    "#cc79a7",
    "#7b5ea7",
    "#56a0d3",
    "#a6761d",
    "#666600",
)
_INK, _GREY = "#222222", "#8a8a8a"
_DPI = 90.0
_TURN, _TILT = 35.0, 18.0  # degrees: from the front, above


def write_gif(
    path: Path, skeleton: Skeleton, times: Array, places: dict[str, Array], fps: float
) -> None:
    """Write a motion as a GIF with `fps` frames per second.

    `times` are those of the frames [s], `places` points of each body, (n, points, 3) [m].
    """
    drawer = _Drawer(skeleton, places)
    save_frames(
        path, drawer.figure, lambda i: drawer.draw(i, f"t = {times[i]:.3f} s"), len(times), fps
    )


def save_frames(
    path: Path, figure: Figure, draw: Callable[[int], None], count: int, fps: float
) -> None:
    """Write some frames, each drawn by its index, as a GIF with `fps` frames a second."""
    canvas = FigureCanvasAgg(figure)
    canvas.figure.set_dpi(_DPI)
    frames: list[Image.Image] = []
    palette: Image.Image | None = None
    for index in range(count):
        draw(index)
        canvas.draw()  # type: ignore[no-untyped-call] # Matplotlib declares none
        figure.set_layout_engine("none")  # every frame has the layout of the first
        pixels = canvas.buffer_rgba()  # type: ignore[no-untyped-call] # likewise
        shown = Image.fromarray(np.asarray(pixels)).convert("RGB")
        palette = palette or _palette(shown)
        frames.append(shown.quantize(palette=palette, dither=Image.Dither.NONE))
    frames[0].save(
        path,
        format="GIF",
        save_all=True,
        append_images=frames[1:],
        duration=round(1000.0 / fps),  # ms
        loop=0,
    )


def _palette(shown: Image.Image) -> Image.Image:
    """Return the most frequent colours of a frame, which a GIF then keeps.

    Of colours that differ by less than 8 of 256 levels only the most frequent is taken: Pillow does
    not distinguish such colours.
    """
    colours, counts = np.unique(np.asarray(shown).reshape(-1, 3), axis=0, return_counts=True)
    colours = colours[np.argsort(-counts, kind="stable")]
    _, first = np.unique(colours // 8, axis=0, return_index=True)
    palette = Image.new("P", (1, 1))
    palette.putpalette(colours[np.sort(first)[:256]].tobytes())
    return palette


def still(skeleton: Skeleton, places: dict[str, Array], index: int, words: str) -> Figure:
    """Return one frame as a figure; arguments as of `write_gif`, and a text for its corner."""
    drawer = _Drawer(skeleton, places)
    drawer.draw(index, words)
    return drawer.figure


def projection(points: Array) -> Array:
    """Return the two directions of a picture of points (n, 3), shape (2, 3).

    A plane mechanism is seen along its normal, any other from the front above.
    """
    spans = np.ptp(points, axis=0)
    for axis, kept in ((1, (0, 2)), (2, (0, 1)), (0, (1, 2))):
        if spans[axis] < 1e-6 * spans.max():
            return np.eye(3)[list(kept)]
    return seen_from(np.radians(_TURN), np.radians(_TILT))


def seen_from(turn: float, tilt: float) -> Array:
    """Return the directions right and up of a picture, shape (2, 3).

    The viewer is at an angle about z from the x axis, and above the horizontal [rad].
    """
    right = [-np.sin(turn), np.cos(turn), 0.0]
    up = [-np.sin(tilt) * np.cos(turn), -np.sin(tilt) * np.sin(turn), np.cos(tilt)]
    return np.array([right, up])


def start_frame(axes: Axes, low: Array, high: Array) -> None:
    """Clear axes, and show a rectangle (lower left, upper right) in equal scales without ticks."""
    axes.clear()
    axes.set_axis_off()
    axes.set_aspect("equal")
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(low[1], high[1])


class _Drawer:
    """Draws the frames of one motion on one figure, in the same view with the same limits."""

    def __init__(self, skeleton: Skeleton, places: dict[str, Array]) -> None:
        self._skeleton, bodies = skeleton, skeleton.bodies
        everywhere = np.concatenate([p.reshape(-1, 3) for p in places.values()])
        self._view = projection(everywhere)
        self._seen = {body: p @ self._view.T for body, p in places.items()}
        on = everywhere @ self._view.T
        low, high = on.min(axis=0), on.max(axis=0)
        self._size = max(float((high - low).max()), 1e-9)
        moving = [body for body in bodies if body != skeleton.ground]
        self._colours = {b: COLOURS[i % len(COLOURS)] for i, b in enumerate(moving)}
        self.figure = Figure(figsize=(6.4, 6.0), layout="constrained")
        self._axes: Axes = self.figure.add_subplot()
        margin = 0.14 * self._size
        self._limits = (low - margin, high + margin)

    def draw(self, index: int, words: str) -> None:
        """Draw one frame instead of the last one."""
        axes, skeleton = self._axes, self._skeleton
        start_frame(axes, *self._limits)
        at = {body: seen[index] for body, seen in self._seen.items()}

        def end(which: tuple[str, str]) -> Array:
            body, point = which
            return at[body][skeleton.bodies[body].index(point)]

        for a, b in skeleton.springs:
            axes.plot(*_coil(end(a), end(b), 0.012 * self._size).T, color=_GREY, lw=1.2, zorder=1)
        for pair in skeleton.guides:
            ends = [end(which) for which in pair]
            middle = (ends[0] + ends[1]) / 2
            for (body, _), start, width in zip(pair, ends, (6.0, 2.5), strict=True):
                colour = self._colours.get(body, _GREY)
                axes.plot(*zip(start, middle, strict=True), color=colour, lw=width, zorder=2)
        for body, colour in self._colours.items():
            label = body.replace("_", " ")
            _draw_body(axes, np.unique(at[body].round(9), axis=0), colour, label)
        if skeleton.ground in at:
            axes.plot(*at[skeleton.ground].T, "^", ms=11, mfc="#e3e3e3", mec=_GREY, zorder=2.5)
        joints = {p for points in skeleton.joints.values() for p in points}
        for body, points in skeleton.bodies.items():
            rows = [row for row, point in enumerate(points) if point in joints]
            axes.plot(*at[body][rows].T, "o", ms=5, mfc="white", mec=_INK, zorder=4)
        for wheel in skeleton.wheels:
            axes.plot(*end(wheel), "o", ms=14, mfc="none", mec=_INK, mew=1.5, zorder=4)
        axes.text(0.02, 0.98, words, transform=axes.transAxes, va="top", size=12)
        self._triad()
        columns = min(4, max(1, len(self._colours)))
        axes.legend(
            loc="upper center",
            bbox_to_anchor=(0.5, -0.01),
            ncols=columns,
            frameon=False,
            fontsize=8.5,
            handlelength=1.2,
        )

    def _triad(self) -> None:
        """Draw the axes in a corner, with a round length that is written beside them."""
        long = 10.0 ** np.floor(np.log10(self._size / 5))
        long *= max(m for m in (1, 2, 5) if m * long <= self._size / 5 or m == 1)
        (left, low), _ = self._limits
        root = np.array([left, low]) + 0.07 * self._size
        for name, tip in zip("xyz", long * self._view.T, strict=True):
            if np.hypot(*tip) < 0.05 * long:
                continue
            self._axes.plot(*zip(root, root + tip, strict=True), color=_INK, lw=1)
            x, y = root + 1.22 * tip
            self._axes.text(x, y, name, ha="center", va="center", size=9)
        size = f"{long * 1e3:g} mm" if long < 1.0 else f"{long:g} m"
        words = f"axes {size} long"
        self._axes.text(0.02, 0.0, words, transform=self._axes.transAxes, size=8.5, color="#5c5c5c")


def _draw_body(axes: "Axes", points: Array, colour: str, label: str) -> None:
    """Draw a body as a block, a line, a triangle or a star of lines, depending on its points."""
    center = points.mean(axis=0)
    if len(points) == 1:
        axes.plot(*center, "s", ms=11, color=colour, label=label, zorder=3)
    elif len(points) == 2:
        axes.plot(*points.T, color=colour, lw=4, label=label, zorder=3, solid_capstyle="round")
    elif len(points) == 3:
        axes.fill(*points.T, facecolor=f"{colour}40", edgecolor=colour, lw=3, label=label, zorder=3)
    else:
        for number, point in enumerate(points):
            line = zip(center, point, strict=True)
            axes.plot(*line, color=colour, lw=3.5, label="" if number else label, zorder=3)


def _coil(start: Array, end: Array, radius: float) -> Array:
    """Return the corners of a zigzag between two points, shape (n, 2)."""
    along = end - start
    length = max(float(np.hypot(*along)), 1e-12)
    across = np.array([-along[1], along[0]]) / length * radius
    shares = 0.15 + 0.7 * (np.arange(14) + 0.5) / 14
    sides = np.where(np.arange(14) % 2, 1.0, -1.0)
    turns = start + shares[:, None] * along + sides[:, None] * across
    return np.vstack([start, turns, end])
