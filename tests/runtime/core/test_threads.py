"""Small matrices are solved in one thread, and the process has its threads again afterwards."""

from concurrent.futures import ThreadPoolExecutor
from threading import Barrier

import numpy as np
import pytest
from kintrafo.core.threads import in_one_thread
from threadpoolctl import threadpool_info, threadpool_limits

np.linalg.inv(np.eye(2))


def numbers():
    """Return how many threads each library may have."""
    return [found["num_threads"] for found in threadpool_info() if found["user_api"] == "blas"]


@pytest.fixture(autouse=True)
def two_threads():
    with threadpool_limits(2, user_api="blas"):
        yield


def test_one_thread_within_and_as_many_as_before_behind():
    assert max(in_one_thread(numbers)()) == 1
    assert max(numbers()) == 2


def test_an_error_leaves_no_limit():
    def fails():
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        in_one_thread(fails)()
    assert max(numbers()) == 2


def test_calls_that_overlap_leave_no_limit():
    """Of calls that overlap, the first one sets and removes the limit, as in threadpoolctl."""
    both = Barrier(2, timeout=30.0)

    @in_one_thread
    def one():
        both.wait()

    with ThreadPoolExecutor(2) as pool:
        for done in [pool.submit(one), pool.submit(one)]:
            done.result()
    assert max(numbers()) == 2
