"""What exact derivatives by parameters cost: `make benchmark-derivatives` fills its page."""

import platform
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import kintrafo
import numpy as np
from kintrafo import Suspension, variation
from kintrafo.generator.mechanisms import MODELS

from .report import fill_page, milliseconds

PAGE = Path(__file__).parent.parent / "docs/derivatives.md"
MECHANISMS = ("four_bar", "macpherson", "multi_link")
TRAVEL = np.linspace(-0.06, 0.06, 13)
STATES = 200
REPEATED = 5
SHIPPED = {model.name: model for model in MODELS}


def main() -> None:
    """Measure everything and fill the page."""
    where = (
        f"On {platform.machine()}, one core, Python {platform.python_version()}; the quickest of"
    )
    text = "\n".join([*costs(), "", *toe(), "", f"{where} {REPEATED} runs."])
    print(text)
    fill_page(PAGE, {"derivatives": text})


def quickest(call: Callable[[], Any]) -> float:
    """Return the shortest time of several runs [s]."""
    times = []
    for _ in range(REPEATED):
        begin = time.perf_counter()
        call()
        times.append(time.perf_counter() - begin)
    return min(times)


def costs() -> list[str]:
    """Return a table: operations, times of a call, code, and how long it takes to be made."""
    lines = [
        "| | " + " | ".join(MECHANISMS) + " |",
        "|---|" + "---:|" * len(MECHANISMS),
    ]
    columns = [_column(name) for name in MECHANISMS]
    rows = ([row, *(column[row] for column in columns)] for row in columns[0])
    return [*lines, *(f"| {' | '.join(row)} |" for row in rows)]


def _column(name: str) -> dict[str, str]:
    with tempfile.TemporaryDirectory() as plain, tempfile.TemporaryDirectory() as folder:
        without, seconds_without = _compiled(name, plain, derivatives=False)
        module, seconds = _compiled(name, folder, derivatives=True)
        sizes = [_sources(made) for made in (without, module)]
        system = kintrafo.System(module)
        functions = module.equations.manifest["functions"]
        rhs, tangent, adjoint = (
            functions[n]["operations"]["total"] for n in ("rhs", "rhs_tangent", "rhs_adjoint")
        )
        states = np.tile(system.design_state, (STATES, 1))
        direction = {next(iter(system.parameters)): 1.0}
        weights = np.ones(module.rhs.shape)
        gradient = quickest(lambda: kintrafo.gradient(system, "rhs", weights, states)) / STATES
        along = quickest(lambda: kintrafo.derivative(system, "rhs", direction, states)) / STATES
        plain_call = quickest(lambda: system.evaluate("rhs", states)) / STATES
        values = np.array([*system.parameters.values()])
        both = plain_call + quickest(lambda: module.prepare(values))
        return {
            "parameters": str(values.size),
            "operations of `rhs`": str(rhs),
            "along a direction, times that": f"{tangent / rhs:.1f}",
            "backwards, times that": f"{adjoint / rhs:.1f}",
            "`rhs` at a state, µs": f"{1e6 * plain_call:.2f}",
            "`derivative` at a state, µs": f"{1e6 * along:.2f}",
            "`gradient` by all at a state, µs": f"{1e6 * gradient:.1f}",
            "one-sided differences by all, with `prepare`, µs": f"{1e6 * both * values.size:.0f}",
            "C, kB, without and with": f"{sizes[0] / 1e3:.0f}, {sizes[1] / 1e3:.0f}",
            "derived and compiled after, s": f"{seconds_without:.1f}, {seconds:.1f}",
        }


def _compiled(name: str, folder: str, *, derivatives: bool) -> tuple[Any, float]:
    begin = time.perf_counter()
    module = kintrafo.compile(SHIPPED[name], parameter_derivatives=derivatives, folder=folder)
    return module, time.perf_counter() - begin


def _sources(module: Any) -> int:
    files = Path(str(module.__file__)).parent.iterdir()
    return sum(file.stat().st_size for file in files if file.suffix in (".c", ".h"))


def toe() -> list[str]:
    """Return what the derivatives of toe by all parameters take, and by differences of cars."""
    car = Suspension.load("reference_car")
    model = kintrafo.Model(car)
    same = SHIPPED[model.equations.NAME]
    system = kintrafo.System(kintrafo.compile(same, parameter_derivatives=True), model.parameters)
    height = model.signal("wheel_center_z", model.design_state)
    states = np.tile(model.design_state, (TRAVEL.size, 1))
    states[:, 0] = kintrafo.arm_angles(model, height + TRAVEL)

    def gradient_of(signal: str) -> dict[str, Any]:
        weights = [float(name == signal) for name in system.signal_names]
        return kintrafo.gradient(system, "signals", weights, states)

    def exact() -> dict[str, Any]:
        of_toe, rise = gradient_of("toe"), gradient_of("wheel_center_z")
        slope = of_toe["beta1"] / rise["beta1"]
        return {n: of_toe[n] - slope * rise[n] for n in system.parameters}

    def compared() -> Any:
        return variation.sensitivity(car, ["hardpoints"], positions=TRAVEL, names=["toe"])["toe"]

    found, differences = exact(), compared()
    names = [
        str(p).removeprefix("hardpoints.").replace(".", "_") for p in differences["place"].values
    ]
    rows = [i for i, name in enumerate(names) if not name.startswith("wheel_center")]
    off = max(float(np.abs(found[names[i]] - differences.values[i]).max()) for i in rows)
    greatest = float(np.abs(differences.values[rows]).max())
    return [
        (
            f"Toe of the reference car at {TRAVEL.size} positions takes "
            f"{milliseconds(quickest(exact))} ms by all of its {len(found)} parameters, and "
            f"{milliseconds(quickest(compared))} ms by {len(names)} hardpoint coordinates with "
            "`kintrafo.variation.sensitivity`, which"
        ),
        f"compares cars. The two agree to {off / greatest:.0e} of the greatest derivative.",
    ]


if __name__ == "__main__":
    main()
