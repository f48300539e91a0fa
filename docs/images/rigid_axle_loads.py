"""Draw docs/images/rigid_axle_loads.png: ``python docs/images/rigid_axle_loads.py``."""

from pathlib import Path

from kintrafo import RigidAxle, loads
from kintrafo.pictures.figures import STYLE, save
from kintrafo.vehicle.plots.loads import free_bodies
from matplotlib import rc_context

if __name__ == "__main__":
    axle = RigidAxle.load("rigid_axle")
    corner = {"corner": loads.standard_cases(axle)["corner"]}
    with rc_context(STYLE):
        found = loads.static(axle, corner)
        drawn = free_bodies(found, "corner", ["beam"], title="Forces on the axle in a corner")
        save(drawn, Path(__file__).with_suffix(".png"), force=True)
