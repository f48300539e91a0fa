"""Pages with a player of the motion of a car: self-contained HTML, or a part of it."""

from collections.abc import Sequence
from importlib.metadata import version
from typing import Any

import numpy as np
from markupsafe import Markup

from ....core.named_types import Array
from ....pages.embedded import asset, embedded, moving_script, page_environment
from .charts import Chart
from .picture import GRID, PER_NEWTON
from .scene import LOOKED_AT, WIDTH, CarScene


def motion_page(scene: CarScene, charts: Sequence[Chart], title: str) -> str:
    """Return the text of a page that plays a motion."""
    return page_environment(__package__).get_template("page.html.jinja").render(
        title=title,
        version=version("kintrafo"),
        player=player(scene, charts),
        script=player_script(),
        style=asset("kintrafo.pages.mechanism", "page.css"),
        own_style=player_style(),
    )  # fmt: skip


def player(scene: CarScene, charts: Sequence[Chart] = ()) -> Markup:
    """Return the part of a page that shows a scene, with a line in curves at the shown time.

    The page has `player_script` once. A scene of one position has no controls of time.
    """
    text = page_environment(__package__).get_template("player.html.jinja").render(
        moves=len(scene.times) > 1,
        turns=scene.turns and len(scene.times) > 1,
        last=len(scene.times) - 1,
        whole=scene.centers.shape[1] > 1,
        has_body=scene.has_body,
        charts=charts,
        data=embedded(_data(scene) | {"charts": [chart.data for chart in charts]}),
    )  # fmt: skip
    return Markup(text)  # noqa: S704 (the template escapes)


def player_script() -> Markup:
    """Return the script of all players of a page."""
    return moving_script() + asset(__package__, "player.js")


def player_style() -> Markup:
    """Return the style sheet of players."""
    return asset(__package__, "player.css")


def _data(scene: CarScene) -> dict[str, Any]:
    """Return the payload: positions relative to the reference point of the car [mm]."""
    at = np.concatenate([scene.places, np.zeros((len(scene.times), 1))], axis=1)

    def beside(points: Array) -> list[Any]:
        """Return points relative to the car as rows, one for each position [mm]."""
        from_car = points - at.reshape(-1, *([1] * (points.ndim - 2)), 3)
        return _whole(1e3 * from_car.reshape(len(at), -1))

    return {
        "times": np.round(scene.times, 4).tolist(),
        "words": scene.words,
        "places": _whole(1e3 * scene.places),
        "cones": _whole(1e3 * scene.cones),
        "tracks": [_track(track) for track in scene.tracks],
        "parts": [beside(points) for points in scene.parts.values()],
        "springs": [beside(ends) for ends in scene.springs],
        "sides": [beside(scene.outline[:, side]) for side in (0, 1)],
        "centers": beside(scene.centers),
        "axes": np.round(scene.axes.reshape(len(at), -1), 4).tolist(),
        "spokes": np.round(scene.spokes.reshape(len(at), -1), 4).tolist(),
        "radii": _whole(1e3 * scene.radii),
        "width": WIDTH,
        "size": round(1e3 * scene.size),
        "height": 1e3 * LOOKED_AT,
        "contacts": beside(scene.contacts),
        "forces": _whole(scene.forces.reshape(len(at), -1)),
        "mmPerNewton": 1e3 * PER_NEWTON,
        "grid": 1e3 * GRID,
    }


def _track(points: Array) -> dict[str, Any]:
    """Return the first position, the step and the heights of a road under wheels [mm]."""
    x, y, z = 1e3 * points.T
    first, step = float(x[0]), float(x[1] - x[0])
    return {"first": round(first, 1), "step": round(step, 6), "y": round(y[0]), "z": _whole(z)}


def _whole(values: Array) -> list[Any]:
    """Return values as whole numbers."""
    return np.round(values).astype(int).tolist()
