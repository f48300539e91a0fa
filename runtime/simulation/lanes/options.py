"""The options of a compiler for vectors of each width; `setup.py` reads this file, too."""

import platform
import sys

_X86_64 = {2: [], 4: ["-mavx2"], 8: ["-mavx512f", "-mavx512vl", "-mavx512dq"]}
_OF_MACHINE = _X86_64 if platform.machine().lower() in ("x86_64", "amd64") else {2: []}

OF_WIDTH: dict[int, list[str]] = {} if sys.platform == "win32" else _OF_MACHINE
"""How many lanes vectors have, and what says that the processor has them: two are in every
processor of 64 bits. Other compilers than GCC and Clang have no vectors."""

SCHEDULED = ["-fschedule-insns", "-fsched-pressure"]
"""Of GCC: put instructions in order before registers are given to values. The long chains of the
equations are a sixth faster for it in four lanes."""
