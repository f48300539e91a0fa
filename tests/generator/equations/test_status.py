"""The status of the generated functions where they have no result: never a silent NaN."""

import pickle
from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from functools import cache

import numpy as np
import pytest
from cars.instants import MODELS, Instant, car_parameters, of_model
from hypothesis import given, settings
from hypothesis import strategies as st
from kintrafo import System
from kintrafo.equations.errors import ClosureError, ModelError, ParameterError
from kintrafo.generated import macpherson, macpherson_free_rack, macpherson_general, trailing_arm
from oracle.constraints import KNUCKLE
from oracle.newton import Mechanism, rotation_matrix
from oracle.reference import (
    BETA1_DESIGN,
    HARDPOINTS,
    SPIN_RATE,
    STAND_INS,
    Parameters,
    offset_from_ball_joint,
    reference_parameters,
    set_inertia,
    set_vector,
    vector,
)
from support.c_text import functions, sources_of

UP = np.array([0.0, 0.0, 1.0])
FORWARD = np.array([1.0, 0.0, 0.0])

each_model = pytest.mark.parametrize("model", MODELS.values(), ids=MODELS.keys())

# the functions with the common signature
COMMON = {name: list(model.equations.functions) for name, model in MODELS.items()}
# `margins` measures how far a loop is from closing, and so does not refuse it
REFUSING = {name: [f for f in found if f != "margins"] for name, found in COMMON.items()}


# -- loops that cannot close ----------------------------------------------------------------------


@each_model
def test_a_rod_that_does_not_reach(model):
    """Beyond the dead point every function names the loop, the coordinates and their values."""
    for function in REFUSING[model.NAME]:
        instant = Instant(BETA1_DESIGN, 0.5, 0.31, 1.5, SPIN_RATE)
        state, inputs = instant.arrays(model)
        with pytest.raises(ClosureError) as caught:
            getattr(model, function)(state, inputs)
        error = caught.value
        message = str(error)
        assert message.startswith(f"{model.NAME}.{function}: ")
        assert {"tie_rod", "knuckle", "(knuckle_closure"} <= {*message.split()}
        assert error.margins["knuckle_closure"] < 0.0
        expected = dict(zip((*model.STATE, *model.INPUTS), (*state, *inputs), strict=True))
        assert error.coordinates == expected
        for name, value in expected.items():
            assert f"{name} = {value:.6g}" in message
        assert error.index == ()


@each_model
def test_residuals_do_not_need_the_loops_to_close(model):
    """They are functions of given coordinates: that they do not vanish is their result."""
    state, inputs = Instant(BETA1_DESIGN, 0.0, 0.31).arrays(model)
    beta = model.relative_coordinates(Instant(BETA1_DESIGN).state(model))
    beta[list(model.RELATIVE_COORDINATES).index("beta9")] = 0.31
    assert np.abs(model.residuals(beta, state, inputs)).max() > 0.1


@each_model
def test_margins_show_how_far_a_loop_is_from_closing(model):
    closure = [name for name, _ in model.GUARDS].index("knuckle_closure")
    found = [
        model.margins(*Instant(BETA1_DESIGN, rack=rack).arrays(model))[closure]
        for rack in (0.0, 0.1, 0.2, 0.31)
    ]
    assert found == sorted(found, reverse=True)
    assert found[1] > 0.0 > found[2]


@each_model
def test_the_element_of_an_array_is_named(model):
    for function in REFUSING[model.NAME]:
        good, bad = (Instant(BETA1_DESIGN, 0.0, rack) for rack in (0.0, -0.31))
        states = np.tile(good.state(model), (2, 3, 1))
        inputs = np.tile(good.inputs(model), (2, 3, 1))
        states[1, 2], inputs[1, 2] = bad.arrays(model)
        with pytest.raises(ClosureError, match=r"\[1, 2\]") as caught:
            getattr(model, function)(states, inputs)
        assert caught.value.index == (1, 2)
        named = {**dict(zip(model.INPUTS, inputs[1, 2], strict=True))}
        named |= dict(zip(model.STATE, states[1, 2], strict=True))
        assert caught.value.coordinates == named


