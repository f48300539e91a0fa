"""The emitted C as text: its functions as tokens, and the operations in them.

No printer of the project is used: only the text of the file counts.
"""

import re
from collections import Counter
from functools import cache
from importlib import import_module
from pathlib import Path

from kintrafo import generated

FOLDER = Path(generated.__file__).parent / "c"
EMITTED = {
    path.stem: import_module(f"kintrafo.generated.{path.stem}")
    for path in sorted(FOLDER.parent.glob("*.json"))
}
"""All generated modules by name."""
STRAIGHT = {
    name: module
    for name, module in EMITTED.items()
    if not any("iterates" in entry for entry in module.equations.manifest["functions"].values())
}
"""Those whose loops are all closed in closed form: straight lines."""

_LAYOUT = re.compile(r"/\*.*?\*/|^\s*#[^\n]*$", re.DOTALL | re.MULTILINE)
_TOKEN = re.compile(
    r"""\s*(?P<token>
        (?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?   # number
      | [A-Za-z_]\w*                           # name
      | \+\+|--|->|<<|>>|&&|\|\||[=!<>]=       # operator of two characters
      | [-+*/%=<>!?:;,.&|^~(){}\[\]]           # any other
    )""",
    re.VERBOSE,
)
_SIGNATURE = re.compile(r"^(?:INLINED )?status_word (\w+)\([^)]*\)\s*\{", re.MULTILINE)

_NAMED = {"+": "add", "-": "add", "*": "multiply", "/": "divide"}
_CALLED = {
    "sqrt": "root",
    "sin": "trigonometric",
    "cos": "trigonometric",
    "asin": "trigonometric",
    "atan2": "trigonometric",
    "exp": "trigonometric",
    "log": "trigonometric",
}


@cache
def header(model):
    """Return the text of a model's header."""
    return (FOLDER / f"{model}.h").read_text(encoding="utf-8")


def sources(model):
    """Return a model's C files, in the order in which they are documented."""
    return [FOLDER / f"{model}.c", FOLDER / f"{model}_derivatives.c"]


@cache
def functions(model):
    """Return the tokens of every function's body, by name without the model's prefix."""
    return functions_of(model, (path.read_text(encoding="utf-8") for path in sources(model)))


def functions_of(model, texts):
    """Return the same of C text that lies in no file."""
    return {name: body for text in texts for name, body in _bodies(model, text).items()}


def whole_of(path):
    """Return the tokens of what all functions of a file compute."""
    return _functions_in(path.read_text(encoding="utf-8"))["compute"]


def _bodies(model, text):
    """Return the bodies of the functions that others may call, each with all that it computes."""
    bodies = _functions_in(text)
    whole = bodies.pop("compute", [])
    return {n.removeprefix(f"{model}_"): _inlined(body, whole) for n, body in bodies.items()}


def _functions_in(text):
    text = _LAYOUT.sub("", text)
    starts = [*_SIGNATURE.finditer(text)]
    ends = [*(match.start() for match in starts[1:]), len(text)]
    return {
        match[1]: tokens(text[match.end() : end].rpartition("}")[0])
        for match, end in zip(starts, ends, strict=True)
    }


def _inlined(body, whole):
    """Return what a function computes that calls the one with all steps, as a compiler does.

    These are the results behind ``if (wanted == NAME)``, and the steps that they need.
    """
    if body[:2] != ["return", "compute"]:
        return body
    branches = [i for i, token in enumerate(whole) if token == "if"]
    chosen = next(i for i in branches if whole[i + 4] == body[3])
    end = min([i for i in branches if i > chosen], default=len(whole))
    own = whole[whole.index("{", chosen) + 1 : end - whole[chosen:end][::-1].index("}") - 1]
    needed, steps = set(own), []
    for name, step in reversed([*_steps(whole[: branches[0]])]):
        if name in needed:
            needed |= set(step)
            steps.append(step)
    return [*(token for step in reversed(steps) for token in step), *own]


def _steps(body):
    """Return the declarations of a straight-line body one by one, each with its name."""
    for statement in statements(body):
        start, kind, depth = 0, [], 0
        for index, token in enumerate([*statement, ","]):
            depth += (token in "([") - (token in ")]")
            if token == "," and not depth:
                part = [*kind, *statement[start:index], ";"]
                start = index + 1
                if "=" in part:
                    place = part.index("=") - 1
                    kind = part[:place]
                    yield part[place], part


def tokens(text):
    """Split C text into tokens; anything unknown is an error."""
    found, position = [], 0
    text = text.rstrip()
    while position < len(text):
        match = _TOKEN.match(text, position)
        assert match is not None, f"no C token: {text[position : position + 40]!r}"
        found.append(match["token"])
        position = match.end()
    return found


def statements(body):
    """Return the statements of a straight-line body."""
    start = 0
    for index, token in enumerate(body):
        if token == ";":
            yield body[start:index]
            start = index + 1


def definitions(body):
    """Return what each name, and each result, is computed from: the tokens behind its sign."""
    found = {}
    for statement in statements(body):
        part = []
        depth = 0
        for token in [*statement, ","]:
            depth += (token in "([") - (token in ")]")
            if token != "," or depth:
                part.append(token)
                continue
            if "=" in part:
                at = part.index("=")
                while "=" in part[at + 1 :]:  # several results that are zero
                    at += 1 + part[at + 1 :].index("=")
                for name in "".join(part[:at]).removeprefix("constdouble").split("="):
                    found[name] = part[at + 1 :]
            part = []
    return found


def sources_of(body, results):
    """Return the tokens on which some results depend, through all that is computed before."""
    known, waiting, seen = definitions(body), list(results), set()
    while waiting:
        name = waiting.pop()
        expression = known.get(name, [])
        after, behind = [*expression[1:], ""], [*expression[2:], "", ""]
        elements = zip(expression, after, behind, strict=False)
        tokens_ = [f"{a}[{c}]" for a, b, c in elements if b == "["]
        fresh = {*expression, *tokens_} - seen
        seen |= fresh
        waiting += fresh
    return seen


def count(body):
    """Count the operations of all assignments; comparisons and the status are none.

    A sign counts as an addition. Numbers count nothing: neither the sign of one that stands by
    itself nor the line of a fraction, which the compiler divides.
    """
    total = Counter()
    for statement in statements(body):
        pointer = "void" in statement  # to the constants: the star is none of a product
        if "=" in statement and statement[0] in ("const", "out", "state", "c") and not pointer:
            total.update(_operations(statement[statement.index("=") + 1 :]))
    return total


def _operations(expression):
    padded = ["(", *expression, ")", ")"]
    for i, token in enumerate(expression):
        before, after, behind = padded[i], padded[i + 2], padded[i + 3]
        signed = token == "-" and before in "(," and after[0].isdigit() and behind in "),"
        fraction = token == "/" and before[0].isdigit() and after[0].isdigit()
        if token in _NAMED and not (signed or fraction):
            yield _NAMED[token]
        elif token in _CALLED:
            yield _CALLED[token]
