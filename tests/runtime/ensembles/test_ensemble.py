"""Many systems at once: beside other solvers one by one, and in any company the same bits."""

import _thread
import shutil
import threading
from dataclasses import replace
from importlib import import_module

import kintrafo
import numpy as np
import pytest
import xarray as xr
from cars.different_cars import BUMP, RACK, SPAN, STEP, TIMES, of_all_kinds, same, some_cars
from kintrafo import (
    Axle,
    AxleModel,
    InputError,
    Model,
    Samples,
    System,
    ensemble,
    simulate,
    state_at_height,
)
from kintrafo.core.physical import impossible, inertia_of_no_body, out_of_range
from kintrafo.datasets import export
from kintrafo.datasets.recording import statistics
from kintrafo.generator import ForceOf
from kintrafo.generator.mechanisms.four_bar import FOUR_BAR, SPRING
from kintrafo.simulation.lanes import library, run
from kintrafo.simulation.lanes.problem import Problem
from kintrafo.simulation.solvers import native_available
from support import lanes
from support.c_text import EMITTED
from support.changes import changed

ensembles = import_module("kintrafo.ensembles.ensemble")

pytestmark = pytest.mark.skipif(not library.widths(), reason="built without lanes")

needs_native = pytest.mark.skipif(not native_available(), reason="built without SUNDIALS")

WIDTHS = library.widths()


@pytest.fixture(scope="module")
def car():
    return Model("reference_car")


@pytest.fixture(scope="module")
def start(car):
    return state_at_height(car, 0.310, spin_rate=93.0)


def alone(car, cars, place, start, **options):
    """Simulate one of some cars alone."""
    own = {n: float(v[place]) for n, v in cars.items() if n in car.parameters}
    state = np.array(start)
    for name in set(cars) & set(car.state_names):
        state[car.state_names.index(name)] = cars[name][place]
    return simulate(System(car.equations, car.parameters | own), SPAN, state, **options)


# -- the motion ---------------------------------------------------------------------------------


@pytest.mark.parametrize("name", EMITTED)
def test_every_model_against_dop853(name):
    """From near the design position, for so long that it moves but meets no dead point."""
    model = System(EMITTED[name])
    rng = np.random.default_rng(5)
    half = model.design_state.size // 2
    state = model.design_state.copy()
    state[half:] += 0.1 * rng.standard_normal(half)
    options = {"rtol": 1e-13, "atol": 1e-13, "t_eval": [0.01, 0.03]}
    found = ensemble(model, None, (0.0, 0.03), state, signals=model.state_names, **options)
    exact = simulate(model, (0.0, 0.03), state, method="DOP853", **options)
    assert found["success"].all(), found["reason"].values
    for place, element in enumerate(model.state_names):
        size = np.abs(exact.y[place]).max() + 1.0
        # tolerances of 1e-13 in each of some hundred steps, of two methods
        np.testing.assert_allclose(found[element].values[0], exact.y[place], atol=1e-10 * size)


def test_inputs_that_jump_and_move(car, start):
    inputs = {"road_height": STEP, "rack_position": RACK, "strut_force": BUMP}
    options = {"rtol": 1e-11, "atol": 1e-12, "t_eval": TIMES, "inputs": inputs}
    found = ensemble(car, None, SPAN, start, signals=["camber", "tyre_force", "toe"], **options)
    exact = simulate(car, SPAN, start, method="DOP853", **options)
    for name in ("camber", "tyre_force", "toe"):
        size = np.abs(exact.signals[name]).max()
        np.testing.assert_allclose(found[name].values[0], exact.signals[name], atol=1e-8 * size)


def test_each_has_its_road(car, start):
    """Labels choose among courses; one of them is a number, which does not vary."""
    roads = {"step": STEP, "bump": BUMP, "high": 0.005}
    racks = {0: 0.0, 1: RACK}
    variants = xr.Dataset({"road_height": ("road", list(roads)), "rack_position": ("rack", [1, 0])})
    found = ensemble(
        car, variants, SPAN, start, signals=["camber"], t_eval=TIMES, rtol=1e-9, atol=1e-10,
        inputs={"road_height": roads, "rack_position": racks},
    )  # fmt: skip
    assert dict(found["camber"].sizes) == {"road": 3, "rack": 2, "time": TIMES.size}
    for i, road in enumerate(roads.values()):
        for j, rack in enumerate((RACK, 0.0)):
            inputs = {"road_height": road, "rack_position": rack}
            exact = simulate(car, SPAN, start, method="DOP853", rtol=1e-9, atol=1e-10,
                             t_eval=TIMES, inputs=inputs)  # fmt: skip
            # errors of some steps of two integrations at 1e-9
            np.testing.assert_allclose(
                found["camber"].values[i, j], exact.signals["camber"], atol=1e-8
            )


@needs_native
@pytest.mark.parametrize("road", [BUMP, STEP], ids=["smooth", "with a jump"])
def test_two_hundred_cars_have_the_bits_of_simulate(car, start, road):
    cars = some_cars(200)
    options = {"t_eval": TIMES, "inputs": {"road_height": road}}
    found = ensemble(car, cars, SPAN, start, signals=["camber"], **options)
    assert found["valid"].all()
    for place in range(200):
        one = alone(car, cars, place, start, method="DormandPrince", **options)
        assert found["steps"].values[place] == one.steps
        np.testing.assert_array_equal(found["final_state"].values[place], one.y[:, -1])
        np.testing.assert_array_equal(found["camber"].values[place], one.signals["camber"])


