"""Results that do not fit into memory are an error at the start, and the estimates are right."""

import re
import resource
import tracemalloc
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from kintrafo import (
    Axle,
    InputError,
    Model,
    RigidAxle,
    System,
    characteristics,
    compare,
    compliance,
    ensemble,
    loads,
    simulate,
    state_at_height,
    sweep,
)
from kintrafo.core import memory
from kintrafo.generated import slider_crank
from kintrafo.simulation.lanes import library

CAR = Model("reference_car")
START = state_at_height(CAR, 0.31)
needs_lanes = pytest.mark.skipif(not library.widths(), reason="built without lanes")
ensembles = import_module("kintrafo.ensembles.ensemble")


@pytest.fixture
def little(monkeypatch):
    """Leave a megabyte, and let nothing be simulated."""
    monkeypatch.setattr(memory, "free", lambda: 1e6)
    for name in ("run", "run_in_chunks"):
        monkeypatch.setattr(ensembles, name, None)


def many(count):
    return {"damper_rate": np.linspace(1e3, 2e3, count)}


GRID = xr.Dataset(
    coords={name: np.linspace(1e3, 2e3, 10**5) for name in ("damper_rate", "spring_rate")}
)
TIMES = np.linspace(0.0, 0.1, 2001)
LARGE = {
    "signals": (
        {"variants": many(1000), "t_eval": TIMES, "signals": ["toe", "camber"]},
        "1,000 systems",
    ),
    "grid": ({"variants": GRID}, "10,000,000,000 systems with 201 outputs"),
    "percentile": (
        {
            "variants": many(20),
            "t_eval": TIMES,
            "reductions": {"toe": ("percentile", 5.0)},
            "threads": 8,
        },
        "20 systems with 2,001 outputs, of which 1 numbers are kept",
    ),
    "spectra": (
        {"variants": many(200), "t_eval": TIMES, "reductions": {"toe": ("psd", 2000)}},
        "of which 1,001 numbers are kept",
    ),
}


@needs_lanes
@pytest.mark.usefixtures("little")
@pytest.mark.parametrize("what", LARGE)
def test_large_ensembles_are_refused_at_once(what):
    given, words = LARGE[what]
    with pytest.raises(
        InputError, match=r"need .* [MGT]B, and 1 MB are free. Take fewer"
    ) as caught:
        ensemble(
            CAR,
            given["variants"],
            (0.0, 0.1),
            START,
            **{k: v for k, v in given.items() if k != "variants"},
        )
    assert words in str(caught.value)


@needs_lanes
@pytest.mark.usefixtures("little")
def test_what_fits_is_begun():
    with pytest.raises(TypeError, match="NoneType"):  # the solver, which is not there
        ensemble(CAR, many(100), (0.0, 0.1), START, signals=["toe"])


@pytest.mark.parametrize(
    ("given", "count"),
    [({"t_eval": np.linspace(0.0, 1.0, 10**5)}, 10**5), ({"method": "RK4", "step": 1e-5}, 10**5)],
)
def test_large_outputs_are_refused_at_once(monkeypatch, given, count):
    monkeypatch.setattr(memory, "free", lambda: 1e6)
    with pytest.raises(InputError, match=f"{count:,} outputs of 4 elements .* 1 MB are free. Ask"):
        simulate(CAR, (0.0, 1.0), START, **given)
    crank = System(slider_crank)
    assert simulate(crank, (0.0, 1.0), crank.state(), t_eval=np.linspace(0.0, 1.0, 100)).success


MANY = np.broadcast_to(0.0, 10**10)  # of no memory itself
AXLE, RIGID = Axle.load("reference_axle"), RigidAxle.load("rigid_axle")
CURVES = {
    "travel": lambda: characteristics.over(CAR, "travel", MANY),
    "range": lambda: characteristics.over(CAR, "travel", range(10**10)),
    "steering": lambda: characteristics.over(CAR, "rack", MANY),
    "positions": lambda: sweep.positions(CAR, MANY),
    "both": lambda: sweep.positions(CAR, np.zeros(10**5), np.zeros(10**5)),
    "compare": lambda: compare.compare({"a": CAR, "b": CAR}, MANY),
    "roll": lambda: characteristics.over(AXLE, "roll", MANY),
    "steer": lambda: characteristics.over(AXLE, "rack", MANY),
    "rigid": lambda: characteristics.over(RIGID, "roll", MANY),
    "compliance": lambda: compliance.linear(CAR, travel=MANY),
    "elastokinematics": lambda: compliance.elastokinematics(CAR, along=MANY),
    "amounts": lambda: compliance.nonlinear(CAR, None, "lateral", MANY),
}


@pytest.mark.parametrize("what", CURVES)
def test_curves_of_too_many_positions_are_refused_at_once(what):
    """By every function that takes positions; 10 thousand millions need 41 TB."""
    with pytest.raises(InputError, match=r"10,000,000,000 .* 41 TB"):
        CURVES[what]()


def test_loads_along_a_long_motion_are_refused(monkeypatch, refused):
    motion = simulate(CAR, (0.0, 0.1), START, t_eval=np.linspace(0.0, 0.1, 11))
    monkeypatch.setattr(memory, "free", lambda: 1e3)
    monkeypatch.setattr(memory, "_LITTLE", 1e3)
    refused(InputError, lambda: loads.along(CAR, motion))


@needs_lanes
@pytest.mark.parametrize(
    ("count", "given"),
    [
        (2000, {"signals": ["toe", "camber"], "t_eval": np.linspace(0.0, 0.01, 201)}),
        (50_000, {"reductions": {"toe": "rms"}, "t_eval": [0.0, 0.01]}),
        (300, {"reductions": {"toe": ("psd", 4000)}, "t_eval": np.linspace(0.0, 0.01, 4000)}),
        (8, {"reductions": {"toe": ("percentile", 5.0)}, "t_eval": np.linspace(0.0, 0.01, 10**5)}),
    ],
    ids=["signals", "systems", "spectra", "percentile"],
)
def test_the_estimate_is_what_is_taken(monkeypatch, count, given):
    """The estimate is within a factor of 2 of the peak that Python traces."""
    needed = []
    monkeypatch.setattr(
        "kintrafo.ensembles.room.refuse_beyond", lambda _, size, *__: needed.append(size)
    )
    cars, options = many(count), {**given, "threads": 1}
    ensemble(CAR, many(2), (0.0, 0.01), START, **options)  # what is loaded once
    tracemalloc.start()
    found = ensemble(CAR, cars, (0.0, 0.01), START, **options)
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert found["success"].all()
    # the free memory is not known better than by such a factor
    assert 0.5 * most < needed[-1] < 2.0 * most


def test_the_system_is_not_asked_for_little(monkeypatch):
    monkeypatch.setattr(memory, "free", None)
    assert simulate(CAR, (0.0, 0.1), START, t_eval=np.linspace(0.0, 0.1, 100)).success


def test_what_is_free_is_what_the_system_reports():
    there = memory.free()
    assert 0.0 < there < 1e15
    soft, hard = resource.getrlimit(resource.RLIMIT_AS)
    size = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    try:
        resource.setrlimit(resource.RLIMIT_AS, (size + 10**8, hard))
        assert 0.0 < memory.free() < 1.1e8
    finally:
        resource.setrlimit(resource.RLIMIT_AS, (soft, hard))


def test_sizes_have_units():
    found = [memory._size(count) for count in (1.0, 2.5e6, 3e9, 4.2e13)]
    assert found == ["1e-06 MB", "2.5 MB", "3 GB", "42 TB"]
    assert re.fullmatch(r"\d.*", found[0])
