"""Ranges in which front suspensions usually lie at design."""

import tomllib
from importlib import resources
from typing import Any


def typical_ranges(kind: str) -> dict[str, dict[str, Any]]:
    """Return the usual ranges of front suspensions by the name of the characteristic.

    Parameters
    ----------
    kind : str
        Kind of the suspension, as in the input file.

    Returns
    -------
    dict
        ``low``, ``high``, ``unit`` and ``source`` of each.
    """
    text = resources.files(__package__).joinpath("typical.toml").read_text(encoding="utf-8")
    ranges: dict[str, dict[str, Any]] = tomllib.loads(text)
    return {name: usual for name, usual in ranges.items() if usual.get("only", kind) == kind}
