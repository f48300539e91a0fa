"""Build the extension modules: the generated models, and the solver where SUNDIALS is found.

Everything else is in pyproject.toml.
"""

import os
import sys
from pathlib import Path

from Cython.Build import cythonize
from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

GENERATED = Path("generated")
SOURCES = GENERATED / "c"
NATIVE = Path("runtime/native")
# No errno from the mathematical functions, so that roots become single instructions; contraction
# into fused operations is left off, so that every machine computes the same bits.
FLAGS = [] if sys.platform == "win32" else ["-O2", "-fno-math-errno", "-ffp-contract=off"]

# Where SUNDIALS may be: named by the user, in the active environment, or of the system.
PREFIXES = [
    Path(p)
    for p in (os.environ.get("SUNDIALS_ROOT"), os.environ.get("CONDA_PREFIX"), "/usr/local", "/usr")
    if p
] + [Path("/opt/homebrew")]
LIBRARIES = ["cvode", "arkode", "nvecserial", "sunmatrixdense", "sunlinsoldense"]


def model_extension(wrapper: Path) -> Extension:
    """Return an extension module: a Cython file, with the C sources of its model if it has any."""
    name = wrapper.stem.removeprefix("_")
    parts = [SOURCES / f"{name}.c", SOURCES / f"{name}_derivatives.c"]
    sources = [wrapper.as_posix(), *(part.as_posix() for part in parts if part.exists())]
    headers = [path.as_posix() for path in [SOURCES / f"{name}.h"] if path.exists()]
    return Extension(
        f"kintrafo.generated.{wrapper.stem}",
        sources,
        include_dirs=[SOURCES.as_posix()],
        depends=headers,
        extra_compile_args=FLAGS,
    )


def solver_extension() -> Extension | None:
    """Return the extension module of the solver, or None where SUNDIALS is not installed.

    Static libraries are preferred: the module then needs nothing but libm and libc.
    """
    prefix = next((p for p in PREFIXES if (p / "include/cvode/cvode.h").exists()), None)
    if prefix is None:
        print("kintrafo: SUNDIALS not found; integration will use SciPy", file=sys.stderr)
        return None
    static, shared = _libraries(prefix)
    return Extension(
        "kintrafo.native._sundials",
        [(NATIVE / "_sundials.pyx").as_posix(), (NATIVE / "integrate.c").as_posix()],
        include_dirs=[NATIVE.as_posix(), (prefix / "include").as_posix()],
        library_dirs=[(prefix / "lib").as_posix()],
        libraries=[*shared, "m"],
        extra_objects=[path.as_posix() for path in static],
        depends=[(NATIVE / "integrate.h").as_posix()],
        extra_compile_args=FLAGS,
        optional=True,  # a build that fails leaves the fallback
    )


def _libraries(prefix: Path) -> tuple[list[Path], list[str]]:
    """Return static libraries, and the names of those that there are only as shared ones."""
    folders = [prefix / "lib", prefix / "lib64", *sorted((prefix / "lib").glob("*-linux-gnu"))]
    # 7.x has a library "core" where 6.x has "generic"
    static, shared = [], []
    for name in [*LIBRARIES, "generic", "core"]:
        archive = next(
            (
                f / f"libsundials_{name}.a"
                for f in folders
                if (f / f"libsundials_{name}.a").exists()
            ),
            None,
        )
        if archive is not None:
            static.append(archive)
        elif any(list(f.glob(f"libsundials_{name}.*")) for f in folders):
            shared.append(f"sundials_{name}")
    return static, shared


class Build(build_ext):
    """Say so when the solver could not be built."""

    def run(self) -> None:
        """Build all extension modules."""
        super().run()
        for extension in self.extensions:
            if extension.optional and not Path(self.get_ext_fullpath(extension.name)).exists():
                print(
                    f"kintrafo: {extension.name} was not built; integration will use SciPy",
                    file=sys.stderr,
                )


if not list(GENERATED.glob("*.pyx")):
    sys.exit("kintrafo: no generated models in generated/; run `make generate` first")
EXTENSIONS = [model_extension(path) for path in sorted(GENERATED.glob("*.pyx"))]
SOLVER = solver_extension()
setup(
    ext_modules=cythonize([*EXTENSIONS, *([SOLVER] if SOLVER else [])], build_dir="build/cython"),
    cmdclass={"build_ext": Build},
)
