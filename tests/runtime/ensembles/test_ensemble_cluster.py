"""Ensembles by workers of Dask, or that go on from what was kept: the same bits as by threads."""

import _thread
import json
import os
import shutil
import socket
import sys
import threading
import time
from concurrent.futures import CancelledError
from dataclasses import replace
from functools import partial
from importlib import import_module
from pathlib import Path
from types import SimpleNamespace

import kintrafo
import numpy as np
import pytest
import xarray as xr
from cars.different_cars import SPAN, of_all_kinds, same, some_cars
from kintrafo import InputError, Model, System, ensemble, state_at_height
from kintrafo.core.optional import MissingPackageError
from kintrafo.ensembles.chunks import chunk, cutting, gather, queue, versions, workers
from kintrafo.generator.mechanisms.four_bar import FOUR_BAR
from kintrafo.simulation.lanes import library
from kintrafo.systems.compile.shipped import shipped
from support import work_on_clusters

from benchmarks import cluster as benchmark

distributed = pytest.importorskip("distributed")

ensembles = import_module("kintrafo.ensembles.ensemble")

pytestmark = pytest.mark.skipif(not library.widths(), reason="built without lanes")

KEPT = {"reductions": {"camber": "max"}}


@pytest.fixture(scope="module")
def client():
    """Yield a client of two workers."""
    there = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": "127.0.0.1:0"}
    with distributed.LocalCluster(**there) as cluster, distributed.Client(cluster) as client:
        yield client


@pytest.fixture(scope="module")
def car():
    return Model("reference_car")


@pytest.fixture(scope="module")
def start(car):
    return state_at_height(car, 0.310, spin_rate=93.0)


@pytest.fixture
def small(monkeypatch):
    """Make chunks of seven cars."""
    monkeypatch.setattr(cutting, "_FEWEST", 7)
    monkeypatch.setattr(cutting, "_MOST", 7)


@pytest.fixture
def done(monkeypatch):
    """Note which chunks are simulated here."""
    found = []

    def noted(common, some, *given):
        found.append((some.first, some.first + some.systems.count))
        return chunk.found_of(common, some, *given)

    monkeypatch.setattr(gather, "found_of", noted)
    return found


# -- the same bits --------------------------------------------------------------------------------


@pytest.mark.usefixtures("small")
def test_the_same_bits_by_workers(client, car, start):
    """Histories, reductions and what fails, by a client and by the address of its scheduler."""
    cars, options = of_all_kinds(car)
    expected = ensemble(car, cars, SPAN, start, **options)
    assert (~expected["success"]).sum() == 5
    for where in (client, client.scheduler.address):
        found = ensemble(car, cars, SPAN, start, cluster=where, **options)
        assert found.identical(expected)
        same(found, expected)


def test_local_workers_share_the_threads(car, start):
    """One chunk, and one worker with all threads."""
    cars = some_cars(20)
    found = ensemble(car, cars, SPAN, start, cluster=1, threads=2, **KEPT)
    same(found, ensemble(car, cars, SPAN, start, **KEPT))
    with kintrafo.core.validator.Validator("ensemble") as given:
        for three in (3, np.int64(3)):
            assert workers.workers_of(given, three, 8, threads=None) == workers.Workers(3, 2)


@pytest.mark.usefixtures("small")
def test_workers_are_measured_beside_threads(client):
    found = [*benchmark.pairs(client, 100, 2)]
    assert all(time.cores > 0 for pair in found for time in (pair.threads, pair.workers))
    assert "| 2 workers with a thread each |" in benchmark.table(found, 100)
    assert "For 100 cars, 2 local workers take" in benchmark.sentence(found, 100, 3.0)


def test_rows_and_grids(client, car, start, tmp_path):
    """A row of states for each, and combinations along dimensions; by threads, kept, as well."""
    states = np.array(start) + 1e-3 * np.arange(20)[:, None]
    grid = xr.Dataset(coords={"spring_rate": [2e4, 3e4, 4e4], "damper_rate": [1e3, 1.5e3, 2e3]})
    for number, given in enumerate(((None, SPAN, states), (grid, SPAN, start))):
        expected = ensemble(car, *given, signals=["camber"], **KEPT)
        where = {"cluster": client} if number else {"kept": tmp_path / "kept"}
        assert ensemble(car, *given, signals=["camber"], **KEPT, **where).identical(expected)


