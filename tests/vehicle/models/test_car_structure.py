"""The structure of a car has all on which its declaration depends, and no more."""

import pytest
from cars.driving_cars import FILE, TYRE
from kintrafo.systems.compile.identity import identity
from kintrafo.vehicle.models.car import Car
from kintrafo.vehicle.models.car.equations import CarStructure

DRIVEN = FILE["front"]["drive"]
CHANGES = [
    ({}, True),
    ({"body.mass_kg": 1400.0, "front.side.hardpoints.wheel_center.z": 300.0}, True),
    ({"tyres.front": TYRE | {"friction": 0.8}}, True),
    ({"tyres.front": "passenger_205_55"}, False),
    ({"tyres.rear": "bmw_e90_rear"}, False),
    ({"tyres.relaxation": False}, False),
    ({"front.brakes.torque_on": "body"}, False),
    ({"front.drive": {**DRIVEN, "torque_on": "carrier"}}, False),
    ({"steering_column": {"stiffness_Nm_per_deg": 2.0}}, False),
    ({"car": "roll"}, False),
    ({"car": "ride"}, False),
]


@pytest.mark.parametrize(("changes", "same"), CHANGES, ids=lambda value: str(value)[:40])
def test_structures_are_the_same_where_declarations_are(changes, same):
    """The oracle is the hash of the whole declaration."""
    known, car = Car.from_dict(FILE), Car.from_dict(FILE).with_changes(changes)
    first, second = CarStructure.of(known), CarStructure.of(car)
    assert (first.text() == second.text()) is same
    assert (identity(first.declared()) == identity(second.declared())) is same


def test_terms_of_the_magic_formula_count():
    """Coefficients that vanish leave terms out of the equations."""
    texts = set()
    for tyre in ("passenger_205_55", "bmw_e90_front"):
        car = Car.from_dict(FILE).with_changes({"tyres.front": tyre, "tyres.rear": tyre})
        structure = CarStructure.of(car)
        assert car.tyres["front"].contact.name in structure.text()
        texts.add(structure.text())
    assert len(texts) == 2
