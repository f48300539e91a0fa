"""Modules run as by ``python -m``, but in this process: the imports of another take a second."""

import runpy
import sys
import warnings
from contextlib import chdir
from unittest.mock import patch

import pytest
from rich.text import Text

from support.folders import ROOT


def run_module(name, *arguments):
    """Run a module in the folder of the repository, and assert that its exit code is zero.

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


def lines_of(tables):
    """Return the cells of tables, line by line, as they are printed."""
    return [
        [Text.from_markup(str(cell)).plain for cell in line]
        for made in tables
        for line in zip(*([column.header, *column.cells] for column in made.columns), strict=True)
    ]
