"""The straight-line program: steps, constants, derivatives, what is shared, counts.

Nothing here knows a mechanism.
"""

from .constants import ConstantStage
from .function import Function
from .program import Program
from .steps import Step, ancestors

__all__ = ["ConstantStage", "Function", "Program", "Step", "ancestors"]
