"""The examples of the help texts: each does what it says, and ends well."""

from __future__ import annotations

import re
import shlex
import shutil
from dataclasses import replace
from itertools import takewhile
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pandas as pd
import pytest
from kintrafo import Model, Suspension, characteristics, export, point_table, starter
from kintrafo.systems.compile.compiler import find_compiler
from kintrafo.vehicle import cli
from kintrafo.vehicle.report.chapters.chapter import Picture

if TYPE_CHECKING:
    from collections.abc import Callable

ROOT = Path(__file__).parents[1]
DATA = ROOT / "tests/data"
CAR = Suspension.load("reference_car")
LINES = [example for module in cli.COMMANDS.values() for example in module.EXAMPLES]
BUSHES = "[bushings.arm_rear]\naxial_N_per_mm = 400.0\nradial_N_per_mm = 900.0\n"
# A crank-rocker, called as the examples call it.
MECHANISM = """
from dataclasses import replace

from kintrafo.generator.mechanisms import four_bar

MODEL = replace(four_bar.MODELS[0], name="crane")
"""
# What stands last of the arguments without a dash is written by these.
WRITERS = ("new", "schema", "import")


def documented(page: str, name: str) -> str:
    """Return a file that a page of the documentation shows."""
    text = (ROOT / "docs" / page).read_text(encoding="utf-8")
    return re.findall(rf"```toml\n# {re.escape(name)}\n(.*?)```", text, flags=re.DOTALL)[0]


def car(path: Path, more: str = "", template: str = "reference_car") -> None:
    starter.write_starter(path, template=template)
    path.write_text(path.read_text(encoding="utf-8") + more, encoding="utf-8")


def points(path: Path, *, mirrored: bool = False) -> None:
    """Write the hardpoints of the starter as a table, or those of the other side of the car."""
    table = path.with_suffix(".csv")
    point_table.write_points(CAR, table)
    found = pd.read_csv(table)
    if mirrored:
        found.iloc[:, 2] *= -1.0
    if path.suffix == ".xlsx":
        found.to_excel(path, index=False)


def measured(path: Path) -> None:
    """Write what a rig would measure of the starter with a tie rod that is 0.3 mm too high."""
    built = CAR.with_changes({"hardpoints.tie_rod_inner": [-140.0, -310.0, 280.3]})
    export.write(characteristics.over(Model(built), "travel")[["toe", "camber"]], path)


def texts(folder: str) -> Callable[[Path], Any]:
    return lambda path: shutil.copy(DATA / folder / path.name, path)


def shown(page: str, name: str = "") -> Callable[[Path], Any]:
    return lambda path: path.write_text(documented(page, name or path.name), encoding="utf-8")


def csv_of_the_page(number: int) -> Callable[[Path], Any]:
    page = (ROOT / "docs/command-line.md").read_text(encoding="utf-8")
    tables = re.findall(r"```csv\n(.*?)```", page, flags=re.DOTALL)
    return lambda path: path.write_text(tables[number], encoding="utf-8")


# How the files come to be that examples read.
FILES: dict[str, Callable[[Path], Any]] = {
    "my_car.toml": car,
    "my_wishbones.toml": lambda path: car(path, template="double_wishbone_car"),
    "my_axle.toml": lambda path: car(path, template="reference_axle"),
    "before.toml": lambda path: car(path, BUSHES),
    "after.toml": lambda path: car(path, BUSHES.replace("900", "700")),
    "points.csv": points,
    "left_side.xlsx": lambda path: points(path, mirrored=True),
    "my_mechanism.py": lambda path: path.write_text(MECHANISM, encoding="utf-8"),
    "front_suspension.sub": texts("adams"),
    "own.sub": lambda path: path.write_text(
        (DATA / "adams/front_suspension.sub")
        .read_text(encoding="utf-8")
        .replace("lca_outer", "my_lca_outer"),
        encoding="utf-8",
    ),
    "cad.csv": csv_of_the_page(0),
    "rig.csv": csv_of_the_page(1),
    "road.csv": csv_of_the_page(2),
    "cases.toml": shown("loads.md"),
    "bushes.toml": shown("loads.md"),
    "axle_bushes.toml": shown("rigid-axle.md"),
    **dict.fromkeys(("tolerances.toml", "goals.toml", "objectives.toml"), shown("studies.md")),
    **dict.fromkeys(
        ("MacPhersonStrut.json", "DoubleWishbone.json", "RigidTire.json"), texts("chrono")
    ),
}
FILES_OF: dict[str, dict[str, Callable[[Path], Any]]] = {
    "fit": {"rig.csv": measured},
    "compliance": {"goals.toml": shown("studies.md", "soft_goals.toml")},
}


@pytest.fixture
def one_picture(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let chapters show their first picture again and again; drawing all of them takes seconds."""
    whole = Picture.of
    drawn: list[Picture] = []

    def first(figure: Any, words: str, ending: Any = "svg") -> Picture:
        if not drawn:
            drawn.append(whole(figure, words, ending))
        return replace(drawn[0], words=words)

    monkeypatch.setattr(Picture, "of", first)


@pytest.mark.skipif(find_compiler() is None, reason="no C compiler")
@pytest.mark.usefixtures("coarse_report", "first_page_of_curves", "one_picture")
@pytest.mark.usefixtures("few_frames", "few_generations")
@pytest.mark.parametrize("line", LINES)
def test_every_example_of_a_help_text_runs(kintrafo: Any, line: str) -> None:
    program, command, *words = shlex.split(line)
    positional = [*takewhile(lambda word: not word.startswith("-"), words)]
    written = positional[-1:] if command in WRITERS else []
    files = FILES | FILES_OF.get(command, {})
    for name in {*words} - {*written}:
        if name in files:
            files[name](Path(name))
    code, out, err = kintrafo(command, *words)
    assert (program, code, bool(out)) == ("kintrafo", 0, True), err
    for name in written or re.findall(r"(?:-o|--out|--car) (\S+)", line):
        stem, ending = Path(name).stem, Path(name).suffix
        assert list(Path().glob(f"{stem}*{ending}")), name
