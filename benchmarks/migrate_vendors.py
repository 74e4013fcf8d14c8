"""Migrate vendors' xacros, prove them and print how much of each is translated.

    python benchmarks/migrate_vendors.py LIST --repositories FOLDER [--json FILE]
    python benchmarks/migrate_vendors.py --wheel rtb-data [--json FILE]

LIST has a xacro on each line, relative to FOLDER, with its arguments: `ur/urdf/ur.urdf.xacro ur_type:=ur5e`.
FOLDER has checkouts of the vendors' repositories; all packages in them are given to each migration. `--wheel` fetches a
wheel with pip and takes its xacros that name a robot. `--keep` leaves the specs in a folder, else nothing of the
vendors' is kept. Exit code 1 unless all are the same.

A part is a macro that has links or joints, and so can be a module; other macros make values, such as an inertia, and
are written where they are called. The last lines give the share of both.
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
import re
import subprocess
import sys
import tempfile
import time
import traceback
import zipfile
from collections import Counter
from collections.abc import Iterator, Mapping
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

from linkforge_compile.analysis import Settings
from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.migration.prove import Migrator

_NAME = re.compile(r"<name>\s*([^<\s]+)\s*</name>")
_FAULTY = "xacro makes no robot"
_COLUMNS = ("macros", "parts", "modules", "in_place", "kept", "raw", "properties", "conditions")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("list", type=Path, nargs="?")
    parser.add_argument("--repositories", type=Path, default=Path())
    parser.add_argument("--package", metavar="NAME=FOLDER", action="append", default=[], help="where a package is")
    parser.add_argument("--wheel", help="a package on PyPI that has xacros, such as rtb-data")
    parser.add_argument("--only", default="", help="only the xacros with this in their path")
    parser.add_argument("--seconds", type=float, default=300, help="the most time for one robot (300)")
    parser.add_argument("--keep", type=Path, help="a folder that the specs are left in")
    parser.add_argument("--json", type=Path)
    arguments = parser.parse_args()
    if (arguments.list is None) is (arguments.wheel is None):
        parser.error("give a LIST or --wheel PACKAGE")
    with tempfile.TemporaryDirectory() as temporary:
        if arguments.wheel:
            folder = _unpacked(arguments.wheel, Path(temporary))
            robots: list[tuple[Path, dict[str, str]]] = [(path, {}) for path in _robots_in(folder)]
            # Wheels leave out the manifests, and name the folders as the packages.
            named = {path.name: path.absolute() for path in folder.rglob("xacro/*") if path.is_dir()}
        else:
            folder, named = arguments.repositories, {}
            robots = list(_listed(arguments.list, folder))
        packages = {**named, **dict(_packages(folder))}
        packages |= {name: Path(place) for name, _, place in (word.partition("=") for word in arguments.package)}
        robots = [one for one in robots if arguments.only in str(one[0])]
        rows: list[dict[str, Any]] = []
        print(f"| robot | equal | {' | '.join(_COLUMNS).replace('_', ' ')} | lines | seconds |")
        print("|" + " --- |" * (len(_COLUMNS) + 4))
        for path, given in robots:
            specs = (arguments.keep or Path(temporary)) / "specs" / _words(path.relative_to(folder))
            row = _bounded((path, given, packages, specs), arguments.seconds)
            rows.append({"robot": str(path.relative_to(folder)), "arguments": given, **row})
            print(_line(rows[-1]), flush=True)
            if arguments.json:
                arguments.json.write_text(json.dumps(rows, indent=1), "utf-8")
    _print_totals(rows)
    return int(not all(row["same"] for row in rows))


def _words(path: Path) -> str:
    return re.sub(r"\W+", "_", str(path))


def _unpacked(package: str, folder: Path) -> Path:
    pip = (sys.executable, "-m", "pip", "download", "--no-deps", "--only-binary", ":all:", "-q", "-d", str(folder))
    subprocess.run([*pip, package], check=True)
    for archive in folder.glob("*.whl"):
        with zipfile.ZipFile(archive) as wheel:
            wheel.extractall(folder / "wheel")
    return folder / "wheel"


def _robots_in(folder: Path) -> Iterator[Path]:
    """Yield the xacros whose root has a name."""
    for path in sorted(folder.rglob("*.xacro")):
        root = re.search(r"<robot\b[^>]*>", path.read_text("utf-8", errors="replace"))
        if root and re.search(r"""\sname\s*=""", root[0]):
            yield path


def _listed(file: Path, folder: Path) -> Iterator[tuple[Path, dict[str, str]]]:
    for line in file.read_text("utf-8").splitlines():
        if words := line.split("#")[0].split():
            yield folder / words[0], dict(word.split(":=", 1) for word in words[1:])


def _packages(folder: Path) -> Iterator[tuple[str, Path]]:
    for manifest in sorted(folder.rglob("package.xml")):
        if name := _NAME.search(manifest.read_text("utf-8", errors="replace")):
            yield name[1], manifest.parent.absolute()


def _bounded(work: tuple[Path, Mapping[str, str], Mapping[str, Path], Path], seconds: float) -> dict[str, Any]:
    """Migrate a xacro in a process of its own, which is ended after a time."""
    start = time.perf_counter()
    context = multiprocessing.get_context("fork")
    here, there = context.Pipe()
    process = context.Process(target=_send, args=(there, *work))
    process.start()
    row: dict[str, Any] = {"same": False, "failed": f"no result in {seconds:g} s"}
    if here.poll(seconds):
        row = here.recv()
    process.terminate()
    process.join()
    return {**row, "seconds": round(time.perf_counter() - start, 1)}


def _send(to: Connection, path: Path, given: Mapping[str, str], packages: Mapping[str, Path], specs: Path) -> None:
    try:
        row = _row(path, given, packages, specs)
    except BaseException:  # a crash is a row of the table
        row = {"same": False, "failed": traceback.format_exc()}
    to.send(row)


def _row(path: Path, given: Mapping[str, str], packages: Mapping[str, Path], specs: Path) -> dict[str, Any]:
    loader = Settings((), packages, allow_outside=True).loader(path)
    migrator = Migrator(path, given, specs, loader, Diagnostics())
    proved = migrator.run()
    specs.mkdir(parents=True, exist_ok=True)
    for name, text in proved.files.items():
        (specs / name).write_text(text, "utf-8")
    row: dict[str, Any] = {
        "same": proved.is_equal,
        "reasons": [f"{one.code.id} {one.message}" for one in proved.diagnostics],
    }
    row["combinations"] = [{**one.arguments} for one in proved.comparisons if not one.refused]
    row["names"] = dict(proved.names)
    if proved.figures is not None and proved.proof is not None:
        return row | {"figures": proved.figures._asdict() | proved.proof.as_json()}
    # Of a xacro that is used as it is, the macros that its files define are counted.
    roots = [document.root for document in migrator.sources.documents.values()]
    macros = [one for root in roots for one in root.walk() if one.tag == "xacro:macro"]
    parts = [one for one in macros if any(inner.tag in ("link", "joint") for inner in one.walk())]
    return row | {"defined": len(macros), "defined_parts": len(parts)}


def _line(row: Mapping[str, Any]) -> str:
    cells = [""] * (len(_COLUMNS) + 1)
    if "failed" in row:
        equal = row["failed"].strip().splitlines()[-1].replace("|", "\\|")
    elif "figures" in row:
        figures = row["figures"]
        compared = figures["combinations"] - figures["unproved"]
        equal = f"{figures['equal']} of {compared}" if compared else _FAULTY
        cells = [str(figures[key]) for key in _COLUMNS]
        cells.append(f"{figures['lines_before']} → {figures['lines_after']}")
    else:
        equal = "stays a xacro" if row["same"] else "no" if row["combinations"] else _FAULTY
    return f"| {row['robot']} | {equal} | {' | '.join(cells)} | {row['seconds']} |"


def _print_totals(rows: list[dict[str, Any]]) -> None:
    total: Counter[str] = Counter()
    for row in (one for one in rows if one.get("combinations", True)):
        total.update({key: value for key, value in row.get("figures", {}).items() if isinstance(value, int)})
        total.update({"kept_macros": row.get("defined", 0), "kept_parts": row.get("defined_parts", 0)})
    robots = [row for row in rows if row.get("combinations", True)]
    same = sum(row["same"] and "figures" in row for row in robots)
    clean = total["modules"] - total["raw_macros"]
    print(f"\n{same} of {len(robots)} robots translated and equal, {total['equal']} combinations of arguments")
    for words, macros in (
        ("macros with links or joints", total["parts"] + total["kept_parts"]),
        ("all macros", total["macros"] + total["kept_macros"]),
    ):
        shares = f"{total['modules'] / max(macros, 1):.0%}, without raw XML {clean} ({clean / max(macros, 1):.0%})"
        print(f"{total['modules']} of {macros} {words} are modules: {shares}")


if __name__ == "__main__":
    sys.exit(main())
