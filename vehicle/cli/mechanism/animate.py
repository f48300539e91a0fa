"""``kintrafo mechanism animate``: a motion as a GIF, or as a page to play."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from ....terminal.console import problems, say
from ..loading import model_of, system_of
from ..options import Force, Which, argument, option, refuse_which

if TYPE_CHECKING:
    from ....simulation.result import Simulation

EXAMPLES = (
    "kintrafo mechanism animate my_mechanism.py motion.gif",
    "kintrafo mechanism animate my_mechanism.py move.html --start crank_angle_rate=6 --duration 2",
    "kintrafo mechanism animate reference_car bounce.gif --slower 5",
)


def command(
    file: Annotated[
        str,
        argument(
            "File of a suspension, an axle or a car, Python file with a mechanism of your own, or "
            "the name of a packaged file.",
            "FILE",
        ),
    ],
    path: Annotated[Path, argument("Ends in .gif or .html.", "PATH")],
    *,
    start: Annotated[
        list[str] | None, option("Values at the start (SI units). May be repeated.", "NAME=VALUE")
    ] = None,
    duration: Annotated[float, option("Length of the motion.", "S")] = 1.0,
    slower: Annotated[
        float, option("Factor by which a GIF is slower than real time.", "TIMES")
    ] = 1.0,
    fps: Annotated[float, option("Frames per second of a GIF.", "1/S")] = 25.0,
    title: Annotated[str | None, option("Heading of a page.")] = None,
    model: Which = None,
    force: Force = False,
) -> None:
    """Show the free response of a mechanism of your own, a suspension, an axle or a car.

    It starts at rest at the design position, except for the values of --start. In Python any motion
    can be shown, over a road or with inputs: kintrafo.animate(result, "motion.gif").
    """
    from ....core.files import refuse
    from ....pages.animation import ENDINGS, animate, frames_in

    refuse_which(file, model)
    refuse([path], force=force, inputs=[file], endings=ENDINGS)
    _see_duration(duration)
    if path.suffix.lower() == ".gif":
        frames_in(duration, fps, slower)  # before the motion is computed
    with problems.status("motion"):
        result = _motion(file, model, _values(start or []), duration)
        options = {"fps": fps, "slower": slower, "title": title}
        written = animate(result, path, force=force, inputs=[file], **options)  # type: ignore[arg-type]
    say(f"  {written}")


def _see_duration(duration: float) -> None:
    """Refuse durations that are not positive, and those of an hour and more [s]."""
    from ....core.validator import Validator

    with Validator("animate") as given:
        given.number("--duration", duration, "s", above=0.0, below=3600.0)


def _values(given: list[str]) -> dict[str, float]:
    """Return the values of --start by name."""
    from ....core.errors import InputError

    found: dict[str, float] = {}
    for text in given:
        name, _, value = (part.strip() for part in text.partition("="))
        if name in found:
            raise InputError([f"{name} is given twice: keep one of them."], "--start")
        try:
            found[name] = float(value)
        except ValueError:
            problem = (
                f"{text!r}: NAME=VALUE is needed, such as crank_angle_rate=6: a number in SI "
                "units, without the unit."
            )
            raise InputError([problem], "--start") from None
    return found


def _motion(file: str, name: str | None, values: dict[str, float], duration: float) -> "Simulation":
    import numpy as np

    from ....simulation.result import SimulationError
    from ....simulation.simulate import simulate

    system = system_of(file, name) if file.endswith(".py") else model_of(file)
    times = np.linspace(0.0, duration, max(201, round(500 * min(duration, 20.0)) + 1))
    try:
        return simulate(system, (0.0, duration), system.state(**values), t_eval=times)
    except SimulationError as error:
        advice = "Choose a shorter --duration or another --start, and check the values of the file."
        raise error.advising(advice) from error
