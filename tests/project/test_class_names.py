"""A class name is defined once, so that a search finds one class."""

import ast
from collections import defaultdict

from support.folders import ROOT

# One interface with two implementations: compiled code, and functions over arrays.
_INTERFACES = {"Function"}


def test_public_classes_have_names_of_their_own():
    places = defaultdict(set)
    for top in ("generator", "runtime", "vehicle"):
        for file in sorted((ROOT / top).rglob("*.py")):
            for node in ast.walk(ast.parse(file.read_text())):
                if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
                    places[node.name].add(str(file.relative_to(ROOT)))
    assert len(places) > 500
    shared = {name: files for name, files in places.items() if len(files) > 1}
    assert {name: files for name, files in shared.items() if name not in _INTERFACES} == {}