@needs_native
@pytest.mark.parametrize("name", ["double_wishbone_car", "multi_link_car", "trailing_arm_car"])
def test_other_kinds_have_the_bits_of_simulate(name):
    """Also where loops iterate."""
    model = Model(name)
    height = float(model.signal("wheel_center_z", model.design_state))
    begin = np.array(state_at_height(model, height - 0.01))
    cars = {"damper_rate": model.parameters["damper_rate"] * np.linspace(0.9, 1.1, 6)}
    options = {"t_eval": TIMES, "inputs": {"road_height": BUMP}}
    found = ensemble(model, cars, SPAN, begin, signals=["camber"], **options)
    for place in range(6):
        one = alone(model, cars, place, begin, method="DormandPrince", **options)
        np.testing.assert_array_equal(found["camber"].values[place], one.signals["camber"])


def test_rest_stays_rest(car):
    """A state that knows its inputs keeps them, as in simulate."""
    rest = kintrafo.equilibrium(car, wheel_load=3000.0)
    found = ensemble(car, None, SPAN, rest, reductions={"wheel_center_z": ["min", "max"]})
    moved = found["wheel_center_z_max"] - found["wheel_center_z_min"]
    assert float(moved[0]) < 1e-9


def test_design_position_of_each(car):
    """Without a start each is in its own design position; of a start that is varied, the rest."""
    cars = some_cars(5)
    found = ensemble(car, cars, (0.0, 1e-9), signals=["beta1", "beta1_rate"], t_eval=[0.0])
    for place in range(5):
        own = {n: float(v[place]) for n, v in cars.items() if n in car.parameters}
        design = car.equations.design_state(car.parameters | own)
        # the arc tangent of lanes is within 2 units of the last place
        assert found["beta1"].values[place, 0] == pytest.approx(design[0], rel=1e-15)
    assert found["beta1_rate"].values[:, 0].tolist() == cars["beta1_rate"].tolist()


# -- the same bits ------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def mixed(car, start):
    cars, options = of_all_kinds(car)
    return ensemble(car, cars, SPAN, start, lanes=2, threads=1, **options)


def test_why_systems_fail(mixed):
    failed = np.flatnonzero(~mixed["success"].values).tolist()
    reasons = dict(zip(failed, mixed["reason"].values[failed].tolist(), strict=True))
    assert failed == [5, 11, 17, 29, 31]
    assert "tie_rod cannot reach" in reasons[5]
    assert "overflows" in reasons[11]
    assert "at t = 0 s: " in reasons[17]
    assert "coincide" in reasons[29]
    assert "'spring_rate' = -1" in reasons[31]
    assert f"{mixed.sizes['car'] - len(failed)} of 60" in mixed.attrs["message"]
    for place in failed:
        assert np.isnan(mixed["tyre_force_max"].values[place])
        assert np.isnan(mixed["tyre_force_percentile_90"].values[place])
        assert np.isnan(mixed["wheel_center_z_psd"].values[place]).all()
        assert np.isnan(mixed["camber"].values[place, -1])
        assert not mixed["valid"].values[place]


def test_failures_end_where_simulate_ends(car, start, mixed):
    cars, options = of_all_kinds(car)
    inputs = {"strut_force": -1e6, "road_height": options["inputs"]["road_height"]["step"]}
    if cars["road_height"][5] == "bump":
        inputs["road_height"] = BUMP
    own = {n: v for n, v in cars.items() if n not in car.input_names}
    with pytest.raises(kintrafo.SimulationError, match="tie_rod") as caught:
        alone(car, own, 5, start, inputs=inputs, method="DormandPrince")
    # both within what the last steps before a dead point leave of the time
    assert float(mixed["end_time"][5]) == pytest.approx(caught.value.time, rel=1e-5)


@pytest.mark.parametrize("width", WIDTHS)
@pytest.mark.parametrize("threads", [1, 3])
def test_the_same_bits_in_any_number(car, start, mixed, width, threads, monkeypatch):
    monkeypatch.setattr(run, "_FEWEST", 7)  # chunks whose ends fall anywhere
    cars, options = of_all_kinds(car)
    same(ensemble(car, cars, SPAN, start, lanes=width, threads=threads, **options), mixed)


def test_the_same_bits_in_any_order(car, start, mixed):
    cars, options = of_all_kinds(car)
    order = np.random.default_rng(9).permutation(60)
    found = ensemble(car, {n: v[order] for n, v in cars.items()}, SPAN, start, **options)
    same(found, mixed.isel(car=order))


