"""The generated functions and the native solver run clean under address and UB sanitizers."""

import os
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from c_text import sources
from cases import MODELS, car_parameters
from folders import ROOT
from kintrafo import Model, state_at_height
from kintrafo.simulation.dead_points import meanings
from kintrafo.simulation.solvers import native_available, native_version
from own_loops import FIVE_BAR
from own_models import own

# without optimisation, which takes most of the time and hides what it removes; of what a debugger
# is told, lines are enough
FLAGS = ["-std=gnu11", "-O0", "-g1", "-fno-math-errno", "-fsanitize=address,undefined"]
FLAGS += ["-fno-sanitize-recover=all", "-Wall", "-Wextra", "-Werror"]
SUNDIALS = ["cvode", "arkode", "nvecserial", "sunmatrixdense", "sunlinsoldense"]

needs_gcc = pytest.mark.skipif(shutil.which("gcc") is None, reason="no gcc")

EVERY_FUNCTION = """
#include "{name}.h"
#include <stdlib.h>

int main(void)
{{
    /* exactly as large as they must be, so that one element too far is seen */
    double *parameters = malloc({parameter_count} * sizeof(double));
    double *constants = malloc({constant_count} * sizeof(double));
    double *state = malloc({state_count} * sizeof(double));
    double *inputs = malloc({input_count} * sizeof(double));
    int status = 0;
    {parameters}
    if ({name}_prepare(parameters, constants)) return 1;
    for (int trial = 0; trial < 200; ++trial) {{
        for (int i = 0; i < {state_count}; ++i) state[i] = i == 0 ? 1.2 + 0.005 * trial : 0.1 * i;
        for (int i = 0; i < {input_count}; ++i) inputs[i] = 0.001 * trial;
        {calls}
    }}
    free(parameters); free(constants); free(state); free(inputs);
    return status == -1;
}}
"""
CALL = (
    "{{ double *out = malloc({size} * sizeof(double)); "
    "status |= {name}_{function}(constants, state, inputs, out); free(out); }}"
)

INTEGRATION = """
#include "integrate.h"
#include "macpherson.h"
#include <stdio.h>
#include <stdlib.h>

static int root(double time, const double *state, double *out, void *data)
{{
    (void)time, (void)data;
    out[0] = state[0] - 1.6;
    return 0;
}}

int main(void)
{{
    double parameters[MACPHERSON_PARAMETER_COUNT] = {{0}}, constants[MACPHERSON_CONSTANT_COUNT];
    {parameters}
    if (macpherson_prepare(parameters, constants)) return 1;
    double inputs[MACPHERSON_INPUT_COUNT] = {{0}}, atol[4] = {{1e-9, 1e-9, 1e-9, 1e-9}};
    double breaks[3] = {{0.0, 0.5, 1.0}};
    double coefficients[8] = {{0.01, 0.0, 0.0, 0.01, 0.0, 0.01, 0.0, 0.0}};
    kt_spline spline = {{2, breaks, coefficients,
                        {{MACPHERSON_INPUT_RACK_POSITION, MACPHERSON_INPUT_RACK_VELOCITY,
                          MACPHERSON_INPUT_RACK_ACCELERATION}}}};
    kt_event event = {{MACPHERSON_SIGNAL_TYRE_FORCE, 0.0}};
    int directions[2] = {{0, 0}}, terminal[2] = {{0, 0}}, guards[] = {{{guards}}};
    double usual_margins[] = {{{usual_margins}}};
    kt_problem problem = {{
        .rhs = macpherson_rhs, .jacobian = macpherson_rhs_jacobian, .signals = macpherson_signals,
        .margins = macpherson_margins, .guard_count = {guard_count}, .guards = guards,
        .usual_margins = usual_margins,
        .state_count = 4, .input_count = MACPHERSON_INPUT_COUNT,
        .signal_count = MACPHERSON_SIGNAL_COUNT, .constants = constants, .inputs = inputs,
        .spline_count = 1, .splines = &spline, .event_count = 1, .events = &event, .root_count = 1,
        .roots = root, .directions = directions, .terminal = terminal}};
    double state[4] = {{{state}}}, times[101];
    for (int i = 0; i < 101; ++i) times[i] = 0.01 * i;
    for (int method = KT_BDF; method <= KT_RUNGE_KUTTA; ++method) {{
        for (int every_step = 0; every_step < 2; ++every_step) {{
            for (long max_steps = 5; max_steps < 1000000; max_steps *= 1000) {{
                kt_options options = {{.method = method, .table = "ARKODE_VERNER_8_5_6",
                                      .rtol = 1e-6, .atol = atol, .max_steps = max_steps,
                                      .max_step = method == KT_RK4 || method == KT_RODASP
                                          ? 1e-3 : 0.0,
                                      .stop_at_outputs = !every_step, .dense = 1}};
                kt_result result;
                int outcome = kt_integrate(&problem, &options, state, times, 101, every_step,
                                           &result);
                if (outcome != KT_DONE && outcome != KT_TOO_MANY_STEPS) return 2 + outcome;
                kt_free(&result);
            }}
        }}
    }}
    inputs[MACPHERSON_INPUT_STRUT_FORCE] = -1e6; /* a loop that will not close */
    kt_options options = {{.method = KT_BDF, .rtol = 1e-6, .atol = atol, .max_steps = 100000}};
    kt_result result;
    int outcome = kt_integrate(&problem, &options, state, times, 101, 1, &result);
    kt_free(&result);
    return outcome == KT_STATE ? 0 : 1;
}}
"""


