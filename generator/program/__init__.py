"""The straight-line program: steps, constants, derivatives, shared subexpressions.

Nothing here depends on mechanisms.
"""

from .constants import ConstantStage
from .function import Function
from .program import Program
from .steps import Step, ancestors

__all__ = ["ConstantStage", "Function", "Program", "Step", "ancestors"]