@pytest.mark.skipif(shutil.which("gcc") is None, reason="no gcc")
def test_the_same_bits_in_eight_lanes(tmp_path, monkeypatch):
    """Also where the processor has not so many: the compiler makes several vectors of one."""
    model, crank = System(EMITTED["four_bar"]), {"crank_mass": np.linspace(0.5, 2.0, 50)}
    options = {"reductions": {model.signal_names[0]: ["max", "rms"]}, "threads": 1}
    expected = ensemble(model, crank, SPAN, **options, lanes=2)
    folder = lanes.ROOT / "generated/c"
    # silent about how vectors are handed over, since all is compiled here
    flags = ["-w", "-DWIDTH=8", '-DMODEL="four_bar.c"', f"-I{folder}"]
    sources = [str(lanes.HEADERS / "model.c"), str(lanes.HEADERS / "integrate.c")]
    wide = lanes.compiled(tmp_path, sources[0], sources[1], *flags, name="eight")
    names = ("prepare", "design_state", "rhs", "signals", "margins")
    addresses = {n: lanes.address(wide, f"four_bar_{n}") for n in names} | {"bounded": 0}
    monkeypatch.setattr(library, "widths", lambda: (8,))
    monkeypatch.setattr(library, "solver", lambda *_: wide.kt_integrate_8)
    monkeypatch.setattr(library, "functions", lambda *_: addresses)
    same(ensemble(model, crank, SPAN, **options, lanes=8), expected)


def test_the_same_bits_beside_what_fails(car, start, mixed):
    cars, options = of_all_kinds(car)
    good = np.flatnonzero(mixed["success"].values)
    found = ensemble(car, {n: v[good] for n, v in cars.items()}, SPAN, start, **options)
    same(found, mixed.isel(car=good))


def test_an_error_that_no_step_keeps(car, start, monkeypatch):
    """Tolerances that the arguments would refuse: no relative one, and nearly no absolute one."""
    module = import_module("kintrafo.simulation.accuracy")
    monkeypatch.setattr(module, "_SMALLEST_RTOL", 0.0)
    found = ensemble(car, None, SPAN, start, rtol=0.0, atol=1e-300)
    assert not found["success"][0]
    assert "Loosen rtol" in found["reason"].item()


# -- checkpoints --------------------------------------------------------------------------------


def time_above(values, times, level):
    """Return how long straight lines are above a level, by the times at which they cross it."""
    by = values - level
    cross = np.flatnonzero(by[:-1] * by[1:] < 0.0)
    at = times[cross] - by[cross] * (times[cross + 1] - times[cross]) / (by[cross + 1] - by[cross])
    ends = np.sort([*times, *at])
    middles = np.interp((ends[1:] + ends[:-1]) / 2.0, times, by)
    return float(np.diff(ends)[middles > 0.0].sum())


def test_time_above_of_a_known_motion(car):
    """A rack that is moved as a sine: above half of its amplitude for a third of its period."""
    rest = kintrafo.equilibrium(car)
    rack = Samples(np.linspace(0.0, 1.0, 201), 0.01 * np.sin(2.0 * np.pi * np.linspace(0, 1, 201)),
                   between="spline")  # fmt: skip
    found = ensemble(car, None, (0.0, 1.0), rest, inputs={"rack_position": rack},
                     t_eval=np.linspace(0.0, 1.0, 1001), signals=["toe"],
                     reductions={"toe": [("above", 0.0)]})  # fmt: skip
    above = time_above(found["toe"].values[0], found["time"].values, 0.0)
    assert float(found["toe_above_0"][0]) == pytest.approx(above, rel=1e-12)


