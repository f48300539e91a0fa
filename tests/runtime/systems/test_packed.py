"""Compiled mechanisms in archives: used for their structure and sources only, never otherwise."""

from __future__ import annotations

from typing import TYPE_CHECKING

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

if TYPE_CHECKING:
    from pathlib import Path
    from types import ModuleType

pytestmark = pytest.mark.skipif(find_compiler() is None, reason="no compiler")
NAME, STRUCTURE = "four_bar", "four bars"


@pytest.fixture
def archive(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return the archive of a mechanism, the only one that is found; the cache is empty."""
    path = packed.pack(kintrafo.compile(FOUR_BAR), STRUCTURE, tmp_path)
    monkeypatch.setattr(packed, "files", lambda _: tmp_path)
    monkeypatch.setenv("KINTRAFO_CACHE", str(tmp_path / "cache"))
    return path


def found(structure: str = STRUCTURE) -> ModuleType | None:
    return packed_mechanism(NAME, structure, lambda: model_of(FOUR_BAR))


def test_it_is_what_was_compiled(archive: Path) -> None:
    equations = found()
    assert equations is not None
    assert equations.__name__.partition(".")[0] == f"kintrafo_{archive.stem.replace('-', '_')}"
    states = [[0.2, 1.0], [0.3, -1.0]]
    np.testing.assert_array_equal(equations.rhs(states), generated.rhs(states))
    derived_again(equations)  # for exports, by its declaration


def test_a_changed_structure_or_source_has_no_archive(
    archive: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert found("four bars, one of them longer") is None
    assert packed_mechanism("five_bar", STRUCTURE, lambda: model_of(FOUR_BAR)) is None
    monkeypatch.setattr(packed, "sources_hash", lambda: "that of an edited file")
    assert found() is None
    assert not (archive.parent / "cache").exists()


def test_a_damaged_file_in_the_cache_is_unpacked_again(archive: Path) -> None:
    assert found() is not None
    folder = archive.parent / "cache" / archive.stem
    (folder / "four_bar.json").write_text("{}")
    name = f"kintrafo_{archive.stem.replace('-', '_')}"
    forget([name, f"{name}._four_bar", f"{name}.four_bar"])
    again = found()
    assert again is not None
    assert (folder / "four_bar.json").stat().st_size > 1000


def test_python_without_its_module_for_archives_has_none(
    archive: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(packed, "find_spec", lambda _: None)
    assert archive.is_file()
    assert found() is None
