"""The HTML report: what is in the file, and how far its numbers are from the compiled model's."""

import base64
import hashlib
import json
import re
from html.parser import HTMLParser

import kintrafo
import numpy as np
import pytest
from cars.driving_cars import light_car
from hypothesis import given
from hypothesis import strategies as st
from kintrafo import InputError, Model, compliance, loads, state_at_height
from kintrafo.vehicle.assembly.of import assembly_of
from kintrafo.vehicle.models.plausibility import typical_ranges
from kintrafo.vehicle.models.points import hardpoints
from kintrafo.vehicle.report import compliance_chapter, elastokinematics_chapter, loads_chapter
from kintrafo.vehicle.report.curves import curves
from kintrafo.vehicle.report.encode import packed, rounded
from kintrafo.vehicle.report.grid import Grid, GridAxis
from kintrafo.vehicle.report.page import _upper_limit, render
from kintrafo.vehicle.report.plotted import decimals, has_pole, shown_range
from kintrafo.vehicle.report.poses import poses, reachable_grid
from kintrafo.vehicle.report.tables import input_tables
from scipy.interpolate import KroghInterpolator
from support.folders import ROOT

MODEL = Model("reference_car")
FOLDER = ROOT / "vehicle/report"
DESIGN_HEIGHT = 0.3


@pytest.fixture(scope="module")
def page():
    return render(MODEL)


@pytest.fixture(scope="module")
def data(page):
    return payload(page)


def payload(text):
    found = re.search(
        r'<script type="application/json" id="payload">(.*?)</script>', text, re.DOTALL
    )
    return json.loads(found.group(1))


def unpacked(array):
    """Decode an array of the page: a second reading of the format, beside that of the script."""
    differences = np.frombuffer(base64.b64decode(array["differences"]), dtype="<f4")
    design = np.atleast_1d(array["design"])
    return (differences.astype(float).reshape(-1, design.size) + design).squeeze()


def axis_of(given):
    return GridAxis(given["first"], given["step"], given["count"])


# -- interpolation ------------------------------------------------------------------------------


@given(
    st.integers(4, 12),
    st.floats(-2.0, 2.0),
    st.floats(0.01, 3.0),
    st.floats(0.0, 1.0),
    st.integers(0, 2**32 - 1),
)
def test_axis_interpolates_like_scipys_polynomial_through_four_neighbours(
    count, first, step, part, seed
):
    axis = GridAxis(first, step, count)
    samples = np.random.default_rng(seed).uniform(-1.0, 1.0, count)
    where = first + part * (axis.last - first)
    start = int(np.clip(np.floor((where - first) / step) - 1, 0, count - 4))
    near = slice(start, start + 4)
    expected = KroghInterpolator(axis.values[near], samples[near])(where)
    # the place within the axis is known to a few ulp of `first`, in steps
    assert axis.interpolate(samples, [where])[0] == pytest.approx(float(expected), abs=1e-10)


def test_grid_is_exact_for_cubics_in_both_directions():
    grid = Grid(GridAxis(-0.1, 0.02, 11), GridAxis(-0.05, 0.025, 5))

    def function(t, r):
        return 1.0 + 2.0 * t - 30.0 * t**3 * r**2 + 7.0 * r**3 + t * r

    samples = function(grid.travel.values[:, None], grid.rack.values)
    travel, rack = np.array([-0.1, -0.0333, 0.071]), np.array([-0.049, 0.0123])
    expected = function(travel[:, None], rack)
    # rounding only
    assert grid.interpolate(samples, travel, rack) == pytest.approx(expected, abs=1e-15)


@given(st.floats(-0.2, -0.001), st.floats(0.001, 0.2), st.floats(0.0005, 0.05))
def test_axis_around_zero_keeps_zero_and_its_limits(low, high, step):
    axis = GridAxis.around_zero(low, high, step)
    assert axis.count >= 4
    assert axis.values[axis.zero] == pytest.approx(0.0, abs=1e-15)
    assert axis.first >= low - 1e-9 * step
    assert axis.last <= high + 1e-9 * step


