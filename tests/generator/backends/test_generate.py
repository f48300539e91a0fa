"""Deriving again gives the same bytes, anywhere and at any time: those in generated/."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from kintrafo import generated
from kintrafo.generator.backends.files import shared_files
from kintrafo.generator.mechanisms import MODELS

COMMITTED = Path(generated.__file__).parent


def read(folder):
    """Return the bytes of all emitted files below a folder, without what a build adds."""
    endings = {".py", ".pyx", ".pyi", ".json", ".md", ".c", ".h"}
    files = (path for path in folder.rglob("*") if path.suffix in endings)
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in files}


def differing(ones, others):
    """Return the files that differ, with the first line that does."""
    result = {}
    for name in sorted({*ones, *others}):
        one, other = (files.get(name, b"").split(b"\n") for files in (ones, others))
        if one != other:
            pairs = zip([*one, b""], [*other, b""], strict=False)
            number, lines = next((i, p) for i, p in enumerate(pairs, 1) if p[0] != p[1])
            result[name] = f"line {number}: {lines[0]!r} and {lines[1]!r}"
    return result


def encoded(texts):
    return {name: text.encode() for name, text in texts.items()}


def test_every_model_is_committed_and_nothing_else():
    """Contents of the files are compared where they are generated again: ``make generate``."""
    names = {model.name for model in MODELS}
    found = read(COMMITTED)
    assert {Path(file).stem for file in found if file.endswith(".json")} == names
    shared = encoded(shared_files())
    assert differing(shared, {name: found.get(name, b"") for name in shared}) == {}
    of_models = found.keys() - shared.keys()
    assert {n for n in of_models if not any(model in n for model in names)} == set()


# One in space with all laws of force, one in a plane with telescopes, and the smallest: a fifth of
# what all take, which `make generate` derives and the check of a change compares.
ELSEWHERE = ["four_bar", "excavator_lifting", "double_wishbone"]

IN_ANOTHER_ORDER = """
import sys
from pathlib import Path
from kintrafo.generator.backends.files import project_files
from kintrafo.generator.mechanisms import MODELS
from kintrafo.generator.equations.outputs import generate

wanted = sys.argv[1:]
for model in sorted((m for m in MODELS if m.name in wanted), key=lambda m: wanted.index(m.name)):
    for name, text in project_files(generate(model)).items():
        target = Path(name)
        target.parent.mkdir(exist_ok=True)
        target.write_text(text, encoding="utf-8", newline="\\n")
"""


@pytest.mark.slow
def test_deriving_in_another_process_gives_the_committed_files(tmp_path):
    """If this fails, run ``make generate``.

    With other hashes sets come in another order; the locale and the time zone matter no more.

    Nor does what is left in memory of the models before (SymPy caches a lot): here they come in
    another order, the smallest first.
    """
    environment = {**os.environ, "PYTHONHASHSEED": "4242", "LC_ALL": "C", "TZ": "Asia/Tokyo"}
    done = subprocess.run(
        [sys.executable, "-c", IN_ANOTHER_ORDER, *ELSEWHERE],
        env=environment,
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=600,  # against a hang only: half a minute on a machine with nothing else to do
        check=False,
    )
    assert done.returncode == 0, done.stderr
    found, committed = read(tmp_path), read(COMMITTED)
    assert {Path(name).stem for name in found if name.endswith(".json")} == {*ELSEWHERE}
    assert differing(found, {name: committed.get(name, b"") for name in found}) == {}


def test_no_trace_of_machine_or_day():
    """The emitted files contain no dates and no paths, and all lines end in the same way."""
    for name, text in read(COMMITTED).items():
        assert not re.search(rb"\b20\d\d-\d\d-\d\d\b|/(home|tmp|work|Users)/", text), name
        assert b"\r" not in text, name
        assert text.endswith(b"\n"), name
        text.decode("utf-8")


def test_difference_is_reported():
    same, other = {"a": b"1\n2\n", "b": b"x\n"}, {"a": b"1\n3\n", "b": b"x\n"}
    assert differing(same, other) == {"a": "line 2: b'2' and b'3'"}
    assert list(differing(same, {"a": b"1\n2\n"})) == ["b"]
