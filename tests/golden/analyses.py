"""The analyses of the golden set: a dataset each, by name.

Only this file knows what the functions are called and which arguments they take. Where they change,
it changes with them; the names of analyses and the stored values stay.
"""

from dataclasses import asdict
from functools import partial

import kintrafo
import numpy as np
import xarray as xr
from kintrafo import (
    AxleModel,
    Model,
    Suspension,
    characteristics,
    checkup,
    compliance,
    loads,
    scenario,
    sheet,
    sweep,
    variation,
)
from kintrafo.vehicle.assembly.by_wheel import flat

from .subjects import AXLES, BUSHES, CORNERS, WHOLE_AXLES

TRAVEL = np.array([-0.05, -0.02, 0.0, 0.03, 0.06])
RACK = np.array([-0.02, 0.0, 0.015])
ROLL = np.radians([-3.0, 0.0, 2.0])
AMOUNTS = {"lateral": [-2000.0, 1500.0], "braking": [1500.0], "aligning": [60.0]}
HELD = ("height", "tyre", "spring", "locked")
SHIPPED = "reference_axle"
"""The axle whose equations need no compiler."""


def analyses(subject):
    """Return the analyses of a subject."""
    bushes = BUSHES[subject]
    if subject in CORNERS:
        return _of_corner(Suspension.load(subject), bushes)
    if subject in AXLES:
        axle = AXLES[subject]()
        found = _of_axle(axle, bushes)
        return found | _of_axle_in_motion(AxleModel(axle)) if subject == SHIPPED else found
    return _of_whole_axle(WHOLE_AXLES[subject](), bushes)


def _of_corner(suspension, bushes):
    model = Model(suspension)
    steered = suspension.steered()
    found = {
        "check": lambda: _facts(checkup.as_dict(checkup.checkup(model))),
        "travel": _flat(characteristics.over, model, "travel", TRAVEL),
        "positions": partial(sweep.positions, model, TRAVEL, RACK if steered else None),
        "static loads": partial(loads.static, model),
        "elastokinematics": partial(compliance.elastokinematics, model, bushes, along=TRAVEL),
        "sheet": partial(sheet.sheet, model, bushes),
        "simulation": lambda: scenario.run(model, _step(), method="DormandPrince")[1],
        "loads in motion": lambda: loads.along(
            model, scenario.run(model, _step(), method="DormandPrince")[0]
        ),
        "linearisation": lambda: _linearised(model, kintrafo.equilibrium(model)),
        "sensitivity": partial(variation.sensitivity, suspension, positions=TRAVEL[1:4]),
        "tolerance": partial(_tolerance, suspension),
    }
    if steered:
        found["steering"] = _flat(characteristics.over, model, "rack", RACK, travel=0.01)
        found["travel, steered"] = _flat(
            characteristics.over, model, "travel", TRAVEL, rack_position=0.01
        )
    for held in HELD:
        found[f"compliance, {held}"] = partial(
            compliance.linear, model, bushes, TRAVEL[1:4], held=held
        )
    for under, amounts in AMOUNTS.items():
        found[f"deflection, {under}"] = partial(
            compliance.nonlinear, model, bushes, under, amounts, travel=0.01
        )
    return found


def _of_axle(axle, bushes):
    # the stored values have the case "drive" also for axles without a drive
    driven = axle if axle.drive else axle.with_changes({"drive": {"share": 1.0}})
    found = {
        "check": lambda: _looked(checkup.checkup(axle)),
        "bump": _flat(characteristics.over, axle, "bump", TRAVEL),
        "roll": _flat(characteristics.over, axle, "roll", ROLL),
        "left": _flat(characteristics.over, axle, "left", TRAVEL),
        "right": _flat(characteristics.over, axle, "right", TRAVEL),
        "static loads": partial(loads.static, axle, loads.standard_cases(driven)),
        "elastokinematics, bump": partial(
            compliance.elastokinematics, axle, bushes, "bump", TRAVEL
        ),
        "elastokinematics, roll": partial(compliance.elastokinematics, axle, bushes, "roll", ROLL),
        "sheet": partial(sheet.sheet, axle, bushes),
    }
    if axle.steered:
        found["steer"] = _flat(characteristics.over, axle, "rack", RACK)
    return found | _compliance(axle, bushes)


