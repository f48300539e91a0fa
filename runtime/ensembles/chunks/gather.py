"""All chunks of an ensemble: by threads of this process, or by workers."""

from collections.abc import Iterable, Iterator
from contextlib import closing, contextmanager

from ..collected import Collected
from .checkpoint import Checkpoint
from .chunk import ChunkResult, Report, chunk_of, common_of, found_of, put
from .cutting import Span, left_of, spans_of
from .queue import by_workers
from .workers import Workers


def run_in_chunks(
    collected: Collected,
    workers: Workers | None,
    threads: int,
    kept: Checkpoint | None,
    report: Report | None,
) -> None:
    """Simulate an ensemble in chunks, except those that a folder has already.

    Without workers, threads of this process simulate it. Each chunk is written to the folder
    `kept`, if any, as soon as it is done. `report` is called now and then with the number of
    finished systems.
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
    with _chunks(collected, workers, threads, left) as chunks:
        for chunk in chunks:
            if chunk is not None:
                put(chunk, collected)
                if kept:
                    kept.keep(chunk)
                count += chunk.last - chunk.first
            notify(count)


@contextmanager
def _chunks(
    collected: Collected, workers: Workers | None, threads: int, left: list[Span]
) -> Iterator[Iterable[ChunkResult | None]]:
    """Yield an iterator over results of chunks; workers of our own end with the block."""
    if workers is None:
        common = common_of(collected)
        yield (
            found_of(common, chunk_of(collected.problem, first, last), threads)
            for first, last in spans_of(collected, left, threads)
        )
        return
    with workers.client() as client:
        cores = max(1, sum(client.nthreads().values()))
        spans = spans_of(collected, left, cores)
        with closing(by_workers(client, common_of(collected), collected.problem, spans)) as chunks:
            yield chunks
