"""Relative coordinates that a mechanism reports."""

from __future__ import annotations

from dataclasses import dataclass

from .declared import DeclarationError, Name, declared
from .joints import Joint, Spherical

_METRES = ("slide",)


@declared
@dataclass(frozen=True)
class RelativeCoordinate:
    """A relative joint coordinate of the report, such as the paper's beta2.

    Parameters
    ----------
    joint
        Whose coordinate it is.
    meaning
        For the documentation of the generated code.
    kind
        Which one, where the joint has several.
    """

    name: Name
    joint: Joint
    meaning: str
    kind: str = ""

    def __post_init__(self) -> None:
        joint, kinds = self.joint, self.joint.coordinates
        if not self.kind and len(kinds) == 1:
            object.__setattr__(self, "kind", kinds[0])
        if isinstance(joint, Spherical):
            problem = f"the angles of the ball joint {joint.name!r} have no names to report"
            raise DeclarationError(f"coordinate {self.name!r}", [f"{problem}; leave it out"])
        if self.kind not in kinds:
            problem = f"{joint.name!r} has {' and '.join(kinds)}, not {self.kind!r}; give its kind"
            raise DeclarationError(f"coordinate {self.name!r}", [problem])

    @property
    def unit(self) -> str:
        """Of its value."""
        return "m" if self.kind in _METRES else "rad"