def _of_axle_in_motion(model):
    def run():
        return scenario.run(model, _step(), wheels="left", method="DormandPrince")

    return {
        "simulation": lambda: run()[1],
        "loads in motion": lambda: loads.along(model, run()[0]),
        "linearisation": lambda: _linearised(model, kintrafo.equilibrium(model)),
    }


def _of_whole_axle(axle, bushes):
    model = kintrafo.model_of(axle)

    def run():
        return scenario.run(model, _step(), wheels="left", method="DormandPrince")

    return {
        "check": lambda: _looked(checkup.checkup(axle)),
        "bump": _flat(characteristics.over, axle, "bump", TRAVEL),
        "roll": _flat(characteristics.over, axle, "roll", ROLL),
        "left": _flat(characteristics.over, axle, "left", TRAVEL),
        "static loads": partial(loads.static, axle),
        "elastokinematics, bump": partial(
            compliance.elastokinematics, axle, bushes, "bump", TRAVEL
        ),
        "elastokinematics, roll": partial(compliance.elastokinematics, axle, bushes, "roll", ROLL),
        "sheet": partial(sheet.sheet, axle, bushes),
        "simulation": lambda: run()[1],
        "loads in motion": lambda: loads.along(model, run()[0]),
        "linearisation": lambda: _linearised(model, kintrafo.equilibrium(model)),
        "sensitivity": partial(variation.sensitivity, axle, positions=TRAVEL[1:4]),
    } | _compliance(axle, bushes)


def _compliance(axle, bushes):
    """Return compliance and deflection of an axle of two corners, or of a rigid one."""
    found = {
        f"compliance, {held}": partial(compliance.linear, axle, bushes, TRAVEL[1:4], held=held)
        for held in HELD
    }
    for under, amounts in AMOUNTS.items():
        for wheels in ("parallel", "opposed"):
            found[f"deflection, {under}, {wheels}"] = partial(
                compliance.nonlinear, axle, bushes, under, amounts, wheels=wheels
            )
    return found


def _flat(analysis, *args, **options):
    """Return an analysis whose result has no dimension of the wheels."""
    return lambda: flat(analysis(*args, **options))


def _tolerance(suspension):
    """Return bands, without ratios of two deviations that may both be rounding errors."""
    found = variation.tolerance(
        suspension, {"hardpoints.wheel_center.z": 1.0}, count=20, positions=TRAVEL
    )
    return found.drop_vars([name for name in found if str(name).endswith("_first_order")])


def _step():
    """Return a road that rises by 10 mm."""
    road = kintrafo.roads.step(0.01, at=0.02, end=0.2)
    return scenario.Scenario(duration=0.2, output_step=0.02, inputs={"road_height": road})


def _linearised(model, state):
    """Return the matrices of the linear equations about a state."""
    found = kintrafo.linearise(model, state)
    return xr.Dataset({name: ([f"{name}_0", f"{name}_1"], getattr(found, name)) for name in "ABCD"})


def _looked(found):
    """Return the numbers of a first look at an axle."""
    sides = {one.side: asdict(one) for one in found.wheels}
    return _facts({"sides": sides, "values": found.axle.values if found.axle else {}})


def _facts(facts, name="fact"):
    """Return the numbers in nested facts as variables, by the path to each."""
    if isinstance(facts, bool | str) or facts is None:
        return xr.Dataset()
    if isinstance(facts, int | float):
        return xr.Dataset({name: float(facts)})
    items = facts.items() if isinstance(facts, dict) else enumerate(facts)
    return xr.merge([_facts(fact, f"{name}.{key}") for key, fact in items])
