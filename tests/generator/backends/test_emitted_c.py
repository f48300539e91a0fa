"""The emitted C: its values, its text, its operation counts, and the warnings of compilers."""

import ctypes
import itertools
import platform
import re
import shutil
import subprocess
from collections import Counter
from functools import cache

import mpmath
import numpy as np
import pytest
from cars.instants import MODELS, car_parameters, random_instants
from kintrafo.generator.equations.outputs import BOUNDED
from oracle.newton import Mechanism
from support.c_text import (
    EMITTED,
    FOLDER,
    STRAIGHT,
    count,
    definitions,
    functions,
    header,
    sources,
    whole_of,
)
from support.symbolic import Rounded, python

DIGITS = 50
SEEDS = range(3)  # 0 is the reference car
POINTS = 1  # for each car

each_model = pytest.mark.parametrize("name", EMITTED)
each_straight_model = pytest.mark.parametrize("name", STRAIGHT)
each_suspension = pytest.mark.parametrize("name", MODELS)


def compare(label, exact, found, size):
    """Demand two things of each element that C computed.

    - Its error is at most 1e-13 of the size given, which is that of the largest element (the
      worst measured is 4e-14).
    - Its error is at most the bound that a running error analysis of the same program gives; this
      is the honest measure for an element that is a small difference of large terms, where a
      relative error of 1e-13 is out of reach. The factor 2 stands for the order of sums, which
      the analysis does not know (the worst measured is 0.9 times the bound).
    """
    for index, (element, value) in enumerate(zip(exact, found.ravel().tolist(), strict=True)):
        error = abs(element.value - mpmath.mpf(value))
        assert error <= 1e-13 * size, f"{label}[{index}]: {value} for {element.value}"
        assert error <= 2 * element.error, f"{label}[{index}]: {value} for {element.value}"


def given_names(compiled):
    return [f"given_{name}" for name in compiled.RELATIVE_COORDINATES]


@pytest.mark.parametrize("seed", SEEDS)
@each_suspension
def test_functions_against_the_symbolic_program(derived, name, seed):
    model, compiled = derived(name), MODELS[name]
    parameters = car_parameters(seed, compiled)
    constants = compiled.prepare(parameters)
    # the constants as C computed them are exact inputs of the other functions
    given = dict(zip(model.prepare.labels, constants.tolist(), strict=True))
    rng = np.random.default_rng(seed)
    with mpmath.workdps(DIGITS):
        for instant in random_instants(rng, Mechanism(parameters), POINTS):
            state, inputs = instant.arrays(compiled)
            # relative coordinates that miss the closed loops, so that the residuals are not zero
            beta = compiled.relative_coordinates(state, inputs, constants)
            beta += 0.01 * rng.standard_normal(beta.shape)
            values = (
                given
                | dict(zip(compiled.STATE, state.tolist(), strict=True))
                | dict(zip(compiled.INPUTS, inputs.tolist(), strict=True))
                | dict(zip(given_names(compiled), beta.tolist(), strict=True))
            )
            exact_values = {key: Rounded.of(value) for key, value in values.items()}
            for label, function in model.functions.items():
                call = getattr(compiled, label)
                arguments = (beta,) if label == "residuals" else ()
                found = call(*arguments, state, inputs, constants)
                exact = [Rounded.of(r) for r in python(function)(exact_values)]
                # residuals are differences of lengths of about 1 m, and of sines
                size = mpmath.mpf(1) if label == "residuals" else max(abs(r.value) for r in exact)
                compare(f"{name}.{label}", exact, found, size)


@pytest.mark.parametrize("seed", SEEDS)
@each_suspension
def test_constants_against_the_symbolic_program(derived, name, seed):
    parameters = car_parameters(seed, MODELS[name])
    found = MODELS[name].prepare(parameters)
    prepare = derived(name).prepare
    assert prepare.labels == MODELS[name].CONSTANTS
    with mpmath.workdps(DIGITS):
        values = {key: Rounded.of(value) for key, value in parameters.items()}
        exact = [Rounded.of(result) for result in python(prepare)(values)]
        # each constant alone: they have many units
        for label, element, value in zip(prepare.labels, exact, found, strict=True):
            size = abs(element.value) + element.error / mpmath.mpf(2) ** -53
            compare(label, [element], np.array([value]), size)


