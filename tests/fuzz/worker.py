"""Try a door with a row of seeds, and send each result: for the processes of `fuzz.campaign`.

A seed that hangs ends the process by a timer that no Python code can stop: the seed after the last
sent result. Time is that of the processor, which a busy machine does not make longer;
what waits for something is given ten times as much on the clock.
"""

import faulthandler
import os
import signal

from .attempts import door, setting, tried


def main(name, first, count, sender, complaints):
    """Try the seeds from `first` on.

    Parameters
    ----------
    name
        Of the door.
    first, count
        The seeds.
    sender
        The end of a pipe to which the result of each seed is sent.
    complaints
        Path of the file for what goes to standard error.
    """
    _lead(os.devnull, 1)  # output of an attempt goes nowhere
    _lead(complaints, 2)
    module = door(name)
    seconds = setting(module, "SECONDS")
    faulthandler.register(signal.SIGPROF, chain=True)  # prints the place, and the process ends
    for seed in range(first, first + count):
        faulthandler.dump_traceback_later(10.0 * seconds, exit=True)
        signal.setitimer(signal.ITIMER_PROF, seconds)
        found = tried(module, seed)
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        faulthandler.cancel_dump_traceback_later()
        sender.send(found)


def _lead(path, stream):
    """Let what is written to a standard stream go to a file."""
    file = os.open(path, os.O_WRONLY)
    os.dup2(file, stream)
    os.close(file)
