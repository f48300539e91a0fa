"""Draw docs/images/tyre.png: ``python docs/images/tyre.py``."""

from pathlib import Path

import kintrafo
from kintrafo.vehicle.plots.tyres import write_tyre

NAME = "passenger_205_55"

if __name__ == "__main__":
    tyre = kintrafo.tyres.load(NAME)
    picture = Path(__file__).with_suffix(".png")
    write_tyre(tyre, picture, title=f"{NAME}, {tyre.name}", force=True)
