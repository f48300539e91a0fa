"""Subsystems of Adams/Car: the same car comes back that was written, or words of what is wrong."""

import re

import numpy as np
import pytest
from cars.adams_files import kind_of, rows_of, subsystem
from kintrafo import InputError, Model, Suspension, characteristics
from kintrafo.vehicle.files.adams_car import imported, read, read_names
from kintrafo.vehicle.files.point_table import write_merged
from kintrafo.vehicle.kinds import KINDS
from support.folders import ROOT

CARS = {kind: Suspension.load(KINDS[kind].STARTER) for kind in KINDS}
OFFSET = Suspension.load("offset_strut_car")
DATA = ROOT / "vehicle/data"
WISHBONES = CARS["double_wishbone"].with_changes({"wheel.camber_deg": -1.2, "wheel.toe_deg": 0.15})
MORE = """\
[BUSHING_ASSEMBLY]
 USAGE  =  'lca_front'
 SYMMETRY  =  'left/right'
[BUSHING_ASSEMBLY]
 USAGE  =  'lca_rear'
[NSPRING_ASSEMBLY]
 USAGE  =  'ride_spring'
 PROPERTY_FILE  =  '<own>/springs.tbl/own.spr'
"""


def written(folder, text, encoding="utf-8"):
    path = folder / "front.sub"
    path.write_bytes(text.encode(encoding))
    return path


def taken(folder, text, **how):
    return imported(read(written(folder, text)), **how)


def loaded(found, folder):
    return Suspension.load(write_merged(found, folder / "imported.toml", force=True))


@pytest.mark.parametrize("unit", ["mm", "meter", "inch", "cm"])
@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize("name", [*KINDS, "offset strut", "with angles"])
def test_hardpoints_come_back(name, side, unit, tmp_path):
    car = {**CARS, "offset strut": OFFSET, "with angles": WISHBONES}[name]
    kind = kind_of(car)
    text = subsystem(car, unit=unit)
    asked = kind if kind in ("push_rod", "pull_rod") else None
    found = taken(tmp_path, text, side=side, kind=asked)
    new = loaded(found, tmp_path)
    expected = car if car.vehicle.side == side else car.mirrored()
    assert (found.kind, new.vehicle.side) == (kind, side)
    assert sorted(found.read) == sorted(car.hardpoints.given())
    for point in car.hardpoints.given():
        here = new.hardpoints.metres(point)
        assert 1000.0 * here == pytest.approx(1000.0 * expected.hardpoints.metres(point), abs=1e-9)
    assert (new.wheel.camber_deg, new.wheel.toe_deg) == (car.wheel.camber_deg, car.wheel.toe_deg)
    assert found.left_out == ("parameter kinematic_flag single integer 0",)


@pytest.mark.parametrize("name", ["double_wishbone", "with angles", "push_rod", "macpherson"])
def test_it_moves_as_the_car_that_was_written(name, tmp_path):
    car = WISHBONES if name == "with angles" else CARS[name]
    found = taken(tmp_path, subsystem(car), side="right", kind=kind_of(car))
    new = loaded(found, tmp_path)
    assert new.to_dict().keys() == car.to_dict().keys()
    path = np.linspace(-0.06, 0.06, 5)
    curves = [characteristics.over(Model(each), "travel", path) for each in (car, new)]
    for key in ("camber", "toe", "caster", "track_change", "wheel_rate"):
        if key in curves[0]:
            np.testing.assert_allclose(curves[1][key], curves[0][key], rtol=1e-9, atol=1e-12)


