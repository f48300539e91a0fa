"""What a file describes: a suspension, an axle, or a rigid axle."""

from typing import TYPE_CHECKING

from . import rigid
from .options import load as load_model

if TYPE_CHECKING:
    from ..suspension.axle import Axle
    from ..suspension.kinds import Suspension
    from ..suspension.model import Model
    from ..suspension.rigid import RigidAxle


def described_by(file: str) -> "Model | Axle | RigidAxle":
    """Return what the file describes."""
    from ..suspension.kinds import Suspension
    from ..suspension.loading import load

    found = load(file)
    return load_model(file) if isinstance(found, Suspension) else found


def studied(file: str) -> "Suspension | RigidAxle":
    """Return what has values that move: a suspension, or a rigid axle."""
    from ..suspension.kinds import Suspension
    from ..suspension.rigid import RigidAxle

    return RigidAxle.load(file) if rigid.is_rigid_axle(file) else Suspension.load(file)
