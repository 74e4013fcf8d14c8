"""Kills a writer of output files at any moment: the file is one whole result, each time.

python benchmarks/interrupted.py [TRIES]     200 unless said
"""

from __future__ import annotations

import random
import subprocess
import sys
import tempfile
import time
from pathlib import Path

_WRITER = """
import sys
from pathlib import Path
from linkforge_compile.cli.output import write_if_changed
print("ready", flush=True)
while True:
    for letter in "ab":
        write_if_changed(Path(sys.argv[1]), letter * 2_000_000)
"""


def torn_files(tries: int, folder: Path) -> int:
    """Return how many of so many kills left a file that is no whole result."""
    target, torn = folder / "robot.urdf", 0
    for _ in range(tries):
        with subprocess.Popen([sys.executable, "-c", _WRITER, str(target)], stdout=subprocess.PIPE) as writer:
            assert writer.stdout is not None
            writer.stdout.readline()
            time.sleep(random.uniform(0, 0.05))
            writer.kill()
        content = target.read_text() if target.exists() else "a" * 2_000_000
        torn += content not in ("a" * 2_000_000, "b" * 2_000_000)
    return torn


if __name__ == "__main__":
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 200
    with tempfile.TemporaryDirectory() as place:
        found = torn_files(count, Path(place))
    print(f"{count} kills, {found} torn files")
    sys.exit(found > 0)
