"""Mistakes in the arguments of a command, in the form of all other errors.

Click and Typer find them; their sentences are written here, with the correction.
"""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, ClassVar

import typer
from rich.markup import escape
from typer.core import TyperArgument, TyperCommand, TyperGroup, TyperOption

from ..core.errors import InputError
from ..core.reading import is_path
from ..core.suggestions import nearest, suggestion

MistakenUsage: Any = typer.BadParameter.__mro__[2]
"""Click's base of all mistakes in arguments, of which Typer may have a copy of its own."""

_COMMON = {"--help", "-h"}  # options of every command, which messages do not list
# A problem of an argument, whose option may be in brackets.
_ARGUMENT = re.compile(r"([\w-]*)(?: \((--[\w-]+)\))?(.*)", re.DOTALL)
_FEW = 3  # most commands that a message about an option names


class OptionError(InputError):
    """Mistakes in the options of a command, whose path is the source, or in its `listed`."""

    def __init__(self, problems: Iterable[str], source: str, listed: str = "options") -> None:
        super().__init__(problems, source)
        self.listed = listed

    def __str__(self) -> str:
        """Return the mistakes, and the command that lists the options."""
        return f"{super().__str__()}\nThe {self.listed} are listed by: {self.source} --help"


class Command(TyperCommand):
    """A command with help without markup in brackets, and explained mistakes."""

    examples: ClassVar[Sequence[str]] = ()  # lines that can be run; a message shows one of them

    def __init__(self, *args: Any, **options: Any) -> None:
        super().__init__(*args, **options)
        for parameter in self.params:
            if isinstance(parameter, TyperArgument | TyperOption) and parameter.help:
                parameter.help = escape(parameter.help)

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Return the remaining arguments: an empty list."""
        ctx.allow_extra_args = True
        try:
            left = super().parse_args(ctx, args)
        except typer.BadParameter:
            raise
        except Exception as error:
            # the parser of options does not set the command
            if getattr(error, "ctx", ctx) is None:
                vars(error)["ctx"] = ctx
            raise
        if left and not ctx.resilient_parsing:
            ctx.fail(_too_many(self, left))
        return left

    def invoke(self, ctx: Any) -> Any:
        """Run the command; errors of its arguments name its options."""
        try:
            return super().invoke(ctx)
        except InputError as error:
            raise _of_command(error, ctx) from None


class CommandGroup(TyperGroup):
    """Commands by name; an unknown one has a message with the nearest known one."""

    instead: ClassVar[Mapping[str, str]] = {}  # commands for other names that users may try

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        """Return name, command and arguments."""
        name = args[0]
        if not name.startswith("-") and self.get_command(ctx, name) is None:
            ctx.fail(f"{name!r} is not a command. {self._meant(ctx, name)}")
        return super().resolve_command(ctx, args)

    def _meant(self, ctx: Any, name: str) -> str:
        if name in self.instead:
            return f"Write {self.instead[name]}."
        shown = [key for key, command in self.commands.items() if not command.hidden]
        inner = {
            own: f"{key} {own}"
            for key in shown
            for own in getattr(self.commands[key], "commands", {})
        }
        if name in inner:
            return f"Write {ctx.command_path} {inner[name]}."
        return suggestion(name, shown)


def usage_problem(error: Any) -> str:
    """Return the mistake in the arguments of a command, and the correction, in sentences.

    The exception is one of Click, or of the copy of it in Typer; its context names the command. The
    text is empty if only the help is to be shown.
    """
    context = getattr(error, "ctx", None)
    command = getattr(context, "command", None)
    # by name, since Click and Typer have different classes
    match type(error).__name__:
        case "NoArgsIsHelpError":
            return ""
        case "NoSuchOption":
            return _no_option(context, error.option_name)
        case "MissingParameter":
            return f"{_named(error.param)} is missing.{_example(command)}"
        case "BadOptionUsage":
            return _bad_usage(command, error.option_name)
        case "BadParameter" if getattr(error, "param", None) is not None:
            return f"{_named(error.param)} {error.message}"
    return str(error.message)


def _of_command(error: InputError, ctx: Any) -> InputError:
    """Return an error with the name of its file, or with that of the command and its options.

    Arguments of functions have the names of options that were given.
    """
    given = {key: value for key, value in ctx.params.items() if value is not None}
    lists = (value if isinstance(value, list) else [value] for value in given.values())
    values = {str(value) for each in lists for value in each}
    source, words = error.source, error.source.removeprefix("kintrafo ")
    if source in values or Path(source).suffix or is_path(source):
        return error
    options = {p.name: _named(p) for p in ctx.command.params if p.param_type_name == "option"}

    def renamed(problem: str) -> str:
        name, option, rest = _ARGUMENT.fullmatch(problem).groups()  # type: ignore[union-attr]  # it fits all texts
        known = name if name.startswith("--") else options.get(name) if name in given else ""
        if option := option or known:
            return option + re.sub("^ = ", " ", rest)
        return problem if words.isidentifier() else f"{words}: {problem}"

    problems = [renamed(problem) for problem in error.problems]
    of_options = any(problem.startswith("--") for problem in problems)
    return (OptionError if of_options else InputError)(problems, ctx.command_path)


def _named(parameter: Any) -> str:
    """Return the longest name of an option, or an argument as in the help."""
    if parameter.param_type_name == "option":
        return str(max(parameter.opts, key=len))
    return str(parameter.metavar or parameter.name.upper())


def _no_option(context: Any, name: str) -> str:
    command, group = context.command, getattr(context.parent, "command", None)
    words = f"{name} is not an option of this command."
    others = getattr(group, "commands", {}).items()
    elsewhere = [key for key, other in others if name in _options(other) and not other.hidden]
    if group is not None and name in _options(group):
        return f"{words} Write {context.parent.command_path} {name}."
    if 0 < len(elsewhere) <= _FEW:
        return f"{words} It is an option of {', '.join(elsewhere)}."
    known = {o.strip("-"): o for o in _options(command) if o.startswith("--")}
    found = nearest(name.strip("-"), known) if name.startswith("--") else ""
    if found:
        return f"{words} Did you mean {known[found]}?"
    return f"{words} Its options are {', '.join(sorted({*known.values()} - _COMMON))}."


def _options(command: Any) -> Iterator[str]:
    for parameter in command.params:
        if parameter.param_type_name == "option":
            yield from (*parameter.opts, *parameter.secondary_opts)


def _bad_usage(command: Any, name: str) -> str:
    """Return a message about an option without its value, or a flag with one."""
    wanted = next((p for p in command.params if name in (*p.opts, *p.secondary_opts)), None)
    if wanted is None or getattr(wanted, "is_flag", False):
        return f"{name} takes no value. Write {name} alone."
    value = wanted.metavar or wanted.name.upper()
    return f"{name} needs a value. Write {name} {value}.{_example(command, name)}"


def _too_many(command: Any, left: Sequence[str]) -> str:
    known = [_named(p) for p in command.params if p.param_type_name == "argument"]
    shown = ", ".join(map(repr, left))
    one = "is one argument" if len(left) == 1 else f"are {len(left)} arguments"
    taken = ", ".join(known) or "options only"
    return f"{shown} {one} too many: the command takes {taken}.{_example(command)}"


def _example(command: Any, name: str = "") -> str:
    """Return a sentence with an example of an option, or with the first example."""
    examples = getattr(command, "examples", ())
    found = next((line for line in examples if not name or name in line.split()), "")
    return f" For example: {found}" if found else ""
