"""Pages of a mechanism: self-contained HTML that draws, moves and plays it."""

from collections.abc import Sequence
from importlib.metadata import version
from typing import Any

import numpy as np
from markupsafe import Markup

from ...core.errors import KintrafoError
from ...core.legible import legible
from ...simulation.result import Simulation, SimulationError
from ...simulation.simulate import simulate
from ...systems.linearisation import linearise
from ...systems.modes import Mode
from ...systems.rest import rest
from ...systems.skeleton import Skeleton
from ...systems.system import System
from ..embedded import asset, embedded, moving_script, page_environment
from .scenes import Scene, by_hand, extent, of_motion

# Relative rounding error of a double zero eigenvalue: the root of that of doubles, and a margin.
_ROUNDING = 1e-6

SECONDS = 1.0
"""Duration of the motion from the design position, if no motion is given [s]."""


def report_page(system: System, title: str | None, motion: Simulation | None) -> str:
    """Return the report of a mechanism as text.

    The heading is by default the title of the mechanism; by default the played motion is a second
    from the design position at rest, without inputs.
    """
    skeleton = Skeleton(system)
    scenes = [*by_hand(skeleton)]
    played, words = _motion(skeleton, motion)
    if played is not None:
        scenes.append(played)
    return _page(skeleton, scenes, title, words, chapters=True)


def motion_page(result: Simulation, title: str | None) -> str:
    """Return a page that plays one motion, as text."""
    skeleton = Skeleton(result.signals.model)
    return _page(skeleton, [of_motion(skeleton, result)], title, "", chapters=False)


def _motion(skeleton: Skeleton, motion: Simulation | None) -> tuple[Scene | None, str]:
    """Return the scene of the motion, and a remark about it."""
    if motion is not None:
        return of_motion(skeleton, motion), "The motion is one that was given."
    system = skeleton.system
    words = f"Left to itself for {SECONDS:g} s from the design position at rest, without inputs."
    times = np.linspace(0.0, SECONDS, 201)
    try:
        found = simulate(system, (0.0, SECONDS), system.design_state, t_eval=times)
    except SimulationError as error:
        if error.partial is None or len(error.partial.t) < 2:
            return None, f"It does not move from the design position: {error}"
        return of_motion(skeleton, error.partial), f"{words} It ended {error}"
    except KintrafoError as error:
        return None, f"It does not move from the design position: {error}"
    return of_motion(skeleton, found), words


def _page(
    skeleton: Skeleton, scenes: Sequence[Scene], title: str | None, words: str, *, chapters: bool
) -> str:
    system = skeleton.system
    return (
        page_environment(__package__)
        .get_template("page.html.jinja")
        .render(
            title=legible(title or system.equations.equations.manifest["title"]),
            version=version("kintrafo"),
            scenes=scenes,
            chapters=chapters,
            words=words,
            parameters=_parameters(system) if chapters else [],
            modes=_modes(system) if chapters else {},
            data=_data(skeleton, scenes),
            script=moving_script() + asset(__package__, "page.js"),
            style=asset(__package__, "page.css"),
        )
    )


def _parameters(system: System) -> list[tuple[str, str, str, str]]:
    """Return the rows of the table of parameters."""
    entries = system.equations.PARAMETERS
    return [
        (name, f"{value:.8g}", entries[name]["unit"], entries[name]["meaning"])
        for name, value in system.parameters.items()
    ]


def _modes(system: System) -> dict[str, Any]:
    """Return the equilibrium near the design position with its modes, or why there is none."""
    try:
        found = rest(system)
        modes = linearise(system, found).modes
    except KintrafoError as error:
        return {"words": f"None near the design position: {error}", "rest": [], "modes": []}
    count = system.layout.positions
    at = zip(system.state_names[:count], np.asarray(found)[:count], strict=True)
    units = system.equations.STATE
    return {
        "words": "Found by Newton's method from the design position, without inputs."
        + " It does not stay there: a mode grows." * _grows(modes),
        "rest": [(name, f"{value:.6g}", units[name]["unit"]) for name, value in at],
        "modes": [(m.text, m.eigenvalues_text) for m in modes],
    }


def _grows(modes: Sequence[Mode]) -> bool:
    """Return whether a mode grows by more than rounding errors of the fastest one."""
    values = np.array([value for mode in modes for value in mode.eigenvalues])
    return bool((values.real > _ROUNDING * np.abs(values).max(initial=0.0)).any())


def _data(skeleton: Skeleton, scenes: Sequence[Scene]) -> Markup:
    system = skeleton.system
    size = extent(skeleton.places(system.design_state))
    entries = {**system.equations.STATE, **system.equations.SIGNALS}
    data = {
        "bodies": list(skeleton.bodies),
        "ground": skeleton.ground,
        "points": {body: list(points) for body, points in skeleton.bodies.items()},
        "joints": sorted({p for points in skeleton.joints.values() for p in points}),
        "guides": skeleton.guides,
        "springs": skeleton.springs,
        "wheels": skeleton.wheels,
        "states": system.state_names,
        "units": {name: entry["unit"] for name, entry in entries.items()},
        "meanings": {name: legible(entry["meaning"]) for name, entry in entries.items()},
        "scenes": [
            {
                "name": s.name,
                "unit": s.unit,
                "meaning": s.meaning,
                "values": _short(s.values),
                # to a 100,000th of the extent, less than a pixel
                "places": {
                    body: np.round(p.reshape(len(s.values), -1), _digits(size)).tolist()
                    for body, p in s.places.items()
                    if body != skeleton.ground
                },
                "still": np.round(s.places[skeleton.ground][0], _digits(size)).tolist()
                if skeleton.ground in s.places
                else [],
                "states": [_short(row) for row in s.states.T],
                "signals": {name: _short(v) for name, v in s.signals.items()},
            }
            for s in scenes
        ],
    }
    return embedded(data)


def _digits(size: float) -> int:
    return max(0, 5 - int(np.floor(np.log10(size))))


def _short(values: Any) -> list[float | None]:
    """Return numbers of six digits, and None for those that are not finite."""
    return [float(f"{v:.6g}") if np.isfinite(v) else None for v in np.asarray(values)]
