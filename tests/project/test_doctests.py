"""The examples in the docstrings and in the documentation run and print what they say."""

import doctest
import importlib
import re

import kintrafo
import pytest
from support.folders import ROOT

# the folders are one package, whose top is that of the runtime
MODULES = sorted(
    ".".join(("kintrafo", *path.relative_to(above).with_suffix("").parts)).removesuffix(".__init__")
    for above, top in ((ROOT / "runtime", ""), (ROOT, "generator"), (ROOT, "vehicle"))
    for path in (above / top).rglob("*.py")
    if ">>> " in path.read_text(encoding="utf-8")
)


@pytest.mark.parametrize("name", MODULES)
def test_docstring_examples(name):
    result = doctest.testmod(importlib.import_module(name))
    assert result.failed == 0


def test_there_are_examples():
    finder = doctest.DocTestFinder()
    examples = list(finder.find(importlib.import_module("kintrafo.vehicle.models.positions")))
    assert sum(len(test.examples) for test in examples) >= 4
    assert {"kintrafo", "kintrafo.vehicle.models.positions"} <= {*MODULES}
    assert len(MODULES) > 80


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
