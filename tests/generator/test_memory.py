"""SymPy's cache of the results of a derivation."""

import subprocess
import sys

PROGRAM = """
import atexit
atexit.register(lambda: print(symbols_of.cache_info().currsize))
from kintrafo.generator.program.symbols import symbols_of
import sympy as sp
symbols_of(sp.Symbol("x") + 1)
print(symbols_of.cache_info().currsize)
"""


def test_sympy_forgets_before_a_program_ends():
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM], capture_output=True, text=True, check=True
    )
    before, after = map(int, done.stdout.split())
    assert before > 0
    assert after == 0
