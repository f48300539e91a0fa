"""Build the extension modules: the generated models, and the solver where SUNDIALS is found.

Everything else is in pyproject.toml.
"""

import json
import os
import platform
import re
import runpy
import shlex
import shutil
import subprocess
import sys
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from copy import copy
from pathlib import Path
from typing import Any

from Cython.Build import cythonize
from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext
from setuptools.errors import CompileError
from setuptools.modified import newer, newer_group

GENERATED = Path("generated")
SOURCES = GENERATED / "c"
NATIVE = Path("runtime/simulation/native")
# Those of runtime/systems/compile/compiler.py, for the same reasons. Without debug information, for
# which Python's own options ask, GCC takes a third less time.
_OPTIONS = "-O2 -g0 -fno-tree-slp-vectorize -fno-math-errno -ffp-contract=off"
FLAGS = [] if sys.platform == "win32" else _OPTIONS.split()

LANES = Path("runtime/simulation/lanes")
OPTIONS = runpy.run_path(str(LANES / "options.py"))
WIDTHS, SCHEDULED = OPTIONS["OF_WIDTH"], OPTIONS["SCHEDULED"]

# Libraries of functional mock-up units (FMUs), for one platform only, see
# runtime/targets/fmi/binaries.py. They share objects with the modules; functions that FMI does not
# call are neither visible nor kept.
FMI = Path("runtime/targets/fmi")
FILES = runpy.run_path(str(FMI / "files.py"))
FOR_FMUS = (sys.platform, platform.machine()) == ("linux", "x86_64")
COMMON = FILES["common_files"](FMI, NATIVE, FILES["HEADERS"])
FMU_OBJECTS = "fmu"
SECTIONS = ["-ffunction-sections", "-fdata-sections"] if FOR_FMUS else []
EXPORTED = "{ global: fmi2*; fmi3*; local: *; };\n"

# Where SUNDIALS may be: in the place that the user names, or built here by `.ci/sundials`, or in
# the active environment, or of the system. `.ci/setup` looks in the same places, and builds it
# rather than take that of Debian, which is not optimised.
NAMED = os.environ.get("SUNDIALS_ROOT")
OTHERS = ["build/sundials", os.environ.get("CONDA_PREFIX"), "/usr/local", "/opt/homebrew", "/usr"]
PREFIXES = [NAMED] if NAMED else OTHERS
HEADER = "include/cvode/cvode.h"
LIBRARIES = ["cvode", "arkode", "nvecserial", "sunmatrixdense", "sunlinsoldense"]


def model_extension(wrapper: Path) -> Extension:
    """Return the extension module of a model: a Cython file, with the C files that it is about."""
    name = wrapper.stem.removeprefix("_")
    manifest = json.loads((GENERATED / f"{name}.json").read_text(encoding="utf-8"))
    files = [(SOURCES / source).as_posix() for source in manifest["sources"]]
    return Extension(
        f"kintrafo.generated.{wrapper.stem}",
        [wrapper.as_posix(), *(file for file in files if file.endswith(".c"))],
        include_dirs=[SOURCES.as_posix()],
        depends=[file for file in files if file.endswith(".h")],
        extra_compile_args=[*FLAGS, *SECTIONS],
    )


def solver_extension() -> Extension | None:
    """Return the extension module of the solver, or None where SUNDIALS is not installed.

    Static libraries are preferred: the module then needs nothing but libm and libc.
    """
    prefix = next((Path(p) for p in PREFIXES if p and (Path(p) / HEADER).exists()), None)
    if prefix is None:
        if NAMED:
            sys.exit(f"kintrafo: SUNDIALS_ROOT = {NAMED}: there is no {HEADER} in it")
        print("kintrafo: SUNDIALS not found; integration will use SciPy", file=sys.stderr)
        return None
    folders = [prefix / "lib", prefix / "lib64", *sorted((prefix / "lib").glob("*-linux-gnu"))]
    static, shared, homes = _libraries(folders)
    headers, linked = _mpi_flags(prefix / "include")
    return Extension(
        "kintrafo.simulation.native._sundials",
        [path.as_posix() for path in (NATIVE / "_sundials.pyx", *sorted(NATIVE.glob("[!_]*.c")))],
        include_dirs=[NATIVE.as_posix(), (prefix / "include").as_posix()],
        library_dirs=homes,
        # found again when the module is imported, wherever they are
        runtime_library_dirs=[] if sys.platform == "win32" else homes,
        libraries=[*shared, "m"],
        extra_objects=[path.as_posix() for path in static],
        depends=[*_headers(NATIVE), *(path.as_posix() for path in static)],
        extra_compile_args=[*FLAGS, *headers],
        extra_link_args=linked,
    )


