"""``kintrafo import``: a file's format by its ending and its content, and the options of each."""

import shutil

import pytest
from kintrafo import InputError, Suspension
from kintrafo.vehicle.files.formats import format_of
from support.folders import DATA

CHRONO = (DATA / "chrono/MacPhersonStrut.json").read_text(encoding="utf-8")
ADAMS = (DATA / "adams/front_suspension.sub").read_text(encoding="utf-8")
TABLE = "point,x [mm],y [mm],z [mm]\nball_joint,5.0,-745.0,180.0\n"


@pytest.mark.parametrize(
    ("name", "text", "found"),
    [
        ("a.json", CHRONO, "chrono"),
        ("a.JSON", "[]", "chrono"),
        ("a", CHRONO, "chrono"),
        ("a.dat", f"\ufeff// of Chrono\n/* two\nlines */ {CHRONO}", "chrono"),
        ("a.sub", ADAMS, "adams"),
        ("a.sub", "", "adams"),
        ("a.xml", "<xml/>", "adams"),
        ("a.txt", ADAMS, "adams"),
        ("a", ADAMS.lower(), "adams"),
        ("a.csv", TABLE, "table"),
        ("a.csv", ADAMS, "table"),
        ("a.txt", TABLE, "table"),
        ("a.txt", "{", "table"),
        ("a.xls", "", "table"),
    ],
)
def test_the_format_of_a_file(name, text, found, tmp_path):
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    assert format_of(path) == found


@pytest.mark.parametrize("name", ["a.toml", "a.bin", "a"])
def test_other_files(name, refused, tmp_path):
    (tmp_path / name).write_text("x = 1\n", encoding="utf-8")
    refused(InputError, lambda: format_of(tmp_path / name))


# what is given besides SOURCE and PATH, of the format that does not have it
OTHERS = [
    ("a.csv", "--side left"),
    ("a.csv", "--kind macpherson"),
    ("a.csv", "--points-only"),
    ("a.csv", "--tire b.json"),
    ("a.sub", "--unit mm"),
    ("a.sub", "--mirror"),
    ("a.sub", "--axes x"),
    ("a.sub", "--sheet x"),
    ("a.sub", "--left-handed"),
    ("a.sub", "--tire b.json"),
    ("b.json", "--from reference_car"),
    ("b.json", "--name a=b"),
    ("b.json", "--kind macpherson"),
    ("b.json", "--mirror"),
]


@pytest.mark.parametrize(("source", "option"), OTHERS)
def test_options_of_another_format(ends, tmp_path, source, option):
    for name, text in {"a.csv": TABLE, "a.sub": ADAMS, "b.json": CHRONO}.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    ends(2, "import", source, "new.toml", *option.split())
    assert not (tmp_path / "new.toml").exists()


@pytest.mark.parametrize(
    ("name", "text", "more"),
    [
        ("a.csv", "point\n", "--from reference_car"),
        ("a.json", "{}", ""),
        ("a.sub", "x", ""),
        ("a.txt", "[UNITS]\n", ""),
    ],
)
def test_a_refusal_says_what_a_file_is_read_as(tmp_path, name, text, more, ends):
    (tmp_path / name).write_text(text, encoding="utf-8")
    ends(2, "import", name, "new.toml", *more.split())


def test_a_table_needs_the_rest(tmp_path, ends):
    (tmp_path / "a.csv").write_text(TABLE, encoding="utf-8")
    ends(2, "import", "a.csv", "new.toml")


def test_a_subsystem_as_a_text_file(kintrafo, tmp_path):
    shutil.copy(DATA / "adams/front_suspension.sub", tmp_path / "front.txt")
    shutil.copy(DATA / "adams/front_suspension.sub", tmp_path / "front.sub")
    for name in ("front.txt", "front.sub"):
        assert kintrafo("import", name, f"{name}.toml")[0] == 0
    assert Suspension.load("front.txt.toml") == Suspension.load("front.sub.toml")
