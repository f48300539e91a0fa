"""Add to a wheel compiled files that setup.py does not build, so that users need no compiler.

These are the libraries of FMUs for Windows, which a cross compiler makes on every system, and the
packaged cars, except on Windows. Both are the same for every version of Python, and taken from the
cache of compiled files where that has them.

Usage: fill.py FOLDER [WHEEL] [--part]. The folder has one wheel, for this version of Python, which
is replaced; or the named wheel is copied to it. --part adds one file of each kind only, for a quick
check.
"""

import re
import shutil
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

    import kintrafo

PART = ("four_bar", "driving_car")
"""The models and cars of a part."""


def main(folder: Path, part: bool) -> None:
    """Replace the wheel in a folder."""
    (wheel,) = folder.glob("*.whl")
    with TemporaryDirectory() as temporary:
        run("unpack", str(wheel), "--dest", temporary)
        (unpacked,) = Path(temporary).iterdir()
        sys.path.insert(0, str(unpacked))
        add_libraries(unpacked / "kintrafo/generated", part)
        if sys.platform != "win32":
            add_cars(unpacked / "kintrafo/generated", part, wheel.name)
        wheel.unlink()
        run("pack", str(unpacked), "--dest-dir", str(folder))


def add_libraries(folder: Path, part: bool) -> None:
    """Write the libraries of FMUs for Windows."""
    from complete import files_of_libraries
    from kintrafo.targets.fmi import binaries

    for name, files in files_of_libraries():
        if part and name not in PART:
            continue
        library = binaries.compiled(files, name, "windows")
        path = folder / f"_{name}_fmu{binaries.ENDINGS['windows']}"
        path.write_bytes(binaries.filled(library, binaries.digest(files)))
        print(f"{path.name}: {len(library) / 1e3:.0f} kB", flush=True)


def add_cars(folder: Path, part: bool, wheel: str) -> None:
    """Write the archives of the compiled cars."""
    from kintrafo import CarModel
    from kintrafo.systems.compile.packed import pack
    from kintrafo.vehicle.models.car.equations import CarStructure

    for car in cars(part):
        equations = CarModel(car).equations
        for library in Path(equations.__file__).parent.glob("*.so"):
            check_version(library, wheel)
        path = pack(equations, CarStructure.of(car).text(), folder)
        print(f"{path.name}: {path.stat().st_size / 1e3:.0f} kB", flush=True)


def cars(part: bool) -> "Iterator[kintrafo.Car]":
    """Yield the packaged cars on two axles, and those that can drive as driving ones, too."""
    import kintrafo
    from kintrafo.vehicle.data import data_sets
    from kintrafo.vehicle.data.starter import CARS

    for name in PART[1:] if part else data_sets(CARS):
        car = kintrafo.load(name)
        if car.axles:
            yield car
        if car.described.tyres is not None and not car.drives:
            yield car.with_changes({"car": "full"})


def check_version(library: Path, wheel: str) -> None:
    """Refuse a library that needs a later C library than the name of its wheel permits."""
    allowed = re.findall(r"manylinux_2_(\d+)", wheel)
    needed = re.findall(rb"GLIBC_2\.(\d+)", library.read_bytes())
    if allowed and max(map(int, needed), default=0) > min(map(int, allowed)):
        sys.exit(f"{library} needs glibc 2.{max(map(int, needed))}, and {wheel} permits less.")


def run(*words: str) -> None:
    """Call the package wheel."""
    command = [sys.executable, "-P", "-m", "wheel", *words]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)  # noqa: S603 (no user's words)


if __name__ == "__main__":
    folder, *wheels = [Path(word) for word in sys.argv[1:] if not word.startswith("--")]
    for wheel in wheels:
        shutil.copy(wheel, folder)
    main(folder, "--part" in sys.argv)
