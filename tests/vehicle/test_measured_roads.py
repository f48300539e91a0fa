"""Measured roads, and what a tyre makes of edges: cams against bisection of their contact."""

import numpy as np
import pytest
from kintrafo import InputError, road_profiles
from kintrafo.vehicle.cli import app
from kintrafo.vehicle.plots.by_axle import by_axle
from kintrafo.vehicle.roads.enveloping import HEIGHT, LENGTH, ORDER, SHIFT
from typer.testing import CliRunner

RADIUS, CONTACT = 0.31, 0.12
CRG = """$CT
a test
$
$ROAD_CRG
REFERENCE_LINE_INCREMENT = 0.5
LONG_SECTION_V_INCREMENT = 0.50
$
$KD_Definition
#:LRFI
D:long section 1,m
D:long section 2,m
D:long section 3,m
D:long section 4,m
D:long section 5,m
$
$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$
"""


def written(folder, name, text):
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


class TestTables:
    def test_two_tracks_are_read_in_any_unit(self, tmp_path):
        text = "distance_m,left_height_mm,Right height [cm]\n0,0,0\n1,10,-1\n1.5,20,2\n4,0,0\n"
        road = road_profiles.read(written(tmp_path, "road.csv", text))
        assert road.spacing == 0.5
        np.testing.assert_allclose(road.left[:4], [0.0, 0.005, 0.01, 0.02], atol=1e-15)
        np.testing.assert_allclose(road.right[:4], [0.0, -0.005, -0.01, 0.02], atol=1e-15)

    def test_one_height_is_under_both_tracks(self, tmp_path):
        text = "distance_m,road_height_m\n0,0\n1,0.1\n2,0\n3,0\n"
        road = road_profiles.read(written(tmp_path, "road.csv", text))
        np.testing.assert_array_equal(road.left, road.right)

    @pytest.mark.parametrize(
        "text",
        [
            "distance_m,left_height_mm\n0,0\n1,1\n",
            "distance_m,left_height_kg,right_height_mm\n0,0,0\n1,1,1\n",
            "distance_m,road_height_mm\n0,0\n2,1\n1,1\n3,1\n",
            "distance_m,road_height_mm\n0,0\n1,nan\n2,1\n3,1\n",
            "distance_m,road_height_mm\n0,0\n1,1\n",
        ],
        ids=["one track", "unit", "falls", "nan", "short"],
    )
    def test_what_is_no_road_is_refused(self, tmp_path, text, refused):
        refused(InputError, lambda: road_profiles.read(written(tmp_path, "road.csv", text)))


class TestOpenCrg:
    def file(self, folder, heights):
        rows = "".join(
            "".join("****nan***" if np.isnan(h) else f"{h:10.6f}" for h in row) + "\n"
            for row in heights
        )
        return written(folder, "road.crg", CRG + rows)

    def test_the_tracks_are_to_either_side_of_the_line(self, tmp_path):
        pytest.importorskip("pyopencrg")
        along, aside = np.arange(9) * 0.5, np.arange(5) * 0.5 - 1.0
        heights = 0.02 * along[:, None] ** 2 + 0.03 * aside
        road = road_profiles.read(self.file(tmp_path, heights), track=1.5)
        # the first section is on the right, at v = -1 m; heights count from the middle at u = 0
        np.testing.assert_allclose(road.left, 0.02 * along**2 + 0.03 * 0.75, atol=2e-6)
        np.testing.assert_allclose(road.right, 0.02 * along**2 - 0.03 * 0.75, atol=2e-6)

    def test_gaps_and_narrow_roads_are_refused(self, tmp_path, refused):
        pytest.importorskip("pyopencrg")
        heights = np.zeros((9, 5))
        path = self.file(tmp_path, heights)
        refused(InputError, lambda: road_profiles.read(path, track=2.5))
        heights[3, 1] = np.nan
        refused(InputError, lambda: road_profiles.read(self.file(tmp_path, heights), track=1.5))

    def test_a_file_that_is_none_is_refused(self, tmp_path):
        pytest.importorskip("pyopencrg")
        with pytest.raises(InputError):
            road_profiles.read(written(tmp_path, "road.crg", "nothing"))


