"""Each outcome in turn, and two ways to end the interpreter: the harness is tested on it."""

import os
import time

from kintrafo.core.errors import InputError

from ..attempts import UnjudgedError, WrongError

SECONDS = 0.1
_WAYS = ("clean", "clear", "wrong", "raw", "hung", "exit", "clean", "unjudged")
SHORT = 8  # each once


def attempt(random):
    way = _WAYS[int(random.bit_generator.seed_seq.entropy)]
    if way == "clear":
        raise InputError(["x = -1 m: 0 m or more."], "a file")
    if way == "unjudged":
        raise UnjudgedError("who can say")
    if way == "wrong":
        raise WrongError("twice as much as there is")
    if way == "raw":
        raise KeyError("b_barrel")
    if way == "hung":
        time.sleep(60.0)
    if way == "exit":
        os._exit(7)
