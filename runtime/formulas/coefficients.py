"""Coefficients of the Magic Formula by their names in property files."""

from collections.abc import Mapping


def keys(text: str) -> tuple[str, ...]:
    """Return the names in a text, in which ``PDX1-3`` represents three."""
    names: list[str] = []
    for word in text.split():
        stem, _, last = word.partition("-")
        if last:
            head = stem.rstrip("0123456789")
            names += [f"{head}{i}" for i in range(int(stem.removeprefix(head)), int(last) + 1)]
        else:
            names.append(word)
    return tuple(names)


SCALES = keys(
    "LFZO LCZ LCX LMUX LEX LKX LHX LVX LGAX LCY LMUY LEY LKY LHY LVY LGAY LKYC LKZC LTR LRES LGAZ "
    "LXAL LYKA LVYKA LS LSGKP LSGAL LMX LVMX LMY"
)
"""Scaling factors, one by default."""

OF_FORCES = keys(
    "PCX1 PDX1-3 PEX1-4 PKX1-3 PHX1-2 PVX1-2 PPX1-4 RBX1-3 RCX1 REX1-2 RHX1 "
    "PCY1 PDY1-3 PEY1-5 PKY1-7 PHY1-3 PVY1-4 PPY1-5 RBY1-4 RCY1 REY1-2 RHY1-2 RVY1-6 "
    "QBZ1-5 QBZ9-10 QCZ1 QDZ1-4 QDZ6-11 QEZ1-5 QHZ1-4 PPZ1-2 SSZ1-4 "
    "QSX1-14 PPMX1 QSY1-8"
)
OF_RADII = keys("BREFF DREFF FREFF Q_RE0 Q_V1-2 Q_FZ1-3 Q_FCX Q_FCY PFZ1")
OF_RELAXATION = keys("PTX1-3 PTY1-2 PCFX1-3 PCFY1-3")

NEUTRAL: Mapping[str, float] = {
    **dict.fromkeys((*OF_FORCES, *OF_RADII, *OF_RELAXATION), 0.0),
    **dict.fromkeys(SCALES, 1.0),
    "PKY4": 2.0,
    "RCX1": 1.0,
    "RCY1": 1.0,
    "Q_RE0": 1.0,
    "QSY7": 1.0,
}
"""Values with which coefficients have no effect."""

IN_EQUATIONS = tuple(key for key in NEUTRAL if key not in keys("Q_V1-2 Q_FCX Q_FCY Q_FZ3"))
"""Coefficients in equations of motion: those of the load by speed and forces are left out."""

ODD = keys("PHY1-2 PVY1-2 PEY3 RBY3 RHX1 RVY1-2 QHZ1-2 QBZ4 QDZ3 QDZ6-7 QEZ4 SSZ1 QSX1")
"""Coefficients with another sign in the mirror image of a tyre."""
