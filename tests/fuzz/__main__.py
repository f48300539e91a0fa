"""``python -m fuzz``: try the doors for long, print a table, write it into a page."""

import argparse
import sys
from pathlib import Path

from benchmarks.report import fill_page

from .attempts import names, short
from .campaign import campaign, table


def _progress(found):
    done = found.counts.total()
    if done % 20 == 0 and sys.stderr.isatty():
        sys.stderr.write(f"\r{found.name}: {done}, {len(found.defects)} defects ")
        sys.stderr.flush()


def main():
    """Run the command."""
    parser = argparse.ArgumentParser(prog="fuzz", description=__doc__)
    parser.add_argument("doors", nargs="*", default=names(), help="all by default")
    parser.add_argument("--rounds", type=int, default=25, help="so many times the short run")
    parser.add_argument("--attempts", type=int, help="so many at each door instead")
    parser.add_argument("--first", type=int, default=0, help="the first seed")
    parser.add_argument("--page", type=Path, help="a page whose table is replaced")
    options = parser.parse_args()
    campaigns = []
    for name in options.doors:
        count = options.attempts or options.rounds * short(name)
        found = campaign(name, count, first=options.first, progress=_progress)
        campaigns.append(found)
        for one in found.defects:
            print(f"{name}, seed {one.seed}: {one.outcome}: {one.text}")
        print(f"{name}: {dict(found.counts)}", flush=True)
    print()
    print(table(campaigns))
    if options.page:
        fill_page(options.page, {"fuzz": table(campaigns)})
    return int(any(found.defects for found in campaigns))


if __name__ == "__main__":
    sys.exit(main())
