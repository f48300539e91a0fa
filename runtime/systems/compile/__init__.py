"""A user's own mechanism: derived, emitted, compiled and loaded outside of the source tree."""

from .build import compile_mechanism
from .choices import proposals
from .compiler import CompilerError
from .declaration import MechanismError
from .derivation import write_derivation

__all__ = ["CompilerError", "MechanismError", "compile_mechanism", "proposals", "write_derivation"]
