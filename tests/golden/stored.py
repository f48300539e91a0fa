"""Storing the golden set, and comparing with what is stored.

One file holds a subject, or the commands: a line for each variable of each analysis, with its
dimensions, unit and values. Numbers are stored with 14 digits.
"""

import json
import tempfile
from pathlib import Path

import numpy as np
from kintrafo.vehicle.assembly.by_wheel import flat

from .analyses import analyses
from .commands import observed
from .subjects import AXLES, CORNERS, WHOLE_AXLES

VALUES = Path(__file__).parent / "values"
COMMANDS = "commands"
SUBJECTS = (*CORNERS, *AXLES, *WHOLE_AXLES)


def computed(name):
    """Return what all analyses of a subject give today, or what all commands do.

    Returns
    -------
    dict
        By "analysis: variable", dimensions and values in their order; by command, see `observed`.
    """
    if name == COMMANDS:
        with tempfile.TemporaryDirectory() as folder:
            return observed(Path(folder))
    return {
        f"{analysis}: {variable}": _plain(dataset[variable])
        for analysis, compute in analyses(name).items()
        for dataset in [flat(compute())]
        for variable in sorted(map(str, dataset.variables))
    }


def _plain(array):
    values = np.asarray(array)
    numbers = values.dtype.kind in "fiub"
    return {
        "dims": [str(dim) for dim in array.dims],
        "unit": array.attrs.get("units", ""),
        "values": [float(f"{x:.14g}") if numbers else str(x) for x in values.ravel()],
    }


def store(name):
    """Write what is computed today into the file of a subject, or of the commands."""
    VALUES.mkdir(exist_ok=True)
    lines = [f"{json.dumps(key)}: {json.dumps(found)}" for key, found in computed(name).items()]
    text = "{\n" + ",\n".join(lines) + "\n}\n"
    (VALUES / f"{name}.json").write_text(text, encoding="utf-8")


def differences(name, tolerance):
    """Return a line for each variable, or command, that is not as it is stored.

    Parameters
    ----------
    name : str
        A subject, or `COMMANDS`.
    tolerance : float
        Largest difference, as a part of the largest value of that unit: a variable that is zero but
        for rounding has no largest value of its own.
    """
    stored = json.loads((VALUES / f"{name}.json").read_text(encoding="utf-8"))
    today = json.loads(json.dumps(computed(name)))
    lines = [
        f"{key}: {'is missing' if key in stored else 'is new'}"
        for key in sorted(stored.keys() ^ today.keys())
    ]
    sizes = _sizes(stored)
    for key in sorted(stored.keys() & today.keys()):
        before, now = stored[key], today[key]
        lines += [
            f"{key}: {part} was {before[part]}, is {now[part]}"
            for part in before.keys() - {"values"}
            if before[part] != now[part]
        ]
        if "values" in before:
            apart = _difference(before["values"], now["values"]) / sizes.get(before["unit"], 1.0)
            lines += [f"{key}: differs by {apart:.1e} of its scale"] if apart > tolerance else []
    return lines


def _sizes(stored):
    """Return the largest finite value of each unit, where it is not zero."""
    sizes = {}
    for variable in stored.values():
        numbers = [abs(x) for x in variable.get("values", []) if not isinstance(x, str)]
        largest = max((x for x in numbers if np.isfinite(x)), default=0.0)
        if largest:
            sizes[variable["unit"]] = max(sizes.get(variable["unit"], 0.0), largest)
    return sizes


def _difference(stored, today):
    """Return the largest difference; infinity where other values are not numbers."""
    if stored == today:
        return 0.0
    if len(stored) != len(today) or any(isinstance(value, str) for value in stored + today):
        return np.inf
    before, now = np.array(stored), np.array(today)
    apart = (before != now) & ~(np.isnan(before) & np.isnan(now))
    if not np.isfinite([before[apart], now[apart]]).all():
        return np.inf
    return float(np.abs(before[apart] - now[apart]).max(initial=0.0))
