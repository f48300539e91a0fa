"""Groups of options that commands share: one parameter of a command for all of them."""

from collections.abc import Callable
from dataclasses import fields, is_dataclass
from functools import wraps
from inspect import Parameter, signature
from typing import Any, get_type_hints


def with_groups(command: Callable[..., None]) -> Callable[..., None]:
    """Return a command with one option for each field of its parameters that are dataclasses.

    The command is annotated for Typer. A group is a keyword without default whose type is a
    dataclass; its fields are annotated for Typer and have defaults.
    """
    hints = get_type_hints(command, include_extras=True)
    groups: dict[str, Any] = {name: hint for name, hint in hints.items() if is_dataclass(hint)}
    parameters: list[Parameter] = []
    for parameter in signature(command).parameters.values():
        if parameter.name not in groups:
            parameters.append(parameter.replace(annotation=hints[parameter.name]))
            continue
        group = groups[parameter.name]
        kinds = get_type_hints(group, include_extras=True)
        for field in fields(group):
            own = kinds[field.name]
            each = Parameter(field.name, Parameter.KEYWORD_ONLY, annotation=own)
            parameters.append(each.replace(default=field.default))

    @wraps(command)
    def expanded(*arguments: Any, **options: Any) -> None:
        for name, group in groups.items():
            own = {field.name: options.pop(field.name) for field in fields(group)}
            options[name] = group(**own)
        command(*arguments, **options)

    expanded.__annotations__ = {each.name: each.annotation for each in parameters}
    # read by inspect, not declared in the type of functions
    expanded.__signature__ = signature(command).replace(parameters=parameters)  # type: ignore[attr-defined]
    return expanded
