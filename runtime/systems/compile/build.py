"""From a declaration to a compiled module."""

import os
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Literal

from ...core.errors import InputError
from ...core.folders import refuse_shared
from ...core.optional import require
from ...core.suggestions import suggestion
from ...core.validator import Validator
from .cache import alone, appearing, cache_folder, damage, fingerprint, seal
from .compiler import Compiler, CompilerError, find_compiler
from .declaration import model_of, translated_errors
from .identity import identity, identity_of_derived
from .loader import load, refuse_damaged
from .on_terminal import on_terminal
from .packed import packed

if TYPE_CHECKING:
    from ...generator import Formulation, Mechanism
    from ...generator.equations.outputs import Derivation

Backend = Literal["auto", "c", "numpy"]
Report = Callable[[str], None]

_REMEDY = "Install a C compiler (on Debian: apt-get install gcc libc6-dev), or name one in CC"
_COMPILED_PER_S = 8_000  # operations of a file by GCC on a processor of 2024
# by the name of the module: what returns the declaration, and whether it has derivatives by
# parameters
_declared: dict[str, "tuple[Callable[[], Formulation], bool]"] = {}


def compile_mechanism(
    declared: "Formulation | Mechanism | str | Path",
    *,
    name: str | None = None,
    backend: Backend = "auto",
    parameter_derivatives: bool = False,
    folder: str | Path | None = None,
    progress: Report | None = None,
) -> ModuleType:
    """Return the equations of a mechanism, derived and compiled, as a module.

    Compiled mechanisms are kept in a cache, and used again as long as declaration, generator and
    compiler are the same. A declaration with a class of your own, such as a force, is derived at
    each call, since its code may have changed; it is compiled only if the equations differ. Damaged
    files in the cache are detected before they are loaded, reported as a warning, and compiled
    again.

    Parameters
    ----------
    declared : Formulation, Mechanism, str or Path
        A declaration, see `kintrafo.generator`, or a Python file with one at its top level. For a
        `Mechanism` the model has mass in all bodies, and the first independent coordinates for
        which every loop closes in closed form.
    name : str, optional
        Name of the model or mechanism, if the file has several.
    backend : {'auto', 'c', 'numpy'}, optional
        'c': compiled by the C compiler of this machine; the variables ``CC`` and ``CFLAGS`` may
        name another one and its options. 'numpy': the same program over NumPy arrays, slower.
        'auto': C if there is a compiler.
    parameter_derivatives : bool, optional
        Whether to add exact derivatives with respect to parameters, states and inputs, for
        `kintrafo.derivative` and `kintrafo.gradient`: some six times as much code.
    folder : str or Path, optional
        Folder of compiled mechanisms; by default that of the environment variable
        ``KINTRAFO_CACHE``, or else the user's cache folder. Its contents are executed, so that it
        must belong to the user, and no other user may write there.
    progress : callable, optional
        Called with a description of the present step: its name, its size, and its remaining time if
        that is more than ten seconds. By default the description is shown on standard error if this
        is a terminal.

    Returns
    -------
    module
        Module with the interface of those of `kintrafo.generated`: functions over arrays of states,
        names, units and meanings. `kintrafo.System` adds values of parameters.

    Raises
    ------
    InputError
        If the file cannot be run or an argument is not known; if the folder cannot be written, or
        its files cannot be loaded; if another user owns it, or can write there.
    MechanismError
        If the declaration contradicts itself, or a loop has no closed form and the declaration does
        not allow iteration.
    CompilerError
        If the compiler fails.
    MissingPackageError
        If the packages of the extra "generator" are not installed.

    Examples
    --------
    >>> import kintrafo
    >>> from kintrafo.generator.mechanisms.four_bar import FOUR_BAR
    >>> four_bar = kintrafo.compile(FOUR_BAR)
    >>> four_bar.MOBILITY, list(four_bar.STATE)
    (1, ['crank_angle', 'crank_angle_rate'])
    """
    with Validator("compile") as given:
        given.among("backend", backend, ("auto", "c", "numpy"))
        given.function("progress", progress)
        parameter_derivatives = given.flag("parameter_derivatives", parameter_derivatives)
        if folder is not None:
            given.path("folder", folder)
    require_generator()
    from ...generator.equations.outputs import generate
    from ...generator.memory import uncollected

    kept = cache_folder() if folder is None else Path(folder)
    refuse_shared(kept)
    model = model_of(declared, name)
    compiler = _compiler(backend)
    built_by = " ".join((*compiler.command, compiler.version)) if compiler else "numpy"

    @contextmanager
    def shown() -> Iterator[Report]:
        with nullcontext(progress) if progress else on_terminal(f"compile {model.name}") as report:
            yield lambda text: report(f"{model.name}: {text}")

    def derive(notify: Report) -> "Derivation":
        with translated_errors(model):
            return generate(model, parameter_derivatives=parameter_derivatives, progress=notify)

    derived, digest = None, identity(model)
    if digest is None:
        with shown() as notify:
            derived = derive(notify)
        digest = identity_of_derived(derived)
    more = " with parameter_derivatives" if parameter_derivatives else ""
    key = fingerprint(digest + more, built_by=built_by)
    target = kept / f"{model.name}-{key}"
    problem = damage(target)
    if problem and target.exists():
        message = f"{target}: {problem}. The compiled files are damaged, and are built again."
        warnings.warn(message, RuntimeWarning, stacklevel=2)
    if problem:
        with shown() as notify, alone(target, notify):
            if damage(target):  # still, after another process
                with uncollected(), appearing(target) as temporary:
                    derived = derived or derive(notify)
                    build(derived, temporary, compiler, name=target.name, report=notify)
        refuse_damaged(target)
    module = load(target)
    _declared[module.__name__] = (lambda: model), parameter_derivatives
    return module


