"""The examples in the docstrings and in the documentation run and print what they say."""

import doctest
import importlib
import pkgutil
import re

import kintrafo
import pytest
from folders import ROOT

MODULES = sorted(
    module.name
    for module in pkgutil.walk_packages(kintrafo.__path__, "kintrafo.")
    if not module.name.endswith("__main__")
)
# the four folders are one package, but only one of them is on its path
MODULES += sorted(
    ".".join(("kintrafo", *path.relative_to(ROOT).with_suffix("").parts))
    for top in ("generator", "vehicle")
    for path in (ROOT / top).rglob("*.py")
    if not path.stem.startswith("__")
)


@pytest.mark.parametrize("name", ["kintrafo", *dict.fromkeys(MODULES)])
def test_docstring_examples(name):
    result = doctest.testmod(importlib.import_module(name))
    assert result.failed == 0


def test_there_are_examples():
    finder = doctest.DocTestFinder()
    examples = list(finder.find(importlib.import_module("kintrafo.vehicle.models.positions")))
    assert sum(len(test.examples) for test in examples) >= 4


def test_the_error_of_the_page_is_the_one_printed(tmp_path):
    page = (ROOT / "docs/reference/file-format.md").read_text(encoding="utf-8")
    (block,) = re.findall(r"```text\n(.*?)\n```", page, flags=re.DOTALL)
    text = (ROOT / "vehicle/data/reference_car.toml").read_text(encoding="utf-8")
    path = tmp_path / "my_car.toml"
    path.write_text(text.replace("spring_rate_N_per_m", "sprng_rate_N_per_m"), encoding="utf-8")
    with pytest.raises(kintrafo.InputError) as caught:
        kintrafo.Suspension.load(path)
    assert str(caught.value).replace(f"{tmp_path}/", "") == block


def test_readme_names_targets_that_exist():
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    for target in re.findall(r"make ([a-z]+)", (ROOT / "README.md").read_text(encoding="utf-8")):
        assert re.search(rf"^{target}:", makefile, flags=re.MULTILINE), target
