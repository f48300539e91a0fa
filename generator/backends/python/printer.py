"""Print the module of a model: the contents of its manifest, as names of Python.

It imports the functions from a file beside it, which is Cython where the C code is built with this
project, and Python where it is in a shared library, or where there is no C.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..templates import template
from ..words import emitted_names, mechanism_hash

if TYPE_CHECKING:
    from ...equations.outputs import Derivation


def module(derivation: Derivation) -> str:
    """Return the text of the ``.py`` file."""
    names = {"name": derivation.formulation.name, "title": derivation.formulation.title}
    return template("python", "model.py").substitute(names)


def addresses_in(derivation: Derivation, library: str) -> str:
    """Return the text of a ``.py`` file that finds the functions in a library beside it."""
    return template("python", "addresses.py").substitute(
        name=derivation.formulation.name,
        library=library,
        mechanism=mechanism_hash(derivation),
        functions="\n".join(f'        "{name}",' for name in emitted_names(derivation)),
    )
