"""Hardpoints from spreadsheets, and into them."""

from pathlib import Path
from typing import Any

import pytest
from kintrafo import InputError, Suspension
from kintrafo.suspension.kinds import KINDS
from kintrafo.suspension.point_table import merged, read_points, write_merged, write_points
from test_cli_commands import kintrafo  # noqa: F401 (a fixture)

CAR = Suspension.load("reference_car")


def table(tmp_path: Path, text: str, name: str = "points.csv") -> Path:
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize("kind", KINDS)
def test_what_is_written_is_read_again(kind: str, tmp_path: Path) -> None:
    name = KINDS[kind].STARTER
    car = Suspension.load(name)
    path = write_points(car, tmp_path / "points.csv")
    found = merged(read_points(path), name)
    assert found.kept == found.left_out == ()
    assert list(found.read) == car.hardpoints.given()
    again = Suspension.load(write_merged(found, tmp_path / "again.toml"))
    assert again == car


def test_points_of_a_table_replace_those_of_the_file(tmp_path: Path) -> None:
    text = "Name;x [m];y [m];z [m];remark\nBall joint;0,005;-0,7115;0,18;moved\nwatts link;1;2;3;\n"
    found = merged(read_points(table(tmp_path, text)), "reference_car")
    assert found.read == {"ball_joint": "Ball joint"}
    assert found.left_out == ("watts link",)
    assert "strut_top" in found.kept
    path = write_merged(found, tmp_path / "new.toml")
    new = Suspension.load(path)
    assert new.hardpoints.ball_joint == (5.0, -711.5, 180.0)
    assert new.with_changes({"hardpoints.ball_joint": list(CAR.hardpoints.ball_joint)}) == CAR
    assert "# control arm to knuckle" in path.read_text(encoding="utf-8")


def test_the_other_side_is_mirrored(tmp_path: Path) -> None:
    path = write_points(CAR.mirrored(), tmp_path / "left.csv")
    found = merged(read_points(path), "reference_car", mirrored=True)
    assert Suspension.load(write_merged(found, tmp_path / "right.toml")) == CAR
    with pytest.raises(InputError, match="Mirror them: --mirror"):
        merged(read_points(path), "reference_car")


def test_excel_is_read(tmp_path: Path) -> None:
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.Workbook()
    book.active.append(["hardpoint", "x (mm)", "y (mm)", "z (mm)"])
    book.active.append(["ball_joint", 5, -711.5, 180.0])
    book.active.append([None, None, None, None])
    book.active.append(["strut_top", "-28", -585, 820])
    book.save(tmp_path / "points.xlsx")
    points = read_points(tmp_path / "points.xlsx").points
    assert points == {"ball_joint": (5.0, -711.5, 180.0), "strut_top": (-28.0, -585.0, 820.0)}
    with pytest.raises(InputError, match="no Excel workbook"):
        read_points(table(tmp_path, "no book", "other.xlsx"))


HEAD = "point,x [mm],y [mm],z [mm]\n"
WRONG = {
    "empty": ("", "the first row names the columns"),
    "no points": (HEAD, "no points below"),
    "no names": ("x [mm],y [mm],z [mm]\n1,2,3\n", "one column with the names"),
    "no z": ("point,x [mm],y [mm]\na,1,2\n", "one column z is needed"),
    "units": ("point,x [mm],y [m],z [mm]\na,1,2,3\n", "of all the same; it is m, mm"),
    "no unit": ("point,x,y,z\na,1,2,3\n", "it is none"),
    "inches": ("point,x [in],y [in],z [in]\na,1,2,3\n", "it is in"),
    "text": (HEAD + "ball_joint,1,two,3\n", "row 2, ball_joint: three numbers"),
    "missing": (HEAD + "ball_joint,1,2\n", "three numbers are needed"),
    "not a number": (HEAD + "ball_joint,nan,2,3\n", "three numbers are needed"),
    "digits": (HEAD + "ball_joint,1_0,2,3\n", "three numbers are needed"),
    "twice": (HEAD + "a,1,2,3\na,1,2,3\n", "a is there twice"),
    "unknown": (HEAD + "bal_joint,1,2,3\n", r"bal_joint \(is it ball_joint\?\)"),
    "impossible": (HEAD + "ball_joint,170,-350,205\n", "two points of the control arm"),
}


@pytest.mark.parametrize(("text", "message"), WRONG.values(), ids=WRONG)
def test_what_is_wrong_is_named(text: str, message: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=message):
        merged(read_points(table(tmp_path, text)), "reference_car")


def test_the_commands(kintrafo: Any, tmp_path: Path) -> None:  # noqa: F811
    assert kintrafo("export-points", "reference_car", "points.csv")[0] == 0
    code, out, _ = kintrafo("import-points", "points.csv", "reference_car", "new.toml")
    assert (code, "read: arm_front" in out) == (0, True)
    assert Suspension.load(tmp_path / "new.toml") == CAR
    (tmp_path / "mine.toml").write_text("mine", encoding="utf-8")
    code, _, err = kintrafo("import-points", "points.csv", "new.toml", "mine.toml")
    assert (code, "mine.toml" in err) == (2, True)
    code, _, _ = kintrafo("import-points", "points.csv", "new.toml", "new.toml", "--force")
    assert code == 2  # what is read is never replaced
    assert kintrafo("import-points", "points.txt", "new.toml", "x.toml")[0] == 2