def welch_by_hand(series, step, segment):
    """Return the one-sided density by sums over complex exponentials, segment after segment."""
    count = np.arange(segment)
    window = 0.5 - 0.5 * np.cos(2.0 * np.pi * count / segment)
    waves = np.exp(-2j * np.pi * np.outer(np.arange(segment // 2 + 1), count) / segment)
    rows = []
    for first in range(0, series.size - segment + 1, segment - segment // 2):
        part = series[first : first + segment]
        rows.append(np.abs(waves @ (window * (part - part.mean()))) ** 2)
    density = 2.0 * step * np.mean(rows, axis=0) / (window**2).sum()
    density[0] /= 2.0
    if segment % 2 == 0:
        density[-1] /= 2.0
    return density


@pytest.mark.parametrize("segment", [16, 17, 41])
def test_spectra_and_percentiles_of_what_simulate_finds(car, start, segment):
    cars = some_cars(70)  # more than a transform takes together
    options = {"t_eval": TIMES, "inputs": {"road_height": BUMP}, "rtol": 1e-9, "atol": 1e-11}
    found = ensemble(
        car, cars, SPAN, start, **options,
        reductions={"wheel_center_z": [("psd", segment), ("percentile", 30.0)]},
    )  # fmt: skip
    assert found["wheel_center_z_psd"].dims == ("car", "frequency")
    assert found["wheel_center_z_psd"].attrs["units"] == "m^2/Hz"
    for place in (0, 3, 64, 69):
        one = alone(car, cars, place, start, method="DormandPrince", **options)
        height = one.signals["wheel_center_z"]
        density = welch_by_hand(height, TIMES[1], segment)
        # motions that agree to 1e-8 m of some centimetres: their squares to 1e-6 of the greatest
        np.testing.assert_allclose(
            found["wheel_center_z_psd"][place], density, rtol=0.0, atol=1e-6 * density.max()
        )
        ordered = np.sort(height)  # of 41 outputs: the place 0.3 * 40
        assert float(found["wheel_center_z_percentile_30"][place]) == pytest.approx(
            ordered[12], abs=1e-8
        )
    np.testing.assert_allclose(
        found["frequency"], np.arange(segment // 2 + 1) / (segment * TIMES[1]), rtol=1e-12
    )


def test_series_do_not_fill_the_memory(car, start, monkeypatch):
    """Memory has samples of a few systems at a time, for any number of systems; the same bits."""
    times = np.linspace(*SPAN, 301)
    options = {"t_eval": times, "reductions": {"camber": [("percentile", 95.0), ("psd", 64)]}}
    expected = ensemble(car, some_cars(100), SPAN, start, **options)
    monkeypatch.setattr(run, "SAMPLES", 8 * 301 * 5)
    held = []
    real = Problem.integrate
    monkeypatch.setattr(
        Problem, "integrate", lambda *given: (held.append(given[2] - given[1]), real(*given))[1]
    )
    same(ensemble(car, some_cars(100), SPAN, start, **options), expected)
    assert max(held) <= max(5, *WIDTHS)


def test_what_is_kept_is_written_and_goes_on_in_pieces(car, start, tmp_path):
    """An ensemble in chunks, each written to a file, is the whole, to the last bit."""
    cars = some_cars(9)
    options = {
        "t_eval": TIMES,
        "reductions": {"camber": [("psd", 16), ("percentile", 95.0), ("above", 0.0)]},
    }
    whole = ensemble(car, cars, SPAN, start, **options)
    chunks = []
    for first, last in ((0, 4), (4, 9)):
        part = {name: values[first:last] for name, values in cars.items()}
        found = ensemble(car, part, SPAN, start, **options)
        export.write(found, tmp_path / f"{first}.nc")
        chunks.append(xr.load_dataset(tmp_path / f"{first}.nc", engine="scipy"))
    together = xr.concat(chunks, "car")
    for name in ("camber_psd", "camber_percentile_95", "camber_above_0", "final_state"):
        assert together[name].values.tobytes() == whole[name].values.tobytes(), name
        assert together[name].dims == whole[name].dims
    assert together["solver"].values.tolist() == whole["solver"].values.tolist()
    spectra = whole[["camber_psd", "camber_percentile_95"]]
    for name in ("spectra.csv", "spectra.parquet"):
        export.write(spectra, tmp_path / name)
    rows = (tmp_path / "spectra.csv").read_text(encoding="utf-8").splitlines()
    assert len(rows) == 1 + 9 * 9


# -- stiff systems --------------------------------------------------------------------------------


def sticking(friction):
    """Return a car whose strut comes to stick soon, frictions of some, and a start."""
    changes = {"strut.friction_N": 600.0, "strut.friction_velocity_m_per_s": 1e-5}
    model = Model(kintrafo.Suspension.load("reference_car").with_changes(changes))
    return model, {"strut_friction": friction}, state_at_height(model, 0.305)


def test_what_is_stiff_is_done_by_bdf(monkeypatch):
    monkeypatch.setattr(ensembles, "_STIFF_AFTER", 500)
    model, cars, start = sticking([0.0, 600.0, 500.0])
    cars |= {"road_height": ["flat", "flat", "step"]}
    courses = {"flat": 0.0, "step": STEP}
    options = {"t_eval": TIMES, "rtol": 1e-8, "atol": 1e-10}
    reductions = {"tyre_force": ["max", "min", "mean", "rms", ("above", 3000.0)],
                  "wheel_center_z": [("psd", 16), ("percentile", 75.0)]}  # fmt: skip
    found = ensemble(
        model, cars, SPAN, start, inputs={"road_height": courses}, signals=["wheel_center_z"],
        reductions=reductions, **options,
    )  # fmt: skip
    assert found["success"].all(), found["reason"].values
    assert found["solver"].values.tolist() == ["DormandPrince", "BDF", "BDF"]
    for place, road in enumerate([0.0, 0.0, STEP]):
        own = model.parameters | {"strut_friction": float(cars["strut_friction"][place])}
        exact = simulate(System(model.equations, own), SPAN, start, method="Radau",
                         inputs={"road_height": road}, **options)  # fmt: skip
        # of two implicit methods at 1e-8 each, in metres, over sticking and slipping
        np.testing.assert_allclose(
            found["wheel_center_z"][place], exact.signals["wheel_center_z"], atol=1e-6
        )
        force = exact.signals["tyre_force"]
        weights = np.diff(TIMES, prepend=TIMES[0], append=TIMES[-1])
        weights = (weights[1:] + weights[:-1]) / 2.0 / TIMES[-1]
        mean = weights @ force
        known = {"max": force.max(), "min": force.min(), "mean": mean,
                 "rms": np.sqrt(weights @ (force - mean) ** 2)}  # fmt: skip
        for name, value in known.items():
            # some hundred N/mm of the tyre times the error of the height
            assert float(found[f"tyre_force_{name}"][place]) == pytest.approx(value, abs=1.0)
        assert float(found["tyre_force_above_3000"][place]) == pytest.approx(
            time_above(force, TIMES, 3000.0), abs=1e-5
        )
        assert found["wheel_center_z_psd"].values[place] == pytest.approx(
            welch_by_hand(found["wheel_center_z"].values[place], TIMES[1], 16), abs=1e-12
        )
        np.testing.assert_allclose(found["final_state"][place], exact.y[:, -1], atol=1e-4)
    assert found["end_time"].values.tolist() == [SPAN[1]] * 3


def test_stiff_ones_end_with_a_reason_where_that_is_wanted(monkeypatch):
    monkeypatch.setattr(ensembles, "_STIFF_AFTER", 500)
    model, cars, start = sticking([0.0, 600.0])
    options = {"t_eval": TIMES, "max_steps": 2000}
    found = ensemble(model, cars, SPAN, start, stiff=None, **options)
    assert found["success"].values.tolist() == [True, False]
    assert "more than 2000 steps" in found["reason"].item(1)
    assert found["solver"].values.tolist() == ["DormandPrince"] * 2


def test_what_both_methods_cannot_do_reports_both_reasons():
    model, cars, start = sticking([0.0, 600.0])
    options = {"t_eval": TIMES, "max_steps": 80}
    found = ensemble(model, cars, SPAN, start, **options, rtol=1e-5, atol=1e-6)
    assert found["success"].values.tolist() == [True, False]
    words = found["reason"].item(1)
    assert "more than 80 steps" in words
    assert "Nor can BDF do it: at t = " in words
    assert found["solver"].item(1) == "DormandPrince"


def test_reductions_are_those_of_the_samples(mixed):
    good = mixed.isel(car=np.flatnonzero(mixed["success"].values))
    force, times = good["tyre_force"], good["time"].values
    assert good["tyre_force_max"].values.tolist() == force.max("time").values.tolist()
    assert good["tyre_force_min"].values.tolist() == force.min("time").values.tolist()
    above = [time_above(row, times, 3000.0) for row in force.values]
    # sums of some tens of terms in another order; crossings that are roots of straight lines
    np.testing.assert_allclose(good["tyre_force_above_3000"], above, rtol=1e-12, atol=1e-15)
    for place in range(good.sizes["car"]):
        known = statistics(xr.Dataset({"force": ("time", force.values[place])}, {"time": times}))
        assert good["tyre_force_mean"].values[place] == pytest.approx(
            known["force"].mean, rel=1e-13
        )
        assert good["tyre_force_rms"].values[place] == pytest.approx(known["force"].rms, rel=1e-12)


def test_bounds_are_watched_as_in_simulate(car):
    high = state_at_height(car, 0.340)
    cars = {"tyre_free_height": car.parameters["tyre_free_height"] + np.array([0.0, 0.1])}
    found = ensemble(car, cars, SPAN, high, t_eval=TIMES)
    assert found["success"].all()
    for place in range(2):
        one = alone(car, cars, place, high, t_eval=TIMES, method="DormandPrince")
        worst = {f"{e.bound.signal}: {e.bound.words}": e.worst for e in one.validity}
        beyond = found["beyond"].isel(car=place).dropna("bound")
        assert set(beyond["bound"].values.tolist()) == set(worst)
        assert bool(found["valid"][place]) == (not worst)
        for bound, value in worst.items():
            # in newtons, of motions that agree to micrometres
            assert float(beyond.sel(bound=bound)) == pytest.approx(value, abs=1.0)
    assert not found["valid"][0]
    assert found["valid"][1]


def test_dimensions_and_coordinates_of_a_grid(car, start):
    grid = xr.Dataset(
        {
            "spring_rate": (
                ("spring", "damper"),
                np.array([[2e4, 2.1e4], [3e4, 3.1e4], [4e4, 4.1e4]]),
            )
        },
        {"damper_rate": ("damper", [1000.0, 2000.0]), "spring": ["soft", "usual", "hard"]},
    )
    found = ensemble(car, grid, SPAN, start, reductions={"camber": "max"}, threads=2)
    assert dict(found["camber_max"].sizes) == {"spring": 3, "damper": 2}
    assert found["camber_max"].attrs["units"] == "rad"
    rates = {n: found[n].broadcast_like(found["camber_max"]).values for n in
             ("spring_rate", "damper_rate")}  # fmt: skip
    flat = ensemble(car, {n: v.ravel() for n, v in rates.items()}, SPAN, start,
                    reductions={"camber": "max"})  # fmt: skip
    assert found["camber_max"].values.ravel().tolist() == flat["camber_max"].values.tolist()


def test_results_are_those_that_are_named(mixed):
    """Names that no dimension of variants may have are those that results have."""
    from kintrafo.ensembles.variants import BOUND, RESULTS, STATE, TIME

    assert {TIME, STATE, BOUND} <= set(mixed.dims)
    asked = ("camber", "tyre_force", "wheel_center_z")
    own = {name for name in mixed.data_vars if not str(name).startswith(asked)}
    assert own == set(RESULTS)


def test_a_model_without_signals():
    model = System(EMITTED["excavator"])
    found = ensemble(model, {"gravity": [9.81, 1.62]}, (0.0, 0.1), signals=model.state_names[:1])
    assert found["valid"].all()
    assert found[model.state_names[0]].values[0, -1] != found[model.state_names[0]].values[1, -1]


def test_progress_is_reported(car, start, monkeypatch):
    reported = []
    monkeypatch.setattr(run, "_FEWEST", 10)
    real = run._wait_for

    def noted(waiting, report):
        real(waiting, lambda done: (reported.append(done), report(done)))

    monkeypatch.setattr(run, "_wait_for", noted)
    ensemble(car, some_cars(50), (0.0, 0.01), start, progress=True)
    assert reported == sorted(reported)
    assert reported[-1] == 50


@pytest.mark.usefixtures("interruptible")
def test_an_interruption_ends_it(car, start):
    """Of what would take hours; without an end at once, this test has none."""
    timer = threading.Timer(0.3, _thread.interrupt_main)
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        ensemble(car, some_cars(10_000), (0.0, 1e5), start, t_eval=[1e5], max_steps=10**9)
    timer.join()


@pytest.mark.usefixtures("interruptible")
def test_an_interruption_ends_what_bdf_does(monkeypatch):
    """Of a hundred million steps, in a thread, which no signal reaches."""
    monkeypatch.setattr(ensembles, "_STIFF_AFTER", 100)
    model, cars, start = sticking([600.0])
    timer = threading.Timer(0.5, _thread.interrupt_main)
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        ensemble(model, cars, (0.0, 1e4), start, t_eval=[1e4], max_step=1e-4, max_steps=10**9)
    timer.join()


# -- arguments ----------------------------------------------------------------------------------


def by_label(*cars):
    """Return a row of numbers of labelled cars."""
    return xr.DataArray([1e3, 2e3, 3e3], dims="car", coords={"car": list(cars)})


class _Name:
    def __repr__(self):
        return "damper_rate"


def roads(*labels, given=None):
    """Return cars by their labels, or those that are given, and a course for each of the labels."""
    courses = {label: 0.01 * place for place, label in enumerate(labels)}
    variants = {"road_height": list(labels) if given is None else given}
    return {"variants": variants, "inputs": {"road_height": courses}}


def along(*values, **coordinates):
    return xr.DataArray(list(values), dims="car", coords=coordinates)


WRONG = [
    roads("1", 1),
    roads("1", 1, given=xr.DataArray(["1", 1], dims="car")),
    roads("1", given=["1", 1]),
    roads("1", given=(1, "1")),
    roads(1.5, "1.5"),
    roads(True, "True"),
    roads("a", "a\0"),
    roads("a", given=["a", "a\0"]),
    roads(2**53, 2**53 + 1, 0.5),
    roads(2**53, 0.5, given=[2**53, 2**53 + 1, 0.5]),
    roads(),
    {"variants": {"damper_rate": []}},
    {"variants": {_Name(): [1e3], "damper_rate": [2e3]}},
    {"variants": {"damper_rate": along(1e3, damper_rate=("car", [2e3]))}},
    {"variants": {"spring_rate": along(2e4, damper_rate=("car", [2e3]))}},
    {"variants": {"spring_rate": along(2e4, beta1=("car", [0.1]))}},
    {
        "variants": {
            "spring_rate": along(2e4, 3e4, name=("car", ["a", "b"])),
            "damper_rate": along(1e3, 2e3, name=("car", ["b", "a"])),
        }
    },
    {"variants": {"spring_rat": [1.0]}},
    {"variants": {"spring_rate": ["a"]}},
    {"variants": {"spring_rate": [np.nan]}},
    {"variants": {"spring_rate": [1.0, 2.0], "damper_rate": [1.0, 2.0, 3.0]}},
    {"variants": {"spring_rate": np.ones((2, 2))}},
    {"variants": 3},
    {"variants": {"rack_velocity": [1.0]}},
    {"variants": {"tie_rod_mass": [1.0]}},
    {"variants": {"road_height": ["a"]}, "inputs": {"road_height": {"b": 0.0}}},
    {"inputs": {"road_height": {"b": 0.0}}},
    {"inputs": {"road": 0.0}},
    {"variants": {"road_height": [0.0]}, "inputs": {"road_height": 0.1}},
    {"variants": xr.Dataset({"spring_rate": ("time", [2e4])})},
    {"t_span": (1.0, 0.0)},
    {"t_eval": [0.0, 2.0]},
    {"signals": ["cambre"]},
    {"reductions": {"camber": "maximum"}},
    {"reductions": {"camber": "above"}},
    {"reductions": {"camber": ("above", np.nan)}},
    {"reductions": {"camber": ("above", xr.DataArray(1.0, attrs={"units": "deg"}))}},
    {"reductions": {"camber": "percentile"}},
    {"reductions": {"camber": ("percentile", 101.0)}},
    {"reductions": {"camber": ("percentile", -1.0)}},
    {"reductions": {"camber": ("max", 1.0)}},
    {"reductions": {"camber": "psd"}},
    {"reductions": {"camber": ("psd", 2.5)}},
    {"reductions": {"camber": [("psd", 16), ("psd", 32)]}},
    {"reductions": {"camber": ("psd", 16)}, "t_eval": np.linspace(0.0, 1.0, 20) ** 2},
    {"stiff": "Radau"},
    {"variants": xr.Dataset({"spring_rate": ("frequency", [2e4])})},
    {"reductions": {"camber": "max"}, "t_eval": [0.5]},
    {"rtol": 0.0},
    {"atol": [1.0, 2.0]},
    {"max_step": 0.0},
    {"max_steps": 0},
    {"threads": 0},
    {"lanes": 3},
    {"y0": np.ones((2, 4)), "variants": {"spring_rate": [1.0, 2.0, 3.0]}},
    {"y0": [1.0]},
    {"variants": {"damper_rate": by_label(2, 0, 1), "spring_rate": by_label(0, 1, 2)}},
    {"variants": xr.Dataset(coords={"damper_rat": [1.0, 2.0]})},
    {"variants": {"damper_rate": np.ma.masked_equal([1.0, 2.0], 1.0)}},
    {"variants": {"strut_length_max": [0.8]}, "reductions": {"strut_length": "max"}},
    {"variants": {"spring_rate": xr.DataArray([20.0], dims="car", attrs={"units": "N/mm"})}},
    {"model": "reference_car"},
]


def test_labels_of_any_kind(car, start):
    labels = xr.DataArray(np.array(["flat", 2, 2.5, "flat"], dtype=object), dims="car")
    roads = {"flat": 0.0, 2: 0.01, 2.5: 0.02}
    found = ensemble(
        car, {"road_height": labels}, SPAN, start, inputs={"road_height": roads}, signals=["camber"]
    )
    heights = [roads[label] for label in labels.values]
    same(found[["camber"]], ensemble(
        car, {"road_height": heights}, SPAN, start, signals=["camber"]
    )[["camber"]])  # fmt: skip
    assert found["road_height"].values.tolist() == labels.values.tolist()


def test_labels_and_coordinates_that_agree(car):
    """A label stays what it is in a row of several kinds; coordinates repeat what they label."""
    labels = ["1", 2, 2**53 + 1, 0.5, np.int64(2)]
    given = roads(*labels[:4], given=labels)
    found = ensemble(car, given["variants"], (0.0, 0.01), inputs=given["inputs"], signals=["toe"])
    expected = ensemble(
        car, {"road_height": [0.0, 0.01, 0.02, 0.03, 0.01]}, (0.0, 0.01), signals=["toe"]
    )
    same(found[["toe"]], expected[["toe"]])
    assert found["road_height"].values.tolist() == labels
    name = ("car", ["a", "b"])
    rates = {
        "damper_rate": along(1e3, 2e3, damper_rate=("car", [1e3, 2e3]), name=name),
        "spring_rate": along(2e4, 3e4, damper_rate=("car", [1e3, 2e3]), name=name),
    }
    two = ensemble(car, rates, (0.0, 0.01))
    assert two["damper_rate"].values.tolist() == [1e3, 2e3]
    assert two["name"].values.tolist() == ["a", "b"]


def test_nothing_is_known_of_what_never_began(car):
    """Parameters out of their range, and parameters of no mechanism, that C finds."""
    own = car.parameters
    hinge = {f"arm_rear_{x}": [own[f"arm_rear_{x}"], own[f"arm_front_{x}"]] for x in "xyz"}
    parameters = {"spring_rate": [-1.0, own["spring_rate"]], **hinge}
    found = ensemble(car, parameters, SPAN)
    assert not found["success"].any()
    assert np.isnan(found["end_time"]).all()
    assert np.isnan(found["final_state"]).all()


def test_rows_of_states_do_not_forget_their_inputs(car, refused):
    steered = state_at_height(car, 0.32, rack_position=0.02)
    refused(InputError, lambda: ensemble(car, None, (0.0, 1.0), [steered, steered]))
    given = {"road_height": steered.inputs[car.input_names.index("road_height")]}
    found = ensemble(
        car,
        None,
        (0.0, 0.01),
        [steered, steered],
        inputs={"rack_position": 0.02, **given},
        signals=["toe"],
        t_eval=[0.0],
    )
    assert found["toe"].values.ravel() == pytest.approx(
        float(car.signal("toe", steered)), rel=1e-12
    )


def test_what_is_kept_is_named(car):
    """Names of signals are broken nowhere but between words, as on the axes of a figure."""
    kinds = ["max", "min", "mean", "rms", ("above", 1.0), ("percentile", 5.0), ("psd", 8)]
    found = ensemble(car, None, (0.0, 0.1), reductions={"wheel_acceleration": kinds})
    kept = [data for name, data in found.items() if str(name).startswith("wheel_acceleration")]
    assert len(kept) == len(kinds)
    assert all("wheel acceleration" in data.attrs["long_name"] for data in kept)


def test_levels_are_reported_with_their_unit(car):
    """In that for people, as the time beside them is, and with all digits that were given."""
    levels = {
        "tyre_force": (5000.0, "5000 N"),
        "camber": (np.deg2rad(-0.5), "-0.5 deg"),
        "wheel_center_z": (0.30000001, "300.00001 mm"),
        "damper_force": (0.0, "0 N"),
    }
    wanted = {name: ("above", level) for name, (level, _) in levels.items()}
    found = ensemble(car, None, (0.0, 0.01), reductions=wanted)
    reported = [
        str(data.attrs["long_name"]) for name, data in found.items() if "_above_" in str(name)
    ]
    for name, (_, words) in levels.items():
        assert f"time for which {name.replace('_', ' ')} is above {words}" in reported


def test_levels_that_look_alike_have_names_of_their_own(car):
    levels = [("above", 0.30000001), ("above", 0.3)]
    found = ensemble(car, None, (0.0, 0.01), reductions={"wheel_center_z": levels})
    assert {"wheel_center_z_above_0.30000001", "wheel_center_z_above_0.3"} <= set(found)


@pytest.mark.parametrize("wrong", WRONG)
def test_what_cannot_be_used(car, wrong, refused):
    given = {"model": car, "variants": None, "t_span": (0.0, 1.0)} | wrong
    refused(InputError, lambda: ensemble(**given))


def test_a_mechanism_with_the_names_of_results(refused):
    """No result replaces another one of its name, and none is missing after the computation."""
    named = changed(FOUR_BAR, (SPRING.rate, replace(SPRING.rate, name="steps")))
    force, highest = (ForceOf(n, named.elements[0], "force") for n in ("success", "success_max"))
    system = System(kintrafo.compile(replace(named, outputs=(force, highest))))
    for asked in (
        {"variants": {"steps": [300.0, 500.0]}},
        {"signals": ["success"]},
        {"signals": ["success_max"], "reductions": {"success": "max"}},
    ):
        with refused(InputError):
            ensemble(**{"model": system, "variants": None, "t_span": SPAN} | asked)
    found = ensemble(system, None, SPAN, signals=["success_max"], reductions={"success": "min"})
    assert found["success"].dtype == bool


def test_own_mechanisms_are_compiled_in_lanes():
    """The four-bar of the project, compiled here: the same bits in every width."""
    from kintrafo.generator.mechanisms.four_bar import FOUR_BAR

    here, there = System(kintrafo.compile(FOUR_BAR)), System(kintrafo.generated.four_bar)
    cranks = {"crank_angle_rate": np.linspace(1.0, 9.0, 7)}
    expected = ensemble(there, cranks, SPAN, signals=there.signal_names, t_eval=TIMES)
    for width in WIDTHS:
        found = ensemble(here, cranks, SPAN, signals=there.signal_names, t_eval=TIMES, lanes=width)
        same(found, expected)


def test_axles_in_lanes_do_what_they_do_alone():
    model = AxleModel(Axle.load("reference_axle"))
    road = {"left_road_height": STEP}
    rates = np.linspace(500.0, 2000.0, 5)
    found = ensemble(model, {"bar_rate": rates}, SPAN, inputs=road, t_eval=TIMES, rtol=1e-8,
                     signals=["bar_spring_moment"])  # fmt: skip
    for place in (0, 4):
        one = System(model.equations, model.parameters | {"bar_rate": rates[place]})
        alone = simulate(one, SPAN, model.design_state, inputs=road, t_eval=TIMES, rtol=1e-10)
        moment = alone.signals["bar_spring_moment"]
        scale = abs(moment).max()
        # the tolerance of either, over the oscillations of half a second
        np.testing.assert_allclose(found["bar_spring_moment"][place], moment, atol=1e-5 * scale)


def test_what_iterates_beside_what_does_not_close():
    """Five links: each as alone, for any width; one in the middle starts out of reach."""
    model, name, count = Model("multi_link_car"), "front_upper_link_inner_y", 9
    cars = {
        name: model.parameters[name] + 1e-3 * np.arange(count),
        "damper_rate": model.parameters["damper_rate"] * (1.0 + 0.1 * np.arange(count)),
    }
    start = np.tile(model.design_state, (count, 1))
    start[4, 0] += 2.0  # the lever of the height sensor, where no links reach
    options = {"signals": ["camber"], "t_eval": [0.1, 0.2], "rtol": 1e-9, "atol": 1e-10}
    first, *others = (
        ensemble(model, cars, (0.0, 0.2), start, lanes=width, **options)
        for width in library.widths()
    )
    for other in others:
        same(other, first)
    assert first["success"].values.tolist() == [place != 4 for place in range(count)]
    assert "do not hold it" in first["reason"].values[4]
    for place in (0, 8):
        own = {key: float(values[place]) for key, values in cars.items()}
        alone = System(model.equations, model.parameters | own)
        exact = simulate(alone, (0.0, 0.2), start[0], method="DOP853", t_eval=[0.1, 0.2],
                         rtol=1e-10, atol=1e-11)  # fmt: skip
        # the tolerance of either
        np.testing.assert_allclose(first["camber"].values[place], exact.signals["camber"],
                                   atol=1e-7)  # fmt: skip


def test_without_a_compiler_own_mechanisms_are_refused(monkeypatch, refused):
    from kintrafo.generator.mechanisms.slider_crank import SLIDER_CRANK

    compiled = kintrafo.compile(SLIDER_CRANK)
    monkeypatch.setattr("kintrafo.simulation.lanes.own.find_compiler", lambda: None)
    refused(InputError, lambda: ensemble(System(compiled), None, (0.0, 1.0)))


def test_impossible_sets_are_those_that_are_refused_one_by_one(car):
    """Ranges, inertias of no body, rotors: the same answers as in words."""
    rng = np.random.default_rng(4)
    described, count = car.equations.PARAMETERS, 100
    names = ("spring_rate", "knuckle_inertia_xx", "knuckle_inertia_xy", "wheel_inertia_spin")
    own = {n: car.parameters[n] + rng.choice([0.0, -1.0, 3.0], count, p=[0.8, 0.1, 0.1])
           for n in names}  # fmt: skip
    own["spring_rate"] -= 1e5 * (rng.random(count) > 0.9)
    found = impossible(car.parameters | own, described, count)
    for place in range(count):
        one = car.parameters | {n: float(v[place]) for n, v in own.items()}
        assert found[place] == bool(out_of_range(one, described) or inertia_of_no_body(one))
    assert 0 < found.sum() < count