def test_interpolation_is_worst_where_it_is_measured():
    axis = GridAxis(0.0, 1.0, 9)
    fine = np.linspace(0.0, 8.0, 8001)
    error = np.abs(axis.interpolate(axis.values**4, fine) - fine**4)
    measured = np.abs(axis.interpolate(axis.values**4, axis.between) - axis.between**4)
    assert measured.max() == pytest.approx(error.max(), rel=1e-6)  # of the fine scan


# -- positions ----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "free_rack"),
    [("reference_car", False), ("reference_car", True), ("double_wishbone_car", False)],
)
def test_poses_are_those_of_bracketed_roots(name, free_rack):
    model = Model(name, free_rack=free_rack)
    travel, rack = np.array([-0.08, 0.013, 0.1]), np.array([-0.06, 0.021])
    found = poses(model, travel, rack)
    for i, t in enumerate(travel):
        for k, r in enumerate(rack):
            state = state_at_height(model, DESIGN_HEIGHT + t, rack_position=r)
            inputs = model.inputs({} if free_rack else {"rack_position": r})
            for of, point in hardpoints(model, state, inputs).items():
                # both find the arm's angle to the last digits
                assert found.points[of][i, k] == pytest.approx(point, abs=1e-14), of


def test_grid_is_as_wide_as_the_mechanism_allows():
    grid = reachable_grid(MODEL)
    assert (grid.travel.first, grid.travel.last) == pytest.approx((-0.1, 0.1), abs=1e-12)
    assert (grid.rack.first, grid.rack.last) == pytest.approx((-0.06, 0.06), abs=1e-12)
    # a rod this long cannot follow the rack 60 mm to either side over the whole travel
    short = Model(
        MODEL.suspension.with_changes(
            {"hardpoints.tie_rod_outer.x": -45.0, "hardpoints.tie_rod_inner.x": -45.0}
        )
    )
    narrow = reachable_grid(short)
    assert narrow.rack.last < 0.06
    poses(short, narrow.travel.values, narrow.rack.values)  # all of it can be reached


# -- the numbers in the file -----------------------------------------------------------------------


def test_encoding_loses_what_it_says():
    values = np.linspace(-0.123, 0.456, 1000)
    back = unpacked(packed(values, 0.1))
    assert back == pytest.approx(rounded(values, 0.1), abs=0.0)
    # half a unit in the last of 24 binary digits of the difference
    assert np.all(np.abs(back - values) <= np.abs(values - 0.1) * 2.0**-24 + 1e-17)


def stated_accuracy(page):
    """Return the errors in the page: of positions [m] and of the wheel's axis [rad]."""
    powers = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")
    words = re.search(r"largest differences are (.+?) mm of a position and (.+?)°", page)
    millimetres, degrees = (
        float(text.replace(" · 10", "e").translate(powers)) for text in words.groups()
    )
    return millimetres * 1e-3, np.radians(degrees)


def test_positions_between_samples_are_as_accurate_as_the_page_says(page, data):
    grid = Grid(axis_of(data["grid"]["travel"]), axis_of(data["grid"]["rack"]))
    random = np.random.default_rng(1)
    travel = random.uniform(grid.travel.first, grid.travel.last, 9)
    rack = random.uniform(grid.rack.first, grid.rack.last, 7)
    exact = poses(MODEL, travel, rack)
    in_metres, in_radians = stated_accuracy(page)
    assert in_metres < 1e-6
    assert in_radians < np.radians(0.001)
    for name, point in exact.points.items():
        samples = unpacked(data["points"][name]).reshape(*grid.shape, 3)
        error = np.linalg.norm(grid.interpolate(samples, travel, rack) - point, axis=-1)
        assert error.max() <= in_metres, name
    axis = grid.interpolate(unpacked(data["spin_axis"]).reshape(*grid.shape, 3), travel, rack)
    axis /= np.linalg.norm(axis, axis=-1, keepdims=True)
    error = np.arcsin(np.linalg.norm(np.cross(axis, exact.spin_axis), axis=-1))
    assert error.max() <= in_radians