@each_model
def test_the_element_of_broadcast_arrays_is_named(model):
    """The index is that of the broadcast result; the values are those of the element."""
    lengths = np.array([0.0, 0.0, -0.31, 0.0])
    states = np.array([Instant(BETA1_DESIGN, 0.0, rack).state(model) for rack in lengths])
    inputs = np.array([Instant(BETA1_DESIGN, 0.0, rack).inputs(model) for rack in lengths])
    constants = np.stack([model.DEFAULT_CONSTANTS] * 3)[:, None]
    with pytest.raises(ClosureError) as caught:
        model.rhs(states, inputs, constants)
    assert caught.value.index == (0, 2)
    assert -0.31 in caught.value.coordinates.values()


def test_errors_travel_between_processes():
    with pytest.raises(ClosureError) as caught:
        macpherson.rhs(*Instant(BETA1_DESIGN, rack=0.31).arrays(macpherson))
    copy = pickle.loads(pickle.dumps(caught.value))
    assert str(copy) == str(caught.value)
    assert (copy.margins, copy.coordinates) == (caught.value.margins, caught.value.coordinates)


# -- every guard ----------------------------------------------------------------------------------


@dataclass(frozen=True)
class Edge:
    """A car and an instant at which exactly one thing is wrong, seen by one function."""

    guard: str
    function: str
    build: Callable[[], tuple[Parameters, Instant]]


def ball_joint_at(parameters, beta1):
    """Return where the arm carries the ball joint; the strut top does not matter for it."""
    car = Mechanism(parameters)
    _, h_y, h_z = car.hinge
    radius = np.linalg.norm(car.points["ball_joint"] - car.hinge_foot)
    return car.hinge_foot + radius * (np.sin(beta1) * h_y + np.cos(beta1) * h_z)


def strut_along(direction):
    """Return a car whose strut has a given vector (m) from ball joint to top, off the design."""
    parameters = reference_parameters()
    instant = Instant(BETA1_DESIGN - 0.3)
    set_vector(parameters, "strut_top", ball_joint_at(parameters, instant.beta1) + direction)
    return parameters, instant


def rod_end_on_the_strut():
    parameters = reference_parameters()
    instant = Instant(BETA1_DESIGN, rack=0.1)
    ball, top = vector(parameters, "ball_joint"), vector(parameters, "strut_top")
    on_strut = ball + 0.2 * (top - ball)
    set_vector(
        parameters, "tie_rod_inner", on_strut - instant.rack * vector(parameters, "rack_axis")
    )
    return parameters, instant


def rod_along(direction):
    """Return a car whose tie rod has a given direction once the rack has moved."""
    parameters = reference_parameters()
    instant = Instant(BETA1_DESIGN, rack=-0.05)
    ball, top = vector(parameters, "ball_joint"), vector(parameters, "strut_top")
    strut = (top - ball) / np.linalg.norm(top - ball)
    outer = vector(parameters, "tie_rod_outer")
    turned = ball + rotation_matrix(0.2 * strut) @ (outer - ball)
    # With the inner end at turned - length * direction, and the rack back at design, the rod must
    # have the same length: |outer - turned + rack + length * direction| = length.
    step = outer - turned + instant.rack * vector(parameters, "rack_axis")
    length = -(step @ step) / (2.0 * step @ direction)
    inner = turned - length * direction
    set_vector(parameters, "tie_rod_inner", inner - instant.rack * vector(parameters, "rack_axis"))
    return parameters, instant