def test_what_lies_elsewhere_is_brought_along(tmp_path):
    """A packaged file is of another car: bodies, tyre and strut follow to where the wheel is."""
    for car in (CARS["double_wishbone"], CARS["macpherson"], OFFSET):
        raised = [(n, s, x + 2500.0, y - 40.0, z + 25.0) for n, s, x, y, z in rows_of(car)]
        found = taken(tmp_path, subsystem(car, rows=raised), side="right")
        new, old = loaded(found, tmp_path), Suspension.load(KINDS[found.kind].STARTER)
        shift = new.hardpoints.metres("wheel_center") - old.hardpoints.metres("wheel_center")
        of_car = new.hardpoints.metres("wheel_center") - car.hardpoints.metres("wheel_center")
        assert of_car == pytest.approx([-2.5, -0.04, 0.025], abs=1e-12)
        height = old.tyre.free_height_mm + 1000.0 * shift[2]
        assert new.tyre.free_height_mm == pytest.approx(height, abs=1e-6)
        for name, body in old.bodies.rigid().items():
            if body.com_mm is not None:
                moved = getattr(new.bodies, name).com_mm
                assert moved == pytest.approx(np.array(body.com_mm) + 1000.0 * shift)
        if found.kind == "macpherson":
            assert force_at_design(new) == pytest.approx(force_at_design(old), abs=1e-5)


def force_at_design(car):
    """Return the force of a strut's spring at design [N]."""
    if not hasattr(car, "strut"):
        return float(car.spring.force_at_design_N)
    seats = car.hardpoints.distance("spring_seat", "spring_top")
    return float(car.strut.spring_rate_N_per_m * (car.strut.free_length(seats) - seats))


def test_a_file_of_the_user_gives_the_rest(tmp_path, refused):
    mine = tmp_path / "mine.toml"
    text = (DATA / "double_wishbone_car.toml").read_text(encoding="utf-8")
    mine.write_text(
        "#:schema ./s.json\n" + text.replace("mass_kg = 12.0", "mass_kg = 14.5  # weighed"),
        encoding="utf-8",
    )
    rows = [row for row in rows_of(WISHBONES) if row[0] != "top_mount"]
    found = taken(tmp_path, subsystem(WISHBONES, rows=rows), base=mine)
    assert (found.side, found.kept) == ("right", ("spring_top",))
    assert any(shown == "spring_top: as in the file mine.toml" for shown in found.assumed)
    lines = found.text.splitlines()
    assert lines[0] == "#:schema ./s.json"
    assert lines[1].startswith("# Hardpoints from front.sub, a subsystem of Adams/Car")
    assert "mass_kg = 14.5  # weighed" in lines
    assert any("# upper arm to knuckle; the wheel steers" in line for line in lines)
    new = loaded(found, tmp_path)
    assert new.with_changes({"bodies.knuckle.mass_kg": 12.0}) == WISHBONES
    other = taken(tmp_path, subsystem(WISHBONES, rows=rows), base=mine, side="left")
    assert loaded(other, tmp_path) == new.mirrored()
    refused(InputError, lambda: taken(tmp_path, subsystem(WISHBONES), base=mine, kind="push_rod"))


def test_a_file_of_another_kind_is_refused(tmp_path, refused):
    """Half of one suspension and half of another would be a car that there is not."""
    strut = subsystem(CARS["macpherson"])
    refused(InputError, lambda: taken(tmp_path, strut, base="double_wishbone_car"))
    found = taken(tmp_path, subsystem(CARS["pull_rod"]), base="push_rod_car")
    assert found.kind == "push_rod"


@pytest.mark.parametrize("kind", KINDS)
def test_comments_say_nothing_of_the_packaged_car(kind, tmp_path):
    """Beside a value stands what its key means, whatever the value."""
    packaged = (DATA / f"{KINDS[kind].STARTER}.toml").read_text(encoding="utf-8")
    asked = kind if kind in ("push_rod", "pull_rod") else None
    text = taken(tmp_path, subsystem(CARS[kind]), kind=asked).text
    kept = {line.partition("#")[2] for line in packaged.splitlines() if re.match("[a-z].*#", line)}
    now = {line.partition("#")[2] for line in text.splitlines() if re.match("[a-z].*#", line)}
    assert {words for words in kept & now if re.search("[0-9]", words)} == set()
    assert "invented" not in text
    schema = Suspension.load(KINDS[kind].STARTER).hardpoints
    for name, field in type(schema).model_fields.items():
        if name in schema.given() and re.search(rf"(?m)^{name} .*#", packaged):
            assert re.search(rf"(?m)^{name} .*# {re.escape(field.description or '')}$", text)


