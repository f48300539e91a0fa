"""Messages name arguments that cannot be used, with the allowed values."""

import re
from contextlib import suppress
from inspect import signature
from operator import attrgetter

import kintrafo
import numpy as np
import pytest
from kintrafo import KintrafoError
from kintrafo.core.validator import Validator, shown
from kintrafo.generated import four_bar
from kintrafo.vehicle.analysis.scenario import Scenario, run
from support.folders import ROOT

CAR = kintrafo.Model("reference_car")
SYSTEM = kintrafo.System(four_bar)
REST = kintrafo.equilibrium(CAR)
SPAN = (0.0, 0.01)


@pytest.mark.parametrize(
    "call",
    [
        lambda: kintrafo.equilibrium(SYSTEM),
        lambda: kintrafo.simulate("reference_car", SPAN, REST),
        lambda: kintrafo.simulate(kintrafo.Model, SPAN, REST),
        lambda: kintrafo.simulate(CAR, SPAN, REST, rtol=[1e-6]),
        lambda: kintrafo.simulate(CAR, SPAN, REST, max_steps=2.5),
        lambda: kintrafo.simulate(CAR, SPAN, REST, atol=np.inf),
        lambda: kintrafo.simulate(CAR, SPAN, "x"),
        lambda: kintrafo.simulate(CAR, 1.0, REST),
        lambda: kintrafo.simulate(CAR, SPAN, REST, inputs=[1]),
        lambda: kintrafo.simulate(CAR, SPAN, REST, inputs=np.arange(3.0)),
        lambda: run(CAR, Scenario(inputs=None)),
        lambda: run(CAR, Scenario(duration={})),
        lambda: run(CAR, Scenario(output_step=1e-9)),
        lambda: kintrafo.simulate(
            CAR, SPAN, REST, inputs={"road_height": ([0.0, 10**400], [0.0, 0.0])}
        ),
        lambda: kintrafo.simulate(CAR, SPAN, REST, inputs={"road_height": lambda _: 10**400}),
        lambda: kintrafo.simulate(CAR, SPAN, REST, inputs={"road_height": "0.01"}),
        lambda: kintrafo.simulate(CAR, SPAN, REST, events=kintrafo.SignalEvent("camber", np.nan)),
        lambda: kintrafo.equilibrium(CAR, spin_rate=np.nan),
        lambda: kintrafo.state_at_height(CAR, [0.3]),
        lambda: kintrafo.state_at_height(CAR, 0.3, spin_rate=np.nan),
        lambda: kintrafo.compile("/missing.py"),
        lambda: CAR.signal("cambre", REST),
        lambda: CAR.signals(REST[:2]),
        lambda: CAR.evaluate("rsh", REST),
        lambda: CAR.signals(np.tile(REST, (2, 1)), np.zeros((3, 5))),
        lambda: CAR.state(beta1=True),
        lambda: kintrafo.System(four_bar, {"crank_mass": np.nan}),
        lambda: kintrafo.System("four_bar"),
        lambda: kintrafo.linearise(CAR, REST, outputs="camber"),
        lambda: kintrafo.Suspension.load(3),
        lambda: kintrafo.Suspension.from_dict([1]),
        lambda: kintrafo.Model("reference_car", free_rack="yes"),
    ],
)
def test_a_mistake_is_reported(call, refused):
    refused(kintrafo.InputError, call)


def test_an_error_of_an_event_says_where_it_was():
    with pytest.raises(TypeError) as caught:
        kintrafo.simulate(CAR, SPAN, REST, events=lambda: 0.0)
    assert caught.value.__notes__ == ["This was raised by the event <lambda>, at t = 0 s."]


def test_all_that_is_wrong_is_reported_at_once():
    with pytest.raises(kintrafo.InputError) as caught:
        kintrafo.equilibrium(SYSTEM, rack_position="0", spin_rate=np.inf, wheel_load=-3.0)
    assert len(caught.value.problems) == 4
    assert caught.value.source == "equilibrium"


def test_what_is_wrong_of_many_is_reported_once():
    with pytest.raises(kintrafo.InputError) as caught:
        kintrafo.variation.tolerance(CAR.suspension, {"hardpoints": -1.0})
    assert [p.split(":")[0] for p in caught.value.problems] == ["[tolerances] hardpoints = -1 mm"]


def test_any_number_of_steps():
    assert kintrafo.simulate(CAR, SPAN, REST, max_steps=np.inf).success


def test_numbers_of_other_kinds_are_numbers():
    from decimal import Decimal
    from fractions import Fraction

    with Validator("test") as given:
        for value in (Decimal("0.5"), Fraction(1, 2), np.float32(0.5), np.array(0.5)):
            assert given.number("x", value) == 0.5
        assert given.array("x", [Fraction(1, 2), 1]).tolist() == [0.5, 1.0]


def test_times_of_other_kinds_are_times():
    from decimal import Decimal

    times = kintrafo.scenario.Scenario(duration=Decimal("0.5"), output_step=Decimal("0.2")).times()
    assert times.tolist() == [0.0, 0.2, 0.4, 0.5]


def test_names_that_are_none_are_refused(refused):
    odd = kintrafo.Samples(np.arange(3.0), np.zeros(3), between=np.zeros(4))
    refused(
        kintrafo.InputError, lambda: kintrafo.simulate(CAR, SPAN, REST, inputs={"road_height": odd})
    )


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
def test_what_no_argument_can_be_is_refused_in_words(name, tmp_path, monkeypatch):
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
