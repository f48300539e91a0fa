"""The right-hand side of this project in the same timing loops: the emitted C as it is."""

import time

from kintrafo.generated import macpherson
from kintrafo.generator.backends.files import project_files
from kintrafo.generator.equations.outputs import generate
from kintrafo.generator.mechanisms.macpherson import MODELS

from .case import REPOSITORY, Array, parameters
from .compiled import Source

_ADAPTER = """
KT_RHS(const double *p, const double *x, double *out) {
    static const double inputs[5] = {0.0};
    macpherson_rhs_rack_held(p, x, inputs, out);
}
"""


def source() -> Source:
    """Return ``macpherson_rhs_rack_held`` with the adapter; parameters are prepared constants."""
    folder = REPOSITORY / "generated" / "c"
    # The texts themselves, so that what is compiled follows them.
    code = (folder / "macpherson.c").read_text()
    for header in ("macpherson.h", "elementary.h"):
        code = code.replace(f'#include "{header}"', (folder / header).read_text())
    code += _ADAPTER
    return Source("kintrafo", code, 4, 4, slice(2, 4), is_derivative=True)


def constants() -> Array:
    """Return the prepared constants of the reference car, without what the paper's model lacks."""
    given = parameters()
    return macpherson.prepare({name: given[name] for name in macpherson.PARAMETERS})


def build_seconds() -> tuple[float, float]:
    """Return the time to derive the whole model, and to write all of its files, s."""
    model = next(model for model in MODELS if model.name == "macpherson")
    begin = time.perf_counter()
    derived = generate(model)
    middle = time.perf_counter()
    project_files(derived)
    return middle - begin, time.perf_counter() - middle