def massless(*but):
    parameters = reference_parameters()
    for body in ("control_arm", "knuckle", "tie_rod", "rack", "upper_strut"):
        if body not in but:
            parameters[f"{body}_mass"] = 0.0
            set_inertia(parameters, body, np.zeros((3, 3)))
    for name in ("wheel_mass", "wheel_inertia_spin", "wheel_inertia_diametral"):
        parameters[name] = 0.0
    return parameters, Instant(BETA1_DESIGN)


def flat_wheel(beta1):
    """Return a car whose spin axis is vertical once the arm has turned."""
    parameters = reference_parameters()
    instant = Instant(beta1)
    knuckle = macpherson.orientations(instant.state(macpherson))[macpherson.BODIES.index("knuckle")]
    set_vector(parameters, "spin_axis", knuckle.T @ UP)
    return parameters, instant


def top_within_the_offset():
    """Return a car whose ball joint comes nearer to the strut top than to the strut's axis."""
    parameters, instant = strut_along(np.array([0.01, 0.01, 0.01]))
    ball, top = vector(parameters, "ball_joint"), vector(parameters, "strut_top")
    offset = offset_from_ball_joint(ball, top, 0.05, 1.0)
    set_vector(parameters, "strut_lower", ball + offset)
    return parameters, instant


def rod_end_on_the_line_of_the_knuckle():
    """Return a car whose outer rod end comes onto the line from ball joint to strut top.

    With an offset strut that line turns in the knuckle as the strut slides. The inner end is where
    the rod has the same length then as at design.
    """
    parameters = reference_parameters()
    instant = Instant(BETA1_DESIGN - 0.3)
    ball, top = vector(parameters, "ball_joint"), vector(parameters, "strut_top")
    lower = ball + offset_from_ball_joint(ball, top, 0.08, 0.0)
    axis = (lower - top) / np.linalg.norm(lower - top)
    ball_now = ball_joint_at(parameters, instant.beta1)
    reach = (ball - top) @ axis
    reach_now = np.sqrt((ball_now - top) @ (ball_now - top) - 0.08**2)
    top_seen = top + (reach - reach_now) * axis  # as drawn on the knuckle
    outer, outer_now = ball + 0.4 * (top_seen - ball), ball_now + 0.4 * (top - ball_now)
    step = outer_now - outer
    across = np.cross(step, FORWARD)
    inner = 0.5 * (outer + outer_now) + 0.3 * across / np.linalg.norm(across)
    for name, place in (("strut_lower", lower), ("tie_rod_outer", outer), ("tie_rod_inner", inner)):
        set_vector(parameters, name, place)
    return parameters, instant


def strut_through_its_mount():
    """Return a car whose strut is 50 mm long at design, and a wheel that has risen by more."""
    parameters = reference_parameters()
    ball, top = vector(parameters, "ball_joint"), vector(parameters, "strut_top")
    lower = ball + offset_from_ball_joint(ball, top, 0.04, 0.0)
    up = (top - lower) / np.linalg.norm(top - lower)
    set_vector(parameters, "strut_lower", top - 0.05 * up)
    return parameters, Instant(BETA1_DESIGN - 0.3)


def spring_without_length():
    """Return a car whose spring seats meet once the arm has turned."""
    parameters = reference_parameters()
    instant = Instant(BETA1_DESIGN - 0.3)
    set_vector(parameters, "spring_seat", vector(parameters, "ball_joint") + 0.3 * UP)
    car = Mechanism(parameters)
    seat = car.point(instant.pose(car), "spring_seat", KNUCKLE)
    set_vector(parameters, "spring_top", seat)
    return parameters, instant