def test_every_characteristic_is_there_and_as_accurate_as_its_decimals(page, data):
    grid = Grid(axis_of(data["grid"]["travel"]), axis_of(data["grid"]["rack"]))
    random = np.random.default_rng(2)
    travel = random.uniform(grid.travel.first, grid.travel.last, 5)
    rack = random.uniform(grid.rack.first, grid.rack.last, 4)
    drawn = {curve["key"]: curve for curve in data["curves"]}
    exact = curves(MODEL, travel, rack)
    assert {curve.key for curve in exact} <= drawn.keys()
    for curve in exact:
        packed_curve = drawn[curve.key]
        assert f'data-curve="{curve.key}"' in page
        samples = unpacked(data["samples"][packed_curve["samples"]]).reshape(grid.shape)
        near = grid.interpolate(samples, travel, rack)
        near = 1.0 / near if packed_curve["reciprocal"] else near
        low, high = packed_curve["range"]
        true = curve.values * curve.factor
        shown = np.isfinite(near) & (true > low) & (true < high)
        error = np.abs(near * curve.factor - true)[shown].max(initial=0.0)
        # no digit is written that interpolation makes wrong by more than rounding does
        assert packed_curve["approximate"] or error <= 0.5 * 10.0 ** -packed_curve["decimals"]


def test_on_its_own_grid_no_digit_is_in_doubt(data):
    """Nor of the Ackermann percentage, which there is not where the rack is in its middle."""
    assert not [curve["key"] for curve in data["curves"] if curve["approximate"]]


def test_lengths_with_a_pole_are_sampled_by_their_reciprocals(data):
    reciprocal = {curve["key"] for curve in data["curves"] if curve["reciprocal"]}
    assert {"swing_arm_length_kinematic", "turning_circle_over_rack"} <= reciprocal
    assert "camber" not in reciprocal


def test_simulated_second_starts_where_the_paper_starts(data):
    motion = data["motion"]
    travel, spin = unpacked(motion["travel"]), unpacked(motion["spin"])
    assert travel[0] == pytest.approx(0.025, abs=1e-9)  # 32 bits of 25 mm
    assert abs(travel[-1]) < 1e-6  # at rest
    assert spin[-1] == pytest.approx(2.0 * np.pi * 14.8, rel=1e-2)  # one second of spinning
    assert motion["time"] == {"first": 0.0, "step": 1e-3, "count": 1001}
    for signal in motion["signals"]:
        # a motion that dies out is no pole: all of it is in sight
        values = unpacked(signal) * signal["factor"]
        assert signal["range"][0] < values.min() < values.max() < signal["range"][1]


@pytest.mark.usefixtures("coarse_report")
def test_motion_that_cannot_be_shown_is_said():
    # without a prescribed rack, the wheel's spin steers the wheel out of the sampled range
    text = render(Model("reference_car", free_rack=True))
    assert payload(text)["motion"] is None
    assert re.search(r"The rack moves from .* beyond the", text)
    assert 'id="play"' not in text


def rows_at_design(page):
    """Return the values of the table at design, by the keys of curves."""
    cells = re.findall(
        r'<td class="number">([^<]*)</td><td class="number now" data-now="(\w+)"', page
    )
    return {key: text.replace("\u2212", "-") for text, key in cells}


@pytest.mark.usefixtures("coarse_report")
def test_values_at_design_are_computed_and_rounded_by_themselves():
    """On a coarse grid, too, every digit is that of the model."""
    car = Model("reference_car").suspension.with_changes(
        {"wheel.toe_deg": -0.25, "hardpoints.tie_rod_inner.z": 284.0}
    )
    page = render(Model(car))
    exact = {curve.key: curve for curve in curves(Model(car), np.zeros(1), np.zeros(1))}
    cells = rows_at_design(page)
    drawn = {curve["key"]: curve for curve in payload(page)["curves"]}
    assert any(drawn[key]["approximate"] for key in cells)
    for key, text in cells.items():
        value = float(exact[key].values[0, 0]) * exact[key].factor
        if text != "\u2013":
            assert float(text) == round(value, drawn[key]["decimals"]), key
    assert cells["toe"] == "-0.25"
    slope = np.degrees(float(exact["bump_steer"].values[0, 0])) * 1e-3
    assert cells["bump_steer"] == f"{slope:.5f}"[: len(cells["bump_steer"])]
    assert len(cells["bump_steer"].lstrip("-0.")) >= 3


# -- the page ------------------------------------------------------------------------------------


class References(HTMLParser):
    """Everything that a browser would load, and whether tags are closed."""

    def __init__(self):
        super().__init__()
        self.found = []
        self.open = []

    def handle_starttag(self, tag, attrs):
        self.found += [v for k, v in attrs if k in ("src", "href", "srcset", "data", "poster")]
        if tag not in ("meta", "link", "input", "br", "hr", "img"):
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag


