"""Work for several processes on one cache; it imports little, so that they begin quickly."""

import os
import random
import time

from kintrafo.systems.compile.cache import _LONG_AGO_S, _MARK, _MARKED, appearing, damage, seal

ROUNDS = 60


def old(folder, mark=None):
    """Make a folder of two days ago that looks like a leftover, with a mark or without."""
    folder.mkdir(parents=True)
    (folder / "kept.txt").write_text("a year of work")
    if mark is not None:
        (folder / _MARK).write_bytes(mark)
    then = time.time() - 2.0 * _LONG_AGO_S
    # the mark last: once it is old, another process may remove all of it
    for path in sorted((folder, *folder.iterdir()), key=lambda path: path.name == _MARK):
        os.utime(path, (then, then))
    return folder


def stress(folder, seed):
    """Fill folders among leftovers, and leave more of them."""
    chosen = random.Random(seed)
    for index in range(ROUNDS):
        old(folder / f".m-0123456789abcdef-{seed}-{index}", _MARKED)
        target = folder / f"m-{chosen.randrange(5):016x}"
        with appearing(target) as temporary:
            (temporary / "a.txt").write_text("x" * 1000)
            seal(temporary, target.name)
        assert not damage(target)
    with appearing(target):
        pass
