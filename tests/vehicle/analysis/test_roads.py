"""Roads and rack motions: by formula, and from measurements."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from kintrafo import InputError, Model, equilibrium, simulate
from kintrafo.simulation.solvers import native_available
from kintrafo.vehicle.analysis.excitation import TimeProfile, excitation
from kintrafo.vehicle.analysis.measurement import measured
from kintrafo.vehicle.analysis.roads import sine, step
from kintrafo.vehicle.analysis.scenario import Scenario, run
from kintrafo.vehicle.assembly.usual import grid

MODEL = Model("reference_car")


def table(tmp_path, text):
    path = tmp_path / "road.csv"
    path.write_text(text, encoding="utf-8")
    return path


def test_step_jumps_once(refused):
    times, heights = step(0.02, at=0.25, end=1.0)
    assert times.tolist() == [0.0, 0.25, 0.25, 1.0]
    assert heights.tolist() == [0.0, 0.0, 0.02, 0.02]
    assert step(0.02, at=0.0, end=1.0) == 0.02
    refused(InputError, lambda: step(0.02, at=1.0, end=1.0))


def test_sine_has_amplitude_and_frequency():
    times = np.linspace(0.0, 7.0, 1001)
    road = sine(0.01, 4.0, end=7.0)
    # the bound of a cubic spline, h^4 / 384 of the fourth derivative, is 6e-11 of the amplitude
    expected = 0.01 * np.sin(2.0 * np.pi * 4.0 * times)
    assert road(times) == pytest.approx(expected, abs=1e-12)
    # the rack's acceleration is taken from it: h^2 / 12 of the same, 1.3e-5
    acceleration = -((2.0 * np.pi * 4.0) ** 2) * expected
    assert road(times, 2) == pytest.approx(acceleration, abs=2e-5 * np.abs(acceleration).max())


def test_a_sine_ends_where_it_was_made_to():
    road = sine(0.01, 4.0, end=2.0)
    assert np.isfinite(road([0.0, 2.0])).all()
    assert np.isnan(road([-0.1, 2.1])).all()
    # margins ahead of the end are those of the curve going on
    for backend in ("sundials", "scipy") if native_available() else ("scipy",):
        options = {"backend": backend, "method": "BDF", "inputs": {"road_height": road}}
        assert simulate(MODEL, (0.0, 2.0), equilibrium(MODEL), **options).success


def test_a_sine_too_long_or_too_short_to_tabulate_is_refused(refused):
    for frequency in (0.0, -1.0, 1e6):
        with refused(InputError):
            sine(0.01, frequency, end=10.0)
    refused(InputError, lambda: sine(0.01, 1.0, end=1e-300))


def test_a_slow_sine_carries_the_suspension_along():
    """At 0.05 Hz, far below the wheel hop, the wheel is where statics puts it."""
    from kintrafo import equilibrium

    _, motion = run(
        MODEL, Scenario(duration=5.0, inputs={"road_height": sine(0.01, 0.05, end=5.0)})
    )
    top = motion["wheel_center_z"].sel(time=5.0)
    rest = MODEL.signal("wheel_center_z", equilibrium(MODEL, road_height=0.01))
    # inertia and damping act with the square of (0.05 / 12) and with 0 at the turning point
    assert float(top) == pytest.approx(float(rest), abs=1e-6)


def test_motion_starts_at_rest_on_the_road_as_it_is():
    road = {"road_height": 0.03, "rack_position": 0.02}
    _, motion = run(MODEL, Scenario(duration=0.2, inputs=road))
    assert float(np.ptp(motion["wheel_center_z"].values)) < 1e-9
    assert float(abs(motion["steer"][0])) > 0.1


# -- measurements -------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "text",
    [
        "time_s,road_height_mm\n1.0,0\n1.5,2.5\n2.0,-1\n",
        "\ufefftime_ms;other;road_height_m\n1000;x;0\n1500;;0,0025\n2000;y;-0,001\n",
        "# measured\n\nroad_height_mm\ttime_s\n0\t1,0\n2,5\t1,5\n-1\t2,0\n",
        '"time_s","road_height_mm"\n1.0,"0"\n1.5,2.5\n2.0,-1\n',
    ],
)
def test_one_road_in_many_spellings(tmp_path, text):
    found = measured(table(tmp_path, text))
    assert found.times == pytest.approx([0.0, 0.5, 1.0], abs=1e-15)
    assert found.values["road_height"] == pytest.approx([0.0, 0.0025, -0.001], abs=1e-18)
    assert found.duration == 1.0


def test_distance_becomes_time(tmp_path):
    text = "distance_m,road_height_mm,rack_position_mm\n5,0,1\n15,1,2\n"
    found = measured(table(tmp_path, text), speed=20.0)
    assert found.times.tolist() == [0.0, 0.5]
    assert set(found.inputs()) == {"road_height", "rack_position"}


@pytest.mark.parametrize(
    "text",
    [
        "",
        "time_s,road_height_mm\n0,0\n",
        "time_s,road_height_mm\n0,0\n1,x\n",
        "time_s,road_height_mm\n0,0\n1,\n",
        "time_s,road_height_mm\n0,0\n1,nan\n",
        "time_s,road_height_mm\n0,0\n1,1_000\n",
        "time_s,road_height_mm\n-1e308,0\n1e308,1\n",
        "time_s,road_height_mm\n0,0\n\n1\n",
        "time_s,road_height_mm\n0,0\n2,1\n1,1\n",
        "time_s,road_height_mm\n1,0\n1,1\n",
        "road_height_mm,note\n0,0\n1,1\n",
        "time_s,time_ms,road_height_mm\n0,0,0\n1,1,1\n",
        "time_s,road_heigth_mm\n0,0\n1,1\n",
        "time_s,road_height_furlong\n0,0\n1,1\n",
        "distance_m,road_height_mm\n0,0\n1,1\n",
    ],
)
def test_what_cannot_be_read_is_refused_with_its_line(tmp_path, text, refused):
    caught = refused(InputError, lambda: measured(table(tmp_path, text)))
    assert "road.csv" in str(caught)


@pytest.mark.parametrize(
    "text",
    [
        "Time (s),Road Height [in],Remark\n0,0,a\n0.5,2,b\n",
        "time_ms,RoadHeight_in,Remark\n0,0,a\n500,2,b\n",
        "time,road height,Remark\ns,in,\n0,0,a\n0.5,2,b\n",
        "# units: s, in\ntime,road_height,Remark\n0,0,a\n0.5,2,b\n",
        "time_s,road_height_cm,Remark\n0,0,a\n0.5,5.08,b\n",
    ],
)
def test_names_and_units_are_those_of_every_table(tmp_path, text):
    found = measured(table(tmp_path, text))
    assert found.times.tolist() == [0.0, 0.5]
    np.testing.assert_allclose(found.values["road_height"], [0.0, 0.0508], rtol=1e-15)
    assert found.left_out == ("Remark",)


def test_a_speed_without_a_distance_is_refused(tmp_path, refused):
    refused(
        InputError,
        lambda: measured(table(tmp_path, "time_s,road_height_mm\n0,0\n1,1\n"), speed=10.0),
    )


def test_many_wrong_lines_are_not_all_listed(tmp_path):
    text = "time_s,road_height_mm\n" + "a,b\n" * 100
    with pytest.raises(InputError) as caught:
        measured(table(tmp_path, text))
    assert len(caught.value.problems) == 6


def test_not_text(tmp_path, refused):
    path = tmp_path / "road.csv"
    path.write_bytes(b"\xff\xfe\x00")
    refused(InputError, lambda: measured(path), lambda: measured(tmp_path))


# -- excitation, times and grids ------------------------------------------------------------------


def test_an_input_is_given_once(tmp_path, refused):
    road = measured(table(tmp_path, "time_s,road_height_mm\n0,0\n1,1\n"))
    profiles = {"road_height": TimeProfile(step=0.01), "rack_position": TimeProfile(held=0.02)}
    refused(InputError, lambda: excitation(profiles, 1.0, road))
    assert excitation({"rack_position": TimeProfile(held=0.02)}, 1.0, road)["rack_position"] == 0.02


@given(duration=st.floats(1e-3, 1e2), count=st.integers(1, 1000), part=st.floats(0.0, 0.99))
def test_output_times_cover_the_duration(duration, count, part):
    times = Scenario(duration=duration, output_step=duration / (count + part)).times()
    assert times[0] == 0.0
    assert times[-1] == duration
    assert np.all(np.diff(times) > 0.0)
    assert times.size in (count + 1, count + 2)


@given(low=st.floats(0.0, 0.2), high=st.floats(0.0, 0.2), step_size=st.floats(1e-4, 0.3))
def test_grids_hold_zero_and_their_ends(low, high, step_size):
    values = grid(-low, high, step_size)
    assert {-low, 0.0, high} <= set(values.tolist())
    assert values[0] == -low
    assert values[-1] == high
    assert np.all(np.diff(values) <= step_size * (1.0 + 1e-6))
    assert not any(math.isclose(*pair, rel_tol=1e-12) for pair in pairwise(values))