LANES = """
#include "ensemble.h"
#define KINTRAFO_LANES /* its functions are declared below, as of vectors */
#include "macpherson.h"
#include <stdlib.h>

typedef double pair __attribute__((vector_size(16)));
typedef long long words __attribute__((vector_size(16)));
#define FUNCTION(name) words in_lanes_##name(const pair *, const pair *, const pair *, pair *);
FUNCTION(rhs) FUNCTION(signals) FUNCTION(margins)
words in_lanes_prepare(const pair *, pair *), in_lanes_design_state(const pair *, pair *);

enum {{ SYSTEMS = 7, STATES = 4, TIMES = 11, GUARDS = {guard_count} }};

static void *exactly(size_t count, size_t size)
{{
    return calloc(count, size); /* so that one element too far is seen */
}}

int main(void)
{{
    double parameters[MACPHERSON_PARAMETER_COUNT] = {{0}};
    {parameters}
    int varied[1] = {{MACPHERSON_PARAMETER_DAMPER_RATE}}, guards[GUARDS] = {{{guards}}};
    double *variants = exactly(SYSTEMS, 8), *states = exactly(SYSTEMS * STATES, 8);
    double *inputs = exactly(SYSTEMS * MACPHERSON_INPUT_COUNT, 8);
    double start[STATES] = {{{state}}}, times[TIMES], weights[TIMES], atol[STATES];
    int drive_of[SYSTEMS];
    for (int i = 0; i < SYSTEMS; ++i) {{
        variants[i] = i == 4 ? 0.0 / 0.0 : 1000.0 + 100.0 * i;
        drive_of[i] = i % 2;
        for (int k = 0; k < STATES; ++k) states[STATES * i + k] = start[k];
    }}
    inputs[3 * MACPHERSON_INPUT_COUNT + MACPHERSON_INPUT_STRUT_FORCE] = -1e6;
    for (int i = 0; i < STATES; ++i) atol[i] = 1e-9;
    for (int i = 0; i < TIMES; ++i) times[i] = 0.05 * i, weights[i] = 0.05;
    double breaks[3] = {{0.0, 0.2, 0.5}}, milestones[1] = {{0.2}}, reaches[1] = {{1e-3}};
    double coefficients[8] = {{0.01, 0.0, 0.0, 0.01, 0.0, 0.01, 0.0, 0.0}};
    kt_course course = {{2, breaks, coefficients}};
    kt_segment whole = {{0.5, &course, 0, milestones, 1, milestones, reaches}};
    kt_segment halves[2] = {{{{0.3, &course, 1, milestones, 0, milestones, reaches}},
                              {{0.5, &course, 0, milestones, 0, milestones, reaches}}}};
    kt_drive drives[2] = {{{{1, &whole}}, {{2, halves}}}};
    int targets[3] = {{MACPHERSON_INPUT_RACK_POSITION, MACPHERSON_INPUT_RACK_VELOCITY,
                      MACPHERSON_INPUT_RACK_ACCELERATION}};
    int items[2] = {{MACPHERSON_SIGNAL_TYRE_FORCE, MACPHERSON_SIGNAL_COUNT + 1}};
    kt_reduction reductions[4] = {{{{0, KT_GREATEST, 0, 0.0}}, {{0, KT_FIRST, 0, 0.0}},
                                  {{0, KT_SQUARES, 1, 0.0}}, {{1, KT_ABOVE, 0, 1.0}}}};
    int bounds[1] = {{MACPHERSON_SIGNAL_TYRE_FORCE}}, above[1] = {{0}};
    double limits[1] = {{3000.0}};
    kt_problem problem = {{
        .prepare = in_lanes_prepare, .design_state = in_lanes_design_state, .rhs = in_lanes_rhs,
        .signals = in_lanes_signals, .margins = in_lanes_margins,
        .parameter_count = MACPHERSON_PARAMETER_COUNT, .constant_count = MACPHERSON_CONSTANT_COUNT,
        .state_count = STATES, .position_count = STATES / 2,
        .input_count = MACPHERSON_INPUT_COUNT, .signal_count = MACPHERSON_SIGNAL_COUNT,
        .guard_count = GUARDS, .guards = guards,
        .parameters = parameters, .varied_count = 1, .varied = varied, .variants = variants,
        .states = states, .state_stride = STATES, .inputs = inputs,
        .input_stride = MACPHERSON_INPUT_COUNT, .drives = drives, .drive_of = drive_of,
        .course_count = 1, .targets = targets, .start = 0.0, .end = 0.5, .time_count = TIMES,
        .times = times, .rtol = 1e-6, .atol = atol, .max_step = 1.0, .max_steps = 1000,
        .items = items, .sample_count = 2, .samples = exactly(SYSTEMS * 2 * TIMES, 8),
        .reduction_count = 4, .reductions = reductions, .weights = weights,
        .reduced = exactly(SYSTEMS * 4, 8), .bound_count = 1, .bound_items = bounds,
        .above = above, .limits = limits, .beyond = exactly(SYSTEMS, 8),
        .ends = exactly(SYSTEMS, sizeof(int)), .codes = exactly(SYSTEMS, sizeof(int)),
        .ended = exactly(SYSTEMS, 8), .finals = exactly(SYSTEMS * STATES, 8),
        .steps = exactly(SYSTEMS, sizeof(long))}};
    const int go_on = 0;
    if (kt_integrate_2(&problem, 0, SYSTEMS, &go_on) || kt_widest() < 2) return 1;
    int wrong = 0;
    for (int i = 0; i < SYSTEMS; ++i) {{
        int expected = i == 3 ? KT_DEAD_POINT : i == 4 ? KT_PARAMETERS : KT_DONE;
        wrong |= problem.ends[i] != expected;
    }}
    free(variants), free(states), free(inputs), free(problem.samples), free(problem.reduced);
    free(problem.beyond), free(problem.ends), free(problem.codes), free(problem.ended);
    free(problem.finals), free(problem.steps);
    return wrong;
}}
"""

