"""``kintrafo import``: a file's format by its ending and its content, and the options of each."""

import shutil

import pytest
from kintrafo import InputError, Suspension
from kintrafo.vehicle.files.formats import NAMES, format_of
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
    ("a.csv", "--side left", "table"),
    ("a.csv", "--kind macpherson", "table"),
    ("a.csv", "--points-only", "table"),
    ("a.csv", "--tire b.json", "table"),
    ("a.sub", "--unit mm", "adams"),
    ("a.sub", "--mirror", "adams"),
    ("a.sub", "--axes x", "adams"),
    ("a.sub", "--sheet x", "adams"),
    ("a.sub", "--left-handed", "adams"),
    ("a.sub", "--tire b.json", "adams"),
    ("b.json", "--from reference_car", "chrono"),
    ("b.json", "--name a=b", "chrono"),
    ("b.json", "--kind macpherson", "chrono"),
    ("b.json", "--mirror", "chrono"),
]


@pytest.mark.parametrize(("source", "option", "found"), OTHERS)
def test_options_of_another_format(kintrafo, tmp_path, source, option, found):
    for name, text in {"a.csv": TABLE, "a.sub": ADAMS, "b.json": CHRONO}.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    code, out, err = kintrafo("import", source, "new.toml", *option.split())
    assert (code, out) == (2, "")
    words = " ".join(err.replace("│", " ").split())
    assert f"{option.split(maxsplit=1)[0]} is not for {NAMES[found]}, as {source} is read" in words
    assert not (tmp_path / "new.toml").exists()


@pytest.mark.parametrize(
    ("name", "text", "more", "found"),
    [
        ("a.csv", "point\n", "--from reference_car", "table"),
        ("a.json", "{}", "", "chrono"),
        ("a.sub", "x", "", "adams"),
        ("a.txt", "[UNITS]\n", "", "adams"),
    ],
)
def test_a_refusal_says_what_a_file_is_read_as(kintrafo, tmp_path, name, text, more, found):
    (tmp_path / name).write_text(text, encoding="utf-8")
    code, out, err = kintrafo("import", name, "new.toml", *more.split())
    assert (code, out) == (2, "")
    assert f"{name} is read as {NAMES[found]}." in " ".join(err.split())


def test_a_table_needs_the_rest(kintrafo, tmp_path):
    (tmp_path / "a.csv").write_text(TABLE, encoding="utf-8")
    code, _, err = kintrafo("import", "a.csv", "new.toml")
    assert (code, "--from FILE" in " ".join(err.split())) == (2, True)


def test_a_subsystem_as_a_text_file(kintrafo, tmp_path):
    shutil.copy(DATA / "adams/front_suspension.sub", tmp_path / "front.txt")
    shutil.copy(DATA / "adams/front_suspension.sub", tmp_path / "front.sub")
    for name in ("front.txt", "front.sub"):
        assert kintrafo("import", name, f"{name}.toml")[0] == 0
    assert Suspension.load("front.txt.toml") == Suspension.load("front.sub.toml")
