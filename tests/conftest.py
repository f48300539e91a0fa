"""Options and fixtures of all tests."""

import pytest
from kintrafo.generator.mechanisms import MODELS
from kintrafo.generator.outputs import GeneratedModel, generate


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--update-baseline",
        action="store_true",
        help="store the present operation counts in tests/operation_counts.json",
    )


@pytest.fixture(scope="session")
def derived() -> dict[str, GeneratedModel]:
    """Every model that comes with the project, derived anew, by name (a few seconds)."""
    return {model.name: generate(model) for model in MODELS}
