"""The files of a car: its own, those of its axles, and those of their sides."""

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..models.axle.file import SECTIONS_OF_SIDES
from ..models.car import Car
from ..models.car.file import ENDS


@dataclass(frozen=True)
class _Sections:
    """Sections of an input file for `kintrafo.vehicle.input.toml_writer`."""

    data: dict[str, Any]

    def to_dict(self, *, exclude_defaults: bool = False) -> dict[str, Any]:
        return self.data


def _shorten(tyres: dict[str, Any], own: Path) -> None:
    """Make the paths of tyres relative to the car's file."""
    for end in ENDS:
        if isinstance(tyres.get(end), str) and Path(tyres[end]).is_file():
            tyres[end] = Path(os.path.relpath(tyres[end], own.parent)).as_posix()


def car_files(car: Car, path: str | Path) -> dict[Path, _Sections]:
    """Return the contents of the files of a car, by their paths, from that of its own file.

    The others are beside it, with the endings ``_front``, ``_rear_side`` and so on of its name.
    """
    own = Path(path)

    def beside(words: str) -> Path:
        return own.with_name(f"{own.stem}_{words}{own.suffix}")

    data = car.to_dict(exclude_defaults=True)
    _shorten(data.get("tyres", {}), own)
    found: dict[Path, _Sections] = {own: _Sections(data)}
    for key in car.parts:
        sections = data[key]
        data[key] = beside(key).name
        found[beside(key)] = _Sections(sections)
        for side in [name for name in SECTIONS_OF_SIDES if name in sections]:
            file = beside(f"{key}_{side}")
            found[file] = _Sections(sections[side])
            sections[side] = file.name
    return found
