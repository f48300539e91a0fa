"""Options and fixtures of all tests."""

from collections.abc import Callable
from functools import cache

import pytest
from kintrafo.generator.equations.outputs import GeneratedModel, generate
from kintrafo.generator.mechanisms import MODELS


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--update-baseline",
        action="store_true",
        help="store the present operation counts in tests/operation_counts.json",
    )


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark what holds numbers against an oracle: the last bits of those depend on the processor."""

    def home(value: object) -> str:
        return str(getattr(value, "__module__", None) or getattr(value, "__name__", ""))

    for item in items:
        names = vars(getattr(item, "module", None) or object).values()
        if any(home(value).startswith(("oracle", "own_models", "cases")) for value in names):
            item.add_marker("numbers")


@pytest.fixture(scope="session")
def derived() -> Callable[[str], GeneratedModel]:
    """Derive a model that comes with the project, by name; each takes a few seconds, once."""
    models = {model.name: model for model in MODELS}
    return cache(lambda name: generate(models[name]))
