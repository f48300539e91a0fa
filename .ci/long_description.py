"""What a package index shows of this project: the README, whose links work there too.

Links of the README are paths, so that they work in a copy of the sources and on every forge. An
index has neither; where the variables KINTRAFO_REPOSITORY (an address) and KINTRAFO_REVISION (a tag
or a commit) say where the sources are, as in a release, paths become addresses there.
"""

import os
import re
from pathlib import Path

_LINK = re.compile(r"(?P<image>!?)\[(?P<text>[^\]]*)\]\((?P<path>[^)\s:#][^)\s:]*)\)")


def long_description(folder: Path) -> str:
    """Return the README as an index shows it."""
    text = (folder / "README.md").read_text(encoding="utf-8")
    repository, revision = repository_and_revision()
    return with_addresses(text, repository, revision) if repository else text


def repository_and_revision() -> tuple[str, str]:
    """Return where the sources are; no address where it is not known."""
    found = os.environ.get("KINTRAFO_REPOSITORY", "").rstrip("/")
    return found, os.environ.get("KINTRAFO_REVISION") or "HEAD"


def with_addresses(text: str, repository: str, revision: str) -> str:
    """Return a text with addresses for paths: of pages, and of pictures as they are."""

    def address(link: re.Match[str]) -> str:
        what = "raw" if link["image"] else "blob"
        return f"{link['image']}[{link['text']}]({repository}/{what}/{revision}/{link['path']})"

    return _LINK.sub(address, text)
