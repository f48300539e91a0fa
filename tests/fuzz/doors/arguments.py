"""Arguments of every public function: wrong types, shapes, NaN, infinity, unknown names.

One or two arguments of a call that is right are replaced. What comes back must be finite, or a
refusal that names an argument, a value or what is out of reach.
"""

import tempfile
import warnings
from contextlib import chdir
from decimal import Decimal
from fractions import Fraction
from pathlib import Path

import kintrafo
import numpy as np
import xarray as xr
from cars.axles import BAR_OF_STRUTS
from kintrafo import (
    characteristics,
    checkup,
    compare,
    compliance,
    excitation,
    export,
    loads,
    measurement,
    plots,
    rig,
    roads,
    scenario,
    sweep,
    variation,
)
from kintrafo.datasets.recording import dataset_of, statistics
from kintrafo.generated import four_bar
from kintrafo.generator.mechanisms.four_bar import FOUR_BAR
from kintrafo.vehicle.models.points import hardpoints
from kintrafo.vehicle.models.positions import design_height

from ..attempts import RawError, WrongError

SHORT = 60
_CAR = kintrafo.Model("reference_car")
_SYSTEM = kintrafo.System(four_bar)
_TURNED = kintrafo.simulate(_SYSTEM, (0.0, 0.01), _SYSTEM.state(crank_angle_rate=1.0))
_DIFFERENTIABLE = kintrafo.System(kintrafo.compile(FOUR_BAR, parameter_derivatives=True))
_BAR_AT = _DIFFERENTIABLE.state(crank_angle=0.3)
_REST = kintrafo.equilibrium(_CAR)
_LINEAR = kintrafo.linearise(_CAR, _REST)
_RESULT = kintrafo.simulate(_CAR, (0.0, 0.01), _REST)
_DATASET = dataset_of(_CAR, _RESULT)
_AXLE = kintrafo.Axle.load("reference_axle")
_BAR = BAR_OF_STRUTS | {
    "axis": [0.0, 1.0, 0.0], "rate_Nm_per_deg": None, "diameter_mm": 20.0, "length_mm": 800.0,
    "inner_diameter_mm": 0.0,
}  # fmt: skip
_RIGID = kintrafo.RigidAxle.load("rigid_axle")
_RIDE, _ = scenario.run(kintrafo.RigidAxleModel(_RIGID), scenario.Scenario(duration=0.01))
# On these two goals of compliance are told, with what holds the wheels as one of their keys.
_BUSHES = {"arm_rear": {"radial_N_per_mm": 1e3}}
_SOFT = _CAR.suspension.with_changes({"bushings": _BUSHES})
_SOFT_AXLE = kintrafo.Axle.from_dict({"axle": "front", "side": _SOFT})
_EXTENT = characteristics.SweepRange(rebound=0.01, bump=0.01, roll=0.01, rack=0.01, step=0.01)
_ONE_CURVE = _DATASET[["camber"]]
_MEASURED = characteristics.over(_CAR, "travel", [-0.02, 0.0, 0.02])[["toe", "camber"]]

NASTY = [
    None, True, False, "", "reference_car", "nan", b"x", 0, -1, 1, 10**400, 0.0, -0.3, 1e-320,
    1e308, np.nan, np.inf, -np.inf, 1j, Decimal("0.1"), Fraction(1, 3), np.float32(0.01),
    np.int64(3), [], [1.0], [np.nan], [[0.0, 0.01]], [None], ["a"],
    [[1.0], [1.0, 2.0]], (0.0, 0.1), (1.0, 1.0),
    (0.1, 0.0, 0.2), np.zeros((0, 4)), np.zeros(4), np.ones((2, 3)), np.array("x"),
    {}, {"a": 1.0}, {"road_height": np.nan}, {"road_height": "0.01"}, {1: 2}, set(), object(), _CAR,
    _SYSTEM, kintrafo.Model, four_bar, np, len, lambda: 0.0, lambda *_: np.nan,
    Path("/missing.toml"), "camber", "BDF", slice(3), range(3), iter([1.0]), xr.Dataset(),
]  # fmt: skip

