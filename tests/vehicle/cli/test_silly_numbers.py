"""Numbers that no car can have are refused before its equations are derived."""

import pytest
from kintrafo import InputError
from kintrafo.vehicle.analysis.handling import load_manoeuvre
from kintrafo.vehicle.cli import drive, ride
from kintrafo.vehicle.data.starter import manoeuvres
from kintrafo.vehicle.input.units import unit_of

SILLY = ("0", "-1", "nan", "inf", "1e9", "1e-9", "1e300")
BUMP, KERB = ("--bump-height", "20"), ("--kerb", "50", "--contact-length", "120")
# Options of ride, others beside them, and values that are a road, though a flat or a smooth one.
OPTIONS = {
    **{
        (name, beside): ()
        for name in ("--speed", "--duration", "--output-step")
        for beside in ((), BUMP, KERB)
    },
    ("--seed", ()): ("0",),
    ("--bump-height", ()): ("0", "-1", "1e-9"),
    ("--bump-length", BUMP): (),
    ("--kerb", KERB[2:]): ("0", "-1", "1e-9"),
    ("--contact-length", ()): ("1e-9",),
    ("--contact-length", KERB[:2]): ("1e-9",),
}
# Keys of manoeuvres that may be small, or are held against the car.
SMALL = ("rise_s", "start_s", "before_m", "after_m", "settle_s", "dwell_s", "settled_s")
OF_CAR = ("car_width_mm", "car_length_mm", "front_overhang_mm")
KEYS = [
    (manoeuvre, key)
    for manoeuvre in manoeuvres()
    for key in type(load_manoeuvre(manoeuvre)).model_fields
    if unit_of(key) and key not in OF_CAR
]


@pytest.fixture(autouse=True)
def nothing_is_derived(monkeypatch):
    def derived(assembly):
        raise AssertionError(f"derives {assembly}")

    for command in (ride, drive):
        monkeypatch.setattr(command, "derived", derived)


@pytest.mark.parametrize(("option", "beside"), OPTIONS)
def test_of_a_ride(kintrafo, option, beside):
    for value in sorted({*SILLY} - {*OPTIONS[option, beside]}):
        words = ["ride", "reference_vehicle", f"{option}={value}", *beside]
        code, out, err = kintrafo(*words)
        assert (code, out) == (2, ""), words
        assert "Traceback" not in err


@pytest.mark.parametrize("manoeuvre", manoeuvres())
def test_of_the_speed_of_a_manoeuvre(kintrafo, manoeuvre):
    for value in SILLY:
        words = ["drive", "driving_car", "--manoeuvre", manoeuvre, f"--speed={value}"]
        code, out, err = kintrafo(*words)
        assert (code, out) == (2, ""), words
        assert "speed" in err


@pytest.mark.parametrize(("manoeuvre", "key"), KEYS)
def test_of_the_keys_of_a_manoeuvre(manoeuvre, key):
    several = isinstance(getattr(load_manoeuvre(manoeuvre), key), tuple)
    silly = {"-1", "nan", "inf", "1e9", "1e300"} | ({"0", "1e-9"} if key not in SMALL else set())
    for value in map(float, silly - ({"0", "1e-9", "-1"} if several else set())):
        with pytest.raises(InputError, match=key):
            load_manoeuvre(manoeuvre, {key: (value, value) if several else value})


def test_the_step_of_a_range_of_speeds_may_be_small():
    made = load_manoeuvre("speed_range", {"step_km_per_h": 0.5, "to_km_per_h": 100.0})
    assert made.model_dump()["step_km_per_h"] == 0.5
