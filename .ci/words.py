"""Find words in the project's prose that readers of the field do not use.

Prose is the text of Markdown files and of templates, and every string of the sources that has a
space in it: docstrings, messages, help. Markdown has patterns of its own in `.ci/words.toml`, and
so have docstrings and comments of Python sources. Each pattern has the words to write instead.
"""

import ast
import re
import sys
import tokenize
import tomllib
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[1]
SOURCES = ("generator", "runtime", "vehicle")
TEMPLATES = ("*.jinja", "*.in")


def main() -> int:
    """Print every finding; return the exit code."""
    listed = tomllib.loads((ROOT / ".ci/words.toml").read_text(encoding="utf-8"))
    rules = {
        scope: [(re.compile(p, re.IGNORECASE | re.MULTILINE), words) for p, words in found.items()]
        for scope, found in listed.items()
    }
    count = 0
    for path, line, text in prose():
        applied = rules["everywhere"] + (rules["pages"] if path.suffix == ".md" else [])
        count += report(path, line, text, applied)
    for folder in (*SOURCES, ".ci"):
        for path in sorted((ROOT / folder).rglob("*.py")):
            for line, text in (*docstrings(path), *comments(path)):
                count += report(path, line, text, rules["docstrings"])
    return min(count, 1)


def report(path: Path, line: int, text: str, rules: list[tuple[re.Pattern[str], str]]) -> int:
    """Print and count the matches of rules in a text that begins at `line` of a file."""
    count = 0
    for pattern, instead in rules:
        for found in pattern.finditer(text):
            at = line + text.count("\n", 0, found.start())
            words = " ".join(found[0].split())
            print(f"{path.relative_to(ROOT)}:{at}: '{words}': write {instead}")
            count += 1
    return count


def prose() -> Iterator[tuple[Path, int, str]]:
    """Yield files, lines and texts."""
    pages = [ROOT / "README.md", ROOT / "CHANGELOG.md", *sorted((ROOT / "docs").rglob("*.md"))]
    for page in pages:
        yield page, 1, without_code(page.read_text(encoding="utf-8"))
    for folder in SOURCES:
        for path in sorted((ROOT / folder).rglob("*.py")):
            yield from strings(path)
        for ending in TEMPLATES:
            for path in sorted((ROOT / folder).rglob(ending)):
                yield path, 1, path.read_text(encoding="utf-8")


def without_code(text: str) -> str:
    """Return a page with blanks for its code, so that lines keep their numbers."""
    text = re.sub(
        r"^```.*?^```",
        lambda block: "\n" * block[0].count("\n"),
        text,
        flags=re.DOTALL | re.MULTILINE,
    )
    text = re.sub(r"`[^`\n]+`", "`code`", text)
    return re.sub(r"\]\([^)]+\)", "]", text)


def strings(path: Path) -> Iterator[tuple[Path, int, str]]:
    """Yield the strings of a source that have a space; of formatted ones the fixed parts."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and " " in node.value:
            yield path, node.lineno, re.sub(r"`+[^`\n]+`+", "`code`", node.value)


def docstrings(path: Path) -> Iterator[tuple[int, str]]:
    """Yield line and text of the docstrings of modules, classes, functions and attributes."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        value = node.value if isinstance(node, ast.Expr) else None
        if isinstance(value, ast.Constant) and isinstance(value.value, str):
            yield value.lineno, without_code(value.value)


def comments(path: Path) -> Iterator[tuple[int, str]]:
    """Yield line and text of each comment; comments on consecutive lines are one."""
    text, end = [], 0
    with path.open("rb") as file:
        for token in tokenize.tokenize(file.readline):
            if token.type != tokenize.COMMENT:
                continue
            if text and token.start[0] != end + 1:
                yield end - len(text) + 1, without_code("\n".join(text))
                text = []
            text, end = [*text, token.string.removeprefix("#").strip()], token.start[0]
    if text:
        yield end - len(text) + 1, without_code("\n".join(text))


if __name__ == "__main__":
    sys.exit(main())
