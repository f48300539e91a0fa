"""Workers of an ensemble: processes of this machine, or those of a scheduler of Dask."""

import errno
import os
import re
import socket
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from multiprocessing import current_process
from pathlib import Path
from typing import Any

import numpy as np

from ...core.errors import InputError
from ...core.optional import require
from ...core.validator import Validator, shown
from .versions import differences, versions

_NEEDED = (
    "the number of local workers, the address of a scheduler such as 'tcp://10.0.0.1:8786', or a "
    "running dask.distributed.Client that is not asynchronous is needed"
)
_ADDRESS = re.compile(r"(\w+://)?[^\s/:]+:\d+")
# Longest time until a scheduler answers, and until it has a worker [s].
_PATIENCE = 30.0
# Longest time until a connection is accepted or refused [s].
_ANSWERED = 5.0


@dataclass(frozen=True)
class Workers:
    """The workers of an ensemble."""

    of: Any  # number of processes that are started here, the address of a scheduler, or its client
    threads: int = 1  # of each process that is started here

    @contextmanager
    def client(self) -> Iterator[Any]:
        """Yield a client of a scheduler with matching workers; our own ones end with the block."""
        distributed = _package()
        if isinstance(self.of, int):
            with _local(distributed, self.of, self.threads) as cluster, _of(cluster) as client:
                yield client
        elif isinstance(self.of, str):
            with _of(self.of) as client:
                yield client
        else:
            _check(self.of)
            yield self.of


def workers_of(given: Validator, cluster: Any, cores: int, *, threads: Any) -> Workers | None:
    """Return the checked workers; None for `cores` threads of this process.

    `cluster` and `threads` are arguments of `ensemble`; workers of a scheduler have threads of
    their own. Raises `MissingPackageError` if the packages of the extra "cluster" are not
    installed.
    """
    if cluster is None:
        return None
    if isinstance(cluster, int | float | np.number) and not isinstance(cluster, bool):
        return _local_workers(given, cluster, cores)
    if isinstance(cluster, str):
        known = _ADDRESS.fullmatch(cluster) is not None
    else:
        known = _is_usable(cluster)
    if not known:
        given.fail(f"cluster = {shown(cluster)}: {_NEEDED}.")
        return None
    if threads is not None:
        given.fail(
            f"threads = {shown(threads)}: the workers of a scheduler have threads of their own. "
            "Leave threads out."
        )
    _package()
    return Workers(cluster)


def _local_workers(given: Validator, cluster: Any, cores: int) -> Workers:
    number = given.whole("cluster", cluster)
    if number > cores:
        given.fail(
            f"cluster = {number}: each worker needs a thread, and there are {cores}. Ask for fewer "
            "workers, or for more threads."
        )
    _package()
    return Workers(number, max(1, cores // number))


def _is_usable(client: Any) -> bool:
    distributed = sys.modules.get("distributed")  # a client exists only after its import
    if distributed is None or not isinstance(client, distributed.Client):
        return False
    return not client.asynchronous and bool(client.status == "running")


def _package() -> Any:
    return require("distributed", purpose="An ensemble on a cluster", extra="cluster")


@contextmanager
def _local(distributed: Any, number: int, threads: int) -> Iterator[Any]:
    """Yield workers of this machine, which end with the block."""
    try:
        cluster = distributed.LocalCluster(
            n_workers=number,
            threads_per_worker=threads,
            processes=True,
            dashboard_address="127.0.0.1:0",  # any free port: there may be several ensembles
        )
    except RuntimeError as error:
        problem = f"cluster = {number}: local workers cannot be started. {_why_not(error)}"
        raise InputError([problem], "ensemble") from error
    try:
        yield cluster
    finally:
        cluster.close()


def _why_not(error: BaseException) -> str:
    """Return the probable reason why workers of this machine ended at their start."""
    if not _is_guarded():
        return (
            "They read the script that starts them: let it call ensemble only below "
            'if __name__ == "__main__":'
        )
    while error.__cause__ is not None:
        error = error.__cause__
    # an assertion of Dask has no details
    details = "" if isinstance(error, AssertionError) else f" ({type(error).__name__}: {error})"
    return (
        f"They ended at their start{details}. Their output has the reason: they may lack a package "
        "or memory. Without cluster, threads of this process do the same."
    )


def _is_guarded() -> bool:
    """Return whether the script that workers read does nothing unless it is the main program."""
    if getattr(current_process(), "_inheriting", False):  # a worker that is reading it
        return False
    script = getattr(sys.modules.get("__main__"), "__file__", None)
    if script is None:  # an interactive session or notebook: nothing is read
        return True
    try:
        return "__main__" in Path(script).read_text(encoding="utf-8", errors="replace")
    except OSError:
        return True


def _refuse_dead(address: str) -> None:
    """Refuse an address without a scheduler at once: Dask would retry, or wait forever."""
    protocol, _, place = address.rpartition("://")
    host, _, port = place.partition(":")
    if protocol not in ("", "tcp", "tls"):
        return
    try:
        with socket.create_connection((host, int(port)), timeout=_ANSWERED) as connection:
            if protocol != "tls":  # a scheduler sends first, except with TLS
                connection.settimeout(_PATIENCE)
                greeted = connection.recv(1)
                if not greeted:
                    raise ConnectionResetError(errno.ECONNRESET, os.strerror(errno.ECONNRESET))
    except (OSError, OverflowError) as error:
        problem = (
            f"cluster = {address!r}: there is no reply ({error}). Check the address, or start a "
            "scheduler there: dask scheduler"
        )
        raise InputError([problem], "ensemble") from error


@contextmanager
def _of(where: Any) -> Iterator[Any]:
    """Yield a client of our own."""
    if isinstance(where, str):
        _refuse_dead(where)
    try:
        client = _package().Client(where, timeout=_PATIENCE, set_as_default=False)
    except (OSError, ValueError) as error:
        problem = f"cluster = {where!r}: no scheduler of Dask answers there. Check the address."
        raise InputError([problem], "ensemble") from error
    try:
        _check(client)
        yield client
    finally:
        client.close()


def _check(client: Any) -> None:
    """Refuse workers on which numbers would differ, and a scheduler without workers."""
    try:
        client.wait_for_workers(1, timeout=_PATIENCE)
    except TimeoutError as error:
        problem = (
            f"cluster: the scheduler has had no worker for {_PATIENCE:g} s. Start some: dask worker"
        )
        raise InputError([problem], "ensemble") from error
    found = client.run(versions, on_error="return")
    problems = [f"the worker {name} {text}" for name, v in found.items() if (text := _other(v))]
    if problems:
        raise InputError(problems, "ensemble")


def _other(found: Any) -> str:
    """Return a message about an unfit worker; empty for a fit one, or one lost just now."""
    if isinstance(found, OSError):
        return ""
    if isinstance(found, Exception):
        return (
            f"cannot load this version of kintrafo ({type(found).__name__}: {found}). Install it "
            "there, as it is here."
        )
    text = differences(found)
    return f"has {text}. Install the same there." if text else ""