_SPAN = (0.0, 0.01)
_ROD = "hardpoints.tie_rod_inner.z"


def _event(value, **attributes):
    """Return an event's function that gives this, and has these attributes."""

    def watch(*_):
        return value

    vars(watch).update(attributes)
    return watch


CALLS = {
    "Model": (kintrafo.Model, {"suspension": "reference_car", "free_rack": False}),
    "System": (kintrafo.System, {"equations": four_bar, "parameters": {"crank_mass": 2.0}}),
    "System.state": (_CAR.state, {"beta1": 1.7, "beta5_rate": 3.0}),
    "System.inputs": (_CAR.inputs, {"values": {"road_height": 0.01}}),
    "System.evaluate": (_CAR.evaluate, {"function": "rhs", "state": _REST, "inputs": None}),
    "System.signals": (_CAR.signals, {"state": _REST, "inputs": None}),
    "System.signal": (_CAR.signal, {"name": "camber", "state": _REST, "inputs": None}),
    "System.eigenvalues": (_CAR.eigenvalues, {"state": _REST, "inputs": None}),
    "simulate": (kintrafo.simulate, {"model": _CAR, "t_span": _SPAN, "y0": _REST,
        "inputs": {"road_height": 0.01}, "method": "BDF", "step": None, "t_eval": None,
        "rtol": 1e-6, "atol": 1e-9, "max_step": np.inf, "first_step": None, "max_steps": 10_000,
        "dense_output": False, "events": None, "stop_at_outputs": False, "backend": "auto"}),
    "ensemble": (kintrafo.ensemble, {"model": _CAR, "variants": {"damper_rate": [1000.0, 2000.0]},
        "t_span": _SPAN, "y0": _REST, "inputs": {"road_height": 0.01}, "signals": ["camber"],
        "reductions": {"camber": "max"}, "t_eval": None, "rtol": 1e-6, "atol": 1e-9,
        "max_step": np.inf, "first_step": None, "max_steps": 1000, "stiff": "BDF", "threads": 1,
        "lanes": None, "cluster": None, "progress": False}),
    "variants": (lambda **given: kintrafo.ensemble(_CAR, given, _SPAN, _REST),
        {"damper_rate": [1000.0, 2000.0], "road_height": 0.0, "beta1_rate": 0.0}),
    "reductions": (
        lambda kind: kintrafo.ensemble(_CAR, None, _SPAN, _REST, reductions={"camber": kind}),
        {"kind": "max"},
    ),
    "loads.static": (loads.static, {"subject": _CAR, "cases": {"a": {"contact_g": [0.0, 0.0, 1.0]}},
        "static_load": 3000.0}),
    "load case": (lambda **given: loads.static(_CAR, {"a": given}),
        {"contact_N": [0.0, 100.0, 3000.0], "contact_g": [0.1, 0.0, 0.0], "rack_mm": 10.0,
         "center_Nm": [10.0, 0.0, 0.0]}),
    "load case at a travel": (lambda **given: loads.static(_CAR, {"a": given}), {"travel_mm": 10.0,
        "contact_N": [100.0, 0.0, 0.0]}),
    "compliance": (compliance.linear, {"subject": _CAR,
        "bushings": {"arm_rear": {"radial_N_per_mm": 1e3}}, "travel": [0.0], "rack_position": 0.0,
        "held": "height"}),
    "bush": (lambda **given: compliance.linear(_CAR, {"arm_rear": given}, [0.0]),
        {"axial_N_per_mm": 1e3, "radial_N_per_mm": [1e3, 2e3], "axis": [1.0, 0.1, 0.0],
         "radial_axis": [0.0, 0.0, 1.0]}),
    "compliance.elastokinematics": (compliance.elastokinematics, {"subject": _CAR,
        "bushings": {"arm_rear": {"radial_N_per_mm": 1e3}}, "along": [0.0], "rack_position": 0.0,
        "hardpoints": "loaded"}),
    "compliance.nonlinear": (compliance.nonlinear, {"subject": _CAR,
        "bushings": {"arm_rear": {"radial_N_per_mm": 1e3}}, "under": "lateral", "amounts": [100.0],
        "travel": 0.0, "rack_position": 0.0, "held": "height", "hardpoints": "loaded"}),
    "compliance.elastokinematics of an axle": (compliance.elastokinematics, {"subject": _AXLE,
        "bushings": {"arm_rear": {"radial_N_per_mm": 1e3}}, "motion": "roll", "along": [0.01],
        "extent": None, "travel": 0.0, "rack_position": 0.0, "hardpoints": "loaded"}),
    "compliance.nonlinear of an axle": (compliance.nonlinear, {"subject": _AXLE,
        "bushings": {"arm_rear": {"radial_N_per_mm": 1e3}}, "under": "lateral", "amounts": [100.0],
        "wheels": [1.0, -0.5], "travel": 0.0, "rack_position": 0.0, "held": "height",
        "hardpoints": "loaded"}),
    "curve of a bush": (
        lambda **given: compliance.elastokinematics(
            _CAR, {"arm_rear": {"axial_curve": given}}, along=[0.0]
        ),
        {"mm": [-1.0, 0.0, 1.0], "N": [-100.0, 0.0, 300.0]},
    ),
    "rig.measured_curves": (rig.measured_curves, {"path": "no.csv"}),
    "rig.beside": (rig.beside, {"measured": None, "subjects": {"a": _CAR}, "name": "measured"}),
    "loads.along": (loads.along, {"model": _CAR, "result": None}),
    "loads.table": (loads.table, {"dataset": None}),
    "loads.envelope": (loads.envelope, {"dataset": None}),
    "sensitivity": (variation.sensitivity, {"suspension": _CAR.suspension, "places": [_ROD],
        "over": "travel", "positions": [0.0, 0.01], "names": ["camber"]}),
    "cars": (variation.cars, {"suspension": _CAR.suspension,
        "values": {_ROD: [279.0, 281.0, 282.0]}, "over": "travel", "positions": [0.0, 0.01],
        "names": ["camber"], "reductions": ["min"], "threads": 1}),
    "goals": (lambda **given: variation.judge(_CAR.suspension, variation.goals({"targets": given})),
        {"toe": {"value": 0.0, "within": 1.0, "at_mm": [0.0, 1.0], "over": "travel"}}),
    "judge": (variation.judge, {"suspension": _CAR.suspension, "wanted": []}),
    "tolerance": (variation.tolerance, {"suspension": _CAR.suspension, "tolerances": {_ROD: 1.0},
        "distribution": "normal", "correlation": [[1.0]], "limits": {"toe": {"least": -1.0}},
        "count": 2, "seed": 1, "over": "travel", "positions": [0.0, 0.01], "names": ["camber"]}),
    "optimise": (variation.optimise, {"suspension": _CAR.suspension, "free": {_ROD: 1.0},
        "targets": {"bump_steer": {"value": 0.0, "within": 1.0}},
        "limits": {"toe": {"least": -1.0}}}),
    "pareto": (variation.pareto, {"suspension": _CAR.suspension, "free": {_ROD: 1.0},
        "targets": {"bump_steer": {"value": 0.0, "within": 1.0}},
        "minimise": {"camber": {"at_mm": 10.0}}, "maximise": {"toe": {"at_mm": [20.0]}},
        "limits": {"toe": {"least": -1.0}}, "population": 4, "generations": 2, "seed": 1}),
    "fit": (variation.fit, {"suspension": _CAR.suspension, "measured": _MEASURED,
        "tolerances": {_ROD: 1.0}, "accuracy": {"toe": 0.1}, "names": ["toe"]}),
    "variation.sweep": (variation.sweep, {"suspension": _CAR.suspension,
        "values": {_ROD: [270.0, 280.0]}, "scenario": scenario.Scenario(duration=0.01),
        "signals": ["camber"], "reductions": {"camber": "max"}, "rtol": 1e-6, "atol": 1e-9,
        "max_steps": 1000}),
    "targets": (lambda **given: variation.optimise(_CAR.suspension, {_ROD: 1.0}, {"toe": given}),
        {"value": 0.0, "within": 1.0, "at_mm": [0.0, 1.0], "over": "travel"}),
    "minimise": (
        lambda **given: variation.pareto(
            _CAR.suspension, {_ROD: 1.0}, minimise={"toe": [given, {"at_mm": 40.0}]},
            population=4, generations=1,
        ),
        {"at_mm": [0.0, 1.0], "over": "travel"},
    ),
    "limits": (
        lambda **given: variation.tolerance(
            _CAR.suspension, {_ROD: 1.0}, limits={"toe": given}, count=2, positions=[0.0]
        ),
        {"least": -1.0, "most": 1.0, "at_mm": [0.0, 1.0], "over": "travel"},
    ),
    "target under loads": (
        lambda **given: variation.judge(
            _SOFT, variation.goals({"targets": {"toe_by_lateral": given}})
        ),
        {"value": 0.0, "within": 1.0, "at_mm": [0.0, 1.0], "over": "travel", "held": "height"},
    ),
    "limit of a load": (
        lambda **given: variation.judge(
            _CAR.suspension, variation.goals({"limits": {"tie_rod_force": given}})
        ),
        {"least": -1.0, "at_percent": [50.0, 100.0], "over": "load", "case": "kerb",
         "cases": {"kerb": {"contact_N": [0.0, -1000.0, 3000.0]}}, "static_load_N": 3000.0},
    ),
    "limit of an axle under loads": (
        lambda **given: variation.judge(
            _SOFT_AXLE,
            variation.goals({"limits": {"toe_by_lateral_opposed_left": given}}, ["bump", "roll"]),
        ),
        {"least": -1.0, "most": 1.0, "at_mm": [0.0, 1.0], "over": "bump", "held": "spring"},
    ),
    "minimise under loads": (
        lambda **given: variation.pareto(
            _SOFT, {"bushings.arm_rear.radial_N_per_mm": 100.0}, population=4, generations=1,
            minimise={"toe_by_lateral": [given, {"at_mm": 40.0}]},
        ),
        {"at_mm": [0.0, 1.0], "over": "travel", "held": "tyre"},
    ),
    "goals of a file": (variation.goals, {"described": {"limits": {"toe": {"most": 1.0}}},
        "axes": ["travel", "rack"]}),
    "variation.limits": (variation.limits, {"described": {"toe_left": {"most": 1.0}},
        "axes": ["bump", "roll"]}),
    "SignalEvent": (
        lambda **given: kintrafo.simulate(
            _CAR, _SPAN, _REST, events=kintrafo.SignalEvent(**given)
        ),
        {"signal": "camber", "level": 0.0, "direction": 0.0, "terminal": False},
    ),
    "equilibrium": (kintrafo.equilibrium, {"model": _CAR, "rack_position": 0.0, "road_height": 0.0,
        "wheel_load": None, "strut_force": 0.0, "spin_rate": 0.0}),
    "equilibrium of an axle": (kintrafo.equilibrium, {"model": kintrafo.RigidAxleModel(_RIGID),
        "rack_position": 0.0, "road_height": {"left": 0.01}, "wheel_load": None,
        "strut_force": {"right": 100.0}, "spin_rate": 0.0,
        "inputs": {"left_spring_actuator": 100.0}}),
    "state_at_height": (kintrafo.state_at_height, {"model": _CAR, "height": 0.3,
        "rack_position": 0.0, "spin_rate": 0.0}),
    "arm_angles": (kintrafo.arm_angles, {"model": _CAR, "height": 0.3, "rack_position": 0.0}),
    "travel_range": (kintrafo.travel_range, {"model": _CAR, "rack_position": 0.0}),
    "design_height": (design_height, {"model": _CAR}),
    "road_under_load": (kintrafo.road_under_load, {"model": _CAR, "wheel_load": 3e3, "state": _REST,
        "inputs": None}),
    "hardpoints": (hardpoints, {"model": _CAR, "state": _REST, "inputs": None}),
    "rest": (kintrafo.rest, {"system": _CAR, "near": _REST, "inputs": {"strut_force": 1.0}}),
    "linearise": (kintrafo.linearise, {"model": _CAR, "state": _REST, "inputs": None,
        "outputs": ["camber"]}),
    "derivative": (kintrafo.derivative, {"system": _DIFFERENTIABLE, "function": "rhs",
        "along": {"crank_mass": 1.0}, "state": _BAR_AT, "inputs": None}),
    "gradient": (kintrafo.gradient, {"system": _DIFFERENTIABLE, "function": "rhs",
        "weights": [0.0, 1.0], "state": _BAR_AT, "inputs": None}),
    "motion_sensitivity": (kintrafo.motion_sensitivity, {"system": _DIFFERENTIABLE,
        "t_span": (0.0, 0.05), "y0": _BAR_AT, "by": ["crank_mass"], "signals": [],
        "t_eval": [0.01, 0.05], "rtol": 1e-6, "atol": 1e-9}),
    "design_derivative": (kintrafo.design_derivative, {"system": _DIFFERENTIABLE,
        "along": {"crank_mass": 1.0}}),
    "frequency_response": (_LINEAR.frequency_response, {"frequency": [1.0, 2.0],
        "source": "road_height"}),
    "sweep.positions": (sweep.positions, {"subject": _CAR, "travel": [0.0], "rack": 0.0}),
    "sweep.grid": (sweep.grid, {"lowest": -0.01, "highest": 0.01, "step": 0.01}),
    "sweep.usual_travel": (sweep.usual_travel, {"model": _CAR, "rebound": 0.01, "bump": None,
        "step": 0.01, "rack": 0.0}),
    "sweep.usual_rack": (sweep.usual_rack, {"model": _CAR, "extent": 0.01, "step": 0.01,
        "travel": 0.0}),
    "characteristics.over": (characteristics.over, {"subject": _CAR, "motion": "travel",
        "along": [0.0, 0.01], "extent": None, "travel": 0.0, "rack_position": 0.0}),
    "characteristics.over, an axle": (characteristics.over, {"subject": _AXLE, "motion": "roll",
        "along": None, "extent": _EXTENT, "travel": 0.0, "rack_position": 0.0}),
    "compare": (compare.compare, {"subjects": {"a": _CAR, "b": _CAR}, "along": [0.0],
        "over": "travel", "held": None, "progress": None}),
    "compare, axles": (compare.compare, {"subjects": {"a": _AXLE, "b": _AXLE}, "over": "left"}),
    "checkup": (checkup.checkup, {"subject": _CAR}),
    "roads.step": (roads.step, {"height": 0.01, "at": 0.1, "end": 1.0}),
    "roads.sine": (roads.sine, {"amplitude": 0.01, "frequency": 1.0, "end": 1.0}),
    "TimeProfile": (lambda end, **given: excitation.TimeProfile(**given).signal(end), {"held": None,
        "step": 0.01, "step_at": 0.1, "sine": None, "frequency": 1.0, "end": 1.0}),
    "excitation": (excitation.excitation,
        {"profiles": {"road_height": excitation.TimeProfile(held=0.01)}, "end": 1.0,
         "measured": None}),
    "measured": (measurement.measured, {"path": "missing.csv", "speed": None}),
    "Scenario": (lambda **given: scenario.run(_CAR, scenario.Scenario(**given)), {"duration": 0.01,
        "output_step": 1e-3, "height": None, "spin_rate": 0.0, "inputs": {}}),
    "run": (scenario.run, {"model": _CAR, "scenario": scenario.Scenario(0.01), "wheels": "both"}),
    "Samples": (
        lambda **given: kintrafo.simulate(
            _CAR, _SPAN, _REST, inputs={"road_height": kintrafo.Samples(**given)}
        ),
        {"times": [0.0, 1.0], "values": [0.0, 0.01], "between": "monotone"},
    ),
    "dataset_of": (dataset_of, {"model": _CAR, "result": _RESULT}),
    "statistics": (statistics, {"dataset": _DATASET}),
    "export.write": (export.write, {"dataset": _DATASET, "path": "a.csv", "force": False,
        "inputs": ()}),
    "plots.write": (plots.write, {"dataset": _ONE_CURVE, "folder": "plots", "formats": ("svg",),
        "title": "", "suffix": "", "force": False, "inputs": ()}),
    "plots.write_overview": (plots.write_overview, {"dataset": _ONE_CURVE, "path": "a.svg",
        "names": (), "title": "", "force": False, "inputs": ()}),
    "plots.figure": (plots.figure, {"dataset": _ONE_CURVE, "names": ["camber"], "title": "",
        "alone": True}),
    "Events": (lambda **given: kintrafo.simulate(_CAR, _SPAN, _REST, events=_event(**given)),
        {"value": 1.0, "direction": 0.0, "terminal": False}),
    "export.as_dict": (export.as_dict, {"dataset": _DATASET}),
    "animate": (kintrafo.animate, {"result": _TURNED, "path": "a.html", "fps": 25.0, "slower": 1.0,
        "title": None, "force": False, "inputs": ()}),
    "report.write": (kintrafo.report.write, {"model": _SYSTEM, "path": "a.html", "title": None,
        "motion": None, "force": False, "inputs": (), "goals": (), "chapters": (), "without": ()}),
    "compliance_chapter": (kintrafo.report.compliance_chapter,
        {"found": compliance.linear(kintrafo.Model(_SOFT), None, [0.0]), "goals": ()}),
    "export.check_format": (export.check_format, {"path": "a.csv"}),
    "plots.check_formats": (plots.check_formats, {"paths": ["a.png"], "formats": ["svg"]}),
    "plots.grouped": (plots.grouped, {"dataset": _DATASET}),
    "compile": (kintrafo.compile, {"declared": "/missing.py", "name": None, "backend": "numpy"}),
    "proposals": (lambda **given: next(kintrafo.proposals(**given)), {"declared": "/missing.py",
        "name": None, "seconds": 1.0}),
    "Axle.load": (kintrafo.Axle.load, {"path_or_name": "reference_axle"}),
    "Axle.from_dict": (kintrafo.Axle.from_dict, {"data": {"axle": "front", "side": "reference_car"},
        "source": "a", "folder": "."}),
    "axle": (
        lambda **given: characteristics.over(
            kintrafo.Axle.from_dict({"axle": "front", **given}), "bump", [0.0]
        ),
        {
            "side": "reference_car", "anti_roll_bar": _BAR, "brakes": {"torque_on": "body"},
            "drive": {"share": 0.5}, "steering": {"angle_deg": [-9.0, 9.0], "rack_mm": [1.0, 0.0]},
        },
    ),
    "anti_roll_bar": (
        lambda **given: characteristics.over(
            kintrafo.Axle.from_dict(
                {"axle": "rear", "side": "reference_car", "anti_roll_bar": given}
            ),
            "roll", [0.0, 0.01],
        ),
        _BAR | {"free_twist_deg": 1.0},
    ),
    "loads.static of an axle": (loads.static, {"subject": _AXLE,
        "cases": {"a": {"contact_g": [0.0, 0.0, 1.0]}}, "static_load": 3000.0}),
    "load case of an axle": (lambda **given: loads.static(_AXLE, {"a": given}), {"rack_mm": 10.0,
        "contact_N": [0.0, 100.0, 3000.0], "left": {"contact_Nm": [10.0, 0.0, 0.0]},
        "right": {"center_N": [1.0, 0.0, 0.0]}}),
    "loads.along of no model": (loads.along, {"model": None, "result": _RESULT}),
    "loads.static of a rigid axle": (loads.static, {"subject": _RIGID,
        "cases": {"a": {"contact_g": [0.0, 0.0, 1.0]}}, "static_load": 3000.0}),
    "load case of a rigid axle": (lambda **given: loads.static(_RIGID, {"a": given}),
        {"travel_mm": None, "contact_N": [0.0, 100.0, 3000.0], "contact_g": [0.1, 0.0, 0.0],
         "left": {"contact_Nm": [10.0, 0.0, 0.0]}, "right": {"center_N": [1.0, 0.0, 0.0]}}),
    "rigid axle held at a travel": (lambda **given: loads.static(_RIGID, {"a": given}),
        {"travel_mm": 10.0, "contact_N": [100.0, 0.0, 0.0], "right": {}}),
    "loads.standard_cases": (loads.standard_cases, {"subject": _RIGID}),
    "loads.along of a rigid axle": (loads.along, {"model": kintrafo.RigidAxleModel(_RIGID),
        "result": _RIDE}),
    "compliance.linear of an axle": (compliance.linear, {"subject": _AXLE,
        "bushings": {"arm_rear": {"radial_N_per_mm": 1e3}}, "travel": [0.0], "rack_position": 0.0,
        "held": "height"}),
    "bush of an axle": (lambda **given: compliance.linear(_AXLE, {"arm_rear": given}, [0.0]),
        {"axial_N_per_mm": 1e3, "radial_N_per_mm": [1e3, 2e3], "axis": [1.0, 0.1, 0.0],
         "radial_axis": [0.0, 0.0, 1.0]}),
    "bush of a file": (
        lambda **given: _CAR.suspension.with_changes({"bushings": {"arm_rear": given}}),
        {
            "axial_N_per_mm": 1e3, "radial_N_per_mm": [1e3, 2e3], "axis": [1.0, 0.1, 0.0],
            "radial_axis": [0.0, 0.0, 1.0], "tilt_Nm_per_deg": 3.0,
        },
    ),
    "bushes of a file": (lambda **given: _CAR.suspension.with_changes(given),
        {"bushings": {"arm_rear": {"axial_curve": {"mm": [-1, 0, 1], "N": [-3, 0, 9]}}}}),
    "rack": (lambda **given: compliance.linear(_AXLE, {"rack": given}, [0.0]),
        {"axial_N_per_mm": 1e3}),
    "SweepRange": (
        lambda **given: characteristics.over(
            _AXLE, "bump", extent=characteristics.SweepRange(**given)
        ),
        {"rebound": 0.01, "bump": 0.02, "step": 0.01},
    ),
    "Suspension.load": (kintrafo.Suspension.load, {"path_or_name": "reference_car"}),
    "Suspension.from_dict": (kintrafo.Suspension.from_dict, {"data": {}}),
    "Suspension.with_changes": (_CAR.suspension.with_changes, {"changes": {}}),
}  # fmt: skip


