"""The right-hand sides that are compared, by name, and how each is made."""

import importlib.util
import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from . import ours
from .case import Array, Instant
from .compiled import FLAGS, Source


@dataclass(frozen=True)
class Built:
    """A right-hand side ready to be compiled."""

    source: Source  # C or C++
    constants: Array  # passed to every call
    state: Callable[[Instant], Array]  # from an `Instant` to the peer's own state
    # from an `Instant` and the peer's output to the second derivatives of beta1 and spin
    accelerations: Callable[[Instant, Array], Array]
    # time to set up the equations and to write the code
    derive_seconds: float
    generate_seconds: float


@dataclass(frozen=True)
class Candidate:
    """A right-hand side by name."""

    name: str  # tool and formulation
    parameters: str  # `inputs`, `literal` (numbers in the code) or `data` (of a run-time model)
    needs: tuple[str, ...]  # packages without which it is skipped
    make: Callable[[], Built]  # returns a `Built`
    flags: tuple[str, ...] = tuple(FLAGS)  # names of the compiler flags that it is compiled with

    @property
    def missing(self) -> list[str]:
        """Packages that are not installed."""
        return [name for name in self.needs if importlib.util.find_spec(name) is None]


def candidates() -> list[Candidate]:
    """Return all right-hand sides, this project's first."""
    found = [Candidate("kintrafo", "inputs", (), _ours)]
    for literal in (False, True):
        kind = "literal" if literal else "inputs"
        found += [
            Candidate(f"CasADi tree, {name}", kind, ("casadi",), _casadi_tree(name, literal))
            for name in ("lagrange", "routh", "implicit")
        ]
        found.append(Candidate("CasADi maximal", kind, ("casadi",), _casadi_maximal(literal)))
        needs = ("sympy", "casadi")
        found.append(Candidate("SymPy KanesMethod", kind, needs, _sympy(literal)))
    needs = ("pinocchio", "sympy", "casadi")
    # Its headers take the compiler some minutes, and are made for the fastest flags.
    return [*found, Candidate("Pinocchio", "data", needs, _pinocchio, ("native",))]


def _ours() -> Built:
    derived, written = ours.build_seconds()
    return Built(ours.source(), ours.constants(), _same, _last_two, derived, written)


def _same(instant: Instant) -> Array:
    return instant.state


def _last_two(_: Instant, out: Array) -> Array:
    return out[2:4]


def _casadi_tree(formulation: str, literal: bool) -> Callable[[], Built]:
    def make() -> Built:
        from . import casadi_tree as peer

        model = peer.build(formulation, literal=literal)
        source, seconds = peer.source(model.function, slice(2, 4), starts_with_beta1=True)
        return Built(source, model.constants, _same, _last_two, model.seconds, seconds)

    return make


def _casadi_maximal(literal: bool) -> Callable[[], Built]:
    def make() -> Built:
        from . import casadi_maximal as peer
        from .casadi_tree import source as generate

        model = peer.build(literal=literal)
        source, seconds = generate(model.function, peer.ACCELERATIONS, starts_with_beta1=False)
        state, read = peer.state, peer.accelerations
        return Built(source, model.constants, state, read, model.seconds, seconds)

    return make


def _sympy(literal: bool) -> Callable[[], Built]:
    def make() -> Built:
        from . import sympy_kane as peer

        source, derived, printed = peer.build(literal=literal)
        constants = np.zeros(0) if literal else peer.constants()
        return Built(source, constants, peer.state, lambda _, out: out[6:8], derived, printed)

    return make


def _pinocchio() -> Built:
    from . import pinocchio_model as peer

    begin = time.perf_counter()
    source = peer.source()
    seconds = time.perf_counter() - begin
    constants = np.zeros(0)
    return Built(source, constants, peer.state, lambda _, o: peer.accelerations(o), 0.0, seconds)
