"""What the command costs before its first line of work, as whole processes, each beside a bare `python -c pass`.

    python benchmarks/startup.py [--rounds 15]

The commands take turns, so that a busy machine slows all of them down alike; a table shows the medians.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
from pathlib import Path
from statistics import median
from time import perf_counter

ARM = str(Path(__file__).parents[1] / "examples" / "01_two_link_arm" / "two_link_arm.robot.yaml")
LINKFORGE = ("-m", "linkforge_compile")
COMMANDS = {
    "python -c pass": ("-c", "pass"),
    "linkforge --version": (*LINKFORGE, "--version"),
    "linkforge --help": (*LINKFORGE, "--help"),
    "all imports before the first file is read": (
        "-c",
        "import linkforge_compile.cli.commands.compile, linkforge_compile.pipeline",
    ),
    "linkforge compile of the two-link arm": (*LINKFORGE, "compile", ARM),
}


def seconds(arguments: tuple[str, ...]) -> float:
    start = perf_counter()
    subprocess.run((sys.executable, *arguments), check=True, capture_output=True)
    return perf_counter() - start


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=15)
    rounds = parser.parse_args().rounds
    taken: dict[str, list[float]] = {label: [] for label in COMMANDS}
    for _ in range(rounds):
        for label, arguments in COMMANDS.items():
            taken[label].append(seconds(arguments))
    bare = median(taken["python -c pass"])
    for label, times in taken.items():
        print(f"{label:<45} {median(times) * 1000:7.0f} ms {median(times) / bare:6.1f} x")


if __name__ == "__main__":
    main()
