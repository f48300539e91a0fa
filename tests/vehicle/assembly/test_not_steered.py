"""Every analysis refuses the steering of every assembly without it, with one message."""

import kintrafo
import pytest
from kintrafo import (
    Axle,
    InputError,
    Model,
    characteristics,
    compliance,
    equilibrium,
    loads,
    sweep,
    travel_range,
)
from kintrafo.vehicle.analysis.compare import compare
from kintrafo.vehicle.analysis.scenario import Scenario, run
from kintrafo.vehicle.assembly.usual import usual_rack
from kintrafo.vehicle.studies import optimise, sensitivity

SUBJECTS = {
    "corner": lambda: kintrafo.load("trailing_arm_car"),
    "axle": lambda: Axle.from_dict(
        {"axle": "rear", "side": kintrafo.load("trailing_arm_car").to_dict()}
    ),
    "rigid axle": lambda: kintrafo.load("rigid_axle"),
    "twist beam": lambda: kintrafo.load("twist_beam"),
}
CASE = {"a": {"contact_N": [0.0, 0.0, 3e3], "rack_mm": 5.0}}
ANALYSES = {
    "characteristics": lambda subject: characteristics.over(subject, "rack"),
    "a position of the rack": lambda subject: characteristics.over(subject, "rack", [0.0]),
    "held rack": lambda subject: characteristics.over(subject, None, rack_position=0.005),
    "elastokinematics": lambda subject: compliance.elastokinematics(subject, {}, "steer"),
    "sensitivity": lambda subject: sensitivity(subject, ["wheel.camber_deg"], over="rack"),
    "goal": lambda subject: optimise(
        subject, {"wheel.camber_deg": 1.0}, {"toe": {"over": "rack", "value": 0.0, "within": 0.1}}
    ),
    "grid": lambda subject: sweep.positions(subject, rack=[0.0, 0.01]),
    "rest": lambda subject: equilibrium(kintrafo.model_of(subject), rack_position=0.01),
    "simulation": lambda subject: run(
        kintrafo.model_of(subject), Scenario(0.1, inputs={"rack_position": 0.0})
    ),
    "loads": lambda subject: loads.static(subject, CASE, static_load=3e3),
}


@pytest.mark.parametrize("analysis", ANALYSES)
@pytest.mark.parametrize("name", SUBJECTS)
def test_every_analysis_refuses_steering_by_one_message(name, analysis, refused):
    with refused(InputError) as error:
        ANALYSES[analysis](SUBJECTS[name]())
    assert len(error.value.problems) == 1


ARM = kintrafo.load("trailing_arm_car")
OF_CORNERS = {
    "usual positions": usual_rack,
    "rest": lambda model: equilibrium(model, rack_position=-0.001),
    "reach": lambda model: travel_range(model, 0.01),
    "comparison": lambda model: compare({"a": model, "b": Model("multi_link_car")}, over="rack"),
    **{
        name: lambda _, name=name: sensitivity(ARM, ["hardpoints.arm_inner.z"], names=[name])
        for name in ("caster", "scrub_radius", "steering_ratio")
    },
}


@pytest.mark.parametrize("ask", OF_CORNERS.values(), ids=OF_CORNERS)
def test_what_moves_a_rack_of_a_corner_is_refused(ask, refused):
    refused(InputError, lambda: ask(Model(ARM)))


@pytest.mark.parametrize("axle", ["rear_axle", "steered_rigid_axle"])
def test_steered_axles_are_not_refused(axle):
    subject = kintrafo.load(axle)
    assert characteristics.over(subject, "rack", [0.0])["toe"].notnull().all()
