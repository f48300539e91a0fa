"""Try a door with a row of seeds, each told in a line of JSON: run by `fuzz.campaign`.

A seed that hangs ends the process by a timer that no Python code can stop; the seed that was begun
and not told is the one. Time is that of the processor, which a busy machine does not make longer;
what waits for something is given ten times as much on the clock.
"""

from __future__ import annotations

import faulthandler
import json
import os
import signal
import sys
from dataclasses import asdict

from .attempts import door, setting, tried


def main(name: str, first: int, count: int) -> None:
    """Try the seeds from `first` on."""
    # lines go to the real standard output, whatever an attempt prints goes nowhere
    told = os.fdopen(os.dup(1), "w", buffering=1)
    nowhere = os.open(os.devnull, os.O_RDWR)
    os.dup2(nowhere, 1)
    module = door(name)
    seconds = setting(module, "SECONDS")
    faulthandler.register(signal.SIGPROF, chain=True)  # tells where, and the process ends
    for seed in range(first, first + count):
        faulthandler.dump_traceback_later(10.0 * seconds, exit=True)
        signal.setitimer(signal.ITIMER_PROF, seconds)
        found = tried(module, seed)
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        faulthandler.cancel_dump_traceback_later()
        told.write(json.dumps(asdict(found)) + "\n")


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]), int(sys.argv[3]))
