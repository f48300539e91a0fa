"""Compiled equations of motion of any mechanism: names, arrays, errors.

Modules that are emitted for a mechanism import `Equations` from here, and the generator imports the
status bits: this package depends on neither.
"""

from .equations import Equations

__all__ = ["Equations"]
