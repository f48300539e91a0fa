"""Mistakes in the arguments of all commands: messages in one style, with what to write instead."""

import re

import pytest
import typer
from kintrafo.vehicle import cli

# Sentences of Click, Typer and pydantic.
FOREIGN = re.compile(
    r"No such|Missing |Got unexpected|Invalid value|requires an? |does not take|is not one of|"
    r"not a valid|Input should|Value error|does not exist|Traceback"
)
ADVICE = re.compile(
    r"Did you mean \S+\?|Write \S+|For example: kintrafo |options are --|is needed|it can be|"
    r"It is an option of|Known are",
    re.MULTILINE,
)


APP = typer.main.get_command(cli.app)


def found_command(name):
    command = APP
    for word in name.split():
        command = command.commands[word]
    return command


def mistakes():
    """Yield the words of command lines, and a word of each that the message must have."""
    for name in cli.COMMANDS:
        line, command = name.split(), found_command(name)
        arguments = [p for p in command.params if p.param_type_name == "argument"]
        yield [*line, "--no-such-option"], "--no-such-option"
        yield [*line, "-z"], "-z"
        if any(argument.required for argument in arguments):
            yield line, "is missing"
        options = [
            (max(p.opts, key=len), p)
            for p in command.params
            if p.param_type_name == "option" and "--help" not in p.opts
        ]
        if all(argument.nargs == 1 for argument in arguments):
            needed = [word for shown, p in options if p.required for word in (shown, "x")]
            yield [*line, *([__file__] * len(arguments)), *needed, "surplus"], "too many"
        flags = [shown for shown, p in options if p.is_flag]
        valued = [shown for shown, p in options if not p.is_flag]
        yield from (([*line, f"{shown}=3"], shown) for shown in flags[:1])
        yield from (([*line, shown], shown) for shown in valued[:1])
        for shown, option in options:
            if re.match(r"^(<.*\|.*>|MM|DEG|S|HZ|COUNT|NUMBER|KM/H)$", str(option.metavar or "")):
                yield [*line, shown, "1_0"], "'1_0'"
    yield ["chek"], "check"
    yield ["kinematics", "reference_car"], "kintrafo characteristics --positions"
    yield ["topology"], "kintrafo mechanism topology"
    yield ["mechanism", "topologie"], "topology"
    yield ["check", "--positions"], "characteristics"
    yield ["check", "--version"], "kintrafo --version"
    yield ["--versoin"], "--version"
    yield ["import", ".", "car.toml"], "folder"
    yield ["mechanism", "generate", "no_such_file.py"], "no_such_file.py"


@pytest.mark.parametrize(
    ("line", "word"),
    [pytest.param(*m, id=" ".join(m[0]).replace(__file__, "FILE")) for m in mistakes()],
)
def test_a_mistake_is_explained_in_one_style(line, word, kintrafo):
    code, out, error = kintrafo(*line)
    assert (code, out) == (2, "")
    assert re.match(r"error: kintrafo[ \w]*: 1 problem\n  - \S", error), error
    assert re.search(r"\nThe (options|commands) are listed by: kintrafo.* --help\n$", error), error
    assert word in error
    assert ADVICE.search(error) or "Check its name" in error or "file is needed" in error, error
    assert not FOREIGN.search(error), error


@pytest.mark.parametrize("line", [[], ["mechanism"]])
def test_no_command_shows_the_help_and_no_error(line, kintrafo):
    _, *shown = kintrafo(*line)
    shown = "".join(shown)
    assert "Usage: " in shown
    assert "problem\n" not in shown