def test_equations_that_were_compiled_here(client, tmp_path, monkeypatch):
    """A worker receives the equations if it finds neither their folder nor a cache with them."""
    model = System(kintrafo.compile(FOUR_BAR))
    crank = {"crank_mass": np.linspace(0.5, 2.0, 5)}
    options = {"signals": model.signal_names[:1]}
    home = Path(model.equations.__file__).parent
    elsewhere = replace(shipped(model.equations), file=f"/missing/{home.name}/four_bar.py")
    monkeypatch.setattr(chunk, "shipped", lambda _: elsewhere)
    before = os.environ["KINTRAFO_CACHE"]
    client.run(work_on_clusters.use_cache, str(tmp_path))
    try:
        found = ensemble(model, crank, SPAN, cluster=client, **options)
    finally:
        client.run(work_on_clusters.use_cache, before)
    same(found, ensemble(model, crank, SPAN, **options))
    assert (tmp_path / home.name / "four_bar.json").exists()


@pytest.mark.usefixtures("small")
def test_what_stiff_cars_report(client, car, start, monkeypatch):
    """A car that both methods fail to simulate has both reasons."""
    monkeypatch.setattr(ensembles, "_STIFF_AFTER", 50)
    cars = {"damper_rate": np.where(np.arange(20) == 15, 1e9, 1.5e3)}
    options = {"max_steps": 60, "rtol": 1e-3, "atol": 1e-5}
    found = ensemble(car, cars, SPAN, start, cluster=client, **options)
    assert np.flatnonzero(found["solver"] == "BDF").tolist() in ([15], [])
    same(found, ensemble(car, cars, SPAN, start, **options))


# -- lost workers and interrupts ------------------------------------------------------------------


@pytest.mark.usefixtures("small")
def test_what_a_lost_worker_did_is_done_again(client, car, start, tmp_path, monkeypatch):
    lost = partial(work_on_clusters.lost_once, str(tmp_path / "lost"))
    monkeypatch.setattr(queue, "_do", lost)
    found = ensemble(car, some_cars(40), SPAN, start, cluster=client, **KEPT)
    assert (tmp_path / "lost").exists()
    same(found, ensemble(car, some_cars(40), SPAN, start, **KEPT))


def test_what_loses_one_worker_after_another(refused):
    """Messages of the scheduler about lost workers, and of a lost scheduler."""
    killed = distributed.scheduler.KilledWorker("chunk", None, 3)
    for error in (killed, CancelledError(), OSError("nobody there")):

        def result(error=error):
            raise error

        with refused(queue.ClusterError):
            queue._result(SimpleNamespace(result=result), (7, 14))


@pytest.mark.usefixtures("interruptible", "small")
def test_an_interruption_ends_what_workers_do(client, car, start, tmp_path, monkeypatch):
    """Of what would take hours: without an end at once, the workers would not answer any more."""
    monkeypatch.setattr(queue, "_do", partial(work_on_clusters.noted, str(tmp_path)))

    def interrupt():
        while not any(tmp_path.iterdir()):
            time.sleep(0.01)
        _thread.interrupt_main()

    thread = threading.Thread(target=interrupt)
    thread.start()
    hours = {"t_eval": [1e5], "max_steps": 10**9, "cluster": client}
    with pytest.raises(KeyboardInterrupt):
        ensemble(car, some_cars(100), (0.0, 1e5), start, **hours)
    thread.join()
    begun = len([*tmp_path.iterdir()])
    assert client.submit(sum, [1, 2]).result() == 3
    assert begun == len([*tmp_path.iterdir()]) <= 4  # nothing that waited was begun


