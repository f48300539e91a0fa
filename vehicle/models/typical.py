"""Usual ranges of front suspensions at design."""

import tomllib
from importlib import resources
from typing import Any


def typical_ranges(kind: str) -> dict[str, dict[str, Any]]:
    """Return ``low``, ``high``, ``unit`` and ``source`` of the usual ranges, by characteristic.

    `kind` is the kind of the suspension, as in the input file.
    """
    text = resources.files(__package__).joinpath("typical.toml").read_text(encoding="utf-8")
    ranges: dict[str, dict[str, Any]] = tomllib.loads(text)
    return {name: usual for name, usual in ranges.items() if usual.get("only", kind) == kind}
