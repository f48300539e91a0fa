"""What a file describes: a suspension, an axle, or a rigid axle."""

from typing import TYPE_CHECKING

from . import axles, rigid
from .options import load

if TYPE_CHECKING:
    from ..suspension.axle import Axle
    from ..suspension.kinds import Suspension
    from ..suspension.model import Model
    from ..suspension.rigid import RigidAxle


def described_by(file: str) -> "Model | Axle | RigidAxle":
    """Return what the file describes."""
    if rigid.is_rigid_axle(file):
        from ..suspension.rigid import RigidAxle

        return RigidAxle.load(file)
    if axles.is_axle(file):
        from ..suspension.axle import Axle

        return Axle.load(file)
    return load(file)


def studied(file: str) -> "Suspension | RigidAxle":
    """Return what has values that move: a suspension, or a rigid axle."""
    from ..suspension.kinds import Suspension
    from ..suspension.rigid import RigidAxle

    return RigidAxle.load(file) if rigid.is_rigid_axle(file) else Suspension.load(file)
