"""Keys of property files (.tir) of the Magic Formula: sections, units, defaults, signs."""

from collections.abc import Iterable, Mapping

from ...formulas.coefficients import NEUTRAL, ODD, keys

NEEDED: Mapping[str, tuple[str, ...]] = {
    "DIMENSION": ("UNLOADED_RADIUS",),
    "VERTICAL": ("FNOMIN", "VERTICAL_STIFFNESS"),
    "LONGITUDINAL_COEFFICIENTS": ("PCX1", "PDX1", "PKX1"),
    "LATERAL_COEFFICIENTS": ("PCY1", "PDY1", "PKY1", "PKY2"),
    "ALIGNING_COEFFICIENTS": ("QBZ1", "QCZ1", "QDZ1"),
}
"""Keys that every file needs, by their usual section."""

DIMENSIONS: Mapping[str, str] = {
    "UNLOADED_RADIUS": "m", "FNOMIN": "N", "VERTICAL_STIFFNESS": "N/m",
    "VERTICAL_DAMPING": "N s/m", "LONGITUDINAL_STIFFNESS": "N/m", "LATERAL_STIFFNESS": "N/m",
    "LONGVL": "m/s", "VXLOW": "m/s", "INFLPRES": "Pa", "NOMPRES": "Pa", "FZMIN": "N", "FZMAX": "N",
    "ALPMIN": "rad", "ALPMAX": "rad", "CAMMIN": "rad", "CAMMAX": "rad", "PRESMIN": "Pa",
    "PRESMAX": "Pa", "KPUMIN": "1", "KPUMAX": "1",
}  # fmt: skip
"""SI units of keys; coefficients have no unit except angles in radians."""

DEFAULTS = NEUTRAL
"""Values of coefficients that are missing in a file."""

USED = frozenset((*DEFAULTS, *DIMENSIONS))
"""Keys with numbers that are used."""

ALIASES: Mapping[str, str] = {
    "QFZ1": "Q_FZ1", "QFZ2": "Q_FZ2", "QFZ3": "Q_FZ3", "QV1": "Q_V1", "QV2": "Q_V2",
    "QRE0": "Q_RE0", "QFCX1": "Q_FCX", "QFCY1": "Q_FCY", "QPFZ1": "PFZ1", "QPZ1": "PPZ1",
    "QPZ2": "PPZ2", "QPX1": "PPMX1", "IP": "INFLPRES", "IP_NOM": "NOMPRES",
}  # fmt: skip
"""Our keys by their names in PAC2002 of Adams/Tire."""

LIMITS: Mapping[str, tuple[str, str]] = {
    "load": ("FZMIN", "FZMAX"),
    "slip": ("KPUMIN", "KPUMAX"),
    "slip_angle": ("ALPMIN", "ALPMAX"),
    "camber": ("CAMMIN", "CAMMAX"),
    "pressure": ("PRESMIN", "PRESMAX"),
}
"""Keys of the range of validity of each argument of `Tyre.evaluate`."""

OF_PRESSURE = keys("PPX1-4 PPY1-5 PPZ1-2 PPMX1 QSY8 PFZ1 PCFX3 PCFY3")
OF_SPEED = keys("QSY3-4 Q_V1-2")
OF_COMBINED_SLIP = ("RBX1", "RBY1")

REASONS: Mapping[str, str] = {
    "MODEL": "how another program runs",
    "MDI_HEADER": "the origin of the file",
    "SHAPE": "the contact is that of a thin disc",
    "DIMENSION": "the contact is that of a thin disc",
    "INERTIA": "masses and moments of inertia are in the file of the vehicle",
    "STRUCTURAL": "the belt has no motion of its own",
    "CONTACT_PATCH": "the road under the contact is a plane",
    "TURNSLIP_COEFFICIENTS": "turn slip is left out",
    "VERTICAL": "the rim does not touch, and camber does not change the loaded radius",
    "DEFLECTION_LOAD_CURVE": "the vertical stiffness is a polynomial",
    "BOTTOMING_CURVE": "the rim does not touch",
}
"""Reasons why keys of a section are not used."""


def mirrored(coefficients: Mapping[str, float]) -> dict[str, float]:
    """Return the coefficients of the mirror image."""
    return {k: -v if k in ODD else v for k, v in coefficients.items()}


def missing(given: Iterable[str]) -> dict[str, list[str]]:
    """Return the needed keys that are missing, by section."""
    there = set(given)
    found = {section: [k for k in keys if k not in there] for section, keys in NEEDED.items()}
    if "Q_FZ1" in there:
        found["VERTICAL"] = [k for k in found["VERTICAL"] if k != "VERTICAL_STIFFNESS"]
    return {section: keys for section, keys in found.items() if keys}
