"""Write the tables of the models that come with the project, for ``make generate``.

They are compiled with the project, so that the export of an FMU of these models needs no compiler.
"""

import json
import sys
from pathlib import Path

from .tables import any_tables


def main(models: Path) -> None:
    """Write the tables for all manifests in a folder into its folder ``fmu``; remove all others."""
    folder = models / "fmu"
    folder.mkdir(exist_ok=True)
    written = set()
    for manifest in sorted(models.glob("*.json")):
        content = json.loads(manifest.read_text(encoding="utf-8"))
        for name, text in any_tables(content).items():
            path = folder / f"{manifest.stem}_{name}"
            written.add(path)
            if not path.exists() or path.read_text(encoding="utf-8") != text:
                path.write_text(text, encoding="utf-8", newline="\n")
    for path in {*folder.glob("*.c")} - written:
        path.unlink()


if __name__ == "__main__":
    main(Path(sys.argv[1]))
