"""All pieces of an ensemble: by threads of this process, or by workers."""

from collections.abc import Iterable, Iterator
from contextlib import closing, contextmanager

from ..collected import Collected
from .cutting import Span, left_of, spans_of
from .kept import Kept
from .piece import ChunkResult, Report, common_of, found_of, piece_of, put
from .queue import by_workers
from .workers import Workers


def run_in_pieces(
    collected: Collected,
    workers: Workers | None,
    threads: int,
    kept: Kept | None,
    report: Report | None,
) -> None:
    """Simulate an ensemble in pieces, but those that were kept.

    Parameters
    ----------
    collected : Collected
        What is found is put there.
    workers : Workers or None
        None: threads of this process.
    threads : int
        Of this process.
    kept : Kept or None
        Where each piece is kept as soon as it is done.
    report : callable, optional
        Called with how many systems are done, now and then.
    """
    notify = report or (lambda _: None)
    done: list[Span] = []
    for found in kept.found() if kept else ():
        put(found, collected)
        done.append((found.first, found.last))
    count = collected.problem.systems.count
    left = left_of(count, done)
    count -= sum(last - first for first, last in left)
    notify(count)
    if not left:
        return
    with _pieces(collected, workers, threads, left) as pieces:
        for piece in pieces:
            if piece is not None:
                put(piece, collected)
                if kept:
                    kept.keep(piece)
                count += piece.last - piece.first
            notify(count)


@contextmanager
def _pieces(
    collected: Collected, workers: Workers | None, threads: int, left: list[Span]
) -> Iterator[Iterable[ChunkResult | None]]:
    """Yield what yields what was found of what is left; what works for it ends with this."""
    if workers is None:
        yield _by_threads(collected, threads, spans_of(collected, left, threads))
        return
    with workers.client() as client:
        cores = max(1, sum(client.nthreads().values()))
        spans = spans_of(collected, left, cores)
        with closing(by_workers(client, common_of(collected), collected.problem, spans)) as pieces:
            yield pieces


def _by_threads(collected: Collected, threads: int, spans: list[Span]) -> Iterator[ChunkResult]:
    common = common_of(collected)
    for first, last in spans:
        yield found_of(common, piece_of(collected.problem, first, last), threads)
