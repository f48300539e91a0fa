"""``python -m fuzz``: try the doors for long, print a table, write it into a page."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from .attempts import names
from .campaign import Campaign, campaign, table

_MARKS = "<!-- fuzz: table -->\n", "<!-- fuzz: end -->\n"


def _progress(found: Campaign) -> None:
    done = found.counts.total()
    if done % 20 == 0 and sys.stderr.isatty():
        sys.stderr.write(f"\r{found.name}: {done}, {len(found.defects)} defects ")
        sys.stderr.flush()


def main() -> int:
    """Run the command."""
    parser = argparse.ArgumentParser(prog="fuzz", description=__doc__)
    parser.add_argument("doors", nargs="*", default=names(), help="all by default")
    parser.add_argument("--attempts", type=int, default=1000, help="at each door")
    parser.add_argument("--first", type=int, default=0, help="the first seed")
    parser.add_argument("--page", type=Path, help="a page whose table is written anew")
    options = parser.parse_args()
    campaigns = []
    for name in options.doors:
        found = campaign(name, options.attempts, first=options.first, told=_progress)
        campaigns.append(found)
        for one in found.defects:
            print(f"{name}, seed {one.seed}: {one.outcome}: {one.text}")
        print(f"{name}: {dict(found.counts)}", flush=True)
    print()
    print(table(campaigns))
    if options.page:
        _write(options.page, table(campaigns))
    return int(any(found.defects for found in campaigns))


def _write(page: Path, text: str) -> None:
    before, rest = page.read_text(encoding="utf-8").split(_MARKS[0])
    after = rest.split(_MARKS[1])[1]
    page.write_text(f"{before}{_MARKS[0]}\n{text}\n\n{_MARKS[1]}{after}", encoding="utf-8")


if __name__ == "__main__":
    sys.exit(main())
