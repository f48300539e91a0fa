"""Files of the cache are executed: none is used from a folder in which others can write."""

import os
import pickle
import sys
from types import ModuleType

import kintrafo
import numpy as np
import pytest
from kintrafo.core import folders, written
from kintrafo.generator.equations import outputs
from kintrafo.generator.mechanisms.four_bar import FOUR_BAR
from kintrafo.generator.planning.proposal import model_of
from kintrafo.simulation.lanes import own
from kintrafo.systems.compile.shipped import shipped

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="permissions of POSIX")

STATE = [[0.2, 1.0]]
ANOTHER = 54321


@pytest.fixture(scope="module")
def derived():
    return outputs.generate(model_of(FOUR_BAR))


@pytest.fixture
def cache(derived, tmp_path, monkeypatch):
    """A cache with a compiled mechanism, of which nothing is loaded yet."""
    monkeypatch.setattr(outputs, "generate", lambda _, **__: derived)
    compiled(tmp_path / "cache")
    forget()
    yield tmp_path / "cache"
    forget()


def compiled(folder):
    return kintrafo.compile(FOUR_BAR, folder=folder, backend="numpy")


def forget():
    for name in [name for name in sys.modules if name.startswith("kintrafo_four_bar_")]:
        del sys.modules[name]


def places(cache):
    """Return the cache, the folder of a mechanism, and a file in it."""
    (target,) = cache.iterdir()
    return {"cache": cache, "mechanism": target, "file": target / "four_bar.py"}


def given_away(path, monkeypatch):
    """Let a file or folder belong to another user; an ordinary user becomes another one."""
    if os.geteuid() == 0:
        os.lchown(path, ANOTHER, ANOTHER)
    else:
        number = os.geteuid() + 1
        monkeypatch.setattr(os, "geteuid", lambda: number)


def for_a_group(path):
    if os.geteuid() == 0:
        os.chown(path, 0, ANOTHER)
    elif folders._by_owner_alone(path.stat()):
        pytest.skip("the user has a group of his own, which may write")
    path.chmod(path.stat().st_mode | 0o020)


@pytest.mark.parametrize("where", ["cache", "mechanism", "file"])
@pytest.mark.parametrize("how", ["owner", "all", "group", "sticky"])
def test_what_others_can_write_to_is_refused(where, how, cache, monkeypatch):
    path = places(cache)[where]
    if how == "owner":
        given_away(path, monkeypatch)
    elif how == "group":
        for_a_group(path)
    else:
        path.chmod(0o1777 if how == "sticky" else path.stat().st_mode | 0o002)
    with pytest.raises(kintrafo.InputError) as refused:
        compiled(cache)
    message = str(refused.value)
    assert str(path) in message or how == "owner"
    assert "belongs to user" in message if how == "owner" else "chmod go-w" in message
    assert "KINTRAFO_CACHE" in message
    assert not any(name.startswith("kintrafo_four_bar_") for name in sys.modules)


@pytest.mark.skipif(sys.platform == "win32" or os.geteuid() != 0, reason="needs another user")
def test_a_link_of_somebody_else_is_refused(cache, tmp_path):
    """It may lead to a folder of the user's own that was not meant."""
    link = tmp_path / "link"
    link.symlink_to(cache)
    compiled(link)
    forget()
    os.lchown(link, ANOTHER, ANOTHER)
    with pytest.raises(kintrafo.InputError, match=f"link belongs to user {ANOTHER}"):
        compiled(link)


@pytest.mark.parametrize("mask", [0o000, 0o002, 0o022, 0o077])
def test_no_umask_makes_a_cache_that_is_refused(mask, derived, tmp_path, monkeypatch):
    monkeypatch.setattr(outputs, "generate", lambda _, **__: derived)
    before = os.umask(mask)
    try:
        for _ in range(2):
            forget()
            compiled(tmp_path / "above" / "cache")
    finally:
        os.umask(before)
        forget()


def test_a_group_with_one_member_is_that_member(monkeypatch):
    """As many systems have it by default, with a umask that lets the group write."""
    import grp
    import pwd

    def known(members, name="ann"):
        monkeypatch.setattr(pwd, "getpwuid", lambda _: pwd.struct_passwd(("ann", *"xxxxxx")))
        monkeypatch.setattr(grp, "getgrgid", lambda _: grp.struct_group((name, "", 7, members)))

    def alone(mode):
        return folders._by_owner_alone(os.stat_result((mode, *[0] * 9)))

    known([])
    assert alone(0o775)
    assert not alone(0o777)
    known(["ann"])
    assert alone(0o775)
    known(["ann", "bob"])
    assert not alone(0o775)
    known([], "staff")
    assert not alone(0o775)


def test_what_a_pickle_refers_to_is_refused(cache, monkeypatch):
    model = kintrafo.System(compiled(cache))
    text = pickle.dumps(model)
    forget()
    given_away(places(cache)["file"], monkeypatch)
    with pytest.raises(kintrafo.InputError, match="belongs to user"):
        pickle.loads(text)


def test_another_process_unpacks_its_own(cache, tmp_path, monkeypatch):
    """Of equations that another user has compiled, the files are sent along."""
    equations = compiled(cache)
    sent, expected = shipped(equations), equations.rhs(STATE)
    forget()
    cache.chmod(0o777)
    monkeypatch.setenv("KINTRAFO_CACHE", str(tmp_path / "own"))
    found = sent.module()
    assert str(tmp_path / "own") in str(found.__file__)
    np.testing.assert_array_equal(found.rhs(STATE), expected)


def test_equations_in_lanes_are_refused_alike(cache, monkeypatch):
    target = places(cache)["mechanism"]
    target.chmod(0o777)
    equations = ModuleType("kintrafo_four_bar_x.four_bar")
    equations.NAME, equations.__file__ = "four_bar", str(target / "four_bar.py")
    monkeypatch.setattr(own, "damage", lambda _: "")
    monkeypatch.setattr(own, "fingerprint", lambda *_, **__: "0")
    (cache / "four_bar_lanes_4-0").mkdir(mode=0o700)
    own.library_of(equations, 4)
    (cache / "four_bar_lanes_4-0").chmod(0o777)
    with pytest.raises(kintrafo.InputError, match="can be written to by others"):
        own.library_of(equations, 4)


def test_a_register_of_written_files_that_others_can_write_to_counts_for_nothing(
    tmp_path, monkeypatch
):
    monkeypatch.setenv("KINTRAFO_CACHE", str(tmp_path / "cache"))
    file = tmp_path / "file"
    file.write_text("text")
    written.note(file, file)
    assert written.known(file)
    (tmp_path / "cache").chmod(0o777)
    assert not written.known(file)
