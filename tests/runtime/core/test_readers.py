"""Files that are too large, not text, or not to be shown: every reader refuses them alike."""

import json
from pathlib import Path
from zipfile import ZIP_DEFLATED, ZipFile

import pytest
from kintrafo import Axle, InputError, RigidAxle, Suspension, chrono, rig
from kintrafo.core.errors import InputError as Error
from kintrafo.core.reading import MOST_OF_DATA, MOST_OF_MEASUREMENTS, bytes_of
from kintrafo.generator import Angle, DeclarationError, Ground, Point, PositionOf
from kintrafo.vehicle.analysis.loads import cases
from kintrafo.vehicle.analysis.measurement import measured
from kintrafo.vehicle.corner import bushes
from kintrafo.vehicle.files import adams_car
from kintrafo.vehicle.files.point_table import read_points
from kintrafo.vehicle.studies.goals import read as read_goals

READERS = {
    "a suspension": (".toml", Suspension.load),
    "an axle": (".toml", Axle.load),
    "a rigid axle": (".toml", RigidAxle.load),
    "bushes": (".toml", bushes.read_bushes),
    "load cases": (".toml", cases.read),
    "goals": (".toml", read_goals),
    "a file of Chrono": (".json", chrono.read),
    "a subsystem of Adams/Car": (".sub", adams_car.read),
    "points": (".csv", read_points),
    "curves of a rig": (".csv", rig.measured_curves),
    "a road": (".csv", measured),
}
TOML = [name for name, (ending, _) in READERS.items() if ending == ".toml"]


def refusal(reader, path):
    with pytest.raises(InputError) as caught:
        READERS[reader][1](path)
    assert str(path) in str(caught.value)
    return str(caught.value)


@pytest.mark.parametrize("reader", READERS)
def test_a_file_that_is_too_large(reader, tmp_path):
    path = tmp_path / f"large{READERS[reader][0]}"
    large = reader in ("curves of a rig", "a road")
    with path.open("wb") as file:
        file.truncate(1 + (MOST_OF_MEASUREMENTS if large else MOST_OF_DATA))
    assert "MiB, which no such file needs" in refusal(reader, path)


@pytest.mark.skipif(not Path("/dev/zero").exists(), reason="is of Unix")
def test_a_file_without_end(refused):
    refused(InputError, lambda: bytes_of("/dev/zero"))


@pytest.mark.parametrize("reader", READERS)
def test_a_zero_byte(reader, tmp_path):
    path = tmp_path / f"zero{READERS[reader][0]}"
    path.write_bytes(b"[a]\nb = 'x\0'\n")
    assert "not a text" in refusal(reader, path)


@pytest.mark.parametrize("text", ['a = "b\\u0000"', '"b\\u001b" = 1', "[x]\na = ['\\b', \"\\b\"]"])
@pytest.mark.parametrize("reader", TOML)
def test_characters_that_cannot_be_shown(reader, text, tmp_path):
    path = tmp_path / "a.toml"
    path.write_text(text, encoding="utf-8")
    assert "cannot be shown" in refusal(reader, path)


@pytest.mark.parametrize("text", ["\0", "\ud800", "\x1b[2J"])
def test_characters_of_json(text, tmp_path):
    path = tmp_path / "a.json"
    for data in ({"Name": text}, {text: 1}, {"a": [{"b": text}]}):
        path.write_text(json.dumps(data), encoding="utf-8")
        assert "cannot be shown" in refusal("a file of Chrono", path)


@pytest.mark.parametrize("text", ["a\0b", "\ud800", "\x1b[2J"])
def test_texts_of_declarations(text, refused):
    body = Ground("ground")
    for make in (
        lambda: Point("p", (0.0, 0.0, 0.0), text),
        lambda: Angle("a", 1.0, text),
        lambda: PositionOf("p", body, Point("p", (0.0, 0.0, 0.0)), text),
    ):
        with refused(DeclarationError):
            make()


@pytest.mark.parametrize("reader", READERS)
def test_what_is_repeated_is_short(reader, tmp_path):
    """A name of three million letters, and fifteen thousand names that are not known."""
    path = tmp_path / f"long{READERS[reader][0]}"
    long, many = 3_000_000 * "a", [f"name{i}" for i in range(15_000)]
    texts = {
        ".toml": [f"{long} = 1\n", "".join(f"[{name}]\nx = 1\n" for name in many)],
        ".json": [json.dumps({long: long}), json.dumps(dict.fromkeys(many, 1))],
        ".sub": [f"[{long}]\n{long} = {long}\n", "".join(f"[HARDPOINT]\n'{n}'\n" for n in many)],
        ".csv": [
            f"{long},b\n1,2\n2,3\n",
            ",".join(many) + "\n",
            "point,x,y,z\n" + f"{long},a,b,c\n",
        ],
    }
    for text in texts[READERS[reader][0]]:
        path.write_text(text, encoding="utf-8")
        assert len(refusal(reader, path)) < 100_000


def test_an_error_holds_what_can_be_read():
    error = Error((f"{i}: \0{5000 * 'a'}" for i in range(10**9)), "a\0.toml")
    assert len(error.problems) == 100
    assert {len(problem) for problem in error.problems[:-1]} == {2000}
    assert error.problems[-1] == "and more problems."
    assert "\0" not in str(error)
    assert Error(error.problems, error.source).problems == error.problems


# -- workbooks -------------------------------------------------------------------------------------


def book_with(path, cells):
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.Workbook()
    for row in (["point", "x [mm]", "y [mm]", "z [mm]"], ["ball_joint", 1, 2, 3]):
        book.active.append(row)
    for place, value in cells.items():
        book.active[place] = value
    book.save(path)
    return path


@pytest.mark.parametrize("cell", ["XFD1048576", "A1048576", "XFD2", "E10001", "IW1"])
def test_a_cell_that_is_far_away(cell, tmp_path):
    path = book_with(tmp_path / "a.xlsx", {cell: "x"})
    assert f"there is a value in cell {cell};" in refusal("points", path)


def test_cells_without_content_do_not_matter(tmp_path):
    openpyxl = pytest.importorskip("openpyxl")
    path = book_with(tmp_path / "a.xlsx", {})
    book = openpyxl.load_workbook(path)
    book.active["XFD1048576"].number_format = "0.00"
    book.save(path)
    assert read_points(path).points == {"ball_joint": (1.0, 2.0, 3.0)}


def test_a_long_text_of_a_workbook(tmp_path):
    path = book_with(tmp_path / "a.xlsx", {"B1": 32_000 * "x"})
    assert len(refusal("points", path)) < 3000


def test_a_text_longer_than_excel_has_them(tmp_path):
    path, long = book_with(tmp_path / "a.xlsx", {"B1": "HEADING"}), tmp_path / "b.xlsx"
    with ZipFile(path) as read, ZipFile(long, "w", ZIP_DEFLATED) as archive:
        for name in read.namelist():
            archive.writestr(name, read.read(name).replace(b"HEADING", 40_000 * b"x"))
    assert "row 1: a text is longer" in refusal("points", long)


def test_a_workbook_that_unpacks_to_much(tmp_path):
    path = book_with(tmp_path / "a.xlsx", {})
    with ZipFile(path, "a", ZIP_DEFLATED) as archive:
        archive.writestr("xl/media.xml", bytes(33 << 20))
    assert path.stat().st_size < 100_000
    assert "once it is unpacked" in refusal("points", path)


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04", b"no book"])
def test_what_is_no_workbook(content, tmp_path):
    path = tmp_path / "a.xlsx"
    path.write_bytes(content)
    assert "not a readable Excel workbook" in refusal("points", path)
