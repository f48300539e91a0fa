"""The description of this project for a package index: the README with links that work there.

Links of the README are paths, so that they work in a copy of the sources and on every forge. For an
index they become addresses, if the variables KINTRAFO_REPOSITORY (an address) and KINTRAFO_REVISION
(a tag or a commit) are set, as in a release.
"""

import os
import re
from pathlib import Path

_LINK = re.compile(r"(?P<image>!?)\[(?P<text>[^\]]*)\]\((?P<path>[^)\s:#][^)\s:]*)\)")


def long_description(folder: Path) -> str:
    """Return the README for an index."""
    text = (folder / "README.md").read_text(encoding="utf-8")
    repository, revision = repository_and_revision()
    return with_addresses(text, repository, revision) if repository else text


def repository_and_revision() -> tuple[str, str]:
    """Return address and revision of the sources; the address is empty if it is not known."""
    found = os.environ.get("KINTRAFO_REPOSITORY", "").rstrip("/")
    return found, os.environ.get("KINTRAFO_REVISION") or "HEAD"


def with_addresses(text: str, repository: str, revision: str) -> str:
    """Return a text with addresses instead of paths: of pages, and of raw pictures."""

    def address(link: re.Match[str]) -> str:
        what = "raw" if link["image"] else "blob"
        return f"{link['image']}[{link['text']}]({repository}/{what}/{revision}/{link['path']})"

    return _LINK.sub(address, text)
