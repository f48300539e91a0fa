"""Checkpoints of an ensemble are read unchanged, or not at all."""

import io
import warnings
from importlib import import_module

import numpy as np
import pytest
from kintrafo import Model, ensemble
from kintrafo.ensembles.chunks import checkpoint, cutting
from kintrafo.simulation.lanes import library

pytestmark = pytest.mark.skipif(not library.widths(), reason="built without lanes")

ensembles = import_module("kintrafo.ensembles.ensemble")
GIVEN = {
    "signals": ["camber"],
    "reductions": {"camber": ["max", ("percentile", 90.0)], "toe": [("psd", 8)]},
    "t_eval": np.linspace(0.0, 0.01, 8),
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Return what reads the folder of an ensemble: six cars, in files of two."""
    found = []
    with pytest.MonkeyPatch.context() as patched:
        for name in ("_FEWEST", "_MOST"):
            patched.setattr(cutting, name, 2)
        patched.setattr(
            ensembles,
            "checkpoint_in",
            lambda *g: found.append(checkpoint.checkpoint_in(*g)) or found[0],
        )
        rates = {"damper_rate": np.linspace(1e3, 2e3, 6)}
        where = tmp_path_factory.mktemp("ensemble")
        ensemble(Model("reference_car"), rates, (0.0, 0.01), kept=where, **GIVEN)
    return found[0]


@pytest.fixture
def path(folder):
    """Yield the middle one of its files, which is sound again at the end."""
    path = sorted(folder.folder.glob("*.npz"))[1]
    sound = path.read_bytes()
    yield path
    path.write_bytes(sound)


def spans(folder):
    return [(chunk.first, chunk.last) for chunk in folder.found()]


def check_damaged(folder):
    """See that the middle file is left out, with a warning."""
    with pytest.warns(
        RuntimeWarning, match="damaged. Systems 2 to 4 are simulated again"
    ) as warned:
        assert spans(folder) == [(0, 2), (4, 6)]
    assert len(warned) == 1


def test_a_sound_folder_is_read(folder):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert spans(folder) == [(0, 2), (2, 4), (4, 6)]


def test_every_bit_counts(path):
    """All bits, those of the directory, of the arrays and of the digest: each changed alone."""
    content = bytearray(path.read_bytes())
    for place in range(len(content)):
        for bit in range(8):
            content[place] ^= 1 << bit
            with pytest.raises(ValueError, match="digest"):
                checkpoint._arrays_in(bytes(content))
            content[place] ^= 1 << bit
    assert checkpoint._arrays_in(bytes(content))


def test_every_byte_counts(path):
    """Cut off at any byte, at either end, or with more behind it."""
    content = path.read_bytes()
    cut = (content[a:b] for end in range(len(content)) for a, b in ((0, end), (end + 1, None)))
    for changed in (*cut, content + b"\0", b"\0" + content, content + content):
        with pytest.raises(ValueError, match="digest"):
            checkpoint._arrays_in(changed)


def test_damage_is_reported_and_left_out(folder, path):
    """Of other systems, as it would be without a digest, changed, empty."""
    content = path.read_bytes()
    others = [other.read_bytes() for other in sorted(folder.folder.glob("*.npz"))[::2]]
    changed = content.replace(b"outcome ends", b"outcome Ends")
    for damaged in (*others, content[:-32], changed, b""):
        assert damaged != content
        path.write_bytes(damaged)
        check_damaged(folder)


SOUND = {
    "ensemble": "<U64", "systems": "<i8", "solvers": "<U13", "samples": "<f8", "reasons": "<U2",
    "outcome ends": "<i4", "outcome codes": "<i4", "outcome ended": "<f8", "outcome finals": "<f8",
    "outcome steps": "<i8", "outcome reduced": "<f8", "outcome beyond": "<f8",
    "series 0": "<f8", "series 1": "<f8",
}  # fmt: skip


@pytest.mark.parametrize("name", SOUND)
def test_names_types_and_shapes_are_exact(folder, path, name):
    """Files with a correct digest that lack an array, or have another one in its place."""
    sound = checkpoint._arrays_in(path.read_bytes())
    values = sound[name]
    others = [
        None,  # no such array
        values[None],
        values[:1] if values.ndim else np.stack([values, values]),
        values.astype("S9" if values.dtype.kind == "U" else np.float32),
        values.astype(values.dtype.newbyteorder()),
    ]
    for other in others:
        arrays = {key: other if key == name else value for key, value in sound.items()}
        write(path, {key: value for key, value in arrays.items() if value is not None})
        check_damaged(folder)


def test_nothing_more_and_of_nothing_else(folder, path):
    sound = checkpoint._arrays_in(path.read_bytes())
    assert {name: values.dtype.str for name, values in sound.items()} == SOUND
    write(path, sound)
    assert spans(folder) == [(0, 2), (2, 4), (4, 6)]
    for more in (
        {"more": np.zeros(2)},
        {"series 2": sound["series 0"]},
        {"systems": np.array([0, 2])},
        {"ensemble": np.array("another")},
    ):
        write(path, {**sound, **more})
        check_damaged(folder)


def write(path, arrays):
    """Write a file that is whole."""
    content = io.BytesIO()
    np.savez(content, **arrays)
    path.write_bytes(content.getvalue() + checkpoint._digest(content.getvalue()))
