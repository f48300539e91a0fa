"""Options and fixtures of all tests."""

from collections.abc import Callable

import own_models
import pytest
from kintrafo.generator.mechanisms import MODELS
from kintrafo.generator.outputs import GeneratedModel


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
    """Let one worker run what shares a model that is derived, or the fixtures of a file.

    Of all that tests make for each other, deriving takes longest, and cannot be handed to another
    process: what is derived is large, and SymPy computes what it reads again.
    """
    for item in items:
        shared = "derived" in getattr(item, "fixturenames", ())
        item.add_marker(pytest.mark.xdist_group("derived" if shared else item.path.stem))


@pytest.fixture(scope="session")
def derived() -> Callable[[str], GeneratedModel]:
    """Derive a model that comes with the project, by name; each takes a few seconds, once."""
    models = {model.name: model for model in MODELS}
    return lambda name: own_models.derive(models[name])
