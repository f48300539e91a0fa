"""From a system to files for other programs."""

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any

from ..core.files import Paths, refuse
from ..core.named_types import ArrayLike
from ..core.validator import Validator
from ..systems.state import inputs_of
from ..systems.system import System
from . import c_folder, fmu, python_module
from .emitted import Emitted

Write = Callable[..., Path]
TARGETS: Mapping[str, Write] = {
    "c": c_folder.write,
    "fmu": fmu.write,
    "casadi": python_module.write_casadi,
    "jax": python_module.write_jax,
}
"""What writes each kind of export: of an `Emitted` and a path, with options of its own."""
CHECKS: Mapping[str, Callable[..., None]] = {
    "c": c_folder.check,
    "fmu": fmu.check,
    "casadi": partial(python_module.check, "casadi"),
    "jax": partial(python_module.check, "jax"),
}
"""What refuses a path, and options of its own, before there is a model."""
ENDINGS: Mapping[str, str] = {
    "c": "_c",
    "fmu": fmu.ENDING,
    "casadi": f"_casadi{python_module.ENDING}",
    "jax": f"_jax{python_module.ENDING}",
}
"""What is added to a name where no path is given."""


def export_model(
    system: System,
    path: str | Path,
    to: str,
    *,
    state: ArrayLike | None = None,
    inputs: Mapping[str, float] | None = None,
    force: bool = False,
    read: Paths = (),
    **options: Any,
) -> Path:
    """Write a model for other programs, with the numbers of its parameters.

    Parameters
    ----------
    system : System, Model, AxleModel or RigidAxleModel
        With compiled equations.
    path : str or pathlib.Path
        Path to write: a folder for 'c', a file that ends in ``.fmu`` for 'fmu', in ``.py`` for
        'casadi' and 'jax'.
    to : {'c', 'fmu', 'casadi', 'jax'}
        'c': plain C99 without dependencies, with a CMake file and an example. 'fmu': a functional
        mock-up unit for Model Exchange and Co-Simulation. 'casadi': a Python module of functions
        of CasADi. 'jax': one of functions over arrays of JAX. Both are derived anew, for which the
        packages of the extra "generator" are needed.
    state : array_like, optional
        State at the start; by default the design position at rest. A state of `equilibrium`
        contains its inputs.
    inputs : mapping, optional
        Values that inputs start with, by name, SI units; zero, or those of the state, by default.
    force : bool, optional
        Whether files that kintrafo did not write are replaced, see `kintrafo.core.files`.
    read : iterable of str or pathlib.Path, optional
        Files that are never replaced, such as that of the suspension.
    **options
        Of 'fmu': ``fmi``, 2 or 3, the version of the standard, 2 by default; ``platforms``, names
        from 'linux' and 'windows', for which there is a compiled library, by default this one.

    Returns
    -------
    pathlib.Path
        Path of the written file or folder, which appears only when it is complete.

    Raises
    ------
    InputError
        If an argument cannot be used, or an existing file must not be replaced; for 'casadi' and
        'jax', if the equations iterate.
    MissingPackageError
        If equations must be derived, and the packages for that are not installed.
    ClosureError
        If there is no motion from the state at the start, since a loop cannot close there.
    CompilerError
        If a library is to be compiled, and there is no compiler for it, or it fails.

    Examples
    --------
    >>> import kintrafo
    >>> from tempfile import TemporaryDirectory
    >>> from kintrafo.generated import four_bar
    >>> with TemporaryDirectory() as folder:
    ...     written = kintrafo.export_model(kintrafo.System(four_bar), f"{folder}/bar", "c")
    ...     sorted(file.name for file in written.iterdir())[:4]
    ['CMakeLists.txt', 'README.txt', 'elementary.h', 'four_bar.c']
    """
    check_export(path, to, force=force, read=read, **options)
    with Validator("export") as given:
        given.instance("system", system, System, System.NEEDED)
        if not given.failed:
            start = system.design_state
            if state is not None:
                count = len(system.state_names)
                start = given.array("state", state, dimensions=[1], last=count, empty=True)
    held = inputs_of(state, system.names_of_states)
    first = system.inputs() if held is None else held.copy()
    named = {} if inputs is None else inputs
    values = system.inputs(named)
    for name in named:
        first[system.input_names.index(name)] = values[system.input_names.index(name)]
    _evaluate(system, start, first)
    emitted = Emitted(system, start, first)
    return TARGETS[to](emitted, Path(path), force=force, read=read, **options)


def check_export(
    path: str | Path, to: str, *, force: bool = False, read: Paths = (), **options: Any
) -> None:
    """Refuse arguments that `export_model` cannot use with any model.

    Parameters
    ----------
    path, to, force, read, **options
        As of `export_model`.

    Raises
    ------
    InputError
        If an argument cannot be used, or an existing file must not be replaced.
    MissingPackageError
        If packages are needed that are not installed.
    """
    with Validator("export") as given:
        given.path("path", path)
        given.among("to", to, TARGETS)
        given.flag("force", force)
        if not given.failed:
            _refuse_options(given, to, options)
    CHECKS[to](Path(path), **options)
    if to != "c":  # whose files have names of their own
        refuse([path], force=force, inputs=read)


def _evaluate(system: System, state: ArrayLike, inputs: ArrayLike) -> None:
    """Raise the error of a state at which the equations do not hold."""
    for name in ("rhs", "signals"):
        if name in system.equations.equations.functions:
            system.evaluate(name, state, inputs)


def _refuse_options(given: Validator, to: str, options: Mapping[str, Any]) -> None:
    """Refuse options that another kind of export has."""
    known = TARGETS[to].__kwdefaults__ or {}
    for name in options:
        if name not in known:
            has = ", ".join(known) or "none"
            given.fail(f"{name} is not an option of an export to {to!r}, which has {has}.")
