"""The cache of compiled mechanisms: it finds any damage, heals, and deletes nothing of others."""

import json
import multiprocessing
import os
import pickle
import shutil
import sys
import threading
import warnings
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from pathlib import Path

import kintrafo
import numpy as np
import pytest
from kintrafo.generator.equations import outputs
from kintrafo.generator.mechanisms.four_bar import FOUR_BAR
from kintrafo.generator.planning.proposal import model_of
from kintrafo.systems.compile import build as own_build
from kintrafo.systems.compile.cache import _MARK, _MARKED, appearing, damage, seal
from kintrafo.systems.compile.compiler import Compiler, find_compiler
from kintrafo.systems.compile.loader import load
from support import work_on_caches

STATES = np.random.default_rng(3).normal(size=(5, 2)) * [0.3, 2.0]
needs_compiler = pytest.mark.skipif(find_compiler() is None, reason="no C compiler")


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """The equations of a mechanism, their folder, and results of the right-hand side."""
    folder, derived = tmp_path_factory.mktemp("made"), outputs.generate(model_of(FOUR_BAR))
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(outputs, "generate", lambda _, **__: derived)
        module = kintrafo.compile(FOUR_BAR, folder=folder)
    return derived, next(folder.iterdir()), module.rhs(STATES)


@pytest.fixture
def cache(made, tmp_path, monkeypatch):
    """A copy of that folder; nothing is derived or compiled a second time."""
    derived, target, _ = made
    forget()
    monkeypatch.setattr(outputs, "generate", lambda _, **__: derived)
    monkeypatch.setattr(
        Compiler, "build", lambda _, __, library, *___: shutil.copy(target / library.name, library)
    )
    shutil.copytree(target, tmp_path / "cache" / target.name)
    yield tmp_path / "cache"
    forget()


def forget():
    for name in [name for name in sys.modules if name.startswith("kintrafo_four_bar_")]:
        del sys.modules[name]


def check_healing(cache, made):
    """It is reported and built again, and what comes out is what a fresh one computes."""
    (target,) = cache.iterdir()
    with pytest.warns(RuntimeWarning, match="damaged, and are built again"):
        module = kintrafo.compile(FOUR_BAR, folder=cache)
    np.testing.assert_array_equal(module.rhs(STATES), made[2])
    assert not damage(target)
    forget()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        np.testing.assert_array_equal(kintrafo.compile(FOUR_BAR, folder=cache).rhs(STATES), made[2])
    assert list(cache.iterdir()) == [target]


