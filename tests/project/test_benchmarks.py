"""The benchmark scripts in a reduced mode: they run, their results have the right structure."""

import json
import re
import shutil

import numpy as np
import pytest
from kintrafo.simulation import solvers
from kintrafo.simulation.lanes.library import widths
from kintrafo.simulation.solvers import native_available
from support.commands import ROOT, run_module
from support.exported import needs_library
from support.models import needs_gcc

from benchmarks import friction, paper_timing, report, work_precision

NEEDS_SUNDIALS = pytest.mark.skipif(not native_available(), reason="SUNDIALS is not built in")
PAGE = ROOT / "docs/theory/gear-against-runge-kutta.md"


@pytest.fixture(scope="module")
def case():
    return paper_timing.standard_case()


def columns(table):
    return {line.count("|") for line in table.splitlines()}


@NEEDS_SUNDIALS
def test_command_writes_everything(tmp_path):
    page = tmp_path / "docs/theory/page.md"
    page.parent.mkdir(parents=True)
    (page.parents[1] / "images").mkdir()
    shutil.copy(PAGE, page)
    run_module("benchmarks", "--quick", "--out", tmp_path, "--page", page)
    results = json.loads((tmp_path / "gear_against_runge_kutta.json").read_text())
    assert set(results) == {
        "environment",
        "stiffness",
        "paper_timing",
        "work_precision",
        "friction",
    }
    assert {"processor", "compiler", "SUNDIALS", "SciPy"} <= set(results["environment"])
    for name in (
        "work_precision.png",
        "work_precision.svg",
        "friction.png",
        "friction.svg",
        "gear_against_runge_kutta.md",
    ):
        assert (tmp_path / name).stat().st_size > 1000
    assert (page.parents[1] / "images/work_precision.png").exists()
    assert page.read_text().count("| Verner 6(5)") >= 1


@NEEDS_SUNDIALS
def test_paper_protocol(case):
    result = paper_timing.measure(case, interval=1e-3, rounds=1)
    runge_kutta, gear = result.entries[:2]
    assert (runge_kutta.method, runge_kutta.stops) == ("Verner", True)
    assert (gear.method, gear.stops) == ("BDF", False)
    assert result.paper_ratio == pytest.approx(27.7, abs=0.01)
    # eight stages onto every output; Gear's steps are far fewer than the outputs
    assert runge_kutta.evaluations >= 8 * result.outputs
    assert gear.evaluations < result.outputs
    assert all(e.error < 1e-4 for e in result.entries)
    assert columns(paper_timing.methods_table(result)) == {10}
    assert columns(paper_timing.ratio_table(result)) == {3}


def test_work_precision(case):
    points = work_precision.measure(case, (1e-4, 1e-7), passes=1, budget=0.0)
    assert len(points) == 2 * len(work_precision.curves())
    for coarse, fine in zip(points[::2], points[1::2], strict=True):
        assert fine.error < coarse.error < 1e-2
        assert fine.evaluations > coarse.evaluations
    assert columns(work_precision.points_table(points)) == {10}
    costs = work_precision.cost_at(points, 1e-5)
    assert costs
    assert columns(work_precision.cost_table(costs)) == {5}
    assert len(work_precision.draw(points, "a processor").axes) == 2


def test_cost_lies_between_the_tolerances():
    def point(error, evaluations):
        timing = report.timing_of([evaluations * 1e-6])
        return work_precision.Point("SciPy", "RK45", 1e-3, error, 0, evaluations, 0, timing)

    (cost,) = work_precision.cost_at([point(1e-4, 100), point(1e-8, 10_000)], 1e-6)
    assert cost.evaluations == pytest.approx(1000)
    assert cost.seconds == pytest.approx(1e-3)


def test_stiffness(case):
    result = work_precision.stiffness(case)
    assert np.max(result.eigenvalues.imag) == pytest.approx(75.48, abs=0.01)
    growth = np.abs(np.max(np.abs(result.eigenvalues)) * result.stable_step)
    assert 2.0 < growth < 4.0  # the region of Dormand-Prince reaches about as far


def test_friction_is_stiff_and_gear_does_not_mind():
    mild, stiff = (friction.measure((speed,), rounds=1) for speed in (1e-2, 1e-4))
    gear, *runge_kutta = stiff
    assert gear.method == "BDF"
    # the slope of the friction law at rest is F / v0, and nothing else depends on v0
    assert gear.eigenvalue / mild[0].eigenvalue == pytest.approx(100.0, rel=0.1)
    for point in runge_kutta:
        # stability: |step times eigenvalue| up to about 3.3, for six or eight evaluations
        assert point.evaluations > 0.3 * abs(point.eigenvalue)
    assert gear.evaluations < 2 * mild[0].evaluations
    assert all(point.error < 1e-3 for point in (*mild, *stiff))
    table = friction.table([*mild, *stiff])
    assert len(columns(table)) == 1
    assert len(friction.draw(stiff, "a processor").axes) == 2


