"""Writing property files of tyres (.tir)."""

from pathlib import Path
from typing import TYPE_CHECKING

from ...core.errors import InputError
from ...core.files import Paths, write_text
from ...core.legible import legible
from ...core.validator import Validator
from ...formulas.coefficients import NEUTRAL, SCALES
from . import coefficients as known

if TYPE_CHECKING:
    from .magic_formula import MagicFormula

_SECTIONS = (
    ("MODEL", ("LONGVL", "VXLOW")),
    ("DIMENSION", ("UNLOADED_RADIUS",)),
    ("OPERATING_CONDITIONS", ("INFLPRES", "NOMPRES")),
    ("VERTICAL", ("FNOMIN", "VERTICAL_", "BREFF", "DREFF", "FREFF", "Q_", "PFZ")),
    ("STRUCTURAL", ("LONGITUDINAL_", "LATERAL_", "PCFX", "PCFY")),
    ("INFLATION_PRESSURE_RANGE", ("PRES",)),
    ("VERTICAL_FORCE_RANGE", ("FZM",)),
    ("LONG_SLIP_RANGE", ("KPU",)),
    ("SLIP_ANGLE_RANGE", ("ALP",)),
    ("INCLINATION_ANGLE_RANGE", ("CAM",)),
    ("SCALING_COEFFICIENTS", SCALES),
    (
        "LONGITUDINAL_COEFFICIENTS",
        ("PCX", "PDX", "PEX", "PKX", "PHX", "PVX", "PPX", "PTX", "RBX", "RCX", "REX", "RHX"),
    ),
    ("OVERTURNING_COEFFICIENTS", ("QSX", "PPMX")),
    (
        "LATERAL_COEFFICIENTS",
        ("PCY", "PDY", "PEY", "PKY", "PHY", "PVY", "PPY", "PTY", "RBY", "RCY", "REY", "RHY", "RVY"),
    ),
    ("ROLLING_COEFFICIENTS", ("QSY",)),
    ("ALIGNING_COEFFICIENTS", ("QBZ", "QCZ", "QDZ", "QEZ", "QHZ", "PPZ", "SSZ")),
)
"""Sections, with the prefixes of their keys."""
_UNITS = ("LENGTH = 'meter'", "FORCE = 'newton'", "ANGLE = 'radians'", "MASS = 'kg'",
          "TIME = 'second'")  # fmt: skip


def write_tir(
    tyre: "MagicFormula",
    path: str | Path,
    *,
    head: str = "",
    force: bool = False,
    inputs: Paths = (),
) -> Path:
    """Write a tyre of the Magic Formula as a property file, in SI units, and return its path.

    Coefficients without effect are left out.

    Parameters
    ----------
    tyre : MagicFormula
    path : str or pathlib.Path
        File name that ends in ``.tir``.
    head : str, optional
        Comment at the top of the file.
    force : bool, optional
        Whether to replace a file that kintrafo did not write; see `kintrafo.core.files`.
    inputs : iterable of str or pathlib.Path, optional
        Files that are never replaced.

    Returns
    -------
    pathlib.Path

    Raises
    ------
    InputError
        If the file cannot be written or must not be replaced.
    """
    with Validator("write_tir") as given:
        given.path("path", path)
        given.text("head", head)
    if Path(path).suffix.lower() != ".tir":
        raise InputError(["the name of a property file ends in .tir."], str(path))
    lines = [f"$ {legible(line)}" for line in head.splitlines()]
    lines += ["[UNITS]", *_UNITS]
    values = {
        key: value
        for key, value in tyre.coefficients.items()
        if value != NEUTRAL.get(key, 0.0) or key in _NEEDED
    }
    for section, starts in _SECTIONS:
        own = [key for key in values if key.startswith(starts)]
        if section == "MODEL":
            lines += [f"[{section}]", *_model(tyre)]
        elif own:
            lines.append(f"[{section}]")
        lines += [f"{key:<24} = {values[key]!r}" for key in own]
    return write_text(path, "\n".join([*lines, ""]), force=force, inputs=inputs)


_NEEDED = frozenset(key for keys in known.NEEDED.values() for key in keys)


def _model(tyre: "MagicFormula") -> list[str]:
    older = {"PAC2002": "PROPERTY_FILE_FORMAT = 'PAC2002'", "MF 5": "FITTYP = 5"}
    version = older.get(tyre.name, f"FITTYP = 6{tyre.name[-1]}")
    # a file may have weights of combined slip that FE_METHOD switches off
    combined = [] if tyre.form.weighted else ["FE_METHOD = 'YES'"]
    return [version, *combined, *([f"TYRESIDE = '{tyre.side.upper()}'"] if tyre.side else [])]