def test_file_is_complete_in_itself(page):
    parser = References()
    parser.feed(page)
    assert parser.open == []
    assert all(reference.startswith(("#", "data:")) for reference in parser.found), parser.found
    assert "default-src 'none'" in page
    assert len(page.encode()) < 4_000_000


@pytest.mark.usefixtures("coarse_report")
def test_same_input_gives_the_same_bytes():
    assert render(Model("reference_car")) == render(Model("reference_car"))


@pytest.mark.usefixtures("coarse_report")
def test_write_makes_folders_and_reports_what_it_does(tmp_path):
    steps = []
    path = tmp_path / "new/report.html"
    assert kintrafo.report.write(MODEL, path, progress=steps.append) == path
    assert path.read_text(encoding="utf-8") == render(MODEL)
    assert "one second of motion" in steps
    assert [file.name for file in path.parent.iterdir()] == ["report.html"]


@pytest.mark.usefixtures("coarse_report")
def test_folder_in_the_way_is_a_clear_error(tmp_path, refused):
    folder = tmp_path / "report.html"
    folder.mkdir()
    refused(InputError, lambda: kintrafo.report.write(MODEL, folder))


@pytest.mark.usefixtures("coarse_report")
def test_title_is_text_and_not_markup():
    text = render(MODEL, title="</title><script>alert(1)</script>$^$ caf\udce9")
    assert "<script>alert" not in text
    assert "<h1>&lt;/title&gt;&lt;script&gt;" in text


@pytest.mark.usefixtures("coarse_report")
def test_left_suspension_is_the_mirror_image(data):
    left = payload(render(Model(MODEL.suspension.mirrored())))
    assert (data["side_sign"], left["side_sign"]) == (-1.0, 1.0)
    for name, point in data["points"].items():
        mirrored = np.array(left["points"][name]["design"]) * [1.0, -1.0, 1.0]
        assert mirrored == pytest.approx(np.array(point["design"]), abs=1e-15), name


@pytest.mark.usefixtures("coarse_report")
def test_the_page_of_a_double_wishbone_says_what_it_is():
    page = render(Model("double_wishbone_car"))
    assert "<h1>Double wishbone suspension, front right</h1>" in page
    assert payload(page)["suspension"] == "double_wishbone"
    assert "control arms</li>" in page
    assert ">strut</li>" not in page
    for key in ("force_at_design_N", "rate_N_s_per_m", "upper_ball_joint", "suspension"):
        assert f"<code>{key}</code>" in page


def test_every_key_of_the_input_file_is_shown(page):
    shown = {
        (table.name, key) for table in input_tables(MODEL.suspension) for key, *_ in table.rows
    }

    def keys(section, path=""):
        for name, value in section.items():
            if isinstance(value, dict):
                yield from keys(value, f"{path}{name}.")
            else:
                yield path.rstrip("."), name

    wanted = set(keys(MODEL.suspension.to_dict()))
    assert wanted <= shown
    assert all(f"<code>{key}</code>" in page for _, key in wanted)
    assert "25000" in page


def test_the_sections_of_a_car_within_one_file_are_shown_once():
    """Axles and linear tyres are tables of the car in its file."""
    sections = assembly_of(light_car()).input_sections
    tables = [
        (begin, table) for begin, section in sections.items() for table in input_tables(section)
    ]
    own = {table.name: {key: text for key, text, _ in table.rows} for b, table in tables if not b}
    assert set(own) == {"", "body", "tyres", "brakes", "air"}
    assert "front" not in own[""]
    assert own["tyres"]["front"].startswith("radius_mm: 316; ")
    assert ("front right", "strut") in {(begin, table.name) for begin, table in tables}


def test_typical_ranges_are_of_characteristics_that_there_are(data):
    units = {curve["key"]: curve["unit"] for curve in data["curves"]}
    for name, usual in typical_ranges("macpherson").items():
        assert usual["unit"] == units[name], name
        assert usual["low"] < usual["high"]
        assert usual["source"]