def cut(path):
    content = path.read_bytes()
    path.write_bytes(content[: len(content) // 2])


def flip(path):
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1
    path.write_bytes(content)


def empty(path):
    path.write_bytes(b"")


def remove(path):
    path.unlink()


def no_folder_inside(path):
    """A link in the place of a file has no target."""
    path.unlink()
    path.symlink_to("nowhere")


WAYS = (cut, flip, empty, remove, no_folder_inside)


def library_of(folder):
    """Return what computes: the shared library, or the NumPy functions where there is none."""
    return next(iter(folder.glob("lib*.so")), *folder.glob("_*[!_].py"))


def empty_folder(folder):
    shutil.rmtree(folder)
    folder.mkdir()


def manifest_of_another(folder):
    path = folder / "manifest.json"
    found = json.loads(path.read_text())
    path.write_text(json.dumps({**found, "folder": "slider_crank-0123456789abcdef"}))


def manifest_without_sense(folder):
    (folder / "manifest.json").write_text('{"files": {"a": 3}, "folder": [')


class TestHealing:
    @pytest.mark.parametrize("way", WAYS, ids=lambda way: way.__name__)
    def test_of_what_computes(self, cache, made, way):
        """A library that is cut off ends the interpreter where it is loaded: it is not."""
        way(library_of(*cache.iterdir()))
        check_healing(cache, made)

    @pytest.mark.parametrize("name", ["four_bar.py", "__init__.py", "manifest.json"])
    def test_of_a_text_that_is_cut_off(self, cache, made, name):
        (target,) = cache.iterdir()
        cut(target / name)
        check_healing(cache, made)

    @pytest.mark.parametrize(
        "way",
        [empty_folder, manifest_of_another, manifest_without_sense],
        ids=lambda way: way.__name__,
    )
    def test_of_a_folder(self, cache, made, way):
        way(*cache.iterdir())
        check_healing(cache, made)

    def test_files_of_others_stay(self, cache, made):
        (target,) = cache.iterdir()
        (target / "notes.txt").write_text("mine")
        kintrafo.compile(FOUR_BAR, folder=cache)  # no damage
        forget()
        remove(target / "four_bar.py")
        check_healing(cache, made)
        assert (target / "notes.txt").read_text() == "mine"

    def test_compiled_bytes_beside_it_are_not_read(self, cache, made):
        """Python trusts a .pyc by the date of its source; here nothing is run unseen."""
        (target,) = cache.iterdir()
        wrong = target / "wrong.py"
        wrong.write_text("raise SystemExit('the wrong bytes were run')")
        import py_compile

        source = target / "four_bar.py"
        os.utime(wrong, ns=(source.stat().st_atime_ns, source.stat().st_mtime_ns))
        padded = wrong.read_text() + "\n" * (source.stat().st_size - wrong.stat().st_size)
        wrong.write_text(padded)
        os.utime(wrong, ns=(source.stat().st_atime_ns, source.stat().st_mtime_ns))
        name = sys.implementation.cache_tag
        py_compile.compile(
            str(wrong), cfile=str(target / "__pycache__" / f"four_bar.{name}.pyc"), doraise=True
        )
        module = kintrafo.compile(FOUR_BAR, folder=cache)
        np.testing.assert_array_equal(module.rhs(STATES), made[2])

    def test_what_cannot_be_healed_is_reported(self, cache):
        """A folder has the name of a file of the cache: nothing in it is removed."""
        (target,) = cache.iterdir()
        (target / "four_bar.py").unlink()
        (target / "four_bar.py").mkdir()
        (target / "four_bar.py" / "mine").write_text("mine")
        words = "KINTRAFO_CACHE"
        with pytest.warns(RuntimeWarning), pytest.raises(kintrafo.InputError, match=words):
            kintrafo.compile(FOUR_BAR, folder=cache)
        assert (target / "four_bar.py" / "mine").read_text() == "mine"
        assert list(cache.iterdir()) == [target]

    def test_a_file_in_the_place_of_the_folder(self, cache):
        (target,) = cache.iterdir()
        shutil.rmtree(target)
        target.write_text("mine")
        with pytest.warns(RuntimeWarning), pytest.raises(kintrafo.InputError, match="written"):
            kintrafo.compile(FOUR_BAR, folder=cache)
        assert target.read_text() == "mine"

    def test_damage_after_it_was_loaded(self, cache, made):
        """The loaded module remains in use; another process compiles it again."""
        module = kintrafo.compile(FOUR_BAR, folder=cache)
        (target,) = cache.iterdir()
        cut(target / "four_bar.py")
        with pytest.warns(RuntimeWarning, match="built again"):
            assert kintrafo.compile(FOUR_BAR, folder=cache) is module
        np.testing.assert_array_equal(module.rhs(STATES), made[2])

    def test_unpickling_what_is_damaged(self, cache):
        pickled = pickle.dumps(kintrafo.System(kintrafo.compile(FOUR_BAR, folder=cache)))
        (target,) = cache.iterdir()
        forget()
        cut(target / "four_bar.py")
        with pytest.raises(kintrafo.InputError, match="Compile the mechanism again"):
            pickle.loads(pickled)

    @needs_compiler
    def test_a_library_that_the_system_does_not_load(self, cache):
        """Whole, and still not for this machine."""
        (target,) = cache.iterdir()
        library_of(target).write_bytes(b"not for this machine")
        (target / "manifest.json").unlink()
        seal(target, target.name)
        with pytest.raises(kintrafo.InputError, match="cannot be loaded"):
            kintrafo.compile(FOUR_BAR, folder=cache)
        assert not [name for name in sys.modules if name.startswith("kintrafo_four_bar_")]

    def test_threads_get_one_module(self, cache):
        (target,) = cache.iterdir()
        with ThreadPoolExecutor(4) as pool:
            found = list(pool.map(load, [target] * 8))
        assert len(set(map(id, found))) == 1

    @pytest.mark.skipif(sys.platform == "win32", reason="no locks")
    def test_a_second_process_waits_for_the_first(self, cache, tmp_path):
        """Threads do as processes: each opens the file of the lock itself."""
        folder, reported = tmp_path / "new", []
        begins, waits = threading.Event(), threading.Event()

        def first(text):
            reported.append(text)
            begins.set()
            assert waits.wait(60.0)

        def second(text):
            reported.append(text)
            waits.set()

        with ThreadPoolExecutor(2) as pool:
            one = pool.submit(kintrafo.compile, FOUR_BAR, folder=folder, progress=first)
            assert begins.wait(60.0)
            other = pool.submit(kintrafo.compile, FOUR_BAR, folder=folder, progress=second)
            assert one.result() is other.result()
        assert sum("writing" in text for text in reported) == 1
        assert sum("waiting for another process" in text for text in reported) == 1
        assert [path.name for path in folder.iterdir()] == [path.name for path in cache.iterdir()]


class TestFullDisk:
    def test_it_is_reported_and_nothing_is_left(self, tmp_path, cache, monkeypatch):
        if not Path("/dev/full").exists():
            pytest.skip("no /dev/full on this system")
        del cache

        def build(_derived, folder, _compiler, name, report):
            assert name
            assert report
            (folder / "four_bar.c").symlink_to("/dev/full")
            (folder / "four_bar.c").write_text("x" * 100_000)

        monkeypatch.setattr(own_build, "build", build)
        with pytest.raises(kintrafo.InputError, match=r"No space left.*KINTRAFO_CACHE"):
            kintrafo.compile(FOUR_BAR, folder=tmp_path / "full")
        assert list((tmp_path / "full").iterdir()) == []


class TestLeftovers:
    """Of processes that were killed: they have a mark, and nothing else is touched."""

    NAME = ".four_bar-0123456789abcdef-x1y2z3"

    def fill(self, cache):
        with appearing(cache / "four_bar-0123456789abcdef") as temporary:
            assert (temporary / _MARK).read_bytes() == _MARKED

    @pytest.mark.parametrize("mark", [None, b"", b"another program's"])
    def test_what_only_looks_like_one_stays(self, tmp_path, mark):
        folder = work_on_caches.old(tmp_path / self.NAME, mark)
        self.fill(tmp_path)
        assert (folder / "kept.txt").read_text() == "a year of work"

    def test_a_link_to_one_is_not_followed(self, tmp_path):
        real = work_on_caches.old(tmp_path / "elsewhere" / "x", _MARKED)
        (tmp_path / "cache").mkdir()
        (tmp_path / "cache" / self.NAME).symlink_to(real)
        self.fill(tmp_path / "cache")
        assert (real / "kept.txt").exists()

    def test_a_marked_one_goes_when_it_is_old(self, tmp_path):
        old = work_on_caches.old(tmp_path / self.NAME, _MARKED)
        young = work_on_caches.old(tmp_path / f"{self.NAME}2", _MARKED)
        os.utime(young / _MARK)
        self.fill(tmp_path)
        assert not old.exists()
        assert young.exists()

    def test_many_processes_at_a_time(self, tmp_path):
        """Each removes what the others remove, fill and move: none has an error."""
        context = multiprocessing.get_context("spawn")
        with ProcessPoolExecutor(2, mp_context=context) as pool:
            list(pool.map(work_on_caches.stress, [tmp_path] * 2, [1, 2]))
        assert sorted(p.name for p in tmp_path.iterdir()) == sorted(
            f"m-{index:016x}" for index in range(5)
        )
