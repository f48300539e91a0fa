"""Forces on the bodies, one file for each kind.

All forces that are defined in this folder are found here: a new kind is a new file.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Union

from ..kinds import defined_in
from .force import Force as _Force

__all__ = ["KINDS", "Force"]

KINDS = tuple(c for c in defined_in(__name__) if issubclass(c, _Force) and c is not _Force)
"""Every kind of force."""

if TYPE_CHECKING:
    Force = _Force
else:
    # an error names every kind; users may define further ones
    Force = Union[(*KINDS, _Force)]
