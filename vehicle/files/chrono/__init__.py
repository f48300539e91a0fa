"""Suspensions and whole vehicles of Project Chrono, as JSON.

The format is that of Chrono::Vehicle (https://projectchrono.org): points and vectors in metres, in
the axes of the vehicle (ISO 8855), for the *left* side; the right one is its mirror image. What its
files leave open is assumed, and each assumption is reported; what is not read of them is listed.

`keys`                            keys that are read, those that are not, slips of the hand
`parts`, `forces`, `stops`        bodies, springs, dampers and stops of the templates
`suspension_file`                 what all templates have
`macpherson`, `double_wishbone`, `semi_trailing_arm`   the templates
`tires`                           tires
`points_only`                     the hardpoints of a file, and the rest of a packaged one
`reading`                         all of it as a suspension
`vehicle_file`, `vehicle_parts`   a whole vehicle and its parts
`vehicle`                         all of it as a car
"""

from .reading import Imported, read
from .tires import TYRE_RATE
from .vehicle import ImportedCar, read_vehicle

__all__ = ["TYRE_RATE", "Imported", "ImportedCar", "read", "read_vehicle"]