class Lanes(Extension):
    """A library that is compiled once for each width, and called by `ctypes`.

    Attributes
    ----------
    wide : sequence of str
        Sources that are compiled for each width.
    renamed : sequence of str
        Functions that are there once for each width; it is added to their names.
    fixed : sequence of str
        Sources that are compiled once.
    """

    def __init__(
        self, name: str, sources: Sequence[str], *, renamed: Sequence[str] = (),
        fixed: Sequence[str] = (), macros: Sequence[tuple[str, str]] = (),
        depends: Sequence[str] = (),
    ) -> None:  # fmt: skip
        super().__init__(
            name,
            [],
            define_macros=list(macros),
            include_dirs=[SOURCES.as_posix(), LANES.as_posix()],
            depends=[*sources, *fixed, *depends],
            optional=True,  # without it, everything but ensembles works
        )
        self.wide, self.renamed = sources, renamed
        self.fixed = [*fixed, (LANES / "module.c").as_posix()]

    def compile(self, compiler: Any, folder: str) -> list[str]:
        """Compile everything, and return the objects."""
        module = self.name.rpartition(".")[2]
        scheduled = SCHEDULED if _is_gcc(compiler.compiler_so[0]) else []

        def objects(sources: Sequence[str], width: int, flags: list[str]) -> list[str]:
            names = [(function, f"{function}_{width}") for function in self.renamed]
            return compiler.compile(
                [*sources],
                output_dir=f"{folder}/{self.name}/{width}",
                macros=[*self.define_macros, *names, ("WIDTH", str(width)), ("MODULE", module)],
                include_dirs=self.include_dirs,
                extra_postargs=[*FLAGS, *scheduled, *flags],
            )

        made = [objects(self.wide, width, flags) for width, flags in WIDTHS.items()]
        made.append(objects(self.fixed, 1, []))
        return [path for paths in made for path in paths]


class FmuLibrary(Extension):
    """The library of a model for FMUs, without numbers.

    Parameters
    ----------
    name : str
        Of the model.
    emitted : sequence of str
        C files of its equations, which are compiled before, with its module.
    """

    def __init__(self, name: str, emitted: Sequence[str]) -> None:
        self.tables = {f: GENERATED / f"fmu/{name}_{f}" for f in ("model.c", "numbers.c")}
        self.model, self.equations = name, {Path(file).name: Path(file) for file in emitted}
        files = [*COMMON.values(), *self.tables.values(), *self.equations.values()]
        super().__init__(
            f"kintrafo.generated._{name}_fmu",
            [],
            depends=[path.as_posix() for path in files],
            optional=True,  # without it, the export of an FMU needs a compiler
        )

    def link(self, compiler: Any, folder: str, common: Sequence[str], path: str) -> None:
        """Write the library with a hash of its sources as its token.

        Parameters
        ----------
        compiler : object
            Of setuptools.
        folder : str
            Of objects.
        common : sequence of str
            Objects that all libraries have.
        path : str
            Of the library.
        """
        equations = {f"{FILES['EQUATIONS']}/{n}": p for n, p in self.equations.items()}
        files = {**COMMON, **equations, **self.tables}
        texts = {name: path.read_text(encoding="utf-8") for name, path in files.items()}
        own = Path(folder) / FMU_OBJECTS / self.model
        for name in (*self.tables, *equations):  # headers are where the tables include them
            (own / name).parent.mkdir(parents=True, exist_ok=True)
            (own / name).write_text(texts[name], encoding="utf-8")
        tables = compile_for_fmus(compiler, [(own / name).as_posix() for name in self.tables], "")
        # the objects of the module, which is built before
        sources = [p.as_posix() for p in self.equations.values() if p.suffix == ".c"]
        objects = compiler.object_filenames(sources, output_dir=folder)
        old = [source for source, made in zip(sources, objects, strict=True) if newer(source, made)]
        if old:
            compile_for_fmus(compiler, old, folder)
        exported = own / "exported.map"
        exported.write_text(EXPORTED, encoding="utf-8")
        # Python's own command for modules may add folders of this machine for a search at run time
        linker = copy(compiler)
        linker.linker_so = [w for w in compiler.linker_so if not w.startswith("-Wl,-rpath")]
        options = ["-Wl,--gc-sections,--no-undefined", f"-Wl,--version-script={exported}", "-s"]
        linker.link_shared_object(
            [*common, *tables, *objects], path, libraries=["m"], extra_postargs=options
        )
        library = Path(path)
        library.write_bytes(FILES["filled"](library.read_bytes(), FILES["digest"](texts)))


