"""Modules run as ``python -m`` runs them, but in this process: another one imports for a second."""

from __future__ import annotations

import runpy
import sys
import warnings
from contextlib import chdir
from pathlib import Path
from unittest.mock import patch

import pytest

ROOT = Path(__file__).parents[1]


def run_module(name: str, *arguments: object) -> None:
    """Run a module in the folder of the repository, and see that it ends well.

    Parameters
    ----------
    name
        As behind ``python -m``.
    arguments
        Of its command line.
    """
    given = [name, *map(str, arguments)]
    with chdir(ROOT), patch.object(sys, "argv", given), warnings.catch_warnings():
        warnings.filterwarnings("ignore", ".*found in sys.modules", RuntimeWarning)
        with pytest.raises(SystemExit) as end:
            runpy.run_module(name, run_name="__main__")
    assert not end.value.code
