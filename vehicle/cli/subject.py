"""What a file describes: a suspension, an axle, or a rigid axle."""

from typing import TYPE_CHECKING

from ...terminal.console import problems
from .options import load as load_model

if TYPE_CHECKING:
    from ..assembly.assembly import Assembly
    from ..kinds import Suspension
    from ..models.axle import Axle
    from ..models.axle.equations import AxleModel
    from ..models.model import Model
    from ..models.rigid import RigidAxle
    from ..models.rigid.model import RigidAxleModel


def described_by(file: str) -> "Model | Axle | RigidAxle":
    """Return what the file describes."""
    from ..files.loading import load
    from ..kinds import Suspension

    found = load(file)
    return load_model(file) if isinstance(found, Suspension) else found


def model_of(file: str, *, wheel_loads: bool = False) -> "Model | AxleModel | RigidAxleModel":
    """Return the equations of motion of what a file describes.

    Parameters
    ----------
    file : str
        Path of a TOML file, or name of a packaged data set.
    wheel_loads
        Whether what acts on the wheels are inputs.
    """
    from ..assembly.of import model_of as of_subject
    from ..files.loading import load

    subject = load(file)
    with problems.status("preparing the equations") as status:
        return of_subject(
            subject,
            wheel_loads=wheel_loads,
            progress=lambda text: status.update(f"the equations: {text}"),
        )


def assembly_of_file(file: str) -> "Assembly":
    """Return what the file describes, as an assembly."""
    from ..assembly.of import assembly_of

    return assembly_of(described_by(file))


def subject_of_file(file: str) -> "Suspension | Axle | RigidAxle":
    """Return what the file describes, whose numbers are design variables."""
    from ..files.loading import load

    return load(file)
