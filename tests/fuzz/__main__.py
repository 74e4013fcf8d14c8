"""Fuzz one target for a given time: `python -m tests.fuzz compile --seconds 600`.

`yaml` reads a spec's text, `expression` computes one, `import` reads a URDF with an SRDF, `compile` does the whole.
What breaks a promise is written to the current folder as `crash-…`, `timeout-…` or `oom-…`: mend it, and keep the file
in tests/fuzz/corpus/TARGET; `python -m tests.fuzz.run TARGET FILE` runs it again. `--keep` adds there what reached code
that nothing there did. It begins with the examples, that corpus, and the real robots that LINKFORGE_SHARED has, and
needs atheris, of the extra `dev`.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from tests.fuzz.targets import CORPUS, ROOT, TARGETS, seeds, words

LONGEST = 4096
"""How many bytes are made up at most; a longer seed is slow, and reaches no more."""

MOST_KEPT = 70
"""How many files are kept of one target: each is run by every test run."""

_LIMITS = (f"-max_len={LONGEST}", "-timeout=60", "-rss_limit_mb=2048")


def fuzz(target: str, seconds: int, found: Path, beginning: Path, dice: int = 0) -> int:
    """Fuzz for so long and return the exit code, 0 where every promise is kept; `found` takes what reaches more.

    `dice` says how chance falls; 0 means otherwise each time.
    """
    dictionary = found.with_name("words")
    quoted = (word.replace("\\", r"\\").replace('"', r"\"") for word in dict.fromkeys(words(target)))
    dictionary.write_text("".join(f'"{word}"\n' for word in quoted), "utf-8")
    given = (f"-max_total_time={seconds}", f"-seed={dice}", f"-dict={dictionary}", *_LIMITS)
    return _run(target, *given, str(found), str(beginning))


def write_seeds(target: str, folder: Path) -> None:
    """Write what a target begins with, and what was kept of it."""
    shared = Path(os.environ.get("LINKFORGE_SHARED", ROOT.parent / "shared"))
    kept = [path.read_bytes() for path in sorted((CORPUS / target).glob("*"))]
    for number, seed in enumerate((*seeds(target, shared), *kept)):
        if len(seed) <= LONGEST:
            (folder / str(number)).write_bytes(seed)


def _keep(target: str, found: Path) -> None:
    """Keep the shortest of what reached more than there was, as long as there is room."""
    kept = CORPUS / target
    kept.mkdir(parents=True, exist_ok=True)
    room = MOST_KEPT - len(list(kept.iterdir()))
    for path in sorted(found.iterdir(), key=lambda path: path.stat().st_size)[: max(room, 0)]:
        shutil.copy(path, kept / path.name[:12])


def _run(target: str, *words: str) -> int:
    return subprocess.run([sys.executable, "-m", "tests.fuzz.run", target, *words], check=False).returncode


def main() -> int:
    parser = argparse.ArgumentParser(
        prog="python -m tests.fuzz", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("target", choices=TARGETS)
    parser.add_argument("--seconds", type=int, default=600, help="how long, 600 unless told")
    parser.add_argument("--keep", action="store_true", help="add to the kept corpus what reaches more")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        found, beginning = Path(folder, "found"), Path(folder, "beginning")
        found.mkdir()
        beginning.mkdir()
        write_seeds(arguments.target, beginning)
        code = fuzz(arguments.target, arguments.seconds, found, beginning)
        if arguments.keep:
            _keep(arguments.target, found)
    print(
        f"{arguments.target}: " + ("something was found, see above" if code else "nothing was found"), file=sys.stderr
    )
    return code


if __name__ == "__main__":
    sys.exit(main())
