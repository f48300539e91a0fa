"""Options of a compiler for vectors of each width; `setup.py` reads this file, too."""

import platform
import sys

_X86_64 = {2: [], 4: ["-mavx2"], 8: ["-mavx512f", "-mavx512vl", "-mavx512dq"]}
_OF_MACHINE = _X86_64 if platform.machine().lower() in ("x86_64", "amd64") else {2: []}

OF_WIDTH: dict[int, list[str]] = {} if sys.platform == "win32" else _OF_MACHINE
"""Options of the compiler by number of lanes: every processor of 64 bits has two. Compilers other
than GCC and Clang have no vectors."""

SCHEDULED = ["-fschedule-insns", "-fsched-pressure"]
"""Options of GCC: schedule instructions before registers are allocated, which makes the long chains
of the equations a sixth faster in four lanes."""
