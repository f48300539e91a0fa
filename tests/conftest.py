"""Options and fixtures of all tests."""

from collections.abc import Callable

import own_models
import pytest
from kintrafo.generator.equations.outputs import GeneratedModel
from kintrafo.generator.mechanisms import MODELS


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--update-baseline",
        action="store_true",
        help="store the present operation counts in tests/operation_counts.json",
    )


def pytest_sessionstart(session: pytest.Session) -> None:
    """Remove what tests compiled long ago, before workers start."""
    if not hasattr(session.config, "workerinput"):
        own_models.forget()


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Say what a test shares with others, and whether it compares with an oracle."""
    for item in items:
        item.add_marker(pytest.mark.xdist_group(_shared(item)))
        if _compares(item):
            item.add_marker("numbers")


def _shared(item: pytest.Item) -> str:
    """Let one worker run what shares a model that is derived, or the fixtures of a file.

    Of all that tests make for each other, deriving takes longest, and cannot be handed to another
    process: what is derived is large, and SymPy computes what it reads again.
    """
    derived = "derived" in getattr(item, "fixturenames", ())
    return "derived" if derived else item.path.stem


def _compares(item: pytest.Item) -> bool:
    """Tell whether a test holds numbers against an oracle: their last bits are a processor's."""

    def home(value: object) -> str:
        return str(getattr(value, "__module__", None) or getattr(value, "__name__", ""))

    names = vars(getattr(item, "module", None) or object).values()
    return any(home(value).startswith(("oracle", "own_models", "cases")) for value in names)


@pytest.fixture(scope="session")
def derived() -> Callable[[str], GeneratedModel]:
    """Derive a model that comes with the project, by name; each takes a few seconds, once."""
    models = {model.name: model for model in MODELS}
    return lambda name: own_models.derive(models[name])
