"""What the command costs before its first line of work, as whole processes, each beside a bare `python -c pass`.

python benchmarks/startup.py [--rounds 15]
"""

from __future__ import annotations

import argparse
from pathlib import Path

from timing import medians, process

ARM = str(Path(__file__).parents[1] / "examples" / "01_two_link_arm" / "two_link_arm.robot.yaml")
LINKFORGE = ("-m", "linkforge_compile")
BARE = "python -c pass"
COMMANDS = {
    BARE: ("-c", "pass"),
    "linkforge --version": (*LINKFORGE, "--version"),
    "linkforge --help": (*LINKFORGE, "--help"),
    "all imports before the first file is read": (
        "-c",
        "import linkforge_compile.cli.commands.compile, linkforge_compile.pipeline",
    ),
    "linkforge compile of the two-link arm": (*LINKFORGE, "compile", ARM),
}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=15)
    rounds = parser.parse_args().rounds
    taken = medians(rounds, {label: process(*arguments) for label, arguments in COMMANDS.items()})
    for label, seconds in taken.items():
        print(f"{label:<45} {seconds * 1000:7.0f} ms {seconds / taken[BARE]:6.1f} x")


if __name__ == "__main__":
    main()
