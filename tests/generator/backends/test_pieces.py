"""Long functions are compiled in pieces: the same bits as in one."""

import numpy as np
import pytest
from kintrafo import System
from kintrafo.generator.backends.c import pieces, source
from kintrafo.generator.mechanisms.held_by_rods import MODELS
from kintrafo.generator.mechanisms.n_four_bar import n_four_bar
from kintrafo.systems.compile.build import build
from kintrafo.systems.compile.compiler import find_compiler
from kintrafo.systems.compile.loader import load
from support.models import derive

FUNCTIONS = ("rhs", "rhs_jacobian", "margins", "poses", "jacobians")


@pytest.mark.parametrize("model", [n_four_bar(8), MODELS[0]], ids=["closed", "iterated"])
def test_pieces_return_the_bits_of_the_whole(tmp_path, monkeypatch, model):
    derived = derive(model)
    results = []
    for number, (long, piece) in enumerate(((10**9, 10**9), (0, 300))):
        monkeypatch.setattr(source, "LONG", long)
        monkeypatch.setattr(pieces, "PIECE", piece)
        folder = tmp_path / f"{model.name}-pieces{number}"
        folder.mkdir()
        build(derived, folder, find_compiler())
        text = (folder / f"{model.name}.c").read_text(encoding="utf-8")
        assert [f" {name}_2(" in text for name in ("prepare", "rhs")] == [long == 0] * 2
        module = load(folder)
        system, random = System(module), np.random.default_rng(3)
        constants, size = system.constants, system.design_state.size
        states = system.design_state + random.uniform(-0.3, 0.3, (50, size))
        values = [getattr(module, name)(states, None, constants) for name in FUNCTIONS]
        results.append([constants, *(np.asarray(v) for group in values for v in _arrays(group))])
    for one, other in zip(*results, strict=True):
        assert one.tobytes() == other.tobytes()


def _arrays(found):
    return found if isinstance(found, tuple) else (found,)


def test_short_functions_stay_in_one_piece_and_so_does_what_comes_with_the_project():
    derived = derive(n_four_bar(8))
    for long, in_pieces, cut in ((10**9, True, False), (0, False, False), (0, True, True)):
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(source, "LONG", long)
            text = source.Source(derived, in_pieces=in_pieces).text()
        assert (" rhs_1(" in text) == cut
        assert (" prepare_1(" in text) == in_pieces  # which is called once, and stores the most
