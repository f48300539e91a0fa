"""Add to a wheel compiled files that setup.py does not build, so that users need no compiler.

These are the libraries of FMUs for Windows, which a cross compiler makes on every system. They are
the same for every version of Python, and taken from the cache of compiled files where that has
them.

Usage: fill.py FOLDER [WHEEL] [--part]. The folder has one wheel, for this version of Python, which
is replaced; or the named wheel is copied to it. --part adds one file of each kind only, for a quick
check.
"""

import shutil
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

PART = ("four_bar",)
"""The models of a part."""


def main(folder: Path, part: bool) -> None:
    """Replace the wheel in a folder."""
    (wheel,) = folder.glob("*.whl")
    with TemporaryDirectory() as temporary:
        run("unpack", str(wheel), "--dest", temporary)
        (unpacked,) = Path(temporary).iterdir()
        sys.path.insert(0, str(unpacked))
        add_libraries(unpacked / "kintrafo/generated", part)
        wheel.unlink()
        run("pack", str(unpacked), "--dest-dir", str(folder))


def add_libraries(folder: Path, part: bool) -> None:
    """Write the libraries of FMUs for Windows."""
    from complete import files_of_libraries  # noqa: PLC0415 (imports the wheel)
    from kintrafo.targets.fmi import binaries  # noqa: PLC0415 (that of the wheel)

    for name, files in files_of_libraries():
        if part and name not in PART:
            continue
        library = binaries.compiled(files, name, "windows")
        path = folder / f"_{name}_fmu{binaries.ENDINGS['windows']}"
        path.write_bytes(binaries.filled(library, binaries.digest(files)))
        print(f"{path.name}: {len(library) / 1e3:.0f} kB", flush=True)


def run(*words: str) -> None:
    """Call the package wheel."""
    command = [sys.executable, "-P", "-m", "wheel", *words]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)  # noqa: S603 (no user's words)


if __name__ == "__main__":
    folder, *wheels = [Path(word) for word in sys.argv[1:] if not word.startswith("--")]
    for wheel in wheels:
        shutil.copy(wheel, folder)
    main(folder, "--part" in sys.argv)