EDGES = [
    Edge("upper_strut_cross_squared", "positions", lambda: strut_along(0.6 * FORWARD)),
    Edge("knuckle_reach_squared", "rhs", rod_end_on_the_strut),
    Edge(
        "knuckle_closure",
        "rhs",
        lambda: (reference_parameters(), Instant(BETA1_DESIGN, rack=-0.31)),
    ),
    Edge("tie_rod_cross_squared", "orientations", lambda: rod_along(UP)),
    Edge("cos_camber_squared", "rhs", lambda: flat_wheel(BETA1_DESIGN - 0.3)),
    Edge("pivot_beta1", "rhs", massless),
    Edge("shaft_level_squared_C", "relative_coordinates", lambda: strut_along(0.6 * UP)),
]
COINCIDENT_ENDS = Edge("length_squared_BC", "rhs", lambda: strut_along(0.0 * UP))
EDGES_OF = {
    macpherson: [*EDGES, COINCIDENT_ENDS],
    macpherson_free_rack: [
        *EDGES,
        COINCIDENT_ENDS,
        Edge("pivot_beta9", "rhs", lambda: massless("control_arm")),
        Edge("shaft_level_squared_E", "relative_coordinates", lambda: rod_along(UP)),
    ],
    macpherson_general: [
        *EDGES,
        Edge("length_squared_BC", "rhs", top_within_the_offset),
        Edge("length_BC", "positions", strut_through_its_mount),
        Edge("knuckle_plane_squared", "positions", rod_end_on_the_line_of_the_knuckle),
        Edge("spring_length_squared", "rhs", spring_without_length),
    ],
}


@pytest.mark.parametrize(
    ("model", "edge"),
    [(model, edge) for model, edges in EDGES_OF.items() for edge in edges],
    ids=lambda value: getattr(value, "NAME", getattr(value, "guard", None)),
)
def test_every_guard_acts_at_its_edge(model, edge):
    parameters, instant = edge.build()
    constants = model.prepare(of_model(model, parameters))
    arrays = *instant.arrays(model), constants
    with pytest.raises(ClosureError) as caught:
        getattr(model, edge.function)(*arrays)
    meaning = dict(model.GUARDS)[edge.guard]
    assert meaning in caught.value.reasons
    assert meaning in str(caught.value)
    # The quantity vanishes to the roundings of its own computation, or is negative.
    assert caught.value.margins[edge.guard] < 1e-15


@each_model
def test_every_guard_has_an_edge(model):
    assert {guard for guard, _ in model.GUARDS} == {edge.guard for edge in EDGES_OF[model]}


# -- numbers that are none ------------------------------------------------------------------------


@cache
def depends_on(model, function):
    """Return the tokens on which the results of a function depend, as the C text shows it."""
    call = getattr(model, function)
    start = model.equations.manifest["functions"].get(function, {}).get("start", 0)
    results = (f"out[{start + i}]" for i in range(len(call.labels)))
    return sources_of(functions(model.NAME)[call.stage], results)


def reads(model, function):
    """Return the state and inputs that a function depends on, as the C text shows it."""
    tokens = depends_on(model, function)
    arrays = (("state", model.STATE), ("inputs", model.INPUTS))
    return {n for kind, names in arrays for i, n in enumerate(names) if f"{kind}[{i}]" in tokens}


@pytest.mark.parametrize("wrong", [np.nan, np.inf, -np.inf])
@each_model
def test_nan_and_infinity_are_named(model, wrong):
    """A function rejects such an element if it reads it, and ignores it otherwise."""
    for function in COMMON[model.NAME]:
        names = (*model.STATE, *model.INPUTS)
        arrays = Instant(BETA1_DESIGN, 0.0, 0.01).arrays(model)
        expected = getattr(model, function)(*arrays)
        for position, name in enumerate(names):
            state, inputs = (array.copy() for array in arrays)
            if position < len(state):
                state[position] = wrong
            else:
                inputs[position - len(state)] = wrong
            if name in reads(model, function):
                with pytest.raises(ModelError, match=f"{function}: .*: {name}$"):
                    getattr(model, function)(state, inputs)
            else:
                found = getattr(model, function)(state, inputs)
                assert found.tolist() == expected.tolist()


