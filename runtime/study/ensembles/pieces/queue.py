"""Pieces that are handed to workers, and what comes back."""

from collections.abc import Generator
from itertools import islice
from queue import Empty, SimpleQueue
from typing import Any

from ....core.errors import KintrafoError
from ....simulation.lanes.problem import Problem
from .cutting import Span
from .piece import Common, Found, Piece, found_of, piece_of

# Pieces for each thread that are under way: so many that none waits, so few that they fill no
# memory here or there.
_AHEAD = 3
# How long the main thread waits before it looks at signals [s].
_PATIENCE = 0.1


class ClusterError(KintrafoError, RuntimeError):
    """A scheduler or its workers ended before an ensemble was done."""


def by_workers(
    client: Any, common: Common, problem: Problem, spans: list[Span]
) -> Generator[Found | None, None, None]:
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
    shared = _shared(client, common)
    left, done = iter(spans), SimpleQueue[Any]()
    waiting: dict[Any, Span] = {}
    try:
        while True:
            most = _AHEAD * max(1, sum(client.nthreads().values()))
            for first, last in islice(left, max(0, most - len(waiting))):
                piece = piece_of(problem, first, last)
                future = client.submit(_do, shared, piece, pure=False, key=_key(shared, first))
                waiting[future] = first, last
                future.add_done_callback(done.put)
            if not waiting:
                return
            future = _next(done)
            if future is None:
                yield None
                continue
            span = waiting.pop(future)
            yield _result(future, span)
    finally:
        client.cancel([*waiting, shared], force=True)


def _shared(client: Any, common: Common) -> Any:
    """Return what all pieces have in common as something that no lost worker takes with it."""
    import dask  # noqa: PLC0415 (of an extra)

    # the scheduler keeps the task, and so what it is of; that may be much, and is sent once
    with dask.config.set({"distributed.admin.large-graph-warning-threshold": "1 TB"}):
        return client.submit(_same, common, pure=False)


def _same(common: Common) -> Common:
    return common


def _key(shared: Any, first: int) -> str:
    return f"kintrafo-{shared.key}-{first}"


def _next(done: SimpleQueue[Any]) -> Any:
    try:
        return done.get(timeout=_PATIENCE)
    except Empty:
        return None


def _result(future: Any, span: Span) -> Found:
    from distributed.scheduler import KilledWorker  # noqa: PLC0415 (of an extra)

    if future.status in ("cancelled", "lost"):
        message = "the scheduler was lost, or somebody else cancelled what it does."
        raise ClusterError(message)
    try:
        found: Found = future.result()
    except KilledWorker as error:
        message = (
            f"systems {span[0]} to {span[1]}: several workers in a row were lost with them. See "
            "what they say; they may have had too little memory."
        )
        raise ClusterError(message) from error
    return found


def _do(common: Common, piece: Piece) -> Found:
    """Simulate a piece in a thread of a worker, which has others for other pieces."""
    from distributed import get_worker  # noqa: PLC0415 (of an extra)

    worker = get_worker()
    key = worker.get_current_task()

    def stop_if_cancelled(_: int) -> None:
        task = worker.state.tasks.get(key)
        if task is None or task.state == "cancelled":
            raise InterruptedError(key)

    return found_of(common, piece, 1, stop_if_cancelled)
