"""Arguments that cannot be used are told by name, with what would be right."""

import re
from contextlib import suppress
from inspect import signature
from operator import attrgetter
from pathlib import Path

import kintrafo
import numpy as np
import pytest
from folders import ROOT
from kintrafo import KintrafoError
from kintrafo.core.arguments import Arguments, shown
from kintrafo.generated import four_bar
from kintrafo.vehicle.analysis.scenario import Scenario, run

CAR = kintrafo.Model("reference_car")
SYSTEM = kintrafo.System(four_bar)
REST = kintrafo.equilibrium(CAR)
SPAN = (0.0, 0.01)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: kintrafo.equilibrium(SYSTEM), "a kintrafo.Model of a suspension"),
        (lambda: kintrafo.simulate("reference_car", SPAN, REST), r"model = 'reference_car'"),
        (lambda: kintrafo.simulate(kintrafo.Model, SPAN, REST), "a class, not one of its"),
        (lambda: kintrafo.simulate(CAR, SPAN, REST, rtol=[1e-6]), r"rtol = \[1e-06\]"),
        (lambda: kintrafo.simulate(CAR, SPAN, REST, max_steps=2.5), "max_steps = 2.5: a whole"),
        (lambda: kintrafo.simulate(CAR, SPAN, REST, atol=np.inf), "atol = inf"),
        (lambda: kintrafo.simulate(CAR, SPAN, "x"), "y0 = 'x': numbers"),
        (lambda: kintrafo.simulate(CAR, 1.0, REST), "t_span = 1.0: two different"),
        (lambda: kintrafo.simulate(CAR, SPAN, REST, inputs=[1]), r"inputs = \[1\]: a dict"),
        (
            lambda: kintrafo.simulate(CAR, SPAN, REST, inputs=np.arange(3.0)),
            r"inputs = array\(\[0., 1., 2.\]\): a dict",
        ),
        (lambda: run(CAR, Scenario(inputs=None)), "inputs = None: a dict of input names"),
        (lambda: run(CAR, Scenario(duration={})), "duration = {}"),
        (lambda: run(CAR, Scenario(output_step=1e-9)), "more than 5000000 rows"),
        (
            lambda: kintrafo.simulate(
                CAR, SPAN, REST, inputs={"road_height": ([0.0, 10**400], [0.0, 0.0])}
            ),
            "two rows of numbers",
        ),
        (
            lambda: kintrafo.simulate(CAR, SPAN, REST, inputs={"road_height": lambda _: 10**400}),
            r"at t = 0 s is 10{59}\.\.\.: a finite number",
        ),
        (
            lambda: kintrafo.simulate(CAR, SPAN, REST, inputs={"road_height": "0.01"}),
            "'road_height' = '0.01'",
        ),
        (
            lambda: kintrafo.simulate(
                CAR, SPAN, REST, events=kintrafo.SignalEvent("camber", np.nan)
            ),
            "level of 'camber' = nan",
        ),
        (lambda: kintrafo.equilibrium(CAR, spin_rate=np.nan), "spin_rate = nan rad/s"),
        (lambda: kintrafo.state_at_height(CAR, [0.3]), r"height = \[0.3\] m"),
        (lambda: kintrafo.state_at_height(CAR, 0.3, spin_rate=np.nan), "spin_rate = nan rad/s"),
        (lambda: kintrafo.compile("/missing.py"), "No such file.*Check its name"),
        (lambda: CAR.signal("cambre", REST), "Did you mean camber"),
        (lambda: CAR.signals(REST[:2]), r"state has the shape \(2,\).*must be 4"),
        (lambda: CAR.evaluate("rsh", REST), "Did you mean rhs"),
        (lambda: CAR.signals(np.tile(REST, (2, 1)), np.zeros((3, 5))), "must go together"),
        (lambda: CAR.state(beta1=True), "'beta1' = True"),
        (lambda: kintrafo.System(four_bar, {"crank_mass": np.nan}), "'crank_mass' = nan kg"),
        (lambda: kintrafo.System("four_bar"), "equations = 'four_bar': a module"),
        (lambda: kintrafo.linearise(CAR, REST, outputs="camber"), "a list of names"),
        (lambda: kintrafo.Suspension.load(3), "path_or_name = 3"),
        (lambda: kintrafo.Suspension.from_dict([1]), r"data = \[1\]: a dict"),
        (lambda: kintrafo.Model("reference_car", free_rack="yes"), "free_rack = 'yes': True"),
    ],
)
def test_a_mistake_is_told(call, words):
    with pytest.raises(kintrafo.InputError, match=words):
        call()