def packed_mechanism(
    name: str, structure: str, declared: "Callable[[], Formulation]"
) -> ModuleType | None:
    """Return the equations of a mechanism that come compiled with a wheel, by name.

    `structure` is everything that determines their declaration, which `declared` returns for
    `derived_again`. None is returned if there are none of this structure and these sources. Raises
    `InputError` if the cache cannot be written, or others can write there.
    """
    module = packed(name, structure)
    if module is not None:
        _declared[module.__name__] = declared, False
    return module


def derived_again(equations: ModuleType) -> "Derivation":
    """Return the derivation of equations that come with the project or were compiled here.

    Raises `InputError` if the declaration is not known, or now has other equations;
    `MissingPackageError` if the packages of the extra "generator" are not installed.
    """
    require_generator()
    from ...generator.backends.words import mechanism_hash
    from ...generator.equations.outputs import generate
    from ...generator.mechanisms import model_named

    if equations.__name__.startswith("kintrafo."):
        model, by_parameters = model_named(equations.NAME), False
    elif equations.__name__ in _declared:
        declared, by_parameters = _declared[equations.__name__]
        model = declared()
    else:
        problem = "the declaration is not known here. Call kintrafo.compile first, in this process."
        raise InputError([problem], str(equations.NAME))
    with on_terminal(f"derive {model.name}") as notify, translated_errors(model):
        derived = generate(model, parameter_derivatives=by_parameters, progress=notify)
    if mechanism_hash(derived) != equations.MECHANISM_HASH:
        problem = "the declaration now has other equations. Compile the mechanism again."
        raise InputError([problem], str(equations.NAME))
    return derived


def require_generator() -> None:
    """Raise a MissingPackageError if a package for deriving equations is not installed."""
    for package in ("sympy", "networkx"):
        require(package, purpose="Deriving equations", extra="generator")


def _compiler(backend: Backend) -> Compiler | None:
    """Return the compiler to use; None for NumPy."""
    if backend not in ("auto", "c", "numpy"):
        problem = f"backend {backend!r} is not known. {suggestion(backend, ['auto', 'c', 'numpy'])}"
        raise InputError([problem], "compile")
    if backend == "numpy":
        return None
    compiler = find_compiler()
    if compiler is None and backend == "c":
        message = f'there is no C compiler. {_REMEDY}; or use backend="numpy".'
        raise CompilerError(message)
    if compiler is None:
        _warn_once()
    return compiler


@cache
def _warn_once() -> None:
    warnings.warn(
        "there is no C compiler; NumPy evaluates the equations instead, with the same results "
        f"but slower. {_REMEDY}.",
        RuntimeWarning,
        stacklevel=4,
    )


def build(
    derived: "Derivation",
    folder: Path,
    compiler: Compiler | None,
    *,
    name: str | None = None,
    report: Report = lambda _: None,
) -> None:
    """Write the package of a derived model into an empty folder, and compile it.

    Without a compiler it has functions over NumPy arrays instead of C. `name` is the final name of
    the folder, by default its present one; `report` is called with a short description of the
    present step.
    """
    from ...generator.backends.files import own_files

    report("putting the operations in order")
    sizes = _operations_of(derived)
    report(f"writing {sum(sizes.values()):,} operations")
    library = f"lib{derived.formulation.name}.so" if compiler else None
    texts = own_files(derived, library)
    for file, text in texts.items():
        (folder / file).write_text(text, encoding="utf-8", newline="\n")
    if compiler and library:
        sources = [folder / file for file in texts if file.endswith(".c")]
        size = f"{sum(sizes.values()):,} operations in {len(sources)} files"
        size += _estimated(list(sizes.values()))
        report(f"compiling {size}")
        compiler.build(
            sources,
            folder / library,
            lambda done: report(f"compiling {size}: {done} of {len(sources)} files are done"),
        )
    seal(folder, name or folder.name)


def _operations_of(derived: "Derivation") -> dict[str, int]:
    """Return the number of operations in each emitted file."""
    from ...generator.backends.counting import operations_of

    sizes: dict[str, int] = {}
    for function in derived.emitted.values():
        sizes[function.part] = sizes.get(function.part, 0) + operations_of(function).total()
    return sizes


def _estimated(sizes: list[int]) -> str:
    """Return the estimated time to compile files with these operations as a text.

    It is empty if the time is short.
    """
    from ...generator.progress import WORTH_REPORTING_S

    in_turn = sum(sizes) / min(len(sizes), os.cpu_count() or 1)
    seconds = max(*sizes, in_turn) / _COMPILED_PER_S
    return f", about {seconds:.0f} s" if seconds > WORTH_REPORTING_S else ""