class TestEnveloping:
    def lifted(self, x, heights, at):
        """Return how high a cam is on a road of straight lines, by bisection of its contact."""
        local = np.linspace(-LENGTH * RADIUS, LENGTH * RADIUS, 20001)
        road = np.interp(at + local, x, heights)
        below = (
            HEIGHT * RADIUS * (1.0 - (np.abs(local) / (LENGTH * RADIUS)) ** ORDER) ** (1.0 / ORDER)
        )
        low, high = -1.0, 1.0
        while high - low > 1e-9:
            height = 0.5 * (low + high)
            clear = np.all(height + HEIGHT * RADIUS - below >= road)
            low, high = (low, height) if clear else (height, high)
        return high

    def test_is_the_mean_height_of_two_cams_on_the_road(self):
        rng = np.random.default_rng(2)
        x = 0.02 * np.arange(200)
        heights = np.where(x > 2.0, 0.05, 0.0) + 0.01 * rng.normal(size=x.size)
        road = road_profiles.Road(0.02, heights, np.zeros_like(heights))
        found = road_profiles.enveloped(road, radius=RADIUS, contact_length=CONTACT)
        assert found.length == pytest.approx(road.length)
        np.testing.assert_allclose(found.right, 0.0, atol=1e-15)
        for at in (1.0, 1.85, 1.97, 2.1, 3.0):
            own = np.mean(
                [self.lifted(x, heights, at + s * 0.5 * SHIFT * CONTACT) for s in (1, -1)]
            )
            # points are 5 mm apart: an edge of a contour is found to the sagitta of that
            assert np.interp(at, found.spacing * np.arange(found.left.size), found.left) == (
                pytest.approx(own, abs=1e-3)
            )

    def test_a_kerb_is_climbed_before_it_is_there_and_in_full(self):
        road = road_profiles.kerb(0.06, radius=RADIUS, contact_length=CONTACT, at=3.0, end=6.0)
        x = road.spacing * np.arange(road.left.size)
        assert road.left[-1] == pytest.approx(0.06)
        assert np.all(np.diff(road.left) >= -1e-12)
        # the first cam meets the edge where its contour is 60 mm above its lowest point
        rise = 1.0 - (1.0 - 0.06 / (HEIGHT * RADIUS)) ** ORDER
        begins = 3.0 - LENGTH * RADIUS * rise ** (1.0 / ORDER) - 0.5 * SHIFT * CONTACT
        assert x[np.flatnonzero(road.left > 1e-6)[0]] == pytest.approx(begins, abs=2 * road.spacing)

    def test_long_waves_stay(self):
        road = road_profiles.sine(0.02, 20.0, end=60.0)
        found = road_profiles.enveloped(road, radius=RADIUS, contact_length=CONTACT)
        own = np.interp(
            found.spacing * np.arange(found.left.size),
            road.spacing * np.arange(road.left.size),
            road.left,
        )
        # by the curvature of the wave and the square of its slope, both of 2e-5 m; not at the ends
        inside = slice(100, -100)
        np.testing.assert_allclose(found.left[inside], own[inside], atol=1e-4)

    @pytest.mark.parametrize(
        "how", [{"height": 0.4}, {"height": np.nan}, {"height": 0.05, "at": 60.0}]
    )
    def test_what_no_wheel_climbs_is_refused(self, how, refused):
        refused(
            InputError, lambda: road_profiles.kerb(**how, radius=RADIUS, contact_length=CONTACT)
        )


class TestCommand:
    def run(self, *given):
        return CliRunner().invoke(app, ["ride", "quarter_car", *given])

    def test_a_measured_road_is_driven_to_its_end(self, tmp_path):
        x = 0.1 * np.arange(200)
        rows = "".join(f"{a:.1f},{5.0 * np.sin(a):.4f}\n" for a in x)
        path = written(tmp_path, "road.csv", f"distance_m,road_height_mm\n{rows}")
        result = self.run("--road", str(path), "--speed", "36", "--contact-length", "120")
        assert result.exit_code == 0, result.output
        assert "1.99 s" in result.output
        assert "enveloped" in " ".join(result.output.split())

    @pytest.mark.parametrize(
        "given",
        [["--kerb", "50"], ["--kerb", "50", "--bump-height", "20"], ["--road", "K"],
         ["--road", "nothing.csv"]],
    )  # fmt: skip
    def test_roads_that_are_none_are_refused(self, given):
        assert self.run(*given).exit_code in (1, 2)

    def test_only_cars_are_proposed_for_a_file_that_is_not_there(self):
        result = CliRunner().invoke(app, ["ride", "nowhere_at_all"])
        assert result.exit_code == 1
        assert "reference_vehicle" in str(result.exception)
        assert "trailing_arm_car" not in str(result.exception)


def test_curves_of_four_wheels_are_those_of_each_axle():
    import xarray as xr

    wheels = ["front_left", "front_right", "rear_left", "rear_right"]
    load = xr.DataArray(np.arange(8.0).reshape(4, 2), dims=("wheel", "time"))
    found = by_axle(xr.Dataset({"load": load, "heave": ("time", [0.0, 1.0])}, {"wheel": wheels}))
    assert set(found) == {"heave", "load_front", "load_rear"}
    assert found["load_rear"].sel(side="right").values.tolist() == [6.0, 7.0]
