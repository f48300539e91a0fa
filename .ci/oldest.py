"""Print the oldest versions that pyproject.toml accepts, as constraints for pip.

Usage: oldest.py > constraints.txt
"""

import tomllib
from pathlib import Path

# Extras of users; those of developers have the newest versions.
_EXTRAS = ("generator", "casadi", "jax", "parquet", "excel", "cluster", "crg", "pareto", "learning")


def main() -> None:
    """Print a line for each package that has a lower bound."""
    project = tomllib.loads(Path("pyproject.toml").read_text(encoding="utf-8"))["project"]
    optional = project["optional-dependencies"]
    needed = [*project["dependencies"], *(line for extra in _EXTRAS for line in optional[extra])]
    for line in needed:
        print(line.replace(">=", "=="))


if __name__ == "__main__":
    main()
