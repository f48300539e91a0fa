"""Hardpoints from spreadsheets, and into them."""

import tomllib
from itertools import product

import numpy as np
import pytest
from kintrafo import InputError, Suspension
from kintrafo.vehicle.files.point_table import (
    as_words,
    merged,
    read_points,
    write_merged,
    write_points,
)
from kintrafo.vehicle.kinds import KINDS

CAR = Suspension.load("reference_car")


def table(tmp_path, text, name="points.csv"):
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize("kind", KINDS)
def test_what_is_written_is_read_again(kind, tmp_path):
    name = KINDS[kind].STARTER
    car = Suspension.load(name)
    path = write_points(car, tmp_path / "points.csv")
    found = merged(read_points(path), name)
    assert found.kept == found.left_out == ()
    assert list(found.read) == car.hardpoints.given()
    again = Suspension.load(write_merged(found, tmp_path / "again.toml"))
    assert again == car


def test_points_of_a_table_replace_those_of_the_file(tmp_path):
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


def test_the_other_side_is_mirrored(tmp_path, refused):
    path = write_points(CAR.mirrored(), tmp_path / "left.csv")
    found = merged(read_points(path), "reference_car", mirrored=True)
    assert Suspension.load(write_merged(found, tmp_path / "right.toml")) == CAR
    refused(InputError, lambda: merged(read_points(path), "reference_car"))


def test_excel_is_read(tmp_path, refused):
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.Workbook()
    book.active.append(["hardpoint", "x (mm)", "y (mm)", "z (mm)"])
    book.active.append(["ball_joint", 5, -711.5, 180.0])
    book.active.append([None, None, None, None])
    book.active.append(["strut_top", "-28", -585, 820])
    book.save(tmp_path / "points.xlsx")
    points = read_points(tmp_path / "points.xlsx").points
    assert points == {"ball_joint": (5.0, -711.5, 180.0), "strut_top": (-28.0, -585.0, 820.0)}
    refused(InputError, lambda: read_points(table(tmp_path, "no book", "other.xlsx")))


HEAD = "point,x [mm],y [mm],z [mm]\n"
WRONG = {
    "empty": "",
    "no points": HEAD,
    "blanks": "point  x  y  z\nball_joint  5.0 -711,5  1.8e2\n",
    "no names": "x [mm],y [mm],z [mm]\n1,2,3\n",
    "no z": "point,x [mm],y [mm]\na,1,2\n",
    "units": "point,x [mm],y [m],z [mm]\na,1,2,3\n",
    "no unit": "point,x,y,z\na,1,2,3\n",
    "no length": "point,x [kg],y [kg],z [kg]\na,1,2,3\n",
    "furlongs": "point,x [furlong],y [furlong],z [furlong]\na,1,2,3\n",
    "another spelling": HEAD + "ball_joint,1,2,3\nBall Joint,1,2,4\n",
    "one word": HEAD + "ball_joint,1,2,3\nBALLJOINT,1,2,4\n",
    "two names": HEAD + "ball_joint,1,2,3\nlca_outer,1,2,4\n",
    "no name": HEAD + "ball_joint,1,2,3\n,1,2,4\n",
    "unit of one": "point,x [mm],y,z\nball_joint,1,2,3\n",
    "unit twice": "# units: in\n" + HEAD + "ball_joint,1,2,3\n",
    "another one below": HEAD + "# in inches\nball_joint,1,2,3\n",
    "row of units": HEAD + ",in,in,in\nball_joint,1,2,3\n",
    "unknown comment": "# units: ells\npoint,x,y,z\nball_joint,1,2,3\n",
    "marks": "point;x [mm];y [mm];z [mm]\nball_joint;1,5;2.5;3\n",
    "text": HEAD + "ball_joint,1,two,3\n",
    "missing": HEAD + "ball_joint,1,2\n",
    "not a number": HEAD + "ball_joint,nan,2,3\n",
    "digits": HEAD + "ball_joint,1_0,2,3\n",
    "twice": HEAD + "a,1,2,3\na,1,2,3\n",
    "unknown": HEAD + "bal_joint,1,2,3\n",
    "none that is needed": HEAD + "spring_seat,1,2,3\na,1,2,3\n",
    "decimal commas": HEAD + "ball_joint,5,0,-711,5,180,0\n",
    "a further value": HEAD + "ball_joint,5,-711.5,180\narm_front,160,5,-360,195\n",
    "a side beside none": ",,,,Left\n" + HEAD[:-1] + ",x [mm],y [mm],z [mm]\na,1,2,3,4,5,6\n",
    "impossible": HEAD + "ball_joint,170,-350,205\n",
}


