"""Migrate vendors' xacros, prove them and print how much of each is translated.

    python benchmarks/migrate_vendors.py LIST --repositories FOLDER [--json FILE]
    python benchmarks/migrate_vendors.py --wheel rtb-data [--json FILE]

LIST has a xacro on each line, relative to FOLDER, with its arguments: `ur/urdf/ur.urdf.xacro ur_type:=ur5e`.
FOLDER has checkouts of the vendors' repositories; all packages in them are given to each migration. `--wheel` fetches a
wheel with pip and takes its xacros that name a robot. Nothing of the vendors' is kept. Exit code 1 unless all are the
same.
"""

from __future__ import annotations

import argparse
import json
import re
import subprocess
import sys
import tempfile
import time
import zipfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from linkforge_compile.analysis import Settings
from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.migration.prove import Migrator

_NAME = re.compile(r"<name>\s*([^<\s]+)\s*</name>")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("list", type=Path, nargs="?")
    parser.add_argument("--repositories", type=Path, default=Path())
    parser.add_argument("--package", metavar="NAME=FOLDER", action="append", default=[], help="where a package is")
    parser.add_argument("--wheel", help="a package on PyPI that has xacros, such as rtb-data")
    parser.add_argument("--json", type=Path)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        if arguments.wheel:
            folder = _unpacked(arguments.wheel, Path(temporary))
            robots = [(path, {}) for path in _robots_in(folder)]
            # Wheels leave out the manifests, and name the folders as the packages.
            named = {path.name: path.absolute() for path in folder.rglob("xacro/*") if path.is_dir()}
        else:
            folder, named = arguments.repositories, {}
            robots = list(_listed(arguments.list, folder))
        packages = {**named, **dict(_packages(folder))}
        packages |= {name: Path(place) for name, _, place in (word.partition("=") for word in arguments.package)}
        rows = [_row(path, given, packages, folder, Path(temporary)) for path, given in robots]
    _print(rows)
    if arguments.json:
        arguments.json.write_text(json.dumps(rows, indent=1), "utf-8")
    return int(not all(row["same"] for row in rows))


def _unpacked(package: str, folder: Path) -> Path:
    pip = [
        sys.executable,
        "-m",
        "pip",
        "download",
        "--no-deps",
        "--no-binary",
        "none",
        "-q",
        "-d",
        str(folder),
        package,
    ]
    subprocess.run(pip, check=True)
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


def _row(
    path: Path, given: dict[str, str], packages: Mapping[str, Path], folder: Path, temporary: Path
) -> dict[str, Any]:
    start = time.perf_counter()
    loader = Settings((), packages, allow_outside=True).loader(path)
    proved = Migrator(path, given, temporary / "specs", loader, Diagnostics()).run()
    row: dict[str, Any] = {"robot": str(path.relative_to(folder)), "same": proved.is_equal, "kept": not proved.figures}
    row |= proved.figures.as_json() if proved.figures else {}
    row["seconds"] = round(time.perf_counter() - start, 1)
    row["reasons"] = [one.message for one in proved.diagnostics]
    return row


def _print(rows: list[dict[str, Any]]) -> None:
    print("| robot | equal | macros | modules | in place | raw XML | properties | conditions | lines | seconds |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |")
    for row in rows:
        if row["kept"]:
            print(f"| {row['robot']} | {'xacro' if row['same'] else 'no'} | | | | | | | | {row['seconds']} |")
            continue
        equal = f"{row['equal']} of {row['combinations'] - row['unproved']}"
        numbers = (row[key] for key in ("macros", "modules", "in_place", "raw", "properties", "conditions"))
        lines = f"{row['lines_before']} → {row['lines_after']}"
        print(f"| {row['robot']} | {equal} | {' | '.join(map(str, numbers))} | {lines} | {row['seconds']} |")
    done = [row for row in rows if not row["kept"]]
    macros, raw = (sum(row[key] for row in done) for key in ("macros", "raw_macros"))
    modules = sum(row["modules"] for row in done)
    same = sum(row["same"] for row in done)
    print(
        f"\n{same} of {len(rows)} translated and equal; {macros} macros: {modules} modules, {raw} of them with raw XML"
    )


if __name__ == "__main__":
    sys.exit(main())