def compile_for_fmus(compiler: Any, sources: Sequence[str], folder: str) -> list[str]:
    """Compile C files of libraries for FMUs, and return the objects."""
    headers = [FMI / "core", FMI / "headers", NATIVE, SOURCES]
    return compiler.compile(
        [*sources],
        output_dir=folder,
        include_dirs=[path.as_posix() for path in headers],
        extra_postargs=[*FLAGS, *SECTIONS, "-fno-lto"],  # see runtime/targets/fmi/binaries.py
    )


def fmu_libraries(wrappers: Iterable[Path]) -> Iterator[FmuLibrary]:
    """Yield the libraries of the models for FMUs, if this machine can run them."""
    for wrapper in wrappers if FOR_FMUS else ():
        name = wrapper.stem.removeprefix("_")
        manifest = json.loads((GENERATED / f"{name}.json").read_text(encoding="utf-8"))
        yield FmuLibrary(name, [(SOURCES / source).as_posix() for source in manifest["sources"]])


def _headers(*folders: Path) -> list[str]:
    return sorted(path.as_posix() for folder in folders for path in folder.glob("*.h"))


def _is_gcc(program: str) -> bool:
    command = [program, "--version"]
    shown = subprocess.run(command, capture_output=True, text=True, check=False)
    return "Free Software Foundation" in shown.stdout


def lanes_extensions(wrappers: Iterable[Path]) -> Iterator[Lanes]:
    """Yield the solver in lanes, and the models."""
    if not WIDTHS:
        return
    yield Lanes(
        "kintrafo.simulation.lanes._integrate",
        [(LANES / name).as_posix() for name in ("integrate.c", "directions.c")],
        fixed=[(LANES / "width.c").as_posix()],
        depends=_headers(LANES, NATIVE),
    )
    for wrapper in wrappers:
        name = wrapper.stem.removeprefix("_")
        manifest = json.loads((GENERATED / f"{name}.json").read_text(encoding="utf-8"))
        functions = ["prepare", "design_state", "rhs", "signals", "bounded", "margins"]
        functions += [f"rhs_{variant}" for variant in manifest["held_variants"]]
        iterates = any("iterates" in function for function in manifest["functions"].values())
        yield Lanes(
            f"kintrafo.generated._{name}_lanes",
            [(LANES / "model.c").as_posix()],
            renamed=[f"{name}_{function}" for function in functions],
            macros=[("MODEL", f'"{name}.c"')],
            depends=[
                *((SOURCES / f).as_posix() for f in (f"{name}.c", f"{name}.h", "elementary.h")),
                (LANES / "vectors.h").as_posix(),
                *([(LANES / "follow.h").as_posix()] if iterates else []),
            ],
        )


def _libraries(folders: list[Path]) -> tuple[list[Path], list[str], list[str]]:
    """Return static libraries, and names and folders of those that are shared ones only."""
    static, shared, homes = [], [], []
    # 7.x has a library "core" where 6.x has "generic"
    for name in [*LIBRARIES, "generic", "core"]:
        found = [f for folder in folders for f in folder.glob(f"libsundials_{name}.*")]
        archives = [f for f in found if f.suffix == ".a"]
        if archives:
            static.append(archives[0])
        elif found:
            shared.append(f"sundials_{name}")
            homes.append(found[0].parent.as_posix())
    return static, shared, sorted(set(homes))


def _mpi_flags(include: Path) -> tuple[list[str], list[str]]:
    """Return what compiler and linker need where SUNDIALS has MPI in its core.

    This is so for the packages of 7.x in Debian and Homebrew. No function of MPI is ever called.
    """
    config = (include / "sundials/sundials_config.h").read_text(encoding="utf-8")
    since_7 = int(re.search(r"SUNDIALS_VERSION_MAJOR (\d+)", config)[1]) >= 7
    if not (since_7 and re.search(r"^#define SUNDIALS_MPI_ENABLED 1", config, re.MULTILINE)):
        return [], []
    compiler = shutil.which("mpicc")
    if compiler is None:
        print("kintrafo: this SUNDIALS was built with MPI, and there is no mpicc", file=sys.stderr)
        return [], []
    command = [compiler, "-show"]
    shown = subprocess.run(command, capture_output=True, text=True, check=True)
    words = shlex.split(shown.stdout)[1:]  # behind the name of the compiler
    headers = [word for word in words if word.startswith("-I")]
    return headers, [word for word in words if word not in headers]


