"""What a load case has act on a wheel."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from ...assembly.load import Load
from ...assembly.poses import CENTER, CONTACT
from .cases import Case

Array = NDArray[np.float64]


def outside_loads(cases: Sequence[Case], axes: Array, points: Mapping[str, Array]) -> list[Load]:
    """Return what acts on the wheel in each position.

    Parameters
    ----------
    cases : sequence of Case
        One for each position.
    axes : ndarray, shape (n, 3, 3)
        Of the tyre, see `kintrafo.assembly.poses.road_axes`.
    points : mapping
        The ``contact`` and the ``wheel_center``, each (n, 3) [m].

    Returns
    -------
    list of Load
        That of the road, and that of the drive.
    """

    def turned(vectors: list[Array]) -> Array:
        rotated: Array = np.einsum("nij,ni->nj", axes, np.array(vectors))
        return rotated

    return [
        Load(
            "wheel",
            CONTACT,
            "road",
            turned([case.contact for case in cases]),
            turned([case.contact_moment for case in cases]),
            points[CONTACT],
        ),
        Load(
            "wheel",
            CENTER,
            "drive",
            turned([case.center for case in cases]),
            turned([case.center_moment for case in cases]),
            points[CENTER],
        ),
    ]
