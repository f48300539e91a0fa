"""A functional mock-up unit (FMU) of FMI 2.0 or 3.0: Model Exchange and Co-Simulation together."""

import zipfile
from collections.abc import Mapping, Sequence
from importlib.resources import files
from pathlib import Path
from types import ModuleType
from typing import Any

from ..core.archives import undated
from ..core.files import Paths, replacing
from ..core.validator import Validator
from .emitted import Emitted
from .fmi import binaries, fmi2, fmi3
from .fmi.description import ModelDescription
from .fmi.sources import library_files, source_files
from .fmi.tables import tables
from .target import Target

ENDING = ".fmu"
VERSIONS: Mapping[int, ModuleType] = {2: fmi2, 3: fmi3}


def check(path: Path, *, fmi: int = 2, platforms: Sequence[str] = binaries.HERE) -> None:
    """Refuse arguments that `write` cannot use, by an InputError."""
    with Validator("export") as given:
        given.among("fmi", str(fmi), map(str, VERSIONS))
        given.names("platforms", platforms, binaries.ENDINGS)
        if path.suffix.lower() != ENDING:
            shown = path.with_suffix(ENDING) if path.name else f"model{ENDING}"
            given.fail(f"{path}: the name of this file must end in {ENDING}. Write {shown}.")


def write(
    emitted: Emitted,
    path: Path,
    *,
    force: bool,
    read: Paths,
    fmi: int = 2,
    platforms: Sequence[str] = binaries.HERE,
) -> Path:
    """Write an FMU; see `export_model`."""
    with replacing(path, force=force, inputs=read) as temporary:
        _pack(temporary, contents(emitted, int(fmi), tuple(dict.fromkeys(platforms))))
    return path


def contents(emitted: Emitted, fmi: int, platforms: Sequence[str]) -> dict[str, bytes]:
    """Return the contents of an FMU by path."""
    version: Any = VERSIONS[fmi]
    known = ModelDescription(emitted)
    token = known.token(fmi)
    of_model = tables(known.manifest, token, known.values)
    sources = source_files(emitted.sources, of_model, [version.FRONT])
    # one library of a model serves both versions and all values of its parameters
    any_numbers = library_files(emitted)
    compiled = [name for name in sources if name.endswith(".c")]
    found = {"modelDescription.xml": version.model_description(known, compiled).encode()}
    for platform in platforms:
        file = f"{known.identifier}{binaries.ENDINGS[platform]}"
        place = f"binaries/{version.FOLDERS[platform]}/{file}"
        found[place] = binaries.library(
            any_numbers, known.identifier, platform, token, known.values
        )
    found |= {f"sources/{name}": text.encode() for name, text in sources.items()}
    if fmi == 3:
        found["sources/buildDescription.xml"] = fmi3.build_description(known, compiled).encode()
    licence = files(fmi2.__package__ or "") / "headers" / "LICENSE.txt"
    found["documentation/licenses/FMI.txt"] = licence.read_bytes()
    return found


def _pack(path: Path, found: Mapping[str, bytes]) -> None:
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name, content in found.items():
            entry = undated(name, zipfile.ZIP_DEFLATED)
            entry.external_attr = 0o644 << 16
            archive.writestr(entry, content)


TARGET = Target("fmu", ENDING, write, check)
