"""What property files (.tir) of the Magic Formula hold: keys, sections, defaults, signs."""

from collections.abc import Iterable, Mapping


def _keys(text: str) -> tuple[str, ...]:
    """Return names, of which ``PDX1-3`` stands for three."""
    names: list[str] = []
    for word in text.split():
        stem, _, last = word.partition("-")
        if last:
            head = stem.rstrip("0123456789")
            names += [f"{head}{i}" for i in range(int(stem.removeprefix(head)), int(last) + 1)]
        else:
            names.append(word)
    return tuple(names)


NEEDED: Mapping[str, tuple[str, ...]] = {
    "DIMENSION": ("UNLOADED_RADIUS",),
    "VERTICAL": ("FNOMIN", "VERTICAL_STIFFNESS"),
    "LONGITUDINAL_COEFFICIENTS": ("PCX1", "PDX1", "PKX1"),
    "LATERAL_COEFFICIENTS": ("PCY1", "PDY1", "PKY1", "PKY2"),
    "ALIGNING_COEFFICIENTS": ("QBZ1", "QCZ1", "QDZ1"),
}
"""Keys that every file has, by the section that they usually are in."""

SCALES = _keys(
    "LFZO LCZ LCX LMUX LEX LKX LHX LVX LGAX LCY LMUY LEY LKY LHY LVY LGAY LKYC LKZC LTR LRES LGAZ "
    "LXAL LYKA LVYKA LS LSGKP LSGAL LMX LVMX LMY"
)
"""Scaling factors, one unless the file says otherwise."""

_OF_FORCES = _keys(
    "PCX1 PDX1-3 PEX1-4 PKX1-3 PHX1-2 PVX1-2 PPX1-4 RBX1-3 RCX1 REX1-2 RHX1 "
    "PCY1 PDY1-3 PEY1-5 PKY1-7 PHY1-3 PVY1-4 PPY1-5 RBY1-4 RCY1 REY1-2 RHY1-2 RVY1-6 "
    "QBZ1-5 QBZ9-10 QCZ1 QDZ1-4 QDZ6-11 QEZ1-5 QHZ1-4 PPZ1-2 SSZ1-4 "
    "QSX1-14 PPMX1 QSY1-8"
)
_OF_RADII = _keys("BREFF DREFF FREFF Q_RE0 Q_V1-2 Q_FZ1-3 Q_FCX Q_FCY PFZ1")
_OF_RELAXATION = _keys("PTX1-3 PTY1-2 PCFX1-3 PCFY1-3")

DIMENSIONS: Mapping[str, str] = {
    "UNLOADED_RADIUS": "m",
    "FNOMIN": "N",
    "VERTICAL_STIFFNESS": "N/m",
    "VERTICAL_DAMPING": "N s/m",
    "LONGITUDINAL_STIFFNESS": "N/m",
    "LATERAL_STIFFNESS": "N/m",
    "LONGVL": "m/s",
    "VXLOW": "m/s",
    "INFLPRES": "Pa",
    "NOMPRES": "Pa",
    "FZMIN": "N",
    "FZMAX": "N",
    "ALPMIN": "rad",
    "ALPMAX": "rad",
    "CAMMIN": "rad",
    "CAMMAX": "rad",
    "PRESMIN": "Pa",
    "PRESMAX": "Pa",
    "KPUMIN": "1",
    "KPUMAX": "1",
}
"""Keys with a unit, and what it is here; coefficients have none, but angles in radians."""

DEFAULTS: Mapping[str, float] = {
    **dict.fromkeys((*_OF_FORCES, *_OF_RADII, *_OF_RELAXATION), 0.0),
    **dict.fromkeys(SCALES, 1.0),
    "PKY4": 2.0,
    "RCX1": 1.0,
    "RCY1": 1.0,
    "Q_RE0": 1.0,
    "QSY7": 1.0,
}
"""What a coefficient is that a file leaves out."""

USED = frozenset((*DEFAULTS, *DIMENSIONS))
"""Keys with numbers that do something."""

ALIASES: Mapping[str, str] = {
    "QFZ1": "Q_FZ1",
    "QFZ2": "Q_FZ2",
    "QFZ3": "Q_FZ3",
    "QV1": "Q_V1",
    "QV2": "Q_V2",
    "QRE0": "Q_RE0",
    "QFCX1": "Q_FCX",
    "QFCY1": "Q_FCY",
    "QPFZ1": "PFZ1",
    "QPZ1": "PPZ1",
    "QPZ2": "PPZ2",
    "QPX1": "PPMX1",
    "IP": "INFLPRES",
    "IP_NOM": "NOMPRES",
}
"""Names that PAC2002 of Adams/Tire has for keys of the others."""

LIMITS: Mapping[str, tuple[str, str]] = {
    "load": ("FZMIN", "FZMAX"),
    "slip": ("KPUMIN", "KPUMAX"),
    "slip_angle": ("ALPMIN", "ALPMAX"),
    "camber": ("CAMMIN", "CAMMAX"),
    "pressure": ("PRESMIN", "PRESMAX"),
}
"""Ranges within which a file holds, by the argument that they limit."""

OF_PRESSURE = _keys("PPX1-4 PPY1-5 PPZ1-2 PPMX1 QSY8 PFZ1 PCFX3 PCFY3")
OF_SPEED = _keys("QSY3-4 Q_V1-2")
OF_COMBINED_SLIP = ("RBX1", "RBY1")

REASONS: Mapping[str, str] = {
    "MODEL": "how another program runs",
    "MDI_HEADER": "who wrote it",
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
"""Why keys of a section are not used."""

_ODD = _keys("PHY1-2 PVY1-2 PEY3 RBY3 RHX1 RVY1-2 QHZ1-2 QBZ4 QDZ3 QDZ6-7 QEZ4 SSZ1 QSX1")


def mirrored(coefficients: Mapping[str, float]) -> dict[str, float]:
    """Return the coefficients of the mirror image: a tyre on the other side of the vehicle."""
    return {k: -v if k in _ODD else v for k, v in coefficients.items()}


def missing(given: Iterable[str]) -> dict[str, list[str]]:
    """Return the keys that a file needs and does not have, by their sections."""
    there = set(given)
    found = {section: [k for k in keys if k not in there] for section, keys in NEEDED.items()}
    if "Q_FZ1" in there:
        found["VERTICAL"] = [k for k in found["VERTICAL"] if k != "VERTICAL_STIFFNESS"]
    return {section: keys for section, keys in found.items() if keys}