def test_comments_beside_changed_values_of_a_user_are_fresh(tmp_path):
    mine = tmp_path / "mine.toml"
    old = (DATA / "double_wishbone_car.toml").read_text(encoding="utf-8")
    old = old.replace("camber_deg = 0.0  ", "camber_deg = 0.0  # none, as measured\n  # in 2019")
    mine.write_text(old.replace("mass_kg = 12.0", "mass_kg = 12.0 # weighed"), encoding="utf-8")
    text = taken(tmp_path, subsystem(WISHBONES), base=mine).text
    assert "camber_deg = -1.2  # camber at design, positive with the top outboard\n" in text
    assert ("measured" in text, "2019" in text) == (False, False)
    assert "mass_kg = 12.0 # weighed" in text
    assert "\ntoe_deg = 0.15                           # toe at design, positive toe-in\n" in text


def test_names_of_the_companys_own(tmp_path, refused):
    text = subsystem(WISHBONES).replace("lca_outer ", "Kugel_1   ")
    refused(InputError, lambda: taken(tmp_path, text))
    found = taken(tmp_path, text, names=read_names(["lower_ball_joint=kugel_1"]), side="right")
    assert loaded(found, tmp_path).hardpoints == WISHBONES.hardpoints
    assert found.read["lower_ball_joint"] == "kugel_1"


def test_one_point_may_be_two_of_ours(tmp_path):
    """Two links that meet in one ball joint are an arm."""
    car = CARS["multi_link"]
    rows = [row for row in rows_of(car) if row[0] != "rear_upper_link_outer"]
    found = taken(
        tmp_path,
        subsystem(car, rows=rows),
        names={"rear_upper_link_outer": "front_upper_link_outer"},
    )
    points = loaded(found, tmp_path).hardpoints
    assert points.rear_upper_link_outer == points.front_upper_link_outer


def test_each_side_may_have_its_own_row(tmp_path):
    left = WISHBONES.mirrored().with_changes({"hardpoints.tie_rod_inner.z": 262.0})
    sides = [*rows_of(left, symmetry=lambda _: "left"),
             *rows_of(WISHBONES, symmetry=lambda _: "right")]  # fmt: skip
    text = subsystem(WISHBONES, rows=sides)
    for car in (left, WISHBONES):
        found = taken(tmp_path, text, side=car.vehicle.side)
        assert loaded(found, tmp_path).hardpoints == car.hardpoints


TOLERATED = {
    "windows": lambda text: text.replace("\n", "\r\n"),
    "old mac": lambda text: text.replace("\n", "\r"),
    "tabs": lambda text: re.sub(" {2,}", "\t", text),
    "double quotes": lambda text: text.replace("'", '"'),
    "no quotes": lambda text: text.replace("'", " "),
    "capitals": lambda text: text.upper(),
    "small letters": lambda text: text.lower(),
    "columns without braces": lambda text: re.sub(r"\{(hard.*)\}", r"\1", text),
    "no names of columns": lambda text: re.sub(r"\{hard.*\}\n", "", text),
    "other order": lambda text: re.sub(
        r"('left/right')(.*)", lambda found: found[2] + " " + found[1], text
    ).replace("symmetry       x_value    y_value    z_value", "x_value y_value z_value symmetry")
    .replace("symmetry       type       value", "type value symmetry")
    .replace("'single    '  'integer'  0", "'integer' 0 'single'"),
    "more columns": lambda text: re.sub(
        r"(z_value)(?=\})|('left/right'(?:  \S+){3})$", r"\1\2  more", text, flags=re.MULTILINE
    ),
    "parameters of any form": lambda text: text + " 'a_list'  'single'  'list'  1  2  'open\n",
    "comments": lambda text: text.replace("\n '", "  $ it's a remark\n! it's one, too\n '"),
    "no header": lambda text: text[text.index("[UNITS]") :],
    "no parameters": lambda text: text[: text.index("[PARAMETER]")],
    "fortran": lambda text: re.sub(r"(\d\.\d+)(?=\s)", r"\1D+00", text),
    "utf-8 mark": lambda text: "\ufeff" + text,
}  # fmt: skip


