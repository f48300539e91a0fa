"""Property files for tests: that of the packaged tyre, and one of PAC2002 made from it."""

import re
from pathlib import Path

import kintrafo

NEWER = Path(kintrafo.tyres.load("passenger_205_55").source).read_text(encoding="utf-8")
_ONLY_OF_THE_NEWER = (
    "PKY4 PKY5 PKY6 PKY7 PEY5 RBX3 RBY4 QDZ10 QDZ11 QSY7 QSY8 NOMPRES INFLPRES "
    "PPX1 PPX2 PPX3 PPX4 PPY1 PPY2 PPY3 PPY4 PPY5 PPZ1 PPZ2 PPMX1 PFZ1 PCFX3 PCFY3"
)


def without(text, *keys):
    """Return a file without some keys."""
    return re.sub(rf"^({'|'.join(keys)})\s*=.*\n", "", text, flags=re.MULTILINE)


def with_values(text, **values):
    """Return a file with other values, or with keys that it did not have, in a last section."""
    for key, value in values.items():
        text, found = re.subn(
            rf"^{key}(\s*)=\s*\S+", rf"{key}\1= {value}", text, flags=re.MULTILINE
        )
        if not found:
            text += f"{key} = {value}\n"
    return text


OLDER = with_values(
    without(NEWER, *_ONLY_OF_THE_NEWER.split()).replace(
        "FITTYP                   = 61", "PROPERTY_FILE_FORMAT     = 'PAC2002'"
    ),
    PHY3=0.028, LGAX=0.9, LGAY=1.1, LGAZ=0.95, PTX1=1.9, PTX2=0.3, PTX3=0.2, PTY1=2.2, PTY2=1.8,
)  # fmt: skip
SCALED = with_values(
    NEWER, LFZO=0.9, LMUX=0.8, LMUY=0.7, LCX=1.1, LCY=0.95, LEX=0.9, LEY=1.2, LKX=1.1, LKY=0.9,
    LHX=0.5, LHY=0.6, LVX=1.3, LVY=0.8, LKYC=1.2, LKZC=0.7, LTR=1.1, LRES=0.6, LXAL=1.2, LYKA=0.8,
    LVYKA=0.9, LS=1.3, LMX=0.9, LVMX=0.8, LMY=1.1, QSX12=0.3, QSX13=0.02, QSX14=-0.4, Q_FZ3=0.0,
)  # fmt: skip
ELLIPSE = without(OLDER, *(f"R{b}{i}" for b in ("BX", "BY", "CX", "CY", "EX", "EY", "HX", "HY",
                                                  "VY") for i in range(1, 7)))  # fmt: skip
FILES = {"MF 6.1": NEWER, "PAC2002": OLDER, "scaled": SCALED, "ellipse": ELLIPSE}
