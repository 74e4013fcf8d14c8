"""Record everything that linkforge prints and writes for many robots, to compare two versions of it byte by byte.

    python benchmarks/same_outputs.py record before.json [--code CHECKOUT] [--robots FOLDER ...]
    python benchmarks/same_outputs.py compare before.json after.json

Every spec, URDF and xacro of this repository and of the given folders is an input of `check`, `compile`, `expand` and
`import`. A record holds a hash of each exit code with its messages, and of each file. `--code` is the checkout whose
linkforge runs; the inputs are always those of this script's repository, so that records differ only by the code.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
INPUTS = ("examples", "tests/cases", "benchmarks/robots")
SPEC, URDF = (".yaml",), (".urdf", ".xacro")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True, metavar="{record,compare}")
    recorder = commands.add_parser("record", help="run linkforge on every robot and write the hashes")
    recorder.add_argument("record", type=Path)
    recorder.add_argument("--code", type=Path, default=ROOT, help="the checkout whose linkforge runs (this one)")
    recorder.add_argument("--robots", type=Path, nargs="+", default=[], help="folders with further robots")
    recorder.set_defaults(run=lambda options: record(options.record, options.code, options.robots))
    comparer = commands.add_parser("compare", help="list what differs between two records")
    comparer.add_argument("records", type=Path, nargs=2)
    comparer.set_defaults(run=lambda options: compare(*options.records))
    # The process in which `record` runs linkforge; without help text, argparse does not list it.
    worker = commands.add_parser("run-commands")
    worker.add_argument("code", type=Path)
    worker.set_defaults(run=lambda options: run_commands(options.code))
    options = parser.parse_args()
    options.run(options)


def record(target: Path, code: Path, folders: list[Path]) -> None:
    robots = sorted(set(inputs(folders)))
    workers = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else 1
    with ThreadPoolExecutor(workers) as pool:
        parts = pool.map(lambda share: run_all(share, code), [robots[number::workers] for number in range(workers)])
        outputs = {name: text for part in parts for name, text in part.items()}
    target.write_text(json.dumps(outputs, indent=0, sort_keys=True), encoding="utf-8")
    print(f"{len(robots)} robots, {len(outputs)} outputs")


def inputs(folders: list[Path]) -> Iterator[Path]:
    for folder in (*(ROOT / name for name in INPUTS), *(folder.resolve() for folder in folders)):
        yield from (path for path in folder.rglob("*") if path.suffix in SPEC + URDF and path.is_file())


def run_commands(code: Path) -> None:
    """Run the commands that come from standard input as lines of JSON; print the output of each as such a line."""
    import linkforge_compile
    from linkforge_compile.cli import main as cli

    if not Path(linkforge_compile.__file__).is_relative_to(code.resolve()):
        raise SystemExit(f"{linkforge_compile.__file__} is not in {code}")
    for line in sys.stdin:
        print(json.dumps(capture(cli.main, json.loads(line))), flush=True)


def capture(command: Callable[[list[str]], int], words: list[str]) -> str:
    """Run a command in this process; return its exit code and what it, and processes that it starts, print."""
    kept = os.dup(1), os.dup(2)
    with tempfile.TemporaryFile() as output:
        sys.stdout.flush()
        os.dup2(output.fileno(), 1)
        os.dup2(output.fileno(), 2)
        try:
            code: object = command(words)
        except SystemExit as end:
            code = end.code
        finally:
            sys.stdout.flush()
            sys.stderr.flush()
            for number, stream in enumerate(kept, start=1):
                os.dup2(stream, number)
                os.close(stream)
        output.seek(0)
        return f"exit {code}\n" + output.read().decode("utf-8", "surrogateescape")


def run_all(robots: list[Path], code: Path) -> dict[str, str]:
    """Return the digest of each command's messages and files, by robot and command."""
    code = code.resolve()
    environment = os.environ | {"PYTHONPATH": str(code), "LINKFORGE_LIMITS": "1", "COLUMNS": "100"}
    outputs = {}
    with (
        tempfile.TemporaryDirectory() as folder,
        subprocess.Popen(
            [sys.executable, __file__, "run-commands", str(code)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            cwd=ROOT,
            env=environment,
        ) as worker,
    ):
        assert worker.stdin
        assert worker.stdout
        for number, robot in enumerate(robots):
            out = Path(folder, str(number))
            name = robot.relative_to(ROOT).as_posix() if robot.is_relative_to(ROOT) else str(robot)
            for label, argv in commands_for(name, out):
                print(json.dumps(argv), file=worker.stdin, flush=True)
                answer = worker.stdout.readline()
                if not answer:
                    raise SystemExit(f"linkforge ended: {' '.join(argv)}")
                outputs[f"{name} {label}"] = digest(json.loads(answer).replace(str(out), "OUT"))
            for file in sorted(out.rglob("*")):
                if file.is_file():
                    outputs[f"{name} -> {file.relative_to(out)}"] = digest(file.read_text("utf-8", "surrogateescape"))
    return outputs


def commands_for(robot: str, out: Path) -> Iterator[tuple[str, list[str]]]:
    """Yield the commands to run on a robot, with their names."""
    if robot.endswith(URDF):
        spec = f"{out}/imported.robot.yaml"
        srdf = Path(ROOT, robot).with_suffix(".srdf")
        with_srdf, to_srdf = (["--srdf", str(srdf)], ["-o", f"{out}/again.srdf"]) if srdf.is_file() else ([], [])
        yield "import", ["import", robot, *with_srdf, "-o", spec]
        if robot.endswith(".urdf"):
            yield "check", ["check", "--diagnostics", "json", robot]
        yield "compile import", ["compile", spec, "-o", f"{out}/again.urdf", *to_srdf]
        return
    yield "check", ["check", "--diagnostics", "json", robot]
    yield "check text", ["check", robot]
    yield "compile", ["compile", robot, "-o", f"{out}/", "--source-map"]
    yield "classic", ["compile", robot, "--gazebo", "classic", "-o", f"{out}/classic/"]
    yield "expand", ["expand", robot]


def digest(text: str) -> str:
    return hashlib.sha256(text.encode("utf-8", "surrogateescape")).hexdigest()[:16]


def compare(before: Path, after: Path) -> None:
    old, new = (json.loads(path.read_text("utf-8")) for path in (before, after))
    differing = [name for name in sorted(old.keys() | new.keys()) if old.get(name) != new.get(name)]
    for name in differing:
        print(name, "" if name in old and name in new else "(only before)" if name in old else "(only after)")
    print(f"{len(old)} outputs before, {len(new)} after: {len(differing)} differ")
    raise SystemExit(bool(differing))


if __name__ == "__main__":
    main()
