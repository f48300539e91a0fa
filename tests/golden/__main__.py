"""``python -m golden``: what differs from the golden set; ``python -m golden store`` replaces it.

Names of subjects after it choose some of them. `make golden` runs it.
"""

import sys

from .stored import COMMANDS, SUBJECTS, differences, store

STRICT = 1e-12
"""Of the largest value of a variable: what a change that only moves code may do on one machine."""

chosen = [name for name in sys.argv[1:] if name != "store"] or [*SUBJECTS, COMMANDS]
if "store" in sys.argv[1:]:
    for name in chosen:
        store(name)
        print(f"{name}: stored")
else:
    lines = [f"{name}: {line}" for name in chosen for line in differences(name, STRICT)]
    print(*lines, f"{len(lines)} differences", sep="\n")
    sys.exit(bool(lines))
