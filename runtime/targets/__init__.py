"""Equations for other programs: files that need nothing of this package.

A target is one file with its `Target`, listed in `export`. Targets use the manifest and
the emitted C of a system; `python_module` uses its derivation.
"""

from .export import export_model

__all__ = ["export_model"]
