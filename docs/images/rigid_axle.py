"""Draw docs/images/rigid_axle.png: ``python docs/images/rigid_axle.py``."""

from pathlib import Path

from kintrafo import RigidAxle
from kintrafo.pictures.figures import STYLE, save
from kintrafo.vehicle.plots.whole_axle import views
from matplotlib import rc_context

if __name__ == "__main__":
    with rc_context(STYLE):
        drawn = views(RigidAxle.load("rigid_axle"))
        save(drawn, Path(__file__).with_suffix(".png"), force=True)