@pytest.mark.parametrize("text", WRONG.values(), ids=WRONG)
def test_what_is_wrong_is_named(text, refused, tmp_path):
    refused(InputError, lambda: merged(read_points(table(tmp_path, text)), "reference_car"))


# -- names, units and axes of other programs -------------------------------------------------------

METRES = {"mm": 0.001, "cm": 0.01, "m": 1.0, "in": 0.0254, "ft": 0.3048}
SPELT = {"mm": "Millimetres", "cm": "CM", "m": "meter", "in": "Inches", "ft": "feet"}
FORMS = {
    "brackets": "point,x [{0}],y [{0}],z [{0}]\n{1}",
    "parentheses": "Name,X ({0}),Y ({0}),Z ({0})\n{1}",
    "endings": "Hardpoint,x_{0},Y {0},z, {0}\n{1}",
    "row": "point,x,y,z\n,{0},[{0}],({0})\n{1}",
    "row with a word": "point,x,y,z\nunits,{0},{0},{0}\n{1}",
    "comment": "# units: {0}\npoint,x,y,z\n{1}",
    "comment below": "point,x,y,z\n# all coordinates are in {0}\n{1}",
    "word in a comment": "point,x,y,z\n# {0}\n{1}",
    "comment that says in": "point,x,y,z\n# in {0}\n{1}",
    "whole sentence": "point,x,y,z\n# points are given in {0}.\n{1}",
    "columns in a comment": "point,x,y,z\n#-,{0},{0},{0}\n{1}",
    "title": "My car\nLength unit,{0}\n\npoint,x,y,z\n{1}",
}


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("unit", METRES)
def test_a_unit_is_one_in_every_form(form, unit, tmp_path):
    text = FORMS[form].replace("z, {0}", '"z, {0}"')
    for spelling in (unit, SPELT[unit]):
        path = table(tmp_path, text.format(spelling, "ball_joint,1.5,-2.25,3\n"))
        found = read_points(path)
        assert (found.unit, found.points) == (unit, {"ball_joint": (1.5, -2.25, 3.0)})


@pytest.mark.parametrize("unit", METRES)
def test_lengths_are_those_of_the_file(unit, tmp_path):
    there = {"arm_front": (160.0, -360.0, 195.0), "arm_rear": (-200.0, -360.0, 200.0)}
    rows = "".join(
        f"{name},{','.join(repr(1e-3 * value / METRES[unit]) for value in place)}\n"
        for name, place in there.items()
    )
    path = table(tmp_path, "point,x,y,z\n" + rows)
    new = merged(read_points(path, unit=SPELT[unit]), "reference_car")
    car = Suspension.load(write_merged(new, tmp_path / "new.toml"))
    for name, place in there.items():
        # four roundings: the two products and the quotient here, and that of the conversion
        np.testing.assert_allclose(getattr(car.hardpoints, name), place, rtol=1e-15, atol=0.0)


def test_lengths_have_the_digits_of_the_table(tmp_path):
    path = table(tmp_path, "point,x [in],y [in],z [in]\narm_front,4.078,-9.492422,10.26018\n")
    new = tomllib.loads(merged(read_points(path), "reference_car").text)
    # exact: 25.4 times these decimals
    assert new["hardpoints"]["arm_front"] == [103.5812, -241.1075188, 260.608572]


def test_a_refusal_says_how_the_table_was_read(tmp_path, refused):
    rows = "arm_front,-160,-360,195\narm_rear,200,-360,200\n"
    path = table(tmp_path, "point,x [mm],y [mm],z [mm]\n" + rows)
    refused(InputError, lambda: merged(read_points(path), "reference_car"))


def test_a_unit_that_is_given_must_not_contradict(tmp_path, refused):
    path = table(tmp_path, HEAD + "ball_joint,1,2,3\n")
    assert read_points(path, unit="millimetre").unit == "mm"
    refused(
        InputError, lambda: read_points(path, unit="in"), lambda: read_points(path, unit="parsec")
    )


POINTING = {
    "forward": (1, 0, 0), "rearward": (-1, 0, 0), "left": (0, 1, 0),
    "right": (0, -1, 0), "up": (0, 0, 1), "down": (0, 0, -1),
}  # fmt: skip


@pytest.mark.parametrize("words", [*product(POINTING, repeat=3)], ids=" ".join)
def test_axes_of_other_programs(words, tmp_path):
    path = table(tmp_path, HEAD + "a,1,2,3\n")
    x, y, z = (np.array(POINTING[word]) for word in words)
    hand = int(np.cross(x, y) @ z)
    left_handed = {1: False, -1: True}.get(hand)
    for told in (False, True):
        if told == left_handed:
            found = read_points(path, axes=" ".join(words), left_handed=told)
            assert found.points["a"] == tuple((1.0 * x + 2.0 * y + 3.0 * z).tolist())
        else:
            with pytest.raises(InputError, match=r"axes|line"):
                read_points(path, axes=" ".join(words), left_handed=told)