def test_pole_does_not_press_the_curve_flat():
    values = 1.0 / np.linspace(-0.1, 0.1001, 401)
    assert has_pole(values)
    low, high = shown_range(values)
    assert -100.0 < low < -10.0
    assert 10.0 < high < 100.0
    assert has_pole(np.array([1.0, np.inf, 2.0]))
    assert not has_pole(np.linspace(-1.0, 1.0, 50) ** 3)
    assert shown_range(np.array([1.0, 2.0, np.nan])) == pytest.approx((0.98, 2.02))


def test_digits_that_are_wrong_are_not_written():
    assert decimals(0.0, 1.0) == 2
    assert decimals(0.0, 1.0, value=0.0131) == 4
    assert decimals(0.0, 1.0, unit="deg", value=0.0131) == 2
    assert decimals(0.0, 0.001, unit="mm") == 2


@pytest.mark.parametrize(
    ("error", "text"),
    [(0.0, "0"), (0.0312, "0.04"), (0.2, "0.2"), (0.97, "1"), (7.2, "8"), (4.1e-7, "5 · 10⁻⁷")],
)
def test_errors_are_rounded_up(error, text):
    assert _upper_limit(error) == text


# -- committed files ----------------------------------------------------------------------------


def test_bundle_was_made_from_these_sources():
    lines = (FOLDER / "assets/checksums.txt").read_text(encoding="utf-8").splitlines()
    listed = dict(reversed(line.split("  ")) for line in lines)
    sources = {f"web/src/{path.name}" for path in (FOLDER / "web/src").iterdir()}
    assert sources <= listed.keys(), "make report-assets"
    for name, checksum in listed.items():
        found = hashlib.sha256((FOLDER / name).read_bytes()).hexdigest()
        assert found == checksum, f"{name} has changed: make report-assets"


def test_bundle_carries_the_licences_and_no_end_tag():
    script = (FOLDER / "assets/report.js").read_text(encoding="utf-8")
    for text in (script, (FOLDER / "assets/LICENSES.txt").read_text(encoding="utf-8")):
        assert text.count("Permission is hereby granted") == 2  # three.js and uPlot
    assert "</script" not in script.lower()
    assert "</style" not in (FOLDER / "assets/report.css").read_text(encoding="utf-8").lower()
    assert all(path.stat().st_size < 900_000 for path in FOLDER.glob("assets/*"))


def test_lock_file_names_no_registry():
    text = (FOLDER / "web/package-lock.json").read_text(encoding="utf-8")
    assert '"resolved"' not in text
    assert '"integrity"' in text


# -- chapters -----------------------------------------------------------------------------------


@pytest.mark.usefixtures("coarse_report")
def test_chapters_stand_in_the_page():
    model = Model("reference_car")
    cases = {"still": {"contact_g": [0.0, 0.0, 1.0]}, "far": {"contact_N": [0.0, 0.0, 1e6]}}
    loaded = loads_chapter(loads.static(model, cases))
    assert "1 of 2 cases have an equilibrium" in loaded.words[0]
    assert loaded.words[1].startswith("far:")
    (picture,) = loaded.pictures  # a case that is not carried has none
    kind, _, coded = picture.source.partition(";base64,")
    assert kind == "data:image/png"
    assert len(base64.b64decode(coded)) > 5000
    bushes = {"arm_rear": {"radial_N_per_mm": 1200.0}}
    soft = compliance_chapter(compliance.linear(model, bushes, [-0.01, 0.0, 0.01]))
    bent = elastokinematics_chapter(
        compliance.elastokinematics(model, bushes, along=[-0.01, 0.0, 0.01])
    )
    text = render(model, chapters=[loaded, soft, bent])
    assert "<h2>Load cases</h2>" in text
    assert text.index("<h2>Load cases</h2>") < text.index("<h2>Compliance</h2>")
    drawn = [*loaded.pictures, *soft.pictures, *bent.pictures]
    assert text.count('<figure class="picture">') == len(drawn)
    assert {picture.words.partition(",")[0] for picture in drawn} == {
        "Free bodies in the load case still",
        "Compliances over wheel travel",
        "Curves over wheel travel with rigid joints and on the bushes",
    }
    for chapter in (loaded, soft, bent):
        for row in chapter.tables[0].rows:
            assert len(row) == len(chapter.tables[0].columns)
            assert f'<th scope="row">{row[0]}</th>' in text