@pytest.mark.parametrize("name", TOLERATED)
def test_what_is_written_otherwise_is_the_same(name, tmp_path):
    car = CARS["double_wishbone"]
    found = taken(tmp_path, TOLERATED[name](subsystem(car)), side="right")
    assert loaded(found, tmp_path) == car


def test_latin_1(tmp_path):
    text = subsystem(WISHBONES).replace("of nobody", "für Zürich, 20 µm")
    path = written(tmp_path, text, "latin-1")
    assert imported(read(path)).kind == "double_wishbone"


def test_angles_in_radians(tmp_path):
    text = subsystem(WISHBONES).replace("'degrees'", "'radians'")
    text = text.replace(" -1.2\n", f" {np.radians(-1.2)!r}\n").replace("np.float64", "")
    text = text.replace("(-0.02", "-0.02").replace(")\n", "\n")
    found = taken(tmp_path, text.replace(" 0.15\n", " 0.0026179938779914945\n"))
    assert found.angles == {
        "camber_deg": pytest.approx(-1.2, abs=1e-12),
        "toe_deg": pytest.approx(0.15, abs=1e-12),
    }


def test_what_is_not_read_is_reported(tmp_path):
    rows = [*rows_of(WISHBONES), ("drive_shaft_inr", "left/right", 0.0, -200.0, 225.0)]
    found = taken(tmp_path, subsystem(WISHBONES, rows=rows, more=MORE))
    beside = "its file 'own.spr' is not beside the subsystem."
    assert found.left_out == (
        "hardpoint drive_shaft_inr (left/right): 0, -200, 225 mm",
        f"spring ride_spring: {beside} PROPERTY_FILE = <own>/springs.tbl/own.spr",
        "parameter kinematic_flag single integer 0",
        "[BUSHING_ASSEMBLY] USAGE = lca_front, SYMMETRY = left/right",
        "[BUSHING_ASSEMBLY] USAGE = lca_rear",
    )
    assert ("left out", found.left_out[0]) in found.words()


@pytest.mark.parametrize("block", ["HARDPOINT", "PARAMETER", "UNITS", "OTHER"])
def test_comments_are_neither_rows_nor_columns(block, tmp_path):
    comment = "(COMMENTS)\n{comment_string}\n'camber_angle of nobody'\n'a = b'\n"
    text = subsystem(WISHBONES, more="[OTHER]\n").replace(f"[{block}]\n", f"[{block}]\n{comment}")
    found = taken(tmp_path, text, side="right")
    assert loaded(found, tmp_path) == WISHBONES
    assert found.left_out == ("parameter kinematic_flag single integer 0", "[OTHER]")


def test_a_ground_that_is_elsewhere_is_reported(tmp_path):
    low = [(n, s, x, y, z - 300.0) for n, s, x, y, z in rows_of(WISHBONES)]
    found = taken(tmp_path, subsystem(WISHBONES, rows=low))
    assert any(
        shown.startswith("ground: not known, as the wheel centre") for shown in found.assumed
    )


SPRING = """\
[UNITS]
 LENGTH  =  'mm'
 FORCE   =  'newton'
[SPRING_DATA]
 FREE_LENGTH  =  300.0
[CURVE]
{ disp   force }
 -50.0  -2250.0
 0.0    0.0
 100.0  4500.0
"""
PRELOAD = " VALUE_TYPE  =  'preload'\n USER_VALUE  =  5100.0\n"