def test_axes_that_are_none(tmp_path, refused):
    path = table(tmp_path, HEAD + "a,1,2,3\n")
    for words in ("", "forward left", "forward left sky", "forward left up down"):
        with refused(InputError):
            read_points(path, axes=words)


def test_names_of_the_user(tmp_path, refused):
    path = table(tmp_path, HEAD + "FLCA outboard,5,-711.5,180\nother,1,2,3\n")
    points = read_points(path)
    found = merged(points, "reference_car", names={"ball_joint": "flca_Outboard"})
    assert found.read == {"ball_joint": "FLCA outboard"}
    assert found.left_out == ("other",)
    for names in ({"ball_joint": "x"}, {"bal_joint": "other"}):
        with refused(InputError):
            merged(points, "reference_car", names=names)


def test_every_column_is_read_or_listed(tmp_path):
    text = "point,x [mm],y [mm],z [mm],remark,radius [mm]\nball_joint,5,-711.5,180,a,3\n"
    points = read_points(table(tmp_path, text))
    assert points.left_out == ("column remark", "column radius [mm]")
    assert "column remark" in as_words(merged(points, "reference_car"), points)["not read"]


LOTUS = """LOTUS SUSPENSION ANALYSIS v4.03
TYPE 1 Double Wishbone, damper to lower wishbone
X Y Z
(mm) (mm) (mm)
-160.0 360.00 195.0 POINT ( 1 ) = Lower wishbone front pivot
200.0 360.00 195 POINT:2 Lower wishbone rear pivot
-5 720.0 185.0 POINT ( 3 ) = Lower wishbone outer ball joint
0.00 0.00 0.00 POINT:0
CAMBER ANGLE (deg): 0.00
"""


def test_a_text_of_lotus_suspension_analysis(tmp_path, refused):
    """There x points rearward and y to the right."""
    points = read_points(table(tmp_path, LOTUS, "front.txt"))
    found = merged(points, "double_wishbone_car")
    assert found.read == {
        "lower_arm_front": "Lower wishbone front pivot",
        "lower_arm_rear": "Lower wishbone rear pivot",
        "lower_ball_joint": "Lower wishbone outer ball joint",
    }
    new = Suspension.load(write_merged(found, tmp_path / "new.toml"))
    assert new == Suspension.load("double_wishbone_car")
    refused(
        InputError, lambda: read_points(table(tmp_path, LOTUS.replace("(mm)", ""), "front.txt"))
    )
    for y in ("360,00", "3 60.00", "nan"):
        with refused(InputError):
            read_points(table(tmp_path, LOTUS.replace("360.00", y, 1), "front.txt"))
    exponents = read_points(table(tmp_path, LOTUS.replace("360.00", "3.6E+02"), "front.txt"))
    assert exponents.points == points.points
    refused(InputError, lambda: read_points(table(tmp_path, LOTUS, "front.shk")))


SIDES = (
    (None, "Name:", "Front"),
    ("User Options", "Length", "millimetre", "mm"),
    ("Double A-Arm", "Point Name", "Left", None, None, None, "Right"),
    (None, None, "X", "Y", "Z", None, "X", "Y", "Z"),
    (None, "CHAS_LowFor", 170.0, 350.0, 190.0, None, 160.0, -360.0, 195.0),
    (None, "UPRI_LowPnt", 5.0, 720.0, 180.0, None, 5.0, -720.0, 185.0),
)


def workbook(tmp_path, sheets, hidden=""):
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.Workbook()
    book.remove(book.active)
    for name, rows in sheets.items():
        sheet = book.create_sheet(name)
        for row in rows:
            sheet.append(row)
        sheet.sheet_state = "hidden" if name == hidden else "visible"
    book.save(tmp_path / "points.xlsx")
    return tmp_path / "points.xlsx"


