"""Reading files of any assembly."""

from pathlib import Path

from ...core.validator import Validator
from ..data import find
from ..data.starter import AXLE, CAR, all_packaged
from ..input.described import described_by
from ..kinds import Suspension
from ..models.axle.axle import Axle
from ..models.car.car import Car
from ..models.whole_axle import WholeAxle, whole_axle_class


def load(path_or_name: str | Path) -> Suspension | Axle | WholeAxle | Car:
    """Return the suspension, axle or car that a TOML file describes.

    Parameters
    ----------
    path_or_name : str or pathlib.Path
        The file; or, as a string, the name of a packaged one, such as ``"reference_car"``,
        ``"reference_axle"``, ``"rigid_axle"`` or ``"reference_vehicle"``.

    Returns
    -------
    Suspension, Axle, WholeAxle or Car
        A suspension of one wheel; an axle of two suspensions; a rigid axle or a twist-beam axle,
        which are each a `WholeAxle`; or a body on axles.

    Raises
    ------
    InputError
        If the file cannot be read, or its data are impossible; the message lists all problems.

    Examples
    --------
    >>> import kintrafo
    >>> [type(kintrafo.load(name)).__name__ for name in ("reference_axle", "rigid_axle")]
    ['Axle', 'RigidAxle']
    >>> kintrafo.load("reference_car").suspension
    'macpherson'
    """
    with Validator("load") as given:
        given.path("path_or_name", path_or_name)
    key = described_by(path_or_name)
    if not key:
        find(path_or_name, all_packaged())
    if key in _KINDS:
        return _KINDS[key].load(path_or_name)
    return whole_axle_class(key).load(path_or_name)


_KINDS: dict[str, type[Suspension | Axle | Car]] = {"": Suspension, AXLE: Axle, CAR: Car}