@pytest.mark.parametrize("folder", [".", "springs.tbl", "../springs.tbl"])
@pytest.mark.parametrize("kind", ["double_wishbone", "macpherson", "multi_link"])
def test_a_straight_spring_is_read(kind, folder, tmp_path):
    (tmp_path / folder).mkdir(exist_ok=True)
    (tmp_path / folder / "own.spr").write_text(SPRING, encoding="utf-8")
    found = taken(tmp_path, subsystem(CARS[kind], more=MORE + PRELOAD))
    assert ("read", "spring 45 N/mm, 5100 N at design (own.spr)") in found.words()
    car = loaded(found, tmp_path)
    if kind == "macpherson":
        assert car.strut.spring_rate_N_per_m == 45000.0
        assert force_at_design(car) == pytest.approx(5100.0)
    else:
        assert (car.spring.rate_N_per_m, car.spring.force_at_design_N) == (45000.0, 5100.0)


@pytest.mark.parametrize(("unit", "factor"), [("mm", 1.0), ("inch", 25.4)])
def test_the_force_at_an_installed_length_is_that_of_the_curve(unit, factor, tmp_path):
    """A spring of 300 mm and 45 N/mm has 3600 N at 220 mm."""
    text = subsystem(WISHBONES, more=f"{MORE} VALUE_TYPE = 'installed_length'\n USER_VALUE = 220\n")
    (tmp_path / "own.spr").write_text(SPRING, encoding="utf-8")
    assert ("read", "spring 45 N/mm, 3600 N at design (own.spr)") in taken(tmp_path, text).words()
    own = SPRING.replace("'mm'", f"'{unit}'").replace("300.0", repr(300.0 / factor))
    own = own.replace("-50.0 ", repr(-50.0 / factor)).replace("100.0 ", repr(100.0 / factor) + " ")
    (tmp_path / "own.spr").write_text(own, encoding="utf-8")
    spring = taken(tmp_path, text).spring
    assert spring.force == pytest.approx(3600.0)
    far = taken(tmp_path, text.replace("USER_VALUE = 220", "USER_VALUE = 100"))
    assert far.spring.force is None  # beyond the curve
    assert any("USER_VALUE = 100" in line for line in far.left_out)


def test_units_of_a_spring(tmp_path):
    """100 lbf/in are 17.5 N/mm, by the definitions of inch, pound and standard gravity."""
    text = SPRING.replace("'mm'", "'inch'").replace("'newton'", "'pound_force'")
    text = text.replace("-50.0  -2250.0", "-1.0 -100.0").replace("100.0  4500.0", "2.0 200.0")
    (tmp_path / "own.spr").write_text(text, encoding="utf-8")
    spring = taken(tmp_path, subsystem(WISHBONES, more=MORE)).spring
    assert spring.force is None
    assert spring.rate == pytest.approx(100.0 * 0.45359237 * 9.80665 / 0.0254)


@pytest.mark.parametrize("kind", ["double_wishbone", "macpherson", "push_rod"])
@pytest.mark.parametrize("preload", [None, 1500.0])
def test_a_spring_by_a_curve_is_read(kind, preload, tmp_path):
    """Its force at design is the preload, and from there it is that of the curve."""
    curve = {-100.0: -6000.0, 0.0: 0.0, 50.0: 2000.0, 200.0: 14000.0}
    rows = "".join(f"{x} {force}\n" for x, force in curve.items())
    text = SPRING.partition("{")[0] + "{disp force}\n" + rows
    (tmp_path / "own.spr").write_text(text, encoding="utf-8")
    entries = "" if preload is None else PRELOAD.replace("5100", "1500")
    found = taken(tmp_path, subsystem(CARS[kind], more=MORE + entries), kind=kind)
    car = loaded(found, tmp_path)
    seats = car.hardpoints.distance("spring_seat", "spring_top")
    assert car.spring.compression_mm == tuple(curve)
    assert car.spring.force_N == tuple(curve.values())
    model = Model(car)
    force = float(model.signal("spring_force", model.design_state))
    expected = force_at_design(Suspension.load(KINDS[kind].STARTER)) if preload is None else preload
    assert force == pytest.approx(expected, rel=1e-9)
    assert seats > 0.0
    assert any(text.startswith("spring: a monotone cubic") for text in found.assumed)


