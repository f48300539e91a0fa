"""A page that plays the motion of a car: self-contained HTML."""

from importlib import resources
from importlib.metadata import version
from typing import Any

import numpy as np
from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup
from numpy.typing import NDArray

from ....pages.embedded import embedded
from .picture import GRID, PER_NEWTON
from .scene import WIDTH, DrivingScene

Array = NDArray[np.float64]


def driving_page(scene: DrivingScene, title: str) -> str:
    """Return a page that plays a motion, as text.

    Parameters
    ----------
    scene : DrivingScene
    title : str
    """
    loader = PackageLoader(__package__, ".")
    environment = Environment(
        loader=loader, autoescape=True, undefined=StrictUndefined, trim_blocks=True
    )
    return environment.get_template("page.html.jinja").render(
        title=title,
        version=version("kintrafo"),
        last=len(scene.times) - 1,
        data=Markup(embedded(_data(scene))),  # noqa: S704 (no end tag is left in it)
        script=Markup(_asset(__package__, "page.js")),  # noqa: S704 (our own)
        style=Markup(_asset("kintrafo.pages.mechanism", "page.css")),  # noqa: S704 (our own)
    )


def _data(scene: DrivingScene) -> dict[str, Any]:
    """Return the payload: places from the reference point of the car [mm]."""
    at = np.concatenate([scene.places, np.zeros((len(scene.times), 1))], axis=1)

    def beside(points: Array) -> list[Any]:
        """Return points as rows, one for each position."""
        from_car = points - at.reshape(-1, *([1] * (points.ndim - 2)), 3)
        return _whole(1e3 * from_car.reshape(len(at), -1))

    return {
        "times": np.round(scene.times, 4).tolist(),
        "words": scene.words,
        "places": _whole(1e3 * scene.places),
        "cones": _whole(1e3 * scene.cones),
        "parts": [beside(points) for points in scene.parts.values()],
        "springs": [beside(ends) for ends in scene.springs],
        "sides": [beside(scene.outline[:, side]) for side in (0, 1)],
        "centers": beside(scene.centers),
        "axes": np.round(scene.axes.reshape(len(at), -1), 4).tolist(),
        "spokes": np.round(scene.spokes.reshape(len(at), -1), 4).tolist(),
        "radii": _whole(1e3 * scene.radii),
        "width": WIDTH,
        "contacts": beside(scene.contacts),
        "forces": _whole(scene.forces.reshape(len(at), -1)),
        "mmPerNewton": 1e3 * PER_NEWTON,
        "grid": 1e3 * GRID,
    }


def _whole(values: Array) -> list[Any]:
    """Return values as whole numbers."""
    found: list[Any] = np.round(values).astype(int).tolist()
    return found


def _asset(package: str, name: str) -> str:
    return resources.files(package).joinpath(name).read_text(encoding="utf-8")
