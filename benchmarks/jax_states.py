"""The time of many right-hand sides by ``jax.ffi``, in a process of its own."""

import importlib.util
import math
import time
from pathlib import Path

import jax
import numpy as np

STATES = 100_000


def nanoseconds(script: Path, library: Path, rounds: int) -> float:
    """Return the time of one right-hand side among many, the shortest of all rounds [ns].

    Parameters
    ----------
    script
        Python file of the exported C, which registers its functions with JAX.
    library
        The compiled functions.
    rounds
        Calls after the first one, which compiles.
    """
    jax.config.update("jax_enable_x64", True)
    spec = importlib.util.spec_from_file_location("car", script)
    assert spec is not None
    assert spec.loader is not None
    car = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(car)
    car.load(library)
    states, rates = np.tile(car.STATE, (STATES, 1)), jax.jit(car.rhs)
    best = math.inf
    for _ in range(rounds + 1):
        begin = time.process_time()
        rates(states, car.INPUTS).block_until_ready()
        best = min(best, time.process_time() - begin)
    return 1e9 * best / STATES