def run(command):
    """Run a compiler, which must not print a message."""
    if shutil.which(command[0]) is None:
        pytest.skip(f"{command[0]} is not installed")
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


STRICT = ["-Wall", "-Wextra", "-Wpedantic", "-Werror"]


@each_model
def test_compiles_silently(name):
    # the front end alone: in a straight line of constants, each defined once from those before it,
    # an analysis of the flow of data has nothing to warn of
    run(["gcc", "-std=c99", *STRICT, "-fsyntax-only", *map(str, sources(name))])


@pytest.mark.parametrize(
    "option", ["-ffast-math", "-Ofast", "-funsafe-math-optimizations", "-ffinite-math-only"]
)
def test_other_arithmetic_is_refused(option):
    """A sine would be that of zero: to round, a large number is added, and taken away again.

    And a state that is NaN would have no status.
    """
    command = ["gcc", "-std=c99", option, "-fsyntax-only", *FOUR_BAR]
    if shutil.which("gcc") is None:
        pytest.skip("gcc is not installed")
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode != 0
    assert "make sines wrong and hide NaN. Leave them out." in done.stderr


def test_headers_are_cpp(tmp_path):
    """Both headers together, twice, in C++."""
    source = tmp_path / "all.cpp"
    includes = "".join(f'#include "{name}.h"\n' for name in (*EMITTED, *EMITTED))
    calls = "".join(f"    sum += {name}_rhs(nullptr, nullptr, nullptr, &x);\n" for name in EMITTED)
    source.write_text(
        f"{includes}int use(double x);\n"
        f"int use(double x)\n{{\n    int sum = 0;\n{calls}    return sum;\n}}\n",
        encoding="utf-8",
    )
    run(["g++", "-std=c++11", *STRICT, f"-I{FOLDER}", "-fsyntax-only", str(source)])


@each_model
def test_constants_are_the_order_of_their_array(name):
    match = re.search(rf"struct {name}_constants \{{\s*double\s+(.*?);", header(name), re.DOTALL)
    names = EMITTED[name].CONSTANTS
    assert tuple(re.split(r",\s+", match[1])) == names
    assert f"{name.upper()}_CONSTANT_COUNT = {len(names)} }}" in header(name)


BRANCHES = {"if", "else", "for", "while", "do", "goto", "switch", "case", "?", ":", "&&", "||"}
LIBRARY = {"sqrt", "sin", "cos", "asin", "atan2", "copysign"}
OWN = {"at_least", "is_positive", "number"}
OF_THE_STATUS = {"guard_bit", "finite_bit"}  # after the arithmetic
OF_PREPARE = {"fabs", "either", "first_not_finite"}


@each_model
def test_straight_line(name):
    """No branch and no loop, in the checks of parameters neither."""
    for function, body in functions(name).items():
        assert not BRANCHES & set(body), function


@each_straight_model
def test_calls_only_cheap_functions(name):
    """Of the C library only these: no pow above all, and nothing that keeps a state."""
    for function, body in functions(name).items():
        called = {f for f, after in itertools.pairwise(body) if after == "(" and f.isidentifier()}
        checks = OF_PREPARE if function == "prepare" else OF_THE_STATUS
        assert called <= LIBRARY | OWN | checks, function


@each_model
def test_every_step_is_used(name):
    """The program is pruned: what is computed has an effect."""
    for function, body in functions(name).items():
        places = (i for i, token in enumerate(body) if token == "=" and body[i - 2] != "->")
        names = [body[i - 1] for i in places if body[i - 1].isidentifier()]
        assert names or function.endswith("_jacobian") or function == "design_state", function
        times = Counter(body)
        assert [n for n in names if times[n] < 2] == [], function


@each_model
def test_no_step_is_written_twice(name):
    """Neither for two functions of a file nor for one."""
    for source in sources(name):
        steps = definitions(whole_of(source))
        once = Counter(" ".join(text) for name, text in steps.items() if name.isidentifier())
        assert [text for text, times in once.items() if times > 1] == []