ITERATION = """
#define KINTRAFO_LANES /* its functions are declared below, as of vectors */
#include "five_bar.h"
#include <stdlib.h>

typedef double pair __attribute__((vector_size(16)));
typedef long long words __attribute__((vector_size(16)));
words in_lanes_rhs(const pair *, const pair *, const pair *, pair *);
words in_lanes_prepare(const pair *, pair *), in_lanes_design_state(const pair *, pair *);

static pair *exactly(size_t count)
{{
    return aligned_alloc(16, 16 * count); /* so that one element too far is seen */
}}

int main(void)
{{
    pair *parameters = exactly(FIVE_BAR_PARAMETER_COUNT), *out = exactly(FIVE_BAR_STATE_COUNT);
    pair *constants = exactly(FIVE_BAR_CONSTANT_COUNT), *state = exactly(FIVE_BAR_STATE_COUNT);
    pair *inputs = exactly(FIVE_BAR_INPUT_COUNT);
    for (int i = 0; i < FIVE_BAR_INPUT_COUNT; ++i) inputs[i] = (pair){{0.0}};
    const double values[] = {{{parameters}}};
    for (int i = 0; i < FIVE_BAR_PARAMETER_COUNT; ++i) parameters[i] = values[i] + (pair){{0.0}};
    words failed = in_lanes_prepare(parameters, constants);
    in_lanes_design_state(parameters, state);
    state[0] += (pair){{0.05, 7.0}}; /* near, and beyond what there is, round once */
    words status = in_lanes_rhs(constants, state, inputs, out);
    free(parameters), free(out), free(constants), free(state), free(inputs);
    return failed[0] || failed[1] || status[0] || !status[1];
}}
"""


