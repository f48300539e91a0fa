"""Print the link from a model's C code to Python, where it is built with this project."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..templates import template
from ..words import emitted_names, mechanism_hash, reads_given

if TYPE_CHECKING:
    from ...equations.outputs import Derivation
    from ...program.function import Function, Stage


class CythonPrinter:
    """Prints the addresses of the C functions of one model."""

    def __init__(self, derivation: Derivation) -> None:
        self.name = derivation.formulation.name
        self._functions = derivation.emitted
        self._mechanism = mechanism_hash(derivation)
        self._names = emitted_names(derivation)

    def addresses(self) -> str:
        """Return the text of the ``.pyx`` file."""
        of_parameters = [
            f"    int {self.name}_{function}(const double *parameters, double *out)"
            for function in self._names
            if function not in self._functions
        ]
        return template("cython", "addresses.pyx").substitute(
            name=self.name,
            mechanism=self._mechanism,
            declarations="\n".join(
                [*of_parameters, *map(self._declaration, self._functions.values())]
            ),
            addresses="\n".join(f'    "{n}": <uintptr_t> &{self.name}_{n},' for n in self._names),
        )

    def _declaration(self, function: Function | Stage) -> str:
        given = ", const double *given" if reads_given(function) else ""
        return (
            f"    int {self.name}_{function.name}(\n"
            f"        const double *constants, const double *state, const double *inputs{given},\n"
            "        double *out)"
        )
