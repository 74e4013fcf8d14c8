"""Kill a process that writes an output file, at random moments; count the files that were written only in part.

python benchmarks/interrupted.py [TRIES]     (default: 200)
"""

from __future__ import annotations

import random
import subprocess
import sys
import tempfile
import time
from pathlib import Path

_CONTENTS = ("a" * 2_000_000, "b" * 2_000_000)


def write_forever(target: Path) -> None:
    """Write the two contents to a file in turn; the process that does so is killed."""
    from linkforge_compile.cli.output import write_if_changed

    print("ready", flush=True)
    while True:
        for content in _CONTENTS:
            write_if_changed(target, content)


def count_torn_files(tries: int, folder: Path) -> int:
    """Return how many of the kills left a file with neither of the two contents."""
    target, torn = folder / "robot.urdf", 0
    for _ in range(tries):
        with subprocess.Popen([sys.executable, __file__, "write", str(target)], stdout=subprocess.PIPE) as writer:
            assert writer.stdout is not None
            writer.stdout.readline()
            time.sleep(random.uniform(0, 0.05))
            writer.kill()
        torn += target.exists() and target.read_text() not in _CONTENTS
    return torn


def main(words: list[str]) -> int:
    if words[:1] == ["write"]:  # the process to kill
        write_forever(Path(words[1]))
    tries = int(words[0]) if words else 200
    with tempfile.TemporaryDirectory() as folder:
        torn = count_torn_files(tries, Path(folder))
    print(f"{tries} kills, {torn} torn files")
    return int(torn > 0)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