FOUR_BAR = [str(source) for source in sources("four_bar")]
OF_AN_ANGLE = 30  # products, at most
LIBRARY_FLAGS = ["-std=c99", "-fno-math-errno", "-ffp-contract=off", "-fPIC", "-shared"]


@pytest.mark.parametrize("compiler", ["gcc -O0", "gcc -O1", "gcc -O3", "clang -O2"])
def test_compiler_and_optimisation_change_no_bit(compiler, tmp_path):
    """Of what `compute` holds a function keeps what it needs, or all, and returns the same."""
    library = tmp_path / "four_bar.so"
    run([*compiler.split(), *LIBRARY_FLAGS, *FOUR_BAR, "-o", str(library), "-lm"])
    compiled, loaded = EMITTED["four_bar"], ctypes.CDLL(str(library))
    state, inputs, given = (np.array(values) for values in ([0.3, 2.0], [0.5], [0.3, 0.1, -0.2]))
    for function, address in compiled.ADDRESSES.items():
        if function in ("prepare", "design_state"):
            continue
        arrays = [compiled.DEFAULT_CONSTANTS, state, inputs]
        arrays += [given] * (function == "residuals")
        outs = [np.full(100, np.nan) for _ in range(2)]
        other = ctypes.cast(loaded[f"four_bar_{function}"], ctypes.c_void_p).value
        for place, out in zip((address, other), outs, strict=True):
            call = ctypes.CFUNCTYPE(ctypes.c_int, *[ctypes.c_void_p] * (len(arrays) + 1))(place)
            assert call(*(array.ctypes.data for array in (*arrays, out))) == 0
        np.testing.assert_array_equal(*outs)


def test_compiled_functions_keep_only_what_they_need(tmp_path):
    """As many products and quotients as counted, or fewer, in the machine code of each function."""
    if platform.machine() not in ("x86_64", "AMD64"):
        pytest.skip("reads the instructions of x86-64")
    for source in FOUR_BAR:
        assembly = tmp_path / "four_bar.s"
        run(["gcc", *LIBRARY_FLAGS[:3], "-O2", "-S", source, "-o", str(assembly)])
        text = assembly.read_text(encoding="utf-8")
        for name, body in re.findall(
            r"^four_bar_(\w+):$(.*?)^\s+ret", text, re.MULTILINE | re.DOTALL
        ):
            if name != "prepare":  # its checks end it before the last line
                found = Counter(re.findall(r"^\s+(mulsd|divsd|sqrtsd)", body, re.MULTILINE))
                counts = count(functions("four_bar")[name])
                # sine and cosine of an angle are made of some, and an arc of one: elementary.h
                arcs = sum(functions("four_bar")[name].count(arc) for arc in ("asin", "atan2"))
                angles = (counts["trigonometric"] - arcs + 1) // 2
                more = OF_AN_ANGLE * (angles + arcs)
                assert found["mulsd"] <= counts["multiply"] + more, name
                assert found["divsd"] <= counts["divide"] + arcs, name
                assert found["sqrtsd"] <= counts["root"] + arcs, name


COUNTED = re.compile(r"(\d+) operations? \(([^)]*)\)")


def described_counts(text):
    """Return the counts of a comment: the total and the kinds."""
    match = COUNTED.search(re.sub(r"\s+", " ", text))
    if match[2] == "none":
        return {"total": int(match[1])}
    kinds = {kind: int(number) for number, kind in (item.split() for item in match[2].split(", "))}
    return kinds | {"total": int(match[1])}


@cache
def counted(name, function):
    """Return the counts of the C text, as `described_counts` does."""
    counts = count(functions(name)[function])
    return dict(counts) | {"total": counts.total()}


@each_straight_model
def test_counts_in_the_header(name):
    for function in functions(name).keys() - {"prepare", BOUNDED}:
        comment = rf"/\*((?:(?!\*/).)*)\*/\s*int {name}_{function}\("
        match = re.search(comment, header(name), re.DOTALL)
        assert match is not None, function
        assert described_counts(match[1]) == counted(name, function), function