@pytest.mark.usefixtures("small")
def test_few_pieces_are_held_at_a_time(client, car, start, monkeypatch):
    """The number of chunks in memory does not depend on the number of systems."""
    held, most = 0, 0

    def cut(*given):
        nonlocal held, most
        held += 1
        most = max(most, held)
        return chunk.chunk_of(*given)

    def put(*given):
        nonlocal held
        held -= 1
        chunk.put(*given)

    monkeypatch.setattr(queue, "chunk_of", cut)
    monkeypatch.setattr(gather, "put", put)
    ensemble(car, some_cars(210), (0.0, 0.01), start, cluster=client, **KEPT)
    assert held == 0
    assert most <= 6  # three for each of two threads


def test_progress_is_reported(client, car, start, monkeypatch):
    shown = []
    real = ensembles.run_in_chunks

    def noted(*given):
        *others, report = given
        real(*others, lambda count: (shown.append(count), report(count)))

    monkeypatch.setattr(ensembles, "run_in_chunks", noted)
    ensemble(car, some_cars(50), SPAN, start, progress=True, cluster=client)
    assert shown == sorted(shown)
    assert shown[-1] == 50


# -- checkpoints ----------------------------------------------------------------------------------


@pytest.mark.usefixtures("small")
def test_an_interrupted_ensemble_continues_from_its_chunks(
    client, car, start, tmp_path, done, monkeypatch
):
    """Only missing chunks are simulated, also in other sizes, and here or by a cluster."""
    cars, options = of_all_kinds(car)
    expected = ensemble(car, cars, SPAN, start, **options)
    folder = tmp_path / "kept"

    def interrupted(common, some, *given):
        if some.first == 14:
            raise KeyboardInterrupt
        return chunk.found_of(common, some, *given)

    with monkeypatch.context() as patched:
        patched.setattr(gather, "found_of", interrupted)
        with pytest.raises(KeyboardInterrupt):
            ensemble(car, cars, SPAN, start, kept=folder, **options)
    monkeypatch.setattr(cutting, "_MOST", 20)
    monkeypatch.setattr(cutting, "_FEWEST", 20)
    shutil.copytree(folder, tmp_path / "again")
    assert ensemble(car, cars, SPAN, start, kept=folder, **options).identical(expected)
    assert done == [(14, 34), (34, 54), (54, 60)]
    again = {"kept": tmp_path / "again", "cluster": client}
    same(ensemble(car, cars, SPAN, start, **options, **again), expected)
    # a complete folder needs neither a simulation nor a cluster
    whole_one = {"kept": str(folder), "cluster": "127.0.0.1:1"}
    same(ensemble(car, cars, SPAN, start, **options, **whole_one), expected)
    assert len(done) == 3


def test_what_is_left_between_what_overlaps():
    assert cutting.left_of(50, [(30, 40), (5, 12), (7, 20), (35, 38)]) == [
        (0, 5),
        (20, 30),
        (40, 50),
    ]
    assert cutting.left_of(20, [(0, 7), (0, 20)]) == []
    assert cutting.left_of(3, []) == [(0, 3)]


OTHERS = [
    {"variants": {"damper_rate": [1e3, 3e3]}},
    {"variants": {"spring_rate": [1e3, 2e3]}},
    {"t_span": (0.0, 0.6)},
    {"inputs": {"road_height": 0.01}},
    {"t_eval": [0.0, 0.5]},
    {"reductions": {"camber": "min"}},
    {"signals": ["camber"]},
    {"rtol": 1e-5},
    {"max_steps": 99},
    {"stiff": None},
    {"y0": [0.1, 0.0, 0.0, 0.0]},
    {"model": Model("offset_strut_car"), "y0": [1.6, 0.0, 0.0, 93.0]},
]


def test_a_folder_of_another_ensemble_is_refused(car, tmp_path, start, refused):
    given = {
        "model": car, "variants": {"damper_rate": [1e3, 2e3]}, "t_span": SPAN, "y0": start,
        "kept": tmp_path,
    }  # fmt: skip
    ensemble(**given)
    ensemble(**given, threads=1, lanes=2)  # how it is done does not matter
    for other in OTHERS:
        with refused(InputError):
            ensemble(**given | other)