def test_without_sundials_scipy_remains(monkeypatch, case):
    monkeypatch.setattr(solvers, "sundials", None)
    assert {library for library, _ in work_precision.curves()} == {"SciPy"}
    points = work_precision.measure(case, (1e-4,), passes=1, budget=0.0)
    assert len(points) == len(work_precision.SCIPY)
    assert report.environment()["SUNDIALS"] == "not built in"
    assert work_precision.draw(points, "a processor").legends


def test_page_names_only_known_blocks():
    found = re.findall(r"<!-- begin (\w+) -->", PAGE.read_text())
    first = ["machine", "methods", "ratios", "stiffness", "costs", "friction"]
    assert found == [*first, "braking_rates", "braking", "accuracy"]


def test_table_and_page(tmp_path):
    table = report.markdown_table(["a", "b"], [["one", "2"], ["three", "44"]])
    assert table.splitlines()[1] == "|:------|----:|"
    page = tmp_path / "page.md"
    page.write_text("x\n<!-- begin a -->\nold\n<!-- end a -->\ny\n")
    report.fill_page(page, {"a": "new \\1", "b": "not there"})
    assert page.read_text() == "x\n<!-- begin a -->\nnew \\1\n<!-- end a -->\ny\n"


@pytest.mark.skipif(not widths(), reason="built without lanes")
def test_ensemble_writes_everything(tmp_path):
    page = tmp_path / "docs/simulation/ensembles.md"
    page.parent.mkdir(parents=True)
    (page.parents[1] / "images").mkdir()
    shutil.copy(ROOT / "docs/simulation/ensembles.md", page)
    run_module("benchmarks.ensemble", "--quick", "--out", tmp_path, "--page", page)
    found = json.loads((tmp_path / "ensemble.json").read_text())
    assert [call["lanes"] for call in found["calls"]] == [1, *widths()]
    assert all(rate["error"] <= 1e-6 for rate in found["rates"])
    assert (page.parents[1] / "images/ensemble.png").stat().st_size > 1000
    assert re.search(r"For a second of motion, .* µs of a core", page.read_text())


@pytest.mark.skipif(not widths(), reason="built without lanes")
def test_what_is_kept_of_stiff_cars_is_measured(tmp_path):
    page = tmp_path / "ensembles.md"
    page.write_text("".join(f"<!-- begin {n} -->\n<!-- end {n} -->\n" for n in ("stiff", "kept")))
    keep = "('percentile', 95)"
    run_module("benchmarks.ensemble_stiff", "--quick", "--page", page)
    assert "DormandPrince" in page.read_text()
    assert keep in page.read_text()


@needs_library
@pytest.mark.skipif(shutil.which("gcc") is None, reason="no gcc")
def test_exports_are_measured(tmp_path):
    page = tmp_path / "export.md"
    blocks = (f"<!-- begin {n} -->\n<!-- end {n} -->\n" for n in ("export", "instances"))
    page.write_text("".join(blocks))
    run_module("benchmarks.export", "--quick", "--page", page)
    assert page.read_text().count("| 3.0 |") == 1
    instances = float(re.findall(r"instances take ([\d.]+) MB", page.read_text())[0])
    assert instances < 50.0


@NEEDS_SUNDIALS
def test_steps_of_one_length_are_measured(tmp_path):
    page = tmp_path / "real-time.md"
    page.write_text("<!-- begin steps -->\n<!-- end steps -->\n")
    run_module("benchmarks.real_time", "--quick", "--page", page)
    assert "longest stable step" in page.read_text()
    assert "| 20 " in page.read_text()


@needs_gcc
@NEEDS_SUNDIALS
def test_braking_to_standstill_is_measured(tmp_path):
    """Steady slip at standstill: explicit steps of a millisecond fail, and implicit ones do not."""
    page = tmp_path / "gear.md"
    blocks = ("braking_rates", "braking")
    page.write_text("".join(f"<!-- begin {b} -->\n<!-- end {b} -->\n" for b in blocks))
    run_module("benchmarks.braking", "--quick", "--page", page)
    lines = page.read_text().splitlines()
    by = {line.split("|")[2].strip(): line for line in lines if line.count("|") == 9}
    assert by["RK4, 1 ms"].count(" - ") == 5
    assert " 5 000 " in by["RODASP, 1 ms"]
