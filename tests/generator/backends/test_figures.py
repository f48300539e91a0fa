"""The figures of a mechanism have every body, joint and coordinate once, and are the same bytes."""

import re
from collections import Counter

import numpy as np
import pytest
from kintrafo.generator.backends.report.figures import ELEMENTS, draw_figures
from kintrafo.generator.mechanisms import MODELS
from kintrafo.generator.planning.plan import CataloguePlan

SHOWN = [m for m in MODELS if m.name in ("macpherson", "andrews")]


@pytest.fixture(scope="module", params=SHOWN, ids=lambda model: model.name)
def drawn(request, tmp_path_factory):
    """Return a plan and the words of each figure."""
    plan, folder = CataloguePlan.of(request.param), tmp_path_factory.mktemp("figures")
    draw_figures(plan, folder)
    prefix = f"{plan.formulation.name}_"
    words = {p.stem.removeprefix(prefix): texts(p) for p in sorted(folder.glob("*.svg"))}
    return plan, words, folder


def texts(path):
    """Return the texts of a figure: words as text, formulas in comments before their paths."""
    written = path.read_text(encoding="utf-8")
    words = re.findall(r"<text[^>]*>([^<]*)</text>", written)
    return [t.strip() for t in (*words, *re.findall(r"<!-- (.*?\$.*?) -->", written))]


def test_every_body_has_its_number_once(drawn):
    plan, words, _ = drawn
    found = Counter(words["bodies"])
    assert {found[str(n)] for n in plan.formulation.mechanism.numbers.values()} == {1}


def test_every_joint_and_fictitious_body_is_in_the_graph(drawn):
    plan, words, _ = drawn
    found, joints = Counter(words["graph"]), plan.formulation.mechanism.joints
    assert {found[f"{j.name.replace('_', ' ')}: {j.freedoms}"] for j in joints} == {1}
    assert all(len(ELEMENTS[j.kind]) == j.freedoms for j in joints)
    assert found["R"] + found["P"] == sum(j.freedoms for j in joints)
    assert found["P"] == sum(j.kind in ("prismatic", "cylindrical") for j in joints)


def test_every_coordinate_is_a_wire_once(drawn):
    plan, words, _ = drawn
    names = [c.name for c in plan.formulation.mechanism.coordinates]
    written = " , ".join(words["transformers"])
    for name in names:
        number = name.removeprefix("beta")
        shown = rf"\beta_{{{number}}}" if number.isdigit() else name
        assert len(re.findall(rf"(?<![\w]){re.escape(shown)}(?![\w])", written)) == 1, name


def test_letters_are_those_of_the_paper(drawn):
    """Figure 1 of the paper: O, A, B, C, D, E, and HG of the wheel's bearing."""
    plan, words, _ = drawn
    if plan.formulation.name != "macpherson":
        pytest.skip("another mechanism")
    found = Counter(words["bodies"])
    assert [found[letter] for letter in ("O", "A", "B", "C", "D", "E", "HG")] == [1] * 7


def test_figures_are_the_same_bytes_again(drawn, tmp_path):
    plan, _, folder = drawn
    if plan.formulation.name != "macpherson":
        pytest.skip("another mechanism")
    again = draw_figures(plan, tmp_path)
    assert len(again) == 6
    for path in again:
        assert path.read_bytes() == (folder / path.name).read_bytes(), path.name


def test_what_goes_up_and_down_often_is_a_thin_line():
    from kintrafo.pictures.curves import _width

    x = np.linspace(0.0, 1.0, 1001)
    assert _width(np.sin(2 * np.pi * 100 * x)) < 1.0 < _width(np.sin(2 * np.pi * x))
    assert _width(np.array([0.0, np.nan, 1.0])) > 1.0
