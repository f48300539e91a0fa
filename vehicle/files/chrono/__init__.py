"""Suspensions and whole vehicles of Project Chrono, as JSON.

The format is that of Chrono::Vehicle (https://projectchrono.org): points and vectors in metres, in
the axes of the vehicle (ISO 8855), for the *left* side; the right one is its mirror image. Each
assumption about missing data is reported, and unread data are listed.

`keys`                            keys that are read, unread and misspelt ones
`parts`, `forces`, `stops`        bodies, springs, dampers and stops of the templates
`suspension_file`                 the base of all templates
`macpherson`, `double_wishbone`, `semi_trailing_arm`   the templates
`tires`                           tires
`points_only`                     hardpoints of a file with the other data of a packaged one
`reading`                         a file as a suspension
`vehicle_file`, `vehicle_parts`   a whole vehicle and its parts
`vehicle`                         a whole vehicle as a car
"""

from .reading import Imported, read
from .tires import TYRE_RATE
from .vehicle import ImportedCar, read_vehicle

__all__ = ["TYRE_RATE", "Imported", "ImportedCar", "read", "read_vehicle"]
