"""Export of a system to files for other programs."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ..core.files import Paths, refuse
from ..core.named_types import ArrayLike
from ..core.validator import Validator
from ..systems.state import inputs_of
from ..systems.system import System
from . import c_folder, fmu, python_module
from .emitted import Emitted
from .target import Target

TARGETS: Mapping[str, Target] = {
    target.name: target
    for target in (c_folder.TARGET, fmu.TARGET, python_module.CASADI, python_module.JAX)
}
"""The kinds of export by name."""


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
    """Write a model for other programs, with the values of its parameters, and return its path.

    Parameters
    ----------
    system : System, Model, AxleModel, RigidAxleModel or CarModel
        The model, with its compiled equations.
    path : str or pathlib.Path
        Path to write: a folder for 'c', a file that ends in ``.fmu`` for 'fmu', in ``.py`` for
        'casadi' and 'jax'.
    to : {'c', 'fmu', 'casadi', 'jax'}
        'c': plain C99 without dependencies, with a CMake file and an example. 'fmu': a functional
        mock-up unit for Model Exchange and Co-Simulation. 'casadi': a Python module of functions
        of CasADi. 'jax': one of functions over arrays of JAX. For 'casadi' and 'jax' the equations
        are derived again, which needs the packages of the extra "generator".
    state : array_like, optional
        Initial state, SI units; by default the design position at rest.
    inputs : mapping, optional
        Initial inputs by name, SI units; by default zero, or those of a `State`, such as that of
        `equilibrium`.
    force : bool, optional
        Whether files that kintrafo did not write are replaced, see `kintrafo.core.files`.
    read : iterable of str or pathlib.Path, optional
        Files that are never replaced, such as that of the suspension.
    **options
        Of 'fmu': ``fmi``, the version of the standard, 2 (default) or 3; ``platforms``, a sequence
        of 'linux' and 'windows' for compiled libraries, by default 'linux' on
        Linux for x86-64, and none elsewhere.

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
        If the packages for deriving equations are needed and not installed.
    ClosureError
        If a loop cannot close in the initial state.
    CompilerError
        If there is no compiler for a library, or it fails.

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
    return TARGETS[to].write(emitted, Path(path), force=force, read=read, **options)


def check_export(
    path: str | Path, to: str, *, force: bool = False, read: Paths = (), **options: Any
) -> None:
    """Refuse arguments that `export_model` cannot use with any model.

    They are as there: path, kind of export, whether other files are replaced, files that are never
    replaced, and options of the kind. Raises `InputError` if an argument cannot be used, or an
    existing file must not be replaced, and `MissingPackageError` if packages are missing.
    """
    with Validator("export") as given:
        given.path("path", path)
        given.among("to", to, TARGETS)
        given.flag("force", force)
        if not given.failed:
            _refuse_options(given, to, options)
    TARGETS[to].check(Path(path), **options)
    if not TARGETS[to].folder:
        refuse([path], force=force, inputs=read)


def _evaluate(system: System, state: ArrayLike, inputs: ArrayLike) -> None:
    """Raise the error of a state in which the equations cannot be evaluated."""
    for name in ("rhs", "signals"):
        if name in system.equations.equations.functions:
            system.evaluate(name, state, inputs)


def _refuse_options(given: Validator, to: str, options: Mapping[str, Any]) -> None:
    """Refuse options that only another kind of export has."""
    known = TARGETS[to].options
    for name in options:
        if name not in known:
            has = ", ".join(known) or "none"
            given.fail(f"{name} is not an option of an export to {to!r}, which has {has}.")
