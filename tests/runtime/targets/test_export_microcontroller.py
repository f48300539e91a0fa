"""Exported C on an emulated Cortex-M7: the bits of this machine, and counted instructions."""

import pytest
from kintrafo.systems.compile.compiler import find_compiler
from support.exported import system_named

from benchmarks.microcontroller.build import FUNCTIONS, UNITS, Program, missing

NEEDED = [*missing(), *([] if find_compiler() else ["a C compiler"])]


@pytest.mark.skipif(bool(NEEDED), reason=f"not installed: {', '.join(NEEDED)}")
def test_a_controller_computes_the_same_bits(tmp_path):
    system = system_named("four_bar")
    program = Program(system, tmp_path / "m7")
    bits = program.here()
    assert len(bits) == 20 * len(FUNCTIONS)
    for unit in UNITS:
        found = program.on_board(unit)
        assert found.bits == bits
        # a thousand, and what is left of the ticks of the timer
        assert abs(found.instructions["thousand"] - 1000) < 5
        for name in FUNCTIONS:
            operations = getattr(system.equations, name).operations["total"]
            assert found.instructions[name] > operations
            assert 0 < found.stack[name] < 20_000  # bytes, as in README.txt
        assert 1000 < found.code < 100_000
