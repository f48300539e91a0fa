"""Draw docs/images/steered_rigid_axle.png: ``python docs/images/steered_rigid_axle.py``."""

from pathlib import Path

from kintrafo import load
from kintrafo.pictures.figures import STYLE, save
from kintrafo.vehicle.plots.whole_axle import views
from matplotlib import rc_context

if __name__ == "__main__":
    with rc_context(STYLE):
        save(views(load("steered_rigid_axle")), Path(__file__).with_suffix(".png"), force=True)