@each_model
def test_nan_in_an_array_is_placed(model):
    states = np.tile(Instant(BETA1_DESIGN).state(model), (4, 1))
    states[2, 0] = np.nan
    with pytest.raises(ModelError, match=r": beta1 \(.*\[2\]"):
        model.rhs(states)


@each_model
@pytest.mark.parametrize("index", range(10))
def test_nan_in_given_coordinates_is_refused(model, index):
    state = Instant(BETA1_DESIGN).state(model)
    beta = model.relative_coordinates(state)
    beta[index] = np.nan
    with pytest.raises(ModelError):
        model.residuals(beta, state)


@each_model
@pytest.mark.parametrize("rate", [1e160, 1e308])
def test_overflow_is_no_silent_nan(model, rate):
    with pytest.raises(ModelError):
        model.rhs(*Instant(BETA1_DESIGN, beta1_rate=rate, spin_rate=rate).arrays(model))


@each_model
def test_nan_among_the_constants_is_no_silent_number(model):
    """No constant that is read may vanish, as in a law that takes a NaN for "not touched"."""
    for function in REFUSING[model.NAME]:
        constants = model.prepare(car_parameters(1, model))
        arrays = Instant(BETA1_DESIGN, 0.2, 0.01, 1.0, 50.0, 0.1).arrays(model)
        read = depends_on(model, function)
        assert "c" in read
        for index, name in enumerate(model.CONSTANTS):
            if name in read:
                wrong = constants.copy()
                wrong[index] = np.nan
                with pytest.raises(ModelError):
                    getattr(model, function)(*arrays, wrong)


# -- parameters -----------------------------------------------------------------------------------


@each_model
@pytest.mark.parametrize("wrong", [np.nan, np.inf])
def test_parameters_that_are_no_numbers(model, wrong):
    parameters = reference_parameters() | {"tyre_rate": wrong, "gravity": wrong}
    with pytest.raises(ParameterError, match=r": tyre_rate, gravity$"):
        model.prepare(of_model(model, parameters))


@each_model
def test_each_parameter_that_is_no_number(model):
    """Also those that a law may ignore, as the stiffness of a stop that is not touched."""
    parameters = car_parameters(1, model)
    for name in parameters:
        with pytest.raises(ParameterError, match=f": {name}$"):
            model.prepare(parameters | {name: np.nan})


@each_model
def test_parameters_by_wrong_names(model):
    parameters = of_model(model, reference_parameters()) | {"sprung_rate": 1.0}
    del parameters["spring_rate"]
    with pytest.raises(ParameterError, match=r"\bsprung_rate\b.*\bspring_rate\b"):
        model.prepare(parameters)


@each_model
def test_parameters_in_an_array(model):
    parameters = car_parameters(1, model)
    values = [parameters[name] for name in model.PARAMETERS]
    assert model.prepare(values).tolist() == model.prepare(parameters).tolist()
    for wrong in (values[:-1], [values], 1.0):
        with pytest.raises(ParameterError, match=f": {len(values)} "):
            model.prepare(wrong)


def coincident(first, second):
    parameters = reference_parameters()
    set_vector(parameters, first, vector(parameters, second))
    return parameters


def moved(name, place):
    parameters = reference_parameters()
    set_vector(parameters, name, place)
    return parameters


DEGENERATE = {
    "hinge points coincide": coincident("arm_front", "arm_rear"),
    "vertical hinge": moved("arm_front", (-0.15, -0.35, 0.6)),
    "ball joint on the hinge": moved("ball_joint", (0.01, -0.35, 0.205)),
    "strut without length": coincident("strut_top", "ball_joint"),
    "tie rod without length": coincident("tie_rod_inner", "tie_rod_outer"),
    "tie rod at the ball joint": coincident("tie_rod_outer", "ball_joint"),
    "tie rod at the strut top": coincident("tie_rod_outer", "strut_top"),
    "wheel centre at the ball joint": coincident("wheel_center", "ball_joint"),
    "no rack axis": moved("rack_axis", (0.0, 0.0, 0.0)),
    "no spin axis": moved("spin_axis", (0.0, 0.0, 0.0)),
    "vertical spin axis": moved("spin_axis", (0.0, 0.0, 1.0)),
    "points at the end of the world": moved("ball_joint", (1e200, -0.7, 0.2)),
}


