"""A command as a processor of 2008 would run it: ``python -m benchmarks.older_processor COMMAND``.

The C library, NumPy and OpenBLAS choose among versions of a function by what the processor has.
Each has a setting that hides some features from it.
"""

import os
import sys

import numpy as np


def environment() -> dict[str, str]:
    """Return what makes a process see no AVX and no fused operations."""
    # their names change with NumPy's versions, and one that is not there is a warning
    found = np.show_config(mode="dicts")["SIMD Extensions"].get("found", [])
    return {
        "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX,-AVX2,-FMA,-FMA4",
        "NPY_DISABLE_CPU_FEATURES": " ".join(found),
        "OPENBLAS_CORETYPE": "Nehalem",
    }


if __name__ == "__main__":
    os.execvpe(sys.argv[1], sys.argv[1:], os.environ | environment())  # noqa: S606 (a command of the caller's, and no shell to read it another way)
