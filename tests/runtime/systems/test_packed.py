"""Compiled mechanisms in archives: used for their structure and sources only, never otherwise."""

import sys
import zipfile
from pathlib import Path

import kintrafo
import numpy as np
import pytest
from kintrafo.generated import four_bar as generated
from kintrafo.generator.mechanisms.four_bar import FOUR_BAR
from kintrafo.generator.planning.proposal import model_of
from kintrafo.systems.compile import packed
from kintrafo.systems.compile.build import derived_again, packed_mechanism
from kintrafo.systems.compile.compiler import find_compiler
from kintrafo.systems.compile.loader import forget

pytestmark = pytest.mark.skipif(find_compiler() is None, reason="no compiler")
NAME, STRUCTURE = "four_bar", "four bars"


@pytest.fixture
def archive(tmp_path, monkeypatch):
    """Return the only archive, that of a four-bar linkage, beside an empty cache."""
    path = packed.pack(kintrafo.compile(FOUR_BAR), STRUCTURE, tmp_path)
    monkeypatch.setattr(packed, "files", lambda _: tmp_path)
    monkeypatch.setenv("KINTRAFO_CACHE", str(tmp_path / "cache"))
    yield path
    own = [k for k, m in sys.modules.items() if str(tmp_path) in str(getattr(m, "__file__", ""))]
    forget(own)


def found(structure=STRUCTURE):
    return packed_mechanism(NAME, structure, lambda: model_of(FOUR_BAR))


def folder_of(equations):
    return Path(str(equations.__file__)).parent


def test_it_is_what_was_compiled(archive):
    equations = found()
    assert folder_of(equations).parent == archive.parent / "cache"
    states = [[0.2, 1.0], [0.3, -1.0]]
    np.testing.assert_array_equal(equations.rhs(states), generated.rhs(states))
    derived_again(equations)  # exports derive the equations from the declaration


def test_a_changed_structure_or_source_has_no_archive(archive, monkeypatch):
    assert found("four bars, one of them longer") is None
    assert packed_mechanism("five_bar", STRUCTURE, lambda: model_of(FOUR_BAR)) is None
    monkeypatch.setattr(packed, "sources_hash", lambda: "that of an edited file")
    assert found() is None
    assert not (archive.parent / "cache").exists()


def test_a_damaged_file_in_the_cache_is_unpacked_again(archive):
    equations = found()
    folder = archive.parent / "cache" / folder_of(equations).name
    (folder / "four_bar.json").write_text("{}")
    package = equations.__name__.partition(".")[0]
    forget([name for name in sys.modules if name.partition(".")[0] == package])
    assert found() is not None
    assert (folder / "four_bar.json").stat().st_size > 1000


def test_archives_of_several_versions_share_a_cache(archive):
    """Files without influence on the key, such as options of the compiler, may differ."""
    first = folder_of(found())
    rewritten(archive, {"another_version.c": b"int another_version;"})
    second = folder_of(found())
    assert not (first / "another_version.c").exists()
    assert (second / "another_version.c").exists()


def test_a_cut_archive_is_refused(archive):
    archive.write_bytes(archive.read_bytes()[:2000])
    with pytest.raises(kintrafo.InputError, match=r"(?s)four_bar-\w+\.zip.* Install kintrafo"):
        found()
    assert [path for path in (archive.parent / "cache").iterdir() if path.is_dir()] == []


@pytest.mark.parametrize("name", ["../outside.py", "folder/inside.py", "/outside.py", ".."])
def test_files_of_other_folders_are_refused(archive, name):
    rewritten(archive, {name: b""})
    with pytest.raises(kintrafo.InputError, match="another folder"):
        found()
    assert list(archive.parent.rglob("*side.py")) == []


def rewritten(archive, more):
    """Add files to an archive."""
    with zipfile.ZipFile(archive, "a", zipfile.ZIP_LZMA) as opened:
        for name, content in more.items():
            opened.writestr(name, content)


def test_python_without_its_module_for_archives_has_none(archive, monkeypatch):
    monkeypatch.setattr(packed, "find_spec", lambda _: None)
    assert archive.is_file()
    assert found() is None