# What compiles the models, by the system's own way to install it.
REMEDY = """Install it and try again:
  Debian, Ubuntu   apt-get install gcc libc6-dev python3-dev
  Fedora           dnf install gcc python3-devel
  macOS            xcode-select --install
  conda            conda install -c conda-forge c-compiler
Or name another compiler in the variable CC."""


class Build(build_ext):
    """Compile on all cores; say what to install where a compiler is missing."""

    def initialize_options(self) -> None:
        """Begin with as many compilers at a time as there are cores."""
        super().initialize_options()
        self.parallel = os.cpu_count()

    def build_extensions(self) -> None:
        """Build all extension modules, if there is what compiles them."""
        # a compiler of Windows has no such command, and says itself what is missing
        program = (getattr(self.compiler, "compiler_so", None) or [None])[0]
        if program and shutil.which(program) is None:
            sys.exit(f"kintrafo: its equations are C, and there is no compiler {program}. {REMEDY}")
        if not any((Path(folder) / "Python.h").exists() for folder in self.include_dirs):
            sys.exit(f"kintrafo: Python's own header Python.h is not installed. {REMEDY}")
        of_fmus = [ext for ext in self.extensions if isinstance(ext, FmuLibrary)]
        modules = [ext for ext in self.extensions if ext not in of_fmus]
        self._build(modules)
        if any(map(self._is_old, of_fmus)):
            sources = [path.as_posix() for path in COMMON.values() if path.suffix == ".c"]
            try:
                with ThreadPoolExecutor(os.cpu_count()) as pool:
                    self.fmu_objects = list(pool.map(self._common_object, sources))
            except CompileError:
                return  # the libraries are optional
        self._build(of_fmus)

    def _build(self, extensions: list[Extension]) -> None:
        """Build some of the extension modules."""
        every, self.extensions = self.extensions, extensions
        super().build_extensions()
        self.extensions = every

    def _common_object(self, source: str) -> str:
        return compile_for_fmus(self.compiler, [source], f"{self.build_temp}/{FMU_OBJECTS}")[0]

    def _is_old(self, ext: Extension) -> bool:
        """Return whether an extension module is missing, or older than one of its files."""
        path = self.get_ext_fullpath(ext.name)
        return self.force or newer_group([*ext.sources, *ext.depends], path)

    def build_extension(self, ext: Extension) -> None:
        """Build an extension module; one in lanes for every width."""
        path = self.get_ext_fullpath(ext.name)
        if not self._is_old(ext):
            return
        # where the build of an optional one fails, an old one is not what these sources say
        Path(path).unlink(missing_ok=True)
        if isinstance(ext, FmuLibrary):
            ext.link(self.compiler, self.build_temp, self.fmu_objects, path)
            return
        if isinstance(ext, Lanes):
            ext.extra_objects = ext.compile(self.compiler, self.build_temp)
        super().build_extension(ext)

    def run(self) -> None:
        """Build all extension modules."""
        super().run()
        for extension in self.extensions:
            if extension.optional and not Path(self.get_ext_fullpath(extension.name)).exists():
                without = {Lanes: "ensembles", FmuLibrary: "it"}.get(type(extension), "SUNDIALS")
                print(
                    f"kintrafo: {extension.name} was not built; continuing without {without}",
                    file=sys.stderr,
                )


if not list(GENERATED.glob("*.pyx")):
    sys.exit("kintrafo: no generated models in generated/; run `make generate` first")
# what calls the functions of any model
CALLS = [
    Extension(
        f"kintrafo.{name.replace('/', '.')}", [f"runtime/{name}.pyx"], extra_compile_args=FLAGS
    )
    for name in ("equations/_calls", "simulation/_steps")
]
EXTENSIONS = [*CALLS, *(model_extension(path) for path in sorted(GENERATED.glob("*.pyx")))]
SOLVER = solver_extension()
MODULES = cythonize([*EXTENSIONS, *([SOLVER] if SOLVER else [])], build_dir="build/cython")
for module in MODULES:
    # a build of the solver that fails leaves SciPy; set here, since cythonize does not keep it
    module.optional = SOLVER is not None and module.name == SOLVER.name
# the longest first, so that no core waits for it at the end
WRAPPERS = sorted(GENERATED.glob("*.pyx"))
MODULES = [*lanes_extensions(WRAPPERS), *MODULES, *fmu_libraries(WRAPPERS)]
README = runpy.run_path(".ci/long_description.py")
REPOSITORY, _ = README["repository_and_revision"]()
setup(
    ext_modules=MODULES,
    cmdclass={"build_ext": Build},
    long_description=README["long_description"](Path()),
    long_description_content_type="text/markdown",
    project_urls={"Repository": REPOSITORY} if REPOSITORY else {},
)