def test_versions_are_part_of_what_is_kept(car, tmp_path, monkeypatch, refused):
    ensemble(car, None, SPAN, kept=tmp_path)
    identity = import_module("kintrafo.ensembles.chunks.identity")
    monkeypatch.setattr(identity, "versions", lambda: {"NumPy": "0.1"})
    refused(InputError, lambda: ensemble(car, None, SPAN, kept=tmp_path))


def test_a_folder_of_something_else_is_refused(car, tmp_path, refused):
    (tmp_path / "mine").write_text("x", encoding="utf-8")
    refused(
        InputError,
        lambda: ensemble(car, None, SPAN, kept=tmp_path),
        lambda: ensemble(car, None, SPAN, kept=tmp_path / "mine"),
    )
    assert [entry.name for entry in tmp_path.iterdir()] == ["mine"]
    for text in ("", "[]", "{}"[:1]):
        (tmp_path / "ensemble.json").write_text(text, encoding="utf-8")
        with refused(InputError):
            ensemble(car, None, SPAN, kept=tmp_path)


@pytest.mark.usefixtures("small")
def test_what_is_damaged_is_done_again(car, start, tmp_path, done):
    cars = some_cars(28)
    expected = ensemble(car, cars, SPAN, start, kept=tmp_path, **KEPT)
    rng = np.random.default_rng(3)
    files = sorted(tmp_path.glob("*.npz"))
    assert len(files) == 4
    files[1].write_bytes(files[1].read_bytes()[:-300])  # cut off
    done.clear()
    with pytest.warns(RuntimeWarning, match="Systems 7 to 14 are simulated again"):
        same(ensemble(car, cars, SPAN, start, kept=tmp_path, **KEPT), expected)
    assert done == [(7, 14)]
    shutil.copy(files[3], files[2])  # of another place
    with pytest.warns(RuntimeWarning, match="Systems 14 to"):
        same(ensemble(car, cars, SPAN, start, kept=tmp_path, **KEPT), expected)
    content = files[0].read_bytes()
    for place in rng.integers(0, len(content), 30).tolist():
        changed = bytearray(content)
        changed[place] ^= 1 << int(rng.integers(8))
        files[0].write_bytes(changed)
        with import_module("warnings").catch_warnings():  # bits that say nothing are no damage
            import_module("warnings").simplefilter("ignore", RuntimeWarning)
            same(ensemble(car, cars, SPAN, start, kept=tmp_path, **KEPT), expected)


# -- arguments ------------------------------------------------------------------------------------


WRONG = [
    {"cluster": 0},
    {"cluster": -1},
    {"cluster": 1.5},
    {"cluster": np.nan},
    {"cluster": True},
    {"cluster": 3, "threads": 2},
    {"cluster": ""},
    {"cluster": "here"},
    {"cluster": "tcp://here"},
    {"cluster": ["127.0.0.1:8786"]},
    {"cluster": Path("x")},
    {"cluster": "127.0.0.1:8786", "threads": 2},
    {"kept": 3},
    {"kept": ["x"]},
    {"kept": "x\0y"},
    {"cluster": "127.0.0.1:1"},
    {"cluster": "tls://127.0.0.1:1"},
    {"cluster": "127.0.0.1:99999"},
]


@pytest.mark.parametrize("given", WRONG, ids=lambda value: str(value)[:40])
def test_wrong_arguments(car, given, refused, monkeypatch):
    monkeypatch.setattr(workers, "_PATIENCE", 0.1)
    refused(InputError, lambda: ensemble(car, None, SPAN, **given))


def test_clients_that_cannot_be_used(client, car):
    closed = distributed.Client(client.scheduler.address, set_as_default=False)
    closed.close()
    for cluster in (closed, distributed.Client, client.cluster):
        with pytest.raises(InputError, match=r"dask\.distributed\.Client"):
            ensemble(car, None, SPAN, cluster=cluster)


def test_a_scheduler_without_workers(car, monkeypatch):
    monkeypatch.setattr(workers, "_PATIENCE", 0.3)
    there = {"n_workers": 0, "processes": False, "dashboard_address": "127.0.0.1:0"}
    with (
        distributed.LocalCluster(**there) as cluster,
        distributed.Client(cluster, set_as_default=False) as client,
        pytest.raises(InputError, match=r" 0\.3 s.*: dask worker"),
    ):
        ensemble(car, None, SPAN, cluster=client)


