"""Equations for other programs: files that need nothing of this package.

`export`           from a system to files, by the name of their target
`emitted`          the exported content: sources, numbers of one parameter set, places of results
`text`             numbers and words as C has them; templates
`c_folder`         plain C with the numbers of this parameter set and an example
`casadi_external`  functions of that folder for ``casadi.external``
`fmu`              a functional mock-up unit of FMI 2.0 or 3.0
`fmi`              what such a unit is made of
`python_module`    functions for CasADi or JAX, printed by a back end of the generator

A target is one file with a function that writes it, named in `export`. Each of them works from the
manifest and the emitted C of a system, and `python_module` from its derivation.
"""

from .export import export_model

__all__ = ["export_model"]
