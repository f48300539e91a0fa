"""The compiled libraries for lanes, and the widths that the processor supports."""

import ctypes
from collections.abc import Callable, Mapping
from functools import cache
from importlib import import_module
from types import ModuleType

from ...core.errors import InputError, KintrafoError
from ...equations.directions import TANGENTS
from .options import OF_WIDTH
from .own import is_own, library_of

_SOLVER = f"{__package__}._integrate"


def widths() -> tuple[int, ...]:
    """Return the numbers of lanes on this machine in ascending order; () if none were built."""
    solver = _library(_SOLVER)
    if solver is None:
        return ()
    widest: int = solver.kt_widest()
    return tuple(w for w in OF_WIDTH if w <= widest and hasattr(solver, f"kt_integrate_{w}"))


def solver(what: str, width: int) -> Callable[..., int]:
    """Return the C function ``integrate`` (many systems) or ``follow`` (directions) of a width.

    It is called without the interpreter's lock.
    """
    return getattr(_library(_SOLVER), f"kt_{what}_{width}")


def functions(equations: ModuleType, width: int, variant: str) -> Mapping[str, int]:
    """Return the addresses of a model's functions in some lanes; zero for those it does not have.

    `width` is one of `widths`, `variant` the suffix of the name of the right-hand side without
    coordinates at rest. Raises `InputError` if the equations cannot be compiled for lanes.
    """
    name: str = equations.NAME
    if not widths():
        problem = (
            "kintrafo was built without lanes, for which it needs GCC or Clang. Build it again "
            "with one of them, or call simulate for each."
        )
        raise InputError([problem], "ensemble")
    library, end = _of(equations, width)
    names = {key: key for key in ("prepare", "design_state", "signals", "bounded", "margins")}
    names["rhs"] = f"rhs{variant}"
    return {key: _address(library, f"{name}_{what}{end}") for key, what in names.items()}


@cache
def tangents(equations: ModuleType, width: int) -> Mapping[str, int] | None:
    """Return the addresses of a model's functions along directions in one of `widths`.

    They are ``rhs_tangent``, and ``signals_tangent``, which is zero without signals; None without a
    compiler.
    """
    if not is_own(equations):
        return None
    try:
        library = _loaded(str(library_of(equations, width, TANGENTS)))
    except (KintrafoError, OSError):
        return None
    names = ("rhs_tangent", "signals_tangent")
    return {what: _address(library, f"{equations.NAME}_{what}") for what in names}


def compiled(equations: ModuleType) -> ctypes.CDLL | None:
    """Return the library of equations that come with the project; None if it was not built."""
    package = equations.__name__.rpartition(".")[0]
    return _library(f"{package}._{equations.NAME}_lanes")


@cache
def _of(equations: ModuleType, width: int) -> tuple[ctypes.CDLL, str]:
    """Return the library of equations, and the suffix of the names of its functions."""
    if is_own(equations):
        return _loaded(str(library_of(equations, width))), ""
    library = compiled(equations)
    assert library is not None  # built with the solver
    return library, f"_{width}"


def _address(library: ctypes.CDLL, name: str) -> int:
    function = getattr(library, name, None)
    return (ctypes.cast(function, ctypes.c_void_p).value or 0) if function else 0


@cache
def _library(name: str) -> ctypes.CDLL | None:
    """Load a library; return None if there is none."""
    try:
        module = import_module(name)
    except ModuleNotFoundError:
        return None
    return _loaded(str(module.__file__))


@cache
def _loaded(path: str) -> ctypes.CDLL:
    return ctypes.CDLL(path)
