"""Draw docs/images/twist_beam.png: ``python docs/images/twist_beam.py``."""

from pathlib import Path

from kintrafo import load
from kintrafo.pictures.figures import STYLE, save
from kintrafo.vehicle.plots.whole_axle import views
from matplotlib import rc_context

if __name__ == "__main__":
    with rc_context(STYLE):
        save(views(load("twist_beam")), Path(__file__).with_suffix(".png"), force=True)