@each_straight_model
def test_count_at_the_head_of_the_files(name):
    for text in (header(name), *(p.read_text(encoding="utf-8") for p in sources(name))):
        head = text[: text.index("*/")]
        assert described_counts(head.split("rhs:")[1]) == counted(name, "rhs")


@each_straight_model
def test_counts_in_python(name):
    """Those of the compiled function that computes it, beside what else that returns."""
    for result in EMITTED[name].equations.functions:
        call = getattr(EMITTED[name], result)
        found = {kind: n for kind, n in call.operations.items() if n or kind == "total"}
        assert found == counted(name, call.stage), result


@each_straight_model
def test_counts_in_the_report(name):
    report = (FOLDER.parent / f"{name}.md").read_text(encoding="utf-8")
    table = report.split("## Functions")[1]
    for function in functions(name).keys() - {BOUNDED}:
        columns, row = (
            [cell.strip() for cell in line.strip("|").split("|")]
            for line in table.splitlines()
            if line.startswith(("| function", f"| `{function}`"))
        )
        cells = dict(zip(columns, row, strict=True))
        counts = counted(name, function)
        expected = {column: counts.get(column, 0) for column in columns[3:]}
        assert {column: int(cells[column]) for column in columns[3:]} == expected, function
        assert int(cells["operations"]) == counts["total"], function


TABLES = {
    "parameter": "PARAMETERS",
    "state": "STATE",
    "input": "INPUTS",
    "relative": "RELATIVE_COORDINATES",
    "signal": "SIGNALS",
    "body": "BODIES",
    "massive": "MASSIVE_BODIES",
}


@each_model
def test_enums_are_the_order_of_the_arrays(name):
    for kind, table in TABLES.items():
        entries = getattr(EMITTED[name], table)
        match = re.search(rf"enum {name}_{kind} \{{(.*?)\}};", header(name), re.DOTALL)
        assert match is not None, kind
        found = re.findall(r"(\w+) = (\d+)", re.sub(r"/\*.*?\*/", "", match[1], flags=re.DOTALL))
        prefix = f"{name}_{kind}_".upper()
        expected = [(f"{prefix}{entry.upper()}", str(i)) for i, entry in enumerate(entries)]
        assert found == [*expected, (f"{prefix}COUNT", str(len(entries)))]
        if isinstance(entries, dict):  # units and meanings stand beside the indices
            for entry in entries.values():
                assert f"/* [{entry['unit']}] {entry['meaning']} */" in match[1]


def test_texts_are_those_of_the_model():
    """Axes have the name of what rests; only the paper's model cites the paper."""
    axes = {name: set(re.findall(r"(\w+) axes[.,]", header(name))) for name in EMITTED}
    assert axes["four_bar"] == {"ground"}
    assert axes["macpherson"] == {"chassis"}
    citing = {name for name in EMITTED if "Figure 3" in str(EMITTED[name].equations.manifest)}
    assert citing == {"macpherson"}


@each_model
def test_ranges_are_left_to_the_manifest(name):
    """`prepare` compares no parameter with a number, and the header contains no range."""
    ranges = {bound for entry in EMITTED[name].PARAMETERS.values() for bound in entry}
    assert ranges & {"least", "above", "most"}
    assert "Ranges of parameters are not" in header(name)
    body = functions(name)["prepare"]
    tests = [body[i : body.index("{", i)] for i, token in enumerate(body) if token == "if"]
    assert all(test[2] in ("fabs", "!") for test in tests)


@each_model
def test_a_shared_value_is_named_after_a_formula_or_what_reads_it(name):
    """No name is a mere number: a part has the name of a step, or of a function, in the file."""
    for path in FOLDER.glob(f"{name}*.c"):
        text = path.read_text(encoding="utf-8")
        assert "shared_" not in text
        names = set(re.findall(r"[A-Za-z]\w*", text))
        parts = {n for n in names if re.search(r"_part_\d+$", n) and "_table_" not in n}
        for part in parts:
            owner = re.sub(r"(_part_\d+)+$", "", part)
            assert any(n.lower().endswith(owner.lower()) for n in names - parts), part