# y' = c y, by c in the first two directions, twice as much in the second, and by y in the third; in
# the fourth nothing is finite.
DIRECTIONS = """
#include "directions.h"
#include <math.h>
#include <stdlib.h>

typedef double pair __attribute__((vector_size(16)));
typedef long long words __attribute__((vector_size(16)));
enum { STEPS = 8, STAGES = 7, TIMES = 3, DIRECTIONS = 4 };

static words rates(const pair *c, const pair *y, const pair *inputs, pair *out)
{
    (void)inputs;
    out[0] = c[1] * y[0] + c[0] * y[1];
    return ~(out[0] - out[0] == 0.0);
}

static words doubled(const pair *c, const pair *y, const pair *inputs, pair *out)
{
    (void)c, (void)inputs;
    out[0] = 2.0 * y[1];
    return (words){0};
}

static double *exactly(size_t count)
{
    return calloc(count, sizeof(double)); /* so that one element too far is seen */
}

int main(void)
{
    const double nodes[STAGES] = {0.0, 0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0}, c[1] = {-0.5};
    double *lengths = exactly(STEPS), *states = exactly(STEPS * STAGES);
    for (int i = 0; i < STEPS; ++i) {
        lengths[i] = 1.0 / STEPS;
        for (int s = 0; s < STAGES; ++s)
            states[STAGES * i + s] = exp(c[0] * (i + nodes[s]) / STEPS);
    }
    /* at the begin, and at the ends of the fourth and the last step */
    long step_of[TIMES] = {0, 3, STEPS - 1};
    const double step[STAGES] = {35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0,
                                 -2187.0 / 6784.0, 11.0 / 84.0, 0.0};
    double *weights = exactly(TIMES * STAGES), *there = exactly(TIMES), *none = exactly(0);
    for (int i = STAGES; i < TIMES * STAGES; ++i) weights[i] = step[i % STAGES];
    int anew[STEPS] = {1};
    double of_constants[DIRECTIONS] = {1.0, 2.0, 0.0, INFINITY};
    double of_start[DIRECTIONS] = {0.0, 0.0, 1.0, 0.0};
    int items[2] = {0, 1};
    kt_motion motion = {
        .rhs_tangent = rates, .signals_tangent = doubled, .constant_count = 1, .state_count = 1,
        .signal_count = 1, .constants = c, .step_count = STEPS, .lengths = lengths,
        .anew = anew, .states = states, .inputs = none, .time_count = TIMES, .step_of = step_of,
        .weights = weights, .states_there = there, .inputs_there = none, .item_count = 2,
        .items = items, .of_constants = of_constants, .of_start = of_start, .of_inputs = none,
        .found = exactly(DIRECTIONS * TIMES * 2)};
    if (kt_follow_2(&motion, 0, 3) || kt_follow_2(&motion, 2, DIRECTIONS) != 2) return 1;
    double wrong = 0.0;
    const double times[TIMES] = {0.0, 0.5, 1.0};
    for (int i = 0; i < TIMES; ++i) {
        double grown = exp(c[0] * times[i]), exact[3] = {times[i], 2.0 * times[i], 1.0};
        for (int k = 0; k < 3; ++k) {
            const double *found = motion.found + 2 * (TIMES * k + i);
            wrong = fmax(wrong, fabs(found[1] - exact[k] * grown));
            wrong = fmax(wrong, fabs(found[0] - 2.0 * found[1]));
        }
    }
    free(lengths), free(states), free(weights), free(there), free(none), free(motion.found);
    return wrong > 1e-9; /* of an eighth to the fifth power, over some thousands */
}
"""


def assignments(model, parameters):
    values = enumerate(parameters[name] for name in model.PARAMETERS)
    return " ".join(f"parameters[{i}] = {value!r};" for i, value in values)


def listed(values):
    return ", ".join(repr(value) for value in values.tolist())


def with_sundials():
    """Return a compiler and flags for the SUNDIALS with which the project was built."""
    since_7 = int(native_version().split(".")[0]) >= 7
    libraries = [*SUNDIALS, "core" if since_7 else "generic"]
    built = ROOT / "build/sundials"
    root = os.environ.get("SUNDIALS_ROOT") or (built if built.is_dir() else None)
    where = [f"-I{root}/include", f"-L{root}/lib", f"-Wl,-rpath,{root}/lib"] if root else []
    # Debian's and Homebrew's 7.x have MPI in their core
    compiler = "mpicc" if since_7 and shutil.which("mpicc") else "gcc"
    return compiler, [*where, *(f"-lsundials_{name}" for name in libraries)]