def test_a_workbook_of_optimumk(tmp_path, refused):
    """Each car gets the points of its own side."""
    points = read_points(workbook(tmp_path, {"Front": SIDES}))
    right = Suspension.load("double_wishbone_car")
    names = {"lower_arm_front": "CHAS_LowFor", "lower_ball_joint": "UPRI_LowPnt"}
    found = merged(points, "double_wishbone_car")
    assert found.read == names
    assert Suspension.load(write_merged(found, tmp_path / "right.toml")) == right
    right.mirrored().save(tmp_path / "old.toml")
    new = Suspension.load(write_merged(merged(points, tmp_path / "old.toml"), tmp_path / "l.toml"))
    assert new.hardpoints.lower_arm_front == (170.0, 350.0, 190.0)
    refused(InputError, lambda: merged(points, "double_wishbone_car", mirrored=True))
    swapped = [[{"Left": "Right", "Right": "Left"}.get(c, c) for c in row] for row in SIDES]
    points = read_points(workbook(tmp_path, {"Front": swapped}))
    refused(InputError, lambda: merged(points, "double_wishbone_car"))


@pytest.mark.parametrize("side", ["Left", "Right"])
def test_a_table_of_one_side(side, tmp_path, refused):
    """It is that of a suspension of this side, and mirrored that of the other."""
    y = {"Left": 711.5, "Right": -711.5}[side]
    text = f",{side}\n{HEAD}ball_joint,5,{y},180\n"
    points = read_points(table(tmp_path, text))
    if side == "Left":
        refused(InputError, lambda: merged(points, "reference_car"))
    found = merged(points, "reference_car", mirrored=side == "Left")
    new = Suspension.load(write_merged(found, tmp_path / "new.toml"))
    assert new.hardpoints.ball_joint == (5.0, -711.5, 180.0)


def test_sheets_of_a_workbook(tmp_path, refused):
    rows = (("point", "x [mm]", "y [mm]", "z [mm]"), ("ball_joint", 5, -711.5, 180.0))
    both = {"notes": [("nothing",)], "front": rows, "rear": rows}
    refused(InputError, lambda: read_points(workbook(tmp_path, both)))
    path = workbook(tmp_path, both, hidden="rear")
    assert read_points(path).left_out == ("sheet notes", "sheet rear")
    assert read_points(path, sheet="rear").left_out == ("sheet notes", "sheet front")
    refused(
        InputError,
        lambda: read_points(path, sheet="raer"),
        lambda: read_points(table(tmp_path, HEAD + "a,1,2,3\n"), sheet="rear"),
    )


CELLS = [True, "two", "#DIV/0!", "1,5", None, "=1+1", float("inf"), "1_0"]


@pytest.mark.parametrize("cell", CELLS, ids=str)
def test_cells_that_are_no_numbers(cell, tmp_path, refused):
    rows = (("point", "x [mm]", "y [mm]", "z [mm]"), ("ball_joint", 5, cell, 180.0))
    refused(InputError, lambda: read_points(workbook(tmp_path, {"a": rows})))


def test_the_commands(kintrafo, tmp_path, ends):
    assert kintrafo("export", "reference_car", "--to", "points", "-o", "points.csv")[0] == 0
    code, out, _ = kintrafo("import", "points.csv", "new.toml", "--from", "reference_car")
    assert (code, "read: arm_front" in out) == (0, True)
    assert Suspension.load(tmp_path / "new.toml") == CAR
    (tmp_path / "mine.toml").write_text("mine", encoding="utf-8")
    ends(2, "import", "points.csv", "mine.toml", "--from", "new.toml")
    code, _, _ = kintrafo("import", "points.csv", "new.toml", "--from", "new.toml", "--force")
    assert code == 2  # what is read is never replaced
    assert kintrafo("import", "points.txt", "x.toml", "--from", "new.toml")[0] == 2


def test_a_table_of_another_car_is_doubted(kintrafo, tmp_path):
    """Rows that are no hardpoints are named on stderr, where hardpoints are missing."""
    other = HEAD + "wheel_center,5,-750,310\nlower_arm_front,1,2,3\nlower_arm_rear,1,2,4\n"
    table(tmp_path, other, "other.csv")
    code, _, err = kintrafo("import", "other.csv", "new.toml", "--from", "reference_car")
    told = " ".join(err.split())
    assert code == 0
    assert "2 of 3 rows are not hardpoints: lower_arm_front, lower_arm_rear; and " in told
    assert "arm_front, arm_rear, ball_joint, " in told
    assert " stay as in the file. " in told
    assert "--name arm_front=lower_arm_front" in told
    assert kintrafo("export", "reference_car", "--to", "points", "-o", "all.csv")[0] == 0
    whole = (tmp_path / "all.csv").read_text(encoding="utf-8")
    for text in (HEAD + "wheel_center,5,-750,310\n", whole + "cad_origin,0,0,0\n"):
        table(tmp_path, text)
        code, _, err = kintrafo(
            "import", "points.csv", "x.toml", "--from", "reference_car", "--force"
        )
        assert (code, err) == (0, "")