@each_model
@pytest.mark.parametrize("case", DEGENERATE)
def test_degenerate_geometry(model, case, refused):
    refused(ParameterError, lambda: model.prepare(of_model(model, DEGENERATE[case])))


def test_offset_strut_without_length(refused):
    parameters = car_parameters(1, macpherson_general)
    set_vector(parameters, "strut_lower", vector(parameters, "strut_top"))
    refused(ParameterError, lambda: macpherson_general.prepare(parameters))


def test_a_tie_rod_may_end_on_the_axis_of_an_offset_strut():
    """Only with the ball joint on the axis too would the rod have no lever."""
    parameters = car_parameters(1, macpherson_general)
    set_vector(parameters, "tie_rod_outer", vector(parameters, "strut_lower"))
    car, constants = Mechanism(parameters), macpherson_general.prepare(parameters)
    instant = Instant(car.beta1_design - 0.1, 0.0, 0.005)
    found = macpherson_general.positions(*instant.arrays(macpherson_general), constants)
    assert found == pytest.approx(instant.pose(car).position, rel=0.0, abs=1e-13)


# -- shapes ---------------------------------------------------------------------------------------


@each_model
def test_wrong_shapes(model):
    for function in COMMON[model.NAME]:
        call = getattr(model, function)
        state, inputs = Instant(BETA1_DESIGN).arrays(model)
        constants = model.DEFAULT_CONSTANTS
        for wrong in (state[:-1], np.append(state, 0.0), state[:, None], 1.0, []):
            with pytest.raises(ValueError, match=rf"{function}: .* state "):
                call(wrong)
        with pytest.raises(ValueError, match=rf"{function}: .* inputs "):
            call(state, inputs[:-1])
        with pytest.raises(ValueError, match=rf"{function}: .* constants "):
            call(state, inputs, constants[1:])
        with pytest.raises(ValueError, match="broadcast"):
            call(np.tile(state, (2, 1)), np.tile(inputs, (3, 1)))


@each_model
def test_wrong_shapes_of_residuals(model):
    state, inputs = Instant(BETA1_DESIGN).arrays(model)
    beta = model.relative_coordinates(state)
    for arguments, name in (
        ((beta[1:], state), "given"),
        ((beta, state[1:]), "state"),
        ((beta, state, inputs[1:]), "inputs"),
        ((beta, state, inputs, model.DEFAULT_CONSTANTS[1:]), "constants"),
    ):
        with pytest.raises(ValueError, match=f"^{name}: "):
            model.residuals(*arguments)


@each_model
def test_residuals_of_arrays_are_those_of_their_elements(model):
    instants = [Instant(BETA1_DESIGN + 0.1 * i, 0.2, 0.01 * i) for i in range(3)]
    states = np.array([instant.state(model) for instant in instants])
    inputs = np.array([instant.inputs(model) for instant in instants])
    beta = model.relative_coordinates(states[0], inputs[0]) + 0.01
    found = model.residuals(beta, states, inputs)
    assert found.shape == (3, len(model.RELATIVE_COORDINATES))
    for row, state, one in zip(found, states, inputs, strict=True):
        assert np.array_equal(row, model.residuals(beta, state, one))


