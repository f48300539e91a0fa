"""The command lines of help texts and pages: each writes the files that it names, and succeeds."""

from __future__ import annotations

import json
import re
import shlex
import shutil
from itertools import takewhile
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pandas as pd
import pytest
from kintrafo import Model, Suspension, characteristics, compliance, export, point_table, starter
from kintrafo.systems.compile.compiler import find_compiler
from kintrafo.vehicle import cli
from kintrafo.vehicle.input.toml_writer import write_toml
from support.folders import ROOT

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    Files = dict[str, Callable[[Path], Any]]
    """By name, how a file comes to be."""

DATA = ROOT / "tests/data"
CAR = Suspension.load("reference_car")
DOCS = ROOT / "docs"
STUDIES = "suspension/design-studies.md"
README = "../README"  # as the others, from the folder of the pages
PAGES = (
    README,
    *(
        page.relative_to(DOCS).with_suffix("").as_posix()
        for page in sorted(DOCS.rglob("*.md"))
        if re.search(r"\nkintrafo |\n```\n\n```text", page.read_text(encoding="utf-8"))
    ),
)
COMPILED = ("get-started/first-mechanism", "simulation/roads", "mechanisms/own-mechanism")
BUSHES = "[bushings.arm_rear]\naxial_N_per_mm = 400.0\nradial_N_per_mm = 900.0\n"
# A crank-rocker, called as the examples call it.
MECHANISM = """
from dataclasses import replace

from kintrafo.generator.mechanisms import four_bar

MODEL = replace(four_bar.MODELS[0], name="crane")
"""
# What stands last of the arguments without a dash is written by these.
WRITERS = ("new", "schema", "import")


def text_of(page: str) -> str:
    return (DOCS / f"{page}.md").read_text(encoding="utf-8")


def commands_of(page: str) -> list[str]:
    """Return the commands of kintrafo in the shell blocks of a page, without their comments."""
    return [line for language, text in blocks_of(page) if language == "sh" for line in lines(text)]


def lines(block: str) -> list[str]:
    found = [line.partition("  #")[0].strip() for line in block.splitlines()]
    return [line for line in found if line.startswith("kintrafo ")]


BLOCK = re.compile(r"^```(\w+)\n(.*?)^```", re.MULTILINE | re.DOTALL)


def blocks_of(page: str) -> list[tuple[str, str]]:
    """Return language and text of the blocks of code of a page."""
    return [(found[1], found[2]) for found in BLOCK.finditer(text_of(page))]


def shown_by(page: str) -> Iterator[tuple[str, str, str]]:
    """Yield language, text and shown output: a block of text with nothing but space before it."""
    text = text_of(page)
    for block in BLOCK.finditer(text):
        output = BLOCK.match(text, re.compile(r"\s*").match(text, block.end()).end())  # type: ignore[union-attr]  # the empty match, too
        yield block[1], block[2], output[2] if output and output[1] == "text" else ""


EXAMPLES = [example for module in cli.COMMANDS.values() for example in module.EXAMPLES]
ON_PAGES = {line for page in PAGES for line in commands_of(page)}


def documented(page: str, name: str) -> str:
    """Return a file that a page of the documentation shows."""
    text = (DOCS / page).read_text(encoding="utf-8")
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


def vehicle_of_chrono(path: Path) -> None:
    """Write the file of a vehicle, and beside it those that it names in their folders."""
    for name, data in json.loads((DATA / "chrono/vehicle.json").read_text("utf-8")).items():
        file = path if name.endswith(path.name) else path.parent / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(json.dumps(data), encoding="utf-8")


def shown(page: str, name: str = "") -> Callable[[Path], Any]:
    return lambda path: path.write_text(documented(page, name or path.name), encoding="utf-8")


def csv_of_the_page(page: str) -> Callable[[Path], Any]:
    (table,) = (text for language, text in blocks_of(page) if language == "csv")
    return lambda path: path.write_text(table, encoding="utf-8")


# How the files come to be that examples read.
FILES: Files = {
    "my_car.toml": car,
    "my_wishbones.toml": lambda path: car(path, template="double_wishbone_car"),
    "my_axle.toml": lambda path: car(path, template="reference_axle"),
    "my_rear.toml": lambda path: car(path, template="rigid_axle"),
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
    "tracks.csv": lambda path: path.write_text(
        "distance_m,left_height_mm,right_height_mm\n0,0,0\n1,0,0\n2,8,5\n3,2,4\n4,0,0\n20,0,0\n",
        encoding="utf-8",
    ),
    "cad.csv": csv_of_the_page("suspension/hardpoints"),
    "rig.csv": csv_of_the_page("suspension/comparison"),
    "road.csv": csv_of_the_page("simulation/roads"),
    "cases.toml": shown("suspension/loads.md"),
    "bushes.toml": shown("suspension/compliance.md"),
    "axle_bushes.toml": shown("suspension/compliance.md"),
    **dict.fromkeys(
        ("tolerances.toml", "goals.toml", "objectives.toml"), shown("suspension/design-studies.md")
    ),
    **dict.fromkeys(
        ("MacPhersonStrut.json", "DoubleWishbone.json", "RigidTire.json"), texts("chrono")
    ),
    "Vehicle_DoubleWishbones_ARB.json": vehicle_of_chrono,
}
FILES_OF: dict[str, Files] = {
    "fit": {"rig.csv": measured},
    "compliance": {"goals.toml": shown(STUDIES, "soft_goals.toml")},
}


