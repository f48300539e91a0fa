"""What workers do, for tests: in a file that they can import."""

import os
import signal
from pathlib import Path

from kintrafo.ensembles.pieces import queue
from kintrafo.ensembles.pieces.piece import Chunk, ChunkResult, Common

DO = queue._do


def lost_once(flag: str, common: Common, piece: Chunk) -> ChunkResult:
    """Simulate a piece; the first worker that is asked for it is killed."""
    try:
        Path(flag).touch(exist_ok=False)
    except FileExistsError:
        return DO(common, piece)
    os.kill(os.getpid(), signal.SIGKILL)
    raise AssertionError


def noted(folder: str, common: Common, piece: Chunk) -> ChunkResult:
    """Simulate a piece, and note that it was begun."""
    (Path(folder) / str(piece.first)).touch()
    return DO(common, piece)


def use_cache(folder: str) -> None:
    """Let what is compiled be looked for, and kept, in a folder."""
    os.environ["KINTRAFO_CACHE"] = folder
