"""Chunks that are submitted to workers, and their results."""

from collections.abc import Generator, Iterator
from concurrent.futures import CancelledError
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from itertools import islice
from queue import Empty, SimpleQueue
from typing import Any

from ...core.errors import KintrafoError
from ...simulation.lanes.problem import Problem
from .chunk import Chunk, ChunkResult, Common, chunk_of, found_of
from .cutting import Span

# Submitted chunks for each thread: enough that none waits, few enough for the memory.
_AHEAD = 3
# Time after which the main thread handles signals [s].
_PATIENCE = 0.1


class ClusterError(KintrafoError, RuntimeError):
    """A scheduler or its workers ended before an ensemble was done."""


def by_workers(
    client: Any, common: Common, problem: Problem, spans: list[Span]
) -> Generator[ChunkResult | None, None, None]:
    """Yield results of chunks as they are done, and now and then None between them.

    The chunk of a lost worker is simulated by another. When the generator is closed, waiting chunks
    are cancelled, and running ones end at once. `common` is sent once to each worker; the chunks
    are cut from the whole `problem`. Raises `ClusterError` if the scheduler is lost, or several
    workers in a row with the same chunk.
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
    """Submitted chunks."""

    client: Any
    problem: Problem
    shared: Any  # of the data that all chunks share
    left: Iterator[Span]  # chunks that are not submitted yet
    waiting: dict[Any, Span] = field(default_factory=dict)  # submitted chunks by their futures
    done: SimpleQueue[Any] = field(default_factory=SimpleQueue)  # finished futures

    def fill(self) -> None:
        """Submit chunks for all threads of the workers, whose number may change."""
        with _reached():
            most = _AHEAD * max(1, sum(self.client.nthreads().values()))
            for first, last in islice(self.left, max(0, most - len(self.waiting))):
                chunk = chunk_of(self.problem, first, last)
                key = f"kintrafo-{self.shared.key}-{first}"
                future = self.client.submit(_do, self.shared, chunk, pure=False, key=key)
                self.waiting[future] = first, last
                future.add_done_callback(self.done.put)

    def next(self) -> ChunkResult | None:
        """Return the results of a chunk; None if none is done soon."""
        try:
            future = self.done.get(timeout=_PATIENCE)
        except Empty:
            return None
        return _result(future, self.waiting.pop(future))

    def end(self) -> None:
        """Cancel all submitted chunks."""
        with suppress(OSError):  # the scheduler may be lost
            self.client.cancel([*self.waiting, self.shared], force=True)


@contextmanager
def _reached() -> Iterator[None]:
    """Raise a ClusterError if the scheduler does not answer."""
    try:
        yield
    except OSError as error:
        message = f"the scheduler was lost: {error}"
        raise ClusterError(message) from error


def _shared(client: Any, common: Common) -> Any:
    """Return the shared data as a future that survives the loss of workers."""
    import dask  # noqa: PLC0415 (of an extra)

    # the scheduler keeps the task with its data, which may be large and are sent once
    with dask.config.set({"distributed.admin.large-graph-warning-threshold": "1 TB"}):
        return client.submit(lambda data: data, common, pure=False)


def _result(future: Any, span: Span) -> ChunkResult:
    """Return results; those lost on their way here are waited for until they are found again."""
    from distributed.scheduler import KilledWorker  # noqa: PLC0415 (of an extra)

    try:
        with _reached():
            found: ChunkResult = future.result()
    except KilledWorker as error:
        message = (
            f"systems {span[0]} to {span[1]}: several workers were lost with them, one after the "
            "other. See their output; they may have had too little memory."
        )
        raise ClusterError(message) from error
    except CancelledError as error:
        message = "the scheduler was lost, or another client cancelled the work."
        raise ClusterError(message) from error
    return found


def _do(common: Common, chunk: Chunk) -> ChunkResult:
    """Simulate a chunk in one thread of a worker."""
    from distributed import get_worker  # noqa: PLC0415 (of an extra)

    worker = get_worker()
    key = worker.get_current_task()

    def stop_if_cancelled(_: int) -> None:
        task = worker.state.tasks.get(key)
        if task is None or task.state == "cancelled":
            raise InterruptedError(key)

    return found_of(common, chunk, 1, stop_if_cancelled)
