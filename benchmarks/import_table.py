"""Print which robots are the same after import and compile, as an independent program compares them.

    python benchmarks/import_table.py COMPARER ROBOT.urdf|ROBOT.srdf|FOLDER ... [--with xml,pin,mujoco,urdfdom]

COMPARER is `urdf_equiv.py` of the shared tools. An SRDF is compared together with the URDF of its robot, which is
searched around it. Exit code 1 if a robot differs by more than a reported change of the name in its SRDF.
"""

from __future__ import annotations

import argparse
import json
import re
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path
from typing import NamedTuple

from linkforge_compile import compile_text, import_urdf, render_srdf, render_urdf
from linkforge_compile.core import Robot


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
    for kind in ("urdf", "srdf"):
        judged = [row for row in rows if row.robot.endswith(kind) and row.verdict != "alone"]
        equal = sum(row.verdict in ("equal", "renamed") for row in judged)
        print(f"{equal} of {len(judged)} {kind.upper()} equal, judged with {arguments.consumers}")
    return int(any(row.verdict not in ("equal", "renamed", "alone") for row in rows))


def _files(path: Path) -> Iterator[Path]:
    yield from sorted((*path.rglob("*.urdf"), *path.rglob("*.srdf"))) if path.is_dir() else (path,)


def urdf_of(srdf: Path) -> Path | None:
    """Return the URDF around an SRDF that is of the same robot: it has the most of what that names, and the least else.

    One in the same folder bears the same robot's name; other folders beside that of the SRDF hold that robot only.
    """
    near = {urdf for urdf in srdf.parent.glob("*.urdf") if _of("robot", "name", urdf) == _of("robot", "name", srdf)}
    near.update(*(srdf.parent.parent.glob(f"{folder}/*.urdf") for folder in ("robots", "urdf")))
    named = _of(r"\w+", "link1|link2|base_link|tip_link|parent_link", srdf)

    def likeness(urdf: Path) -> tuple[bool, int, int]:
        links = _of("link", "name", urdf)
        return urdf.stem.startswith(srdf.stem), len(named & links), -len(links)

    return max(sorted(near), key=likeness, default=None)


def _of(tag: str, attribute: str, file: Path) -> set[str]:
    tags = re.findall(rf"<{tag}\s[^>]*", file.read_text("utf-8", "replace"))
    return {value for text in tags for value in re.findall(rf"\b(?:{attribute})\s*=\s*[\"']([^\"']*)", text)}


def _row(judge: Path, consumers: str, file: Path) -> Row:
    srdf = file if file.suffix == ".srdf" else None
    urdf = urdf_of(srdf) if srdf else file
    if urdf is None:
        return Row(file.name, "alone", 0, "", "")
    imported = import_urdf(urdf, srdf=srdf)
    told = f"{len(imported.diagnostics)} told" if imported.diagnostics else ""
    if imported.text is None:
        return Row(file.name, "refused", 0, told, "\n".join(map(str, imported.diagnostics)))
    lines = imported.text.count("\n")
    compilation = compile_text(imported.text, name=f"{urdf.stem}.robot.yaml", folder=urdf.parent)
    if compilation.robot is None:
        errors = [str(one) for one in compilation.diagnostics if one.severity == "error"]
        return Row(file.name, "errors", lines, told, "\n".join(errors[:5]))
    differences = differences_of(compilation.robot, judge, urdf, srdf, consumers)
    if not differences:
        return Row(file.name, "equal", lines, told, "")
    is_renamed = bool(srdf) and all(one["path"] == "/robot/@name" for one in differences)
    return Row(file.name, "renamed" if is_renamed else "DIFFERS", lines, told, "" if is_renamed else str(differences))


Difference = Mapping[str, str | None]


def differences_of(robot: Robot, judge: Path, urdf: Path, srdf: Path | None, consumers: str) -> list[Difference]:
    """Return the differences of a compiled robot from the files it was imported from."""
    with tempfile.TemporaryDirectory() as folder:
        ours, semantic = Path(folder) / "ours.urdf", Path(folder) / "ours.srdf"
        ours.write_text(render_urdf(robot), "utf-8")
        semantic.write_text(render_srdf(robot), "utf-8")
        both = ("--srdf", srdf, semantic) if srdf else ()
        words = [sys.executable, judge, urdf, ours, *both, "--with", consumers, "--json"]
        run = subprocess.run(words, capture_output=True, text=True, check=False)
    if run.returncode == 0:
        return []
    try:
        checks = json.loads(run.stdout)["checks"]
    except json.JSONDecodeError:
        return [{"path": run.stdout + run.stderr}]
    found = [one for check in checks.values() for one in check.get("fatal", ())]
    return found or [{"path": run.stdout[:1500]}]


if __name__ == "__main__":
    sys.exit(main())