def run_line(kintrafo: Any, line: str, files: Files) -> tuple[str, list[Path]]:
    """Run a command line on files that are made as it needs them.

    Returns
    -------
    tuple
        What it prints, and the files that it writes.
    """
    program, command, *words = shlex.split(line)
    positional = [*takewhile(lambda word: not word.startswith("-"), words)]
    written = positional[-1:] if command in WRITERS else []
    for name in {*words} - {*written}:
        if name in files and not Path(name).exists():
            files[name](Path(name))
    code, out, err = kintrafo(command, *words)
    assert (program, code, bool(out)) == ("kintrafo", 0, True), (line, err)
    found: list[Path] = []
    for name in written or re.findall(r"(?:-o|--out|--car|--plot) (\S+)", line):
        at = Path(name)
        new = [at] if at.exists() else [*at.parent.glob(f"{at.stem}*{at.suffix}")]
        assert new, (line, name)
        assert all(path.is_dir() or path.stat().st_size > 0 for path in new), (line, name)
        found += new
    assert not [*Path().glob(".*")]
    return out, found


@pytest.mark.skipif(find_compiler() is None, reason="no C compiler")
@pytest.mark.usefixtures("coarse_report", "first_page_of_curves", "one_picture")
@pytest.mark.usefixtures("few_frames", "few_generations", "coarse_drives")
@pytest.mark.parametrize("line", [line for line in EXAMPLES if line not in ON_PAGES])
def test_every_example_of_a_help_text_runs(kintrafo, line):
    run_line(kintrafo, line, FILES | FILES_OF.get(shlex.split(line)[1], {}))


# -- pages ----------------------------------------------------------------------------------------


def lower_rod(path: Path) -> None:
    """Write the file that the reader of the tutorial has changed."""
    (line,) = re.findall(r"```toml\n(tie_rod_inner .*?)\n```", text_of("get-started/first-car"))
    text = Path("my_car.toml").read_text(encoding="utf-8")
    text, count = re.subn(r"^tie_rod_inner = .*$", line, text, flags=re.MULTILINE)
    assert count == 1
    path.write_text(text, encoding="utf-8")


SOFT = {
    "arm_rear": {"axial_N_per_mm": 400.0, "radial_N_per_mm": 900.0},
    "strut_top": {"axial_N_per_mm": 1500.0, "radial_N_per_mm": 700.0},
}
SOFT_CAR = CAR.with_changes({"bushings": SOFT})


def soft_rig(path: Path) -> None:
    softer = Model(SOFT_CAR.with_changes({"bushings.strut_top.radial_N_per_mm": 600.0}))
    export.write(compliance.linear(softer)[["toe_by_lateral", "camber_by_lateral"]], path)


MADE_FOR: dict[str, Files] = {
    "mechanisms/own-mechanism": {
        "pushrod_suspension.py": lambda path: shutil.copy(ROOT / "examples" / path.name, path)
    },
    "suspension/design-studies": {
        "rig.csv": measured,
        "soft_car.toml": lambda path: write_toml(SOFT_CAR, path),
        "soft_rig.csv": soft_rig,
    },
    "get-started/first-car": {"lower_rod.toml": lower_rod},
}
# What the files of a page have in them, and what they do not, as patterns.
WITH: dict[str, dict[str, list[str]]] = {
    "suspension/characteristics": {"curves_roll.csv": ["^roll_angle"]},
    "mechanisms/own-mechanism": {
        f"equations/pushrod_suspension.{end}": [] for end in ("c", "h", "md")
    },
    "suspension/report": {
        f"{name}.html": ["(?s)MIT License.*MIT License"] for name in ("my_car", "front_axle")
    },
    "suspension/types": {"my_rear.html": [r"\[rods\.panhard_rod\]", "roll-centre height"]},
    "get-started/first-car": {"front_axle.html": ["Front axle, stage 1"]},
}
WITHOUT: dict[str, dict[str, str]] = {
    "suspension/types": {
        "my_rear.html": r'(src|href)="(?!data:|#)',
        "my_arm.html": ">tie rod<|>Typical",
    },
}
# Of the code of a page, what it leaves.
CODE: dict[str, Callable[[dict[str, Any]], bool]] = {
    "suspension/loads": lambda _: True,
    "suspension/design-studies": lambda names: bool(
        abs(names["found"]["bump_steer_share"].sum("place") - 1.0).max() < 1e-12
    ),
}
PRINTED = {"kintrafo loads my_car.toml --cases cases.toml": r"wheel travel .* 60.0 "}