def test_a_dead_address_is_reported_at_once(car):
    begun = time.monotonic()
    with pytest.raises(InputError, match=": dask scheduler"):
        ensemble(car, None, SPAN, cluster="tcp://127.0.0.1:1")
    assert time.monotonic() - begun < workers._PATIENCE / 2.0


def test_what_listens_and_is_no_scheduler(car, monkeypatch):
    monkeypatch.setattr(workers, "_PATIENCE", 0.3)
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]
        with pytest.raises(InputError, match=r"127\.0\.0\.1"):
            ensemble(car, None, SPAN, cluster=f"127.0.0.1:{port}")


@pytest.mark.parametrize("script", ["x", "if __name__ == '__main__': x", None])
def test_local_workers_that_cannot_begin(car, monkeypatch, tmp_path, script, refused):
    """The error follows from whether workers could read the script, and from Dask's error."""
    main = SimpleNamespace()
    if script:
        main.__file__ = str(tmp_path / "script.py")
        Path(main.__file__).write_text(script)
    monkeypatch.setitem(sys.modules, "__main__", main)

    def begin(**_):
        raise RuntimeError from ImportError("no such module")

    monkeypatch.setattr(distributed, "LocalCluster", begin)
    refused(InputError, lambda: ensemble(car, None, SPAN, cluster=1))


def test_a_worker_that_reads_the_script(monkeypatch):
    monkeypatch.setattr(workers, "current_process", lambda: SimpleNamespace(_inheriting=True))
    assert "only below if __name__" in workers._why_not(RuntimeError())


def test_a_missing_package(car, monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    for cluster in (1, "127.0.0.1:8786"):
        with pytest.raises(MissingPackageError, match=r"kintrafo\[cluster\]"):
            ensemble(car, None, SPAN, cluster=cluster)


def test_workers_with_other_versions(client, car, monkeypatch):
    real = versions.versions()
    monkeypatch.setattr(versions, "version", lambda _: "9.9")
    monkeypatch.setattr(versions, "_digest", lambda: "")
    versions.versions.cache_clear()
    words = f"tcp://.* {real['kintrafo']} .* 9.9, "
    try:
        with pytest.raises(InputError, match=words):
            ensemble(car, None, SPAN, cluster=client)
    finally:
        versions.versions.cache_clear()


def test_a_worker_that_came_later_with_other_versions(car, monkeypatch):
    real = chunk.common_of
    monkeypatch.setattr(
        gather, "common_of", lambda found: replace(real(found), versions={"kintrafo": "9.9"})
    )
    monkeypatch.setattr(
        ensembles, "checkpoint_in", lambda *_: SimpleNamespace(found=list, keep=None)
    )
    with pytest.raises(InputError, match=r"kintrafo 9\.9"):
        ensemble(car, None, SPAN, kept="here")


def test_a_worker_that_cannot_load_it():
    shown = workers._other(ModuleNotFoundError("No module named 'kintrafo'"))
    assert shown.startswith("cannot load this version of kintrafo (ModuleNotFoundError: No module")
    assert not workers._other(ConnectionResetError("it was lost"))  # what it did is done again


def test_a_folder_where_a_file_should_be(car, tmp_path, refused):
    ensemble(car, None, SPAN, kept=tmp_path)
    (tmp_path / "systems-000000000-000000001.npz").unlink()
    (tmp_path / "systems-000000000-000000001.npz").mkdir()
    refused(InputError, lambda: ensemble(car, None, SPAN, kept=tmp_path))


def test_what_is_kept_can_be_read(car, tmp_path):
    """As any archive of NumPy, and a list of digests."""
    found = ensemble(car, {"damper_rate": [1e3, 2e3]}, SPAN, kept=tmp_path)
    with np.load(tmp_path / "systems-000000000-000000002.npz", allow_pickle=False) as kept:
        assert kept["outcome finals"].tolist() == found["final_state"].values.tolist()
    assert "equations" in json.loads((tmp_path / "ensemble.json").read_bytes())