LEFT_OUT = {
    "none": (SPRING.replace("[CURVE]", "[CURVES]"), "no curve of deflection and force"),
    "falling": (SPRING.replace("-2250.0", "9.0").replace("4500", "-9"), "its curve falls"),
    "flat": (SPRING.replace("-2250.0", "0.0").replace("4500", "0"), "its curve falls"),
    "short": (SPRING.replace("4500.0", "4700.0"), "does not reach the force at design, 5360.27 N"),
    "long": (
        SPRING + "".join(f"{x} {x**2}\n" for x in range(101, 120)),
        "its curve has 22 points; 11 are the most",
    ),
    "words": (SPRING.replace("4500.0", "many"), "a row that is not two numbers"),
    "xml": ("<?xml version='1.0'?>", "not a file in the TeimOrbit format"),
    "units": (SPRING.replace("'newton'", "'stone'"), "FORCE is 'stone', which is not known"),
}


@pytest.mark.parametrize(("text", "message"), LEFT_OUT.values(), ids=LEFT_OUT)
def test_a_spring_that_is_left_out(text, message, tmp_path):
    (tmp_path / "own.spr").write_text(text, encoding="utf-8")
    found = taken(tmp_path, subsystem(WISHBONES, more=MORE))
    assert [line for line in found.left_out if message in line]
    assert found.spring is None


def test_springs_that_are_not_taken(tmp_path):
    (tmp_path / "own.spr").write_text(SPRING, encoding="utf-8")
    second = MORE + "[NSPRING_ASSEMBLY]\n USAGE = 'helper'\n SYMMETRY = 'left/right'\n"
    more = taken(tmp_path, subsystem(WISHBONES, more=second))
    assert "spring helper is not the only one: SYMMETRY = left/right" in more.left_out
    scaled = taken(tmp_path, subsystem(WISHBONES, more=MORE + " FORCE_SCALE = 1.1\n"))
    (shown,) = (line for line in scaled.left_out if "FORCE_SCALE is not 1. " in line)
    assert shown.endswith("FORCE_SCALE = 1.1")
    # compressed beyond the curve
    unused = " VALUE_TYPE = 'installed_length'\n USER_VALUE = 100.0\n"
    length = taken(tmp_path, subsystem(WISHBONES, more=MORE + unused))
    assert "spring ride_spring: VALUE_TYPE = installed_length, USER_VALUE = 100.0" in (
        length.left_out
    )
    assert "force of the spring: as in the packaged double_wishbone_car" in length.assumed
    right = taken(tmp_path, subsystem(WISHBONES, more=MORE + " SYMMETRY = 'right'\n"))
    assert right.spring is None
    assert any(t.startswith("spring ride_spring is not of the left side: ") for t in right.left_out)
    based = taken(tmp_path, subsystem(WISHBONES, more=MORE), base="double_wishbone_car")
    shown = "spring 45 N/mm (own.spr): the file double_wishbone_car has its own"
    assert shown in based.left_out


def changed(old, new, count=-1):
    text = subsystem(WISHBONES)
    assert old in text
    return text.replace(old, new, count)


