"""Lines of keys in TOML files, and every reader that names them in its messages."""

import tomllib

import pytest
from kintrafo.vehicle.data.starter import all_packaged, manoeuvres
from kintrafo.vehicle.input.toml_file import lines_of_keys
from support.folders import ROOT

SYNTAX = '''# [no.table] of a comment
top = "[a] = {" # ]
two."part s" = """
[inside]
text = 1
"""
'literal' = \'\'\'x = [\'\'\'
[first] # [
rows = [
  [1, 2], # ]
  ["]", 4],
]
inline = {a = 1, b = {c = 2}}
[ first . "in side" ]
key = """four""""
[[many]]
key = 1
once = 2
[[many]]
key = 3
[apart.below]
[apart]
last = 1
'''
LINES = {
    "top": 2, "two": 3, "two.part s": 3, "literal": 7, "first": 8, "first.rows": 9,
    "first.inline": 13, "first.inline.a": 13, "first.inline.b": 13, "first.inline.b.c": 13,
    "first.in side": 14, "first.in side.key": 15, "many.once": 18, "apart.below": 21, "apart": 22,
    "apart.last": 23,
}  # fmt: skip


@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_lines_of_all_syntax(end):
    assert tomllib.loads(SYNTAX)
    assert lines_of_keys(SYNTAX.replace("\n", end)) == LINES


def names(tables, before=""):
    for key, value in tables.items():
        yield before + key
        if isinstance(value, dict):
            yield from names(value, f"{before}{key}.")


def prefixes(text):
    """Yield a number of lines, and the names in these lines alone, where they are a valid file."""
    lines = text.split("\n")
    for count in range(len(lines) + 1):
        try:
            yield count, {*names(tomllib.loads("\n".join(lines[:count])))}
        except tomllib.TOMLDecodeError:
            continue


@pytest.mark.parametrize("name", ["formula_student", "driving_car", "rigid_axle", "step_steer"])
def test_a_key_begins_after_the_last_lines_that_are_without_it(name):
    text = {**all_packaged(), **manoeuvres()}[name].read_text(encoding="utf-8")
    found, before, first = lines_of_keys(text), 0, {}
    for count, known in prefixes(text):
        first |= dict.fromkeys(known - first.keys(), before + 1)
        before = count
    # a table may be first seen as part of the header of one below it, without a line of its own
    own = {key: line for key, line in first.items() if key in found}
    assert found == own
    assert all(any(k.startswith(f"{key}.") for k in found) for key in first.keys() - own.keys())


TEXT = (ROOT / "vehicle/data/reference_car.toml").read_text(encoding="utf-8")
STUDY = """[free]
"hardpoints.nowhere" = 1.0
[tolerances]
"hardpoints.ball_joint.z" = -1.0
[targets.bump_steer]
at_mm = 10.0
value = 0.0
within = 0.01
"""
GOALS = "[limits.toe]\nat_mm = 10.0\nleast = 0.0\nmsot = 1.0\n"
READERS = {
    "suspension": ("check FILE", f"nonsense = 1\n{TEXT}", "1"),
    "axle": ("check FILE", 'axle = "front"\nside = "nowhere.toml"\n', "2"),
    "rigid axle": ("check FILE", 'rigid_axle = "rear"\n[spring]\nrate = 1\n', "3"),
    "car": ("check FILE", 'car = "heave"\ncorner = "reference_car"\n[body]\nmas_kg = 1\n', "4"),
    "manoeuvre": ("drive driving_car --manoeuvre FILE",
                  'manoeuvre = "step_steer"\nspeed_km_per_h = -1\n', "2"),
    "optimise": ("optimise reference_car FILE", STUDY, "2"),
    "pareto": ("pareto reference_car FILE", f"{STUDY}[minimise.scrub_radius]\n", "2"),
    "tolerance": ("tolerance reference_car FILE", STUDY, "4"),
    "no section": ("tolerance reference_car FILE", "[free]\n", ""),
    "unknown section": ("tolerance reference_car FILE", "\n[fre]\n", "2"),
    "characteristics": ("characteristics reference_car --goals FILE", GOALS, "4"),
    "compare": ("compare reference_car reference_car --goals FILE", GOALS, "4"),
    "report": ("report reference_car x.html --goals FILE", GOALS, "4"),
    "load cases": ("loads reference_car --cases FILE", "[cases.a]\n[cases.b]\nfx_N = 1\n", "3"),
    "of an axle": ("loads reference_axle --cases FILE",
                   "[cases.a]\n[cases.b.left]\nfx_N = 1\n", "3"),
    "bushes": ("compliance reference_car --bushes FILE",
               "[bushings.arm_rear]\nradial_N_per_mm = 'soft'\n", "2"),
    "bushes of a sheet": ("sheet reference_axle --bushes FILE", "\n[bushings.nowhere]\n", "2"),
}  # fmt: skip


@pytest.mark.parametrize("reader", READERS)
def test_every_reader_names_the_file_and_the_line(reader, kintrafo, tmp_path):
    line, text, number = READERS[reader]
    file = tmp_path / "mine.toml"
    file.write_text(text)
    code, out, err = kintrafo(*line.replace("FILE", str(file)).split())
    assert code
    assert not err.startswith("\n")  # the end of a progress bar
    head, *problems = (out + err).partition(f"{file}: ")[2].splitlines()
    assert "problem" in head
    assert not number or any(each.startswith(f"  - line {number}: ") for each in problems)
