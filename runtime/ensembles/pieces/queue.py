"""Pieces that are handed to workers, and what comes back."""

from collections.abc import Generator, Iterator
from concurrent.futures import CancelledError
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from itertools import islice
from queue import Empty, SimpleQueue
from typing import Any

from ...core.errors import KintrafoError
from ...simulation.lanes.problem import Problem
from .cutting import Span
from .piece import Chunk, ChunkResult, Common, found_of, piece_of

# Pieces for each thread that are under way: so many that none waits, so few that they fill no
# memory here or there.
_AHEAD = 3
# How long the main thread waits before it looks at signals [s].
_PATIENCE = 0.1


class ClusterError(KintrafoError, RuntimeError):
    """A scheduler or its workers ended before an ensemble was done."""


def by_workers(
    client: Any, common: Common, problem: Problem, spans: list[Span]
) -> Generator[ChunkResult | None, None, None]:
    """Yield what was found of pieces as they are done; nothing, now and then, between them.

    What was lost with a worker is done again by another. When the caller wants no more, what waits
    is cancelled, and what is being done ends at once.

    Parameters
    ----------
    client : distributed.Client
    common : Common
        Sent once to each worker.
    problem : Problem
        From which the pieces are cut.
    spans : list
        Those that are to be done.

    Raises
    ------
    ClusterError
        If the scheduler is lost, or several workers one after another with the same piece.
    """
    with _reached():
        queue = _Queue(client, problem, _shared(client, common), iter(spans))
    try:
        queue.fill()
        while queue.waiting:
            found = queue.next()
            yield found
            if found is not None:
                queue.fill()
    finally:
        queue.end()


@dataclass
class _Queue:
    """Pieces that are under way.

    Attributes
    ----------
    client : distributed.Client
    problem : Problem
    shared : Future
        Of what all pieces have in common.
    left : iterator
        What is still to be handed out.
    waiting : dict
        What was handed out, by its future.
    done : SimpleQueue
        Futures that have come to an end.
    """

    client: Any
    problem: Problem
    shared: Any
    left: Iterator[Span]
    waiting: dict[Any, Span] = field(default_factory=dict)
    done: SimpleQueue[Any] = field(default_factory=SimpleQueue)

    def fill(self) -> None:
        """Hand out as many as the threads of all workers, who come and go, have use for."""
        with _reached():
            most = _AHEAD * max(1, sum(self.client.nthreads().values()))
            for first, last in islice(self.left, max(0, most - len(self.waiting))):
                piece = piece_of(self.problem, first, last)
                key = f"kintrafo-{self.shared.key}-{first}"
                future = self.client.submit(_do, self.shared, piece, pure=False, key=key)
                self.waiting[future] = first, last
                future.add_done_callback(self.done.put)

    def next(self) -> ChunkResult | None:
        """Return what was found of one; nothing if none is done soon."""
        try:
            future = self.done.get(timeout=_PATIENCE)
        except Empty:
            return None
        return _result(future, self.waiting.pop(future))

    def end(self) -> None:
        """Cancel what is under way."""
        with suppress(OSError):  # there may be no scheduler any more
            self.client.cancel([*self.waiting, self.shared], force=True)


@contextmanager
def _reached() -> Iterator[None]:
    """Say in words that a scheduler does not answer."""
    try:
        yield
    except OSError as error:
        message = f"the scheduler was lost: {error}"
        raise ClusterError(message) from error


def _shared(client: Any, common: Common) -> Any:
    """Return what all pieces have in common as something that no lost worker takes with it."""
    import dask  # noqa: PLC0415 (of an extra)

    # the scheduler keeps the task, and so what it is of; that may be much, and is sent once
    with dask.config.set({"distributed.admin.large-graph-warning-threshold": "1 TB"}):
        return client.submit(_same, common, pure=False)


def _same(common: Common) -> Common:
    return common


def _result(future: Any, span: Span) -> ChunkResult:
    """Return what was found; where it was lost on its way here, that takes until it is again."""
    from distributed.scheduler import KilledWorker  # noqa: PLC0415 (of an extra)

    try:
        with _reached():
            found: ChunkResult = future.result()
    except KilledWorker as error:
        message = (
            f"systems {span[0]} to {span[1]}: several workers in a row were lost with them. See "
            "what they say; they may have had too little memory."
        )
        raise ClusterError(message) from error
    except CancelledError as error:
        message = "the scheduler was lost, or another client cancelled the work."
        raise ClusterError(message) from error
    return found


def _do(common: Common, piece: Chunk) -> ChunkResult:
    """Simulate a piece in a thread of a worker, which has others for other pieces."""
    from distributed import get_worker  # noqa: PLC0415 (of an extra)

    worker = get_worker()
    key = worker.get_current_task()

    def stop_if_cancelled(_: int) -> None:
        task = worker.state.tasks.get(key)
        if task is None or task.state == "cancelled":
            raise InterruptedError(key)

    return found_of(common, piece, 1, stop_if_cancelled)