# Pages whose Python needs what they do not show: test_own_mechanism.py has that.
RUN_ELSEWHERE = ("mechanisms/own-mechanism",)


def write_files(page: str) -> None:
    """Write the files that a page shows."""
    for language, block in blocks_of(page):
        named = re.match(r"# (\w+\.\w+)(?::.*)?\n", block)
        if named and language in ("toml", "py"):
            Path(named[1]).write_text(block[named.end() :], encoding="utf-8")


def same_text(shown: str, printed: str) -> bool:
    """Return whether all lines are printed, in order; numbers may differ in the last digit."""
    found = iter([words_of(line) for line in printed.splitlines()])
    wanted = [words_of(line) for line in shown.splitlines() if line.strip() not in ("", "...")]
    return all(any(like(one, other) for other in found) for one in wanted)


def words_of(line: str) -> list[str]:
    return re.sub(r"[│┃┏┓┗┛━┳┻┡┩╇└┘─┴┬├┤┼|]", " ", line).split()


def like(one: list[str], other: list[str]) -> bool:
    return len(one) == len(other) and all(map(like_word, one, other))


def like_word(one: str, other: str) -> bool:
    if one == other:
        return True
    number = r"-?\d+\.(\d+)"
    places = re.fullmatch(number, one)
    if places is None or re.fullmatch(number, other) is None:
        return False
    return abs(float(one) - float(other)) < 1.5 * 10.0 ** -len(places[1])


def run_code(page: str, capsys: pytest.CaptureFixture[str]) -> None:
    """Run the Python of a page that is listed, or that shows what it prints."""
    names: dict[str, Any] = {}
    all_of_it = page in CODE or any(
        language == "python" and output for language, _, output in shown_by(page)
    )
    for language, text, output in shown_by(page):
        if language == "python" and all_of_it and page not in RUN_ELSEWHERE:
            exec(compile(text, f"{page}.md", "exec"), names)
            printed = capsys.readouterr().out
            assert same_text(output, printed), printed
    assert CODE.get(page, bool)(names) or page not in CODE


def check_files(page: str) -> None:
    for name, patterns in WITH.get(page, {}).items():
        found = Path(name).read_text(encoding="utf-8")
        assert all(re.search(pattern, found) for pattern in patterns), name
    for name, pattern in WITHOUT.get(page, {}).items():
        assert not re.search(pattern, Path(name).read_text(encoding="utf-8")), name
    if page == "suspension/design-studies":
        toes = [toe_at_60_mm(car) for car in (CAR, Suspension.load("better_car.toml"))]
        assert toes[1] < toes[0] / 5


def toe_at_60_mm(car: Suspension) -> float:
    """Return the larger toe [rad] in bump and rebound."""
    return float(abs(characteristics.over(Model(car), "travel", [-0.06, 0.06])["toe"]).max())


@pytest.mark.parametrize("page", PAGES)
@pytest.mark.usefixtures("coarse_report", "one_picture")
@pytest.mark.usefixtures("few_frames", "few_generations", "coarse_drives")
def test_the_commands_of_a_page_run(kintrafo, page, request, capsys):
    """In their order, in one folder; one page draws all groups of curves."""
    if page in COMPILED and find_compiler() is None:
        pytest.skip("no C compiler")
    every = page == "suspension/characteristics"
    request.getfixturevalue("each_page_of_curves_once" if every else "first_page_of_curves")
    write_files(page)
    for language, text, output in shown_by(page):
        if text.startswith("$ kintrafo"):
            command, _, shown_text = text[2:].partition("\n")
            _, out, err = kintrafo(*shlex.split(command)[1:])
            assert same_text(shown_text, out + err), out + err
        printed = ""
        for line in lines(text) if language == "sh" else ():
            out, written = run_line(kintrafo, line, FILES | MADE_FOR.get(page, {}))
            assert re.search(PRINTED.get(line, ""), out)
            if re.search(r"characteristics my_car.toml (?!--positions).*-o ", line):
                assert {path.stem.rpartition("_")[2] for path in written} == {"travel", "rack"}
            printed += out
        assert same_text(output if language == "sh" else "", printed), printed
    check_files(page)
    run_code(page, capsys)
