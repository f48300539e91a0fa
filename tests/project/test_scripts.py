"""Scripts beside the packages: no type checker reads them, and few tests run them."""

import ast
import importlib

import pytest
from support.folders import ROOT

FOLDERS = (".ci", "benchmarks", "docs", "examples")


def imports_of(path):
    """Return modules and names of the project that a script imports anywhere."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    return [
        (node.module, name.name)
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom) and not node.level
        if (node.module or "").partition(".")[0] == "kintrafo"
        for name in node.names
    ]


SCRIPTS = [path for folder in FOLDERS for path in sorted((ROOT / folder).rglob("*.py"))]


@pytest.mark.parametrize("path", SCRIPTS, ids=lambda path: str(path.relative_to(ROOT)))
def test_its_imports_of_the_project_are_there(path):
    for module, name in imports_of(path):
        found = importlib.import_module(module)
        if not hasattr(found, name):
            importlib.import_module(f"{module}.{name}")