def run_clean(folder, text, files, flags=(), compiler="gcc"):
    program = folder / "program.c"
    program.write_text(text, encoding="utf-8")
    folders = ("generated/c", "runtime/simulation/native", "runtime/simulation/lanes")
    include = [f"-I{ROOT / path}" for path in folders]
    command = [compiler, *FLAGS, *include, program, *files, "-o", folder / "program", *flags]
    built = subprocess.run([*map(str, command), "-lm"], capture_output=True, text=True, check=False)
    if "cannot find" in built.stderr and "asan" in built.stderr:
        pytest.skip("the compiler's sanitizer library is not installed")
    assert built.returncode == 0, built.stderr
    result = subprocess.run([folder / "program"], capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stderr


@needs_gcc
@pytest.mark.slow
def test_generated_functions(tmp_path):
    """Of the model with all laws of force; what writes the others is the same."""
    name = "macpherson_general"
    model = MODELS[name]
    sizes = {n: f for n, f in model.equations.functions.items() if n in model.ADDRESSES}
    calls = [
        CALL.format(name=name, function=n, size=len(function.labels))
        for n, function in sizes.items()
    ]
    text = EVERY_FUNCTION.format(
        name=name,
        parameter_count=len(model.PARAMETERS),
        constant_count=len(model.CONSTANTS),
        state_count=len(model.STATE),
        input_count=len(model.INPUTS),
        parameters=assignments(model, car_parameters(1, model)),
        calls="\n        ".join(calls),
    )
    run_clean(tmp_path, text, sources(name))


@needs_gcc
@pytest.mark.slow
@pytest.mark.skipif(not native_available(), reason="built without SUNDIALS")
def test_native_solver(tmp_path):
    model = Model("reference_car")
    start = state_at_height(model, 0.325, spin_rate=93.0)
    guards = meanings(model.equations)
    text = INTEGRATION.format(
        parameters=assignments(MODELS["macpherson"], car_parameters(0)),
        state=listed(start),
        guard_count=len(guards),
        guards=listed(guards),
        usual_margins=listed(model.usual_margins),
    )
    files = [*sources("macpherson"), *sorted((ROOT / "runtime/simulation/native").glob("*.c"))]
    compiler, flags = with_sundials()
    run_clean(tmp_path, text, files, flags, compiler)


@needs_gcc
@pytest.mark.slow
def test_solver_in_lanes(tmp_path):
    model = Model("reference_car")
    guards = meanings(model.equations)
    text = LANES.format(
        parameters=assignments(MODELS["macpherson"], car_parameters(0)),
        state=listed(state_at_height(model, 0.325, spin_rate=93.0)),
        guard_count=len(guards),
        guards=listed(guards),
    )
    # in two lanes, which every processor has; the functions get names that the header has not
    names = ("prepare", "design_state", "rhs", "rhs_rack_held", "signals", "margins")
    flags = ["-std=gnu11", "-DWIDTH=2", '-DMODEL="macpherson.c"']
    renamed = [f"-Dmacpherson_{name}=in_lanes_{name}" for name in names]
    folder = ROOT / "runtime/simulation/lanes"
    files = [folder / name for name in ("model.c", "integrate.c", "width.c")]
    run_clean(tmp_path, text, files, [*flags, *renamed])


@needs_gcc
@pytest.mark.slow
def test_iteration_in_lanes(tmp_path):
    """In a small loop: longer ones call the same solver of a block."""
    module = own(FIVE_BAR, derivatives=False)
    values = np.array([p.default for p in FIVE_BAR.mechanism.parameters])
    text = ITERATION.format(parameters=listed(values))
    names = ("prepare", "design_state", "rhs")
    flags = ["-std=gnu11", "-DWIDTH=2", '-DMODEL="five_bar.c"', f"-I{Path(module.__file__).parent}"]
    renamed = [f"-Dfive_bar_{name}=in_lanes_{name}" for name in names]
    source = ROOT / "runtime/simulation/lanes/model.c"
    run_clean(tmp_path, text, [source], [*flags, *renamed])


@needs_gcc
@pytest.mark.slow
def test_directions_in_lanes(tmp_path):
    source = ROOT / "runtime/simulation/lanes/directions.c"
    run_clean(tmp_path, DIRECTIONS, [source], ["-std=gnu11", "-DWIDTH=2"])


@needs_gcc
def test_sanitizer_sees_an_element_too_far(tmp_path):
    body = "double *a = malloc(8); a[1] = 1; free(a); return 0;"
    text = f"#include <stdlib.h>\nint main(void) {{ {body} }}"
    with pytest.raises(AssertionError, match=r"heap-buffer-overflow|insufficient space"):
        run_clean(tmp_path, text, [])