@each_model
def test_arrays_are_single_states_side_by_side(model):
    """Leading dimensions broadcast, and each element equals the result of a single call."""
    for function in COMMON[model.NAME]:
        call = getattr(model, function)
        instants = [Instant(BETA1_DESIGN + 0.1 * k, 0.3, 0.01, 1.0, 50.0, 0.1) for k in (-1, 0, 1)]
        states = np.array([instant.state(model) for instant in instants])
        inputs = np.array(
            [[i.inputs(model)] for i in (instants[0], replace(instants[0], rack=-0.02))]
        )
        constants = [model.prepare(car_parameters(seed, model)) for seed in (0, 1)]
        found = call(states, inputs, np.array(constants)[:, None, None])
        assert found.shape == (2, 2, 3, *call.shape)
        for i, j, k in np.ndindex(2, 2, 3):
            single = call(states[k], inputs[j, 0], constants[i])
            assert single.shape == call.shape
            assert found[i, j, k].tolist() == single.tolist()


@each_model
def test_nothing_in_nothing_out(model):
    for function in COMMON[model.NAME]:
        call = getattr(model, function)
        assert call(np.empty((0, len(model.STATE)))).shape == (0, *call.shape)


@each_model
def test_results_are_new_and_constants_are_fixed(model):
    """A second call does not change the first result, and shared constants cannot be changed."""
    state = Instant(BETA1_DESIGN).state(model)
    first = model.rhs(state)
    copy = first.copy()
    model.rhs(state + 0.1)
    assert first.tolist() == copy.tolist()
    with pytest.raises(ValueError, match="read-only"):
        model.DEFAULT_CONSTANTS[0] = 1.0
    with pytest.raises(ValueError, match="read-only"):
        model.prepare(car_parameters(0, model))[0] = 1.0


# -- anything -------------------------------------------------------------------------------------

calm = settings(deadline=None, max_examples=50)


def attempt(call):
    """Return the result of a call, or its error; other errors are failures."""
    try:
        return call(), None
    except ModelError as error:
        return None, error


def finite_or_refused(model, instant, constants):
    """Demand a finite result or a clear error of every function, and closed loops with a result.

    Returns the functions that gave a result.
    """
    arrays = *instant.arrays(model), constants
    done = set()
    for function in COMMON[model.NAME]:
        result, error = attempt(lambda f=function: getattr(model, f)(*arrays))
        if error is None:
            assert np.isfinite(result).all(), function
            done.add(function)
        elif "overflows" in str(error):
            assert " beta1 = " in str(error)
        else:
            assert isinstance(error, ClosureError)
            assert error.reasons
            assert set(error.reasons) <= {meaning for _, meaning in model.GUARDS}
            assert "must be positive" in str(error)
    if "relative_coordinates" in done:
        beta = model.relative_coordinates(*arrays)
        # Lengths of up to 2 m, and angles of up to 1e3 rad; close to a dead point the turn of the
        # knuckle is badly conditioned, but the rod has its length all the same.
        assert np.abs(model.residuals(beta, *arrays)).max() < 1e-12
    return done


def usual_constants(model):
    """Return the reference car's constants, and those of a car with everything where that is."""
    if model is macpherson_general:
        return model.prepare(car_parameters(1, model))
    return model.DEFAULT_CONSTANTS


def number(largest):
    return st.floats(-largest, largest)


anything = st.floats(allow_nan=False, allow_infinity=False)
any_instants = st.builds(Instant, *[anything] * len(fields(Instant)))


@given(any_instants)
@calm
@each_model
def test_any_finite_state(model, instant):
    """Up to 1e308, where squares overflow."""
    finite_or_refused(model, instant, usual_constants(model))


@given(any_instants, number(0.6), number(0.1))
@calm
@each_model
def test_any_finite_rates(model, instant, turn, rack):
    """The same where the loops close, so that the dynamics have something to compute."""
    reachable = replace(instant, beta1=BETA1_DESIGN + turn, rack=rack)
    finite_or_refused(model, reachable, usual_constants(model))


