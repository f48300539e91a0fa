"""Which whole vehicles of Project Chrono are read: `python -m benchmarks.chrono_vehicles FOLDER`.

FOLDER is ``data/vehicle`` of Chrono's repository. The wheels of a file that names no tire have the
first tire that is beside it and can be read, or else that of ``--tire``.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from kintrafo import InputError
from kintrafo.vehicle.files.chrono import read_vehicle
from kintrafo.vehicle.files.chrono.vehicle import is_vehicle
from kintrafo.vehicle.files.chrono.vehicle_file import Folder

if TYPE_CHECKING:
    from collections.abc import Iterator


def vehicles(folder: Path) -> Iterator[Path]:
    """Yield the files of whole vehicles in a folder, by name."""
    for file in sorted(folder.rglob("*.json")):
        try:
            if is_vehicle(file):
                yield file
        except InputError:
            continue  # no JSON, or not of Chrono


def outcome(file: Path, usual: Path | None) -> tuple[bool, str]:
    """Return whether a vehicle is read, with its description or the reason why not."""
    beside = sorted(Folder(file).tires(), key=lambda name: "TMeasy" not in name)
    why = ""
    for tire in (None, *beside, *filter(None, [usual])):
        try:
            found = read_vehicle(file, tire=tire)
        except InputError as error:
            if tire is None and "no file of a tire" not in str(error):
                return False, error.problems[0]
            why = error.problems[0]
        else:
            return True, found.car.heading()
    return False, why


def main() -> None:
    """Print a line for each vehicle, and how many are read."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--tire", type=Path, help="for vehicles that have none")
    given = parser.parse_args()
    found = {file: outcome(file, given.tire) for file in vehicles(given.folder)}
    for file, (is_read, words) in found.items():
        print("read " if is_read else "  not", file.relative_to(given.folder), "|", words)
    print(f"{sum(is_read for is_read, _ in found.values())} of {len(found)} are read")


if __name__ == "__main__":
    main()
