"""The results of an ensemble as a labelled dataset."""

from collections.abc import Hashable, Iterator
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ..core.quantities import variable
from ..equations.errors import ModelError
from ..equations.status import NOT_FINITE, bit_of
from ..simulation.lanes.problem import End
from ..systems.system import System
from .collected import Collected
from .series import frequencies
from .variants import BOUND, FREQUENCY, STATE, TIME, Variants

Data = dict[Hashable, Any]


def dataset_of(model: System, variants: Variants, collected: Collected) -> xr.Dataset:
    """Return all results by name, over the dimensions of the variants."""
    asked, outcome = collected.asked, collected.problem.outcome
    reasons = _reasons(model, variants, collected)
    done = outcome.ends == End.DONE
    passed = np.isfinite(outcome.beyond).any(axis=1)
    shape = tuple(variants.shape.values())
    over = tuple(variants.shape)

    def wide(values: NDArray[Any], meaning: str, unit: str, *more: Hashable) -> xr.Variable:
        dimensions: Any = (*over, *more)
        return variable(dimensions, values.reshape(*shape, *values.shape[1:]), meaning, unit)

    data: Data = {
        "success": wide(done, "whether the end of the time was reached", "1"),
        "valid": wide(done & ~passed, "whether it was, and no bound was passed on the way", "1"),
        "reason": wide(reasons, "why the end of the time was not reached", "1"),
        "end_time": wide(outcome.ended, "time that was reached", "s"),
        "steps": wide(outcome.steps, "steps that were taken", "1"),
        "solver": wide(collected.solvers, "method by which this was found", "1"),
        "final_state": wide(outcome.finals, "state that was reached", "SI", STATE),
        "beyond": wide(outcome.beyond, "value furthest beyond a bound, if passed", "SI", BOUND),
    }
    described = {**model.equations.SIGNALS, **model.equations.STATE}
    for place, name in enumerate(asked.signals):
        entry = described[name]
        values = collected.samples[:, place]
        data[name] = wide(values, entry["meaning"], entry["unit"], TIME)
    for reduced, values in [*asked.on_the_way(outcome), *collected.of_series.items()]:
        of_signal = described[reduced.signal]["unit"]
        more = (FREQUENCY,) if reduced.kind == "psd" else ()
        words, unit = reduced.words(of_signal), reduced.unit(of_signal)
        data[reduced.name] = wide(values, words, unit, *more)
        if more:
            known = frequencies(asked.times, int(reduced.level))
            data[FREQUENCY] = variable(FREQUENCY, known, "frequency", "Hz")
    coordinates = {
        **variants.coordinates,
        TIME: variable(TIME, asked.times, "time", "s"),
        STATE: np.array(model.state_names),
        BOUND: np.array([f"{b.signal}: {b.words}" for b in asked.bounds], dtype=str),
        **_varied(model, variants, wide),
    }
    coordinates |= {FREQUENCY: data.pop(FREQUENCY)} if FREQUENCY in data else {}
    attributes = {"title": "ensemble of simulations", "message": _message(done, passed)}
    return xr.Dataset(data, coordinates, attributes)


def _varied(model: System, variants: Variants, wide: Any) -> Data:
    """Return the values of the variants that are not coordinates."""
    equations = model.equations
    described = {**equations.PARAMETERS, **equations.STATE, **equations.INPUTS}
    columns = {**variants.parameters, **variants.states, **variants.inputs, **variants.labels}
    return {
        f"{name}_at_start" if name in equations.STATE else name: wide(
            values,
            described[name]["meaning"],
            "1" if name in variants.labels else described[name]["unit"],
        )
        for name, values in columns.items()
        if name not in variants.coordinates
    }


def _message(done: NDArray[np.bool_], passed: NDArray[np.bool_]) -> str:
    failed, beyond = int((~done).sum()), int((done & passed).sum())
    text = f"{done.size - failed} of {done.size} reached the end of the time"
    text += ", `reason` has the cause for the others." if failed else "."
    if beyond:
        text += f" {beyond} passed a bound of what the model describes on the way, see `beyond`."
    return text


# -- reasons --------------------------------------------------------------------------------------


def _reasons(model: System, variants: Variants, collected: Collected) -> NDArray[np.object_]:
    """Return the reasons of systems that did not reach the end; empty texts for the others."""
    outcome = collected.problem.outcome
    max_steps = collected.problem.accuracy.max_steps
    reasons = np.full(outcome.ends.size, "", dtype=object)
    entries: dict[tuple[int, int], str] = {}
    for place in np.flatnonzero(outcome.ends != End.DONE).tolist():
        end, code = End(outcome.ends[place]), int(outcome.codes[place])
        if end is End.PARAMETERS:  # each by its own values
            reasons[place] = _refused_parameters(model, variants, place)
            continue
        if (end, code) not in entries:
            entries[end, code] = _in_words(model, end, code, max_steps)
        reasons[place] = f"at t = {outcome.ended[place]:.6g} s: {entries[end, code]}"
        if collected.reasons.get(place):
            reasons[place] += f" Nor can BDF do it: {collected.reasons[place]}"
    return reasons


def _refused_parameters(model: System, variants: Variants, place: int) -> str:
    own = {name: float(values[place]) for name, values in variants.parameters.items()}
    try:
        model.equations.prepare(model.parameters | own)
    except ModelError as error:
        return str(error)
    return "the parameters are those of no system"  # only rounding distinguishes these


def _in_words(model: System, end: End, code: int, max_steps: int) -> str:
    guards = model.equations.GUARDS
    if end is End.DEAD_POINT:
        return f"{guards[code][1]}. Try another initial state, or smaller forces."
    if end is End.REFUSED:
        found = [*_acting(model, code)] or ["the motion overflows double precision"]
        return f"{'; '.join(found)}. Try another initial state, or smaller forces."
    if end is End.SMALL_STEP:
        return "steps became too small, since the error stays too large. Loosen rtol and atol."
    if end is End.STIFF:
        return "it is stiff: stability, not accuracy, limits the steps of an explicit method."
    return f"more than {max_steps} steps. Raise max_steps, or loosen rtol."


def _acting(model: System, status: int) -> Iterator[str]:
    """Yield the meanings of the bits of a status word."""
    if status & NOT_FINITE:
        return
    for place, (_, meaning) in enumerate(model.equations.GUARDS):
        if status >> bit_of(place) & 1:
            yield meaning