def test_an_error_of_an_event_says_where_it_was():
    with pytest.raises(TypeError) as caught:
        kintrafo.simulate(CAR, SPAN, REST, events=lambda: 0.0)
    assert caught.value.__notes__ == ["This was raised by the event <lambda>, at t = 0 s."]


def test_all_that_is_wrong_is_told_at_once():
    with pytest.raises(kintrafo.InputError) as caught:
        kintrafo.equilibrium(SYSTEM, rack_position="0", spin_rate=np.inf, wheel_load=-3.0)
    assert len(caught.value.problems) == 4
    assert caught.value.source == "equilibrium"


def test_what_is_wrong_of_many_is_told_once():
    with pytest.raises(kintrafo.InputError) as caught:
        kintrafo.variation.tolerance(CAR.suspension, {"hardpoints": -1.0})
    assert [p.split(":")[0] for p in caught.value.problems] == ["tolerance of hardpoints = -1 mm"]


def test_any_number_of_steps():
    assert kintrafo.simulate(CAR, SPAN, REST, max_steps=np.inf).success


def test_numbers_of_other_kinds_are_numbers():
    from decimal import Decimal
    from fractions import Fraction

    with Arguments("test") as given:
        for value in (Decimal("0.5"), Fraction(1, 2), np.float32(0.5), np.array(0.5)):
            assert given.number("x", value) == 0.5
        assert given.array("x", [Fraction(1, 2), 1]).tolist() == [0.5, 1.0]


def test_times_of_other_kinds_are_times():
    from decimal import Decimal

    times = kintrafo.scenario.Scenario(duration=Decimal("0.5"), output_step=Decimal("0.2")).times()
    assert times.tolist() == [0.0, 0.2, 0.4, 0.5]


def test_names_that_are_none_are_refused():
    odd = kintrafo.Samples(np.arange(3.0), np.zeros(3), between=np.zeros(4))
    with pytest.raises(kintrafo.InputError, match="there are monotone, spline, linear"):
        kintrafo.simulate(CAR, SPAN, REST, inputs={"road_height": odd})


def test_what_is_long_is_cut():
    assert len(shown(list(range(1000)))) < 70


DOCUMENTED = sorted(
    {
        name
        for page in (ROOT / "docs/reference/api").glob("*.md")
        for name in re.findall(r"autofunction:: kintrafo\.(\S+)", page.read_text(encoding="utf-8"))
    }
)
JUNK = (3, -1, None, "nothing", "", b"x", True, np.nan, [], [np.nan], (1, 2, 3), {}, object())


@pytest.mark.parametrize("name", DOCUMENTED)
def test_what_no_argument_can_be_is_refused_in_words(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Every function of the interface is given what it cannot use, for all that it needs."""
    monkeypatch.chdir(tmp_path)
    function = attrgetter(name)(kintrafo)
    every = signature(function).parameters.values()
    needed = [p for p in every if p.default is p.empty and p.kind is not p.VAR_KEYWORD]
    for junk in JUNK if needed else ():
        given = [junk for p in needed if p.kind is not p.KEYWORD_ONLY]
        named = {p.name: junk for p in needed if p.kind is p.KEYWORD_ONLY}
        with suppress(KintrafoError):  # all other errors are raw
            function(*given, **named)
