"""Compare the pairs that `linkforge collisions` finds for a URDF with those of a published SRDF.

    python benchmarks/collision_agreement.py panda.urdf panda.srdf --package panda_description=../panda_description

Prints the rows of the table in docs/collisions.md, and each pair that only one of the two has.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import time
from collections.abc import Mapping, Sequence
from pathlib import Path

from lxml import etree

Pairs = Mapping[frozenset[str], str]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("urdf", type=Path)
    parser.add_argument("srdf", type=Path)
    parser.add_argument("options", nargs=argparse.REMAINDER, help="options of linkforge collisions")
    arguments = parser.parse_args()
    begin = time.monotonic()
    ours, checked = computed(arguments.urdf, arguments.options)
    seconds = time.monotonic() - begin
    known = {name for pair in (*ours, *checked) for name in pair}
    published = {pair: reason for pair, reason in read_srdf(arguments.srdf).items() if pair <= known}
    print(f"{len(known)} links with collisions, {len(ours) + len(checked)} pairs, {seconds:.1f} s")
    both = ours.keys() & published.keys()
    print(f"ours {len(ours)}, published {len(published)}, both {len(both)}: ", end="")
    print(f"precision {len(both) / len(ours):.0%}, recall {len(both) / len(published):.0%}")
    for reason in ("Adjacent", "Default", "Always", "Never"):
        one, other = ({pair for pair, why in pairs.items() if why == reason} for pairs in (ours, published))
        print(f"{reason}: ours {len(one)}, published {len(other)}, both {len(one & other)}")
    for title, pairs, others in (("only ours", ours, published), ("only published", published, ours)):
        for pair in sorted(map(sorted, pairs.keys() - others.keys())):
            print(f"{title}: {' '.join(pair)} {pairs[frozenset(pair)]}")


def computed(urdf: Path, options: Sequence[str]) -> tuple[Pairs, set[frozenset[str]]]:
    """Return the pairs that need no check, with their reasons, and those that do."""
    command = [sys.executable, "-m", "linkforge_compile", "collisions", str(urdf), "--json", *options]
    done = subprocess.run(command, stdout=subprocess.PIPE, check=True)
    document = json.loads(done.stdout)
    disabled = {frozenset((pair["link1"], pair["link2"])): pair["reason"] for pair in document["disabled"]}
    return disabled, {frozenset((pair["link1"], pair["link2"])) for pair in document["checked"]}


def read_srdf(path: Path) -> Pairs:
    """Return the pairs of an SRDF with their reasons."""
    pairs = etree.parse(path).iter("disable_collisions")
    return {frozenset((pair.get("link1", ""), pair.get("link2", ""))): pair.get("reason", "") for pair in pairs}


if __name__ == "__main__":
    main()
