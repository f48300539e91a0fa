"""The emitted C as text: its functions as tokens, and the operations in them.

Nothing of the project's printers is used: what counts is what the file says.
"""

import re
from collections import Counter
from collections.abc import Iterable, Iterator
from functools import cache
from importlib import import_module
from pathlib import Path

from kintrafo import generated

FOLDER = Path(generated.__file__).parent / "c"
EMITTED = {
    path.stem: import_module(f"kintrafo.generated.{path.stem}")
    for path in sorted(FOLDER.glob("*.h"))
}
"""All generated modules by name."""

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
_SIGNATURE = re.compile(r"^int (\w+)\([^)]*\)\s*\{", re.MULTILINE)

_NAMED = {"+": "add", "-": "add", "*": "multiply", "/": "divide"}
_CALLED = {
    "sqrt": "root",
    "sin": "trigonometric",
    "cos": "trigonometric",
    "asin": "trigonometric",
    "atan2": "trigonometric",
}


@cache
def header(model: str) -> str:
    """Return the text of a model's header."""
    return (FOLDER / f"{model}.h").read_text(encoding="utf-8")


def sources(model: str) -> list[Path]:
    """Return a model's C files, in the order in which they are documented."""
    return [FOLDER / f"{model}.c", FOLDER / f"{model}_derivatives.c"]


@cache
def functions(model: str) -> dict[str, list[str]]:
    """Return the tokens of every function's body, by name without the model's prefix."""
    return functions_of(model, (path.read_text(encoding="utf-8") for path in sources(model)))


def functions_of(model: str, texts: Iterable[str]) -> dict[str, list[str]]:
    """Return the same of C text that lies in no file."""
    return {name: body for text in texts for name, body in _bodies(model, text).items()}


def _bodies(model: str, text: str) -> dict[str, list[str]]:
    text = _LAYOUT.sub("", text)
    starts = [*_SIGNATURE.finditer(text)]
    ends = [*(match.start() for match in starts[1:]), len(text)]
    return {
        match[1].removeprefix(f"{model}_"): tokens(text[match.end() : end].strip()[:-1])
        for match, end in zip(starts, ends, strict=True)
    }


def tokens(text: str) -> list[str]:
    """Split C text into tokens; anything unknown is an error."""
    found, position = [], 0
    text = text.rstrip()
    while position < len(text):
        match = _TOKEN.match(text, position)
        assert match is not None, f"no C token: {text[position : position + 40]!r}"
        found.append(match["token"])
        position = match.end()
    return found


def statements(body: list[str]) -> Iterator[list[str]]:
    """Return the statements of a straight-line body."""
    start = 0
    for index, token in enumerate(body):
        if token == ";":
            yield body[start:index]
            start = index + 1


def count(body: list[str]) -> Counter[str]:
    """Count the operations of all assignments; comparisons and the status are none.

    A sign counts as an addition. Numbers count nothing: neither the sign of one that stands by
    itself nor the line of a fraction, which the compiler divides.
    """
    total: Counter[str] = Counter()
    for statement in statements(body):
        pointer = "void" in statement  # to the constants: the star is none of a product
        if "=" in statement and statement[0] in ("const", "out", "state", "c") and not pointer:
            total.update(_operations(statement[statement.index("=") + 1 :]))
    return total


def _operations(expression: list[str]) -> Iterator[str]:
    padded = ["(", *expression, ")", ")"]
    for i, token in enumerate(expression):
        before, after, behind = padded[i], padded[i + 2], padded[i + 3]
        signed = token == "-" and before in "(," and after[0].isdigit() and behind in "),"
        fraction = token == "/" and before[0].isdigit() and after[0].isdigit()
        if token in _NAMED and not (signed or fraction):
            yield _NAMED[token]
        elif token in _CALLED:
            yield _CALLED[token]
