"""Prints which robots come back the same when they are imported and compiled, as an independent judge sees it.

    python benchmarks/import_table.py JUDGE ROBOT.urdf|FOLDER ... [--with xml,pin,mujoco,urdfdom]

JUDGE is `urdf_equiv.py` of the shared tools. Exit code 1 unless every robot is equal.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path
from typing import NamedTuple

from linkforge_compile import compile_text, render_urdf
from linkforge_compile.pipeline import import_urdf


class Row(NamedTuple):
    robot: str
    verdict: str
    lines: int
    told: str
    reason: str


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("judge", type=Path)
    parser.add_argument("robots", type=Path, nargs="+")
    parser.add_argument("--with", dest="consumers", default="xml")
    arguments = parser.parse_args()
    robots = sorted(file for path in arguments.robots for file in _files(path))
    with ThreadPoolExecutor() as pool:
        rows = list(pool.map(partial(_row, arguments.judge, arguments.consumers), robots))
    for row in rows:
        print(f"{row.robot:50}  {row.verdict:8}  {row.lines:5} lines  {row.told}")
        for line in row.reason.splitlines():
            print(f"    {line}")
    equal = sum(row.verdict == "equal" for row in rows)
    print(f"{equal} of {len(rows)} equal, judged with {arguments.consumers}")
    return int(equal < len(rows))


def _files(path: Path) -> Iterator[Path]:
    yield from sorted(path.rglob("*.urdf")) if path.is_dir() else (path,)


def _row(judge: Path, consumers: str, urdf: Path) -> Row:
    imported = import_urdf(urdf)
    told = f"{len(imported.diagnostics)} told" if imported.diagnostics else ""
    if imported.text is None:
        return Row(urdf.name, "refused", 0, told, "\n".join(map(str, imported.diagnostics)))
    lines = imported.text.count("\n")
    compilation = compile_text(imported.text, name=f"{urdf.stem}.robot.yaml", folder=urdf.parent)
    if compilation.robot is None:
        errors = [str(one) for one in compilation.diagnostics if one.severity == "error"]
        return Row(urdf.name, "errors", lines, told, "\n".join(errors[:5]))
    with tempfile.TemporaryDirectory() as folder:
        ours = Path(folder) / "ours.urdf"
        ours.write_text(render_urdf(compilation.robot), "utf-8")
        run = subprocess.run(
            [sys.executable, judge, urdf, ours, "--with", consumers, "--json"],
            capture_output=True,
            text=True,
            check=False,
        )
    return Row(urdf.name, "equal" if run.returncode == 0 else "DIFFERS", lines, told, _differences(run))


def _differences(run: subprocess.CompletedProcess[str]) -> str:
    if run.returncode == 0:
        return ""
    try:
        return json.dumps(json.loads(run.stdout))[:1500]
    except json.JSONDecodeError:
        return run.stdout + run.stderr


if __name__ == "__main__":
    sys.exit(main())
