"""Where what tests derived and compiled is kept, and for how long."""

import shutil
import time

from support.folders import ROOT

KEPT = ROOT / "build/tests"
"""The folder: a folder for each model, and beside it a lock whose date is that of the last use."""
UNOPTIMISED = ("-O0", "-Dalways_inline=unused")
"""Options of compilers, with which they take a tenth of the time: half of it because functions are
not expanded into their callers. Without contraction the bits are the same. A call of a block that
iterates takes a third of a millisecond either way."""
FORGOTTEN_S = 7 * 24 * 3600.0
"""Age of unused files that are removed, since the generator has changed."""


def forget() -> None:
    """Remove what has not been used for long."""
    for lock in KEPT.glob("*.lock"):
        if time.time() - lock.stat().st_mtime > FORGOTTEN_S:
            shutil.rmtree(lock.with_suffix(""), ignore_errors=True)
            lock.unlink(missing_ok=True)