ROW = " 'lca_front               '  'left/right'  -160.0  -360.0  195.0\n"
REFUSED = {
    "nothing": "",
    "xml": "<?xml version='1.0'?>\n<Subsystem/>",
    "binary": "[UNITS]\n\0",
    "another file": changed("'sub'", "'asy'"),
    "a steering": changed("'suspension'", "'steering'"),
    "no units": changed("[UNITS]", "[UNIT]"),
    "furlongs": changed("'mm'", "'furlong'"),
    "two units": changed("[HARD", "[UNITS]\nLENGTH = 'm'\n[HARD"),
    "gon": changed("'degrees'", "'gon'"),
    "no points": changed("[HARDPOINT]", "[POINTS]"),
    "columns": changed("x_value ", "p_value "),
    "twice": changed(ROW, ROW + ROW),
    "twice a side": changed(ROW, ROW + ROW.replace("left/right", "left")),
    "too few": changed("-160.0  -360.0  195.0", "-160.0  -360.0"),
    "too many": changed("-160.0  -360.0", "-160,0  -360.0"),
    "no number": changed("-160.0  -360", "-16o.0  -360"),
    "nan": changed("-160.0  -360.0", "nan  -360.0"),
    "infinite": changed("-160.0  -360.0", "1e999  -360.0"),
    "no angle": changed("  -1.2\n", "  steep\n"),
    "angle of no side": changed("'left/right'  'real'     -1.2", "'single'  'real'  -1.2"),
    "open quote": changed("'lca_front     ", "lca_front     "),
    "a spring's key twice": subsystem(WISHBONES, more=MORE + " PROPERTY_FILE = 'x.spr'\n"),
    "symmetry": changed("'left/right'  -160", "'both'  -160"),
    "single": changed("'left/right'  -160", "'single'  -160"),
    "the right one only": changed("'left/right'  -160", "'right'  -160"),
    "the other side": re.sub("  -(?=[367]..0  )", "  ", changed("-760.0", "760.0")),
    "missing": changed(" 'uca_front", " 'uxa_front"),
    "metres for millimetres": changed("'mm'", "'meter'"),
    "too steep": changed("  -1.2\n", "  -80.0\n"),
    "swapped": changed(ROW, ROW.replace("-160", "160")).replace(
        "rear                '  'left/right'  200", "rear  '  'left/right'  -200"),
}  # fmt: skip


@pytest.mark.parametrize("text", REFUSED.values(), ids=REFUSED)
def test_what_would_make_a_wrong_car_is_refused(text, refused, tmp_path):
    refused(InputError, lambda: taken(tmp_path, text))


def test_push_or_pull_is_asked(tmp_path, refused):
    refused(InputError, lambda: taken(tmp_path, subsystem(CARS["push_rod"])))


SAID = {
    "no pair": ["lca"],
    "twice": ["spring_top=a", "spring_top=b"],
    "not ours": ["spring_tip=top_mount"],
    "not theirs": ["spring_top=top_mound"],
}


@pytest.mark.parametrize("entries", SAID.values(), ids=SAID)
def test_names_that_are_none(entries, refused, tmp_path):
    refused(
        InputError,
        lambda: taken(
            tmp_path, subsystem(WISHBONES), names=read_names(entries), kind="double_wishbone"
        ),
    )


def test_two_that_may_be_one(tmp_path, refused):
    rows = [*rows_of(CARS["push_rod"]), ("prod_outer", "left/right", 0.0, -600.0, 200.0)]
    text = subsystem(CARS["push_rod"], rows=rows)
    refused(InputError, lambda: taken(tmp_path, text, kind="push_rod"))
    assert taken(tmp_path, text, kind="push_rod", names={"push_rod_outer": "prod_outboard"})


def test_the_command(kintrafo, tmp_path, ends):
    written(tmp_path, subsystem(WISHBONES, more=MORE))
    code, out, _ = kintrafo("import", "front.sub", "car.toml", "--side", "right")
    assert code == 0
    assert "read      double wishbone suspension, right side" in out
    assert "left out  [BUSHING_ASSEMBLY] USAGE = lca_front, SYMMETRY = left/right" in out
    assert "assumed   axes: x rearward" in out
    assert Suspension.load(tmp_path / "car.toml") == WISHBONES
    (tmp_path / "mine.toml").write_text("mine", encoding="utf-8")
    ends(2, "import", "front.sub", "mine.toml")
    code, _, _ = kintrafo("import", "front.sub", "car.toml", "--from", "car.toml", "--force")
    assert code == 2  # what is read is never replaced
    named = ["--name", "spring_seat=lwr_strut_mount", "--kind", "double_wishbone"]
    assert kintrafo("import", "front.sub", "again.toml", *named)[0] == 0
    written(tmp_path, subsystem(WISHBONES).replace("'mm'", "'furlong'"))
    assert kintrafo("import", "front.sub", "other.toml")[0] == 2
    assert not (tmp_path / "other.toml").exists()
