"""Every analysis refuses the steering of every assembly without it, with one message."""

import kintrafo
import pytest
from kintrafo import Axle, InputError, characteristics, compliance, equilibrium, loads, sweep
from kintrafo.vehicle.analysis.scenario import Scenario, run
from kintrafo.vehicle.studies import sensitivity

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
    "held rack": lambda subject: characteristics.over(subject, None, rack_position=0.005),
    "elastokinematics": lambda subject: compliance.elastokinematics(subject, {}, "steer"),
    "sensitivity": lambda subject: sensitivity(subject, ["wheel.camber_deg"], over="rack"),
    "grid": lambda subject: sweep.positions(subject, rack=[0.0, 0.01]),
    "rest": lambda subject: equilibrium(kintrafo.model_of(subject), rack_position=0.01),
    "simulation": lambda subject: run(
        kintrafo.model_of(subject), Scenario(0.1, inputs={"rack_position": 0.0})
    ),
    "loads": lambda subject: loads.static(subject, CASE, static_load=3e3),
}


@pytest.mark.parametrize("analysis", ANALYSES)
@pytest.mark.parametrize("name", SUBJECTS)
def test_every_analysis_refuses_steering_by_one_message(name, analysis):
    with pytest.raises(InputError, match="its wheels are not steered") as error:
        ANALYSES[analysis](SUBJECTS[name]())
    assert len(error.value.problems) == 1


@pytest.mark.parametrize("axle", ["rear_axle", "steered_rigid_axle"])
def test_steered_axles_are_not_refused(axle):
    subject = kintrafo.load(axle)
    assert characteristics.over(subject, "rack", [0.0])["toe"].notnull().all()