def attempt(random):
    name = str(random.choice(list(CALLS)))
    function, right = CALLS[name]
    given = dict(right)
    for wrong in random.choice(list(given), random.integers(1, 1 + min(2, len(given)))):
        given[str(wrong)] = NASTY[random.integers(len(NASTY))]
    # some calls write what they return
    with tempfile.TemporaryDirectory() as folder, chdir(folder), warnings.catch_warnings():
        warnings.simplefilter("error", RuntimeWarning)
        try:
            found = function(**given)
        except kintrafo.KintrafoError as error:
            _check_words(name, str(error))
            raise
        except Exception as error:
            told = {key: value for key, value in given.items() if value is not right[key]}
            error.add_note(f"{name}: {told}")
            raise RawError(f"{name}({told}): {type(error).__name__}: {error}") from error
    _check_finite(name, found)


def _check_words(name, text):
    """Refuse the words of the library below, or none."""
    for foreign in ("Traceback", "NoneType", "object has no attribute", "could not convert"):
        if foreign in text:
            raise RawError(f"{name}: {text}")
    if len(text) < 20:
        raise RawError(f"{name}: {text}")


def _check_finite(name, found):
    arrays = found if isinstance(found, tuple | list) else [found]
    if name == "simulate":
        arrays = [found.y, found.inputs]
    for array in arrays:
        if isinstance(array, np.ndarray | float) and not np.isfinite(array).all():
            raise WrongError(f"{name}: a result that is not finite")
