"""Build the generated models as extension modules. Everything else is in pyproject.toml."""

import sys
from pathlib import Path

from Cython.Build import cythonize
from setuptools import Extension, setup

GENERATED = Path("generated")
SOURCES = GENERATED / "c"
# No errno from the mathematical functions, so that roots become single instructions; contraction
# into fused operations is left off, so that every machine computes the same bits.
FLAGS = [] if sys.platform == "win32" else ["-O2", "-fno-math-errno", "-ffp-contract=off"]


def extension(wrapper: Path) -> Extension:
    """Return an extension module: a Cython file, with the C source of its model if it has one."""
    sources, headers = [wrapper.as_posix()], []
    model = SOURCES / f"{wrapper.stem.removeprefix('_')}.c"
    if model.exists():
        sources.append(model.as_posix())
        headers.append(model.with_suffix(".h").as_posix())
    return Extension(
        f"kintrafo.generated.{wrapper.stem}",
        sources,
        include_dirs=[SOURCES.as_posix()],
        depends=headers,
        extra_compile_args=FLAGS,
    )


setup(
    ext_modules=cythonize(
        [extension(path) for path in sorted(GENERATED.glob("*.pyx"))],
        build_dir="build/cython",
    )
)