@st.composite
def plausible_cars(draw):
    """The reference car with every hardpoint moved by up to 0.2 m, and any directions."""
    parameters = reference_parameters()
    shift = number(0.2)
    for name in HARDPOINTS:
        moved_by = np.array([draw(shift) for _ in "xyz"])
        set_vector(parameters, name, vector(parameters, name) + moved_by)
    for name in ("rack_axis", "spin_axis"):
        set_vector(parameters, name, [draw(number(0.5)), draw(st.floats(0.5, 2.0)), draw(shift)])
    for name in ("spring_rate", "damper_rate", "tyre_rate", "wheel_mass", "rack_mass"):
        parameters[name] = draw(st.floats(0.1, 1e5))
    for name in ("strut_lower", "spring_top", "spring_seat"):
        moved_by = np.array([draw(number(0.1)) for _ in "xyz"])
        set_vector(parameters, name, vector(parameters, STAND_INS[name]) + moved_by)
    return parameters | {"tyre_lifts_off": draw(st.sampled_from([0.0, 1.0]))}


@given(plausible_cars(), number(0.6), number(0.1), number(20.0), number(200.0))
@calm
@each_model
def test_plausible_cars(model, parameters, turn, rack, rate, spin_rate):
    constants, error = attempt(lambda: model.prepare(of_model(model, parameters)))
    if error is not None:
        assert "degenerate" in str(error)
        return
    beta1 = Mechanism(parameters).beta1_design
    instant = Instant(beta1 + turn, 0.3, rack, rate, spin_rate, 0.1 * rate, road_height=0.01)
    finite_or_refused(model, instant, constants)
    # the design position itself always closes
    at_design = Instant(beta1)
    model.rhs(*at_design.arrays(model), constants)
    # by roundings of coordinates of up to 1 m
    for body, position in zip(
        model.BODIES, model.positions(*at_design.arrays(model), constants), strict=True
    ):
        name = "wheel_center" if body == "wheel" else f"{body}_com"
        assert position == pytest.approx(vector(parameters, name), abs=1e-12)


@each_model
@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_both_sides_of_a_dead_point(model, side):
    """The rack is moved to where the rod just reaches, by bisection down to the last digit."""
    reached, missed = 0.0, 0.31 * side
    constants = usual_constants(model)

    def instant_at(rack):
        return Instant(BETA1_DESIGN, 0.0, rack, 1.0, 50.0, 0.1)

    while True:
        middle = 0.5 * (reached + missed)
        if middle in (reached, missed):
            break
        done = finite_or_refused(model, instant_at(middle), constants)
        # functions that share subexpressions differently may round the same margin differently:
        # some roundings of 0.1 m^2, divided by its slope over the rack of some 0.1 m
        if abs(missed - reached) > 1e-13:
            assert done == set(COMMON[model.NAME]) or done <= {"margins"}
        if "rhs" in done:
            reached = middle
        else:
            missed = middle
    assert 0.05 < abs(reached) < 0.31
    values = model.margins(*instant_at(reached).arrays(model), constants)
    margins = dict(zip((guard for guard, _ in model.GUARDS), values, strict=True))
    # roundings of areas of 0.1 m²
    assert 0.0 < margins["knuckle_closure"] < 1e-15


def test_what_nothing_has_mass_to_move_is_not_called_geometry(refused):
    """An arm on a hinge, whose mass matrix is a constant."""
    parameters = System(trailing_arm).parameters
    parameters |= {name: 0.0 for name in parameters if name.endswith("_mass") or "_inertia" in name}
    refused(ParameterError, lambda: trailing_arm.prepare(parameters))


@pytest.mark.parametrize(("margin", "words"), [(-1e-9, "must be positive"), (1e-9, "must stay")])
def test_a_motion_may_end_where_a_margin_is_positive_still(margin, words):
    """At the last state before a dead point, where "must be positive" would contradict itself."""
    assert words in str(ClosureError("rhs", ["it cannot close"], {"closure": margin}, {}, (), {}))
