"""Contents of a wheel: every folder with modules is one of the listed packages."""

import tomllib

from support.folders import ROOT

ROOTS = {
    "runtime": "kintrafo",
    "generator": "kintrafo.generator",
    "generated": "kintrafo.generated",
    "vehicle": "kintrafo.vehicle",
}


def test_every_folder_of_modules_is_packaged():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    named = project["tool"]["setuptools"]["packages"]
    folders = {
        ".".join([package, *module.parent.relative_to(ROOT / root).parts])
        for root, package in ROOTS.items()
        for module in (ROOT / root).rglob("*.py")
        if "node_modules" not in module.parts
    }
    assert len(folders) > 30
    assert folders - {*named} == set()
