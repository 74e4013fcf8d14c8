"""Measure linkforge from an installed wheel, in comparison with xacro and linkforge-core.

    python benchmarks/compare.py
    python benchmarks/compare.py --environment /tmp/measured --only cold,warm --robots vendors/ my.urdf.xacro

README.md beside this file explains the rows and budgets. The exit code is 0 even if a budget is missed.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from comparisons import COMPARISONS, OF_ROBOTS, Bench, Robot
from environment import Environment, make_environment
from table import HEADER, format_row, make_record

ROBOTS = Path(__file__).resolve().parent / "robots"


def main() -> None:
    options = parse_arguments()
    groups = find_robots(options.robots)
    with open_bench(options) as bench:
        machine = describe(bench)
        print("\n".join(f"{name}: {value}" for name, value in machine.items()))
        left_out = []
        if OF_ROBOTS & set(options.only):
            left_out += [line for group, files in groups.items() for line in import_robots(bench, group, files)]
        print("\n".join(["", *left_out, HEADER]), flush=True)
        records = []
        for name in options.only:
            for row in COMPARISONS[name](bench):
                print(format_row(row), flush=True)
                records.append({"comparison": name, **make_record(row)})
        robots = {group: {robot.name: str(robot.xacro) for robot in found} for group, found in bench.robots.items()}
    if options.json:
        report = {"machine": machine, "robots": robots, "left_out": left_out, "rows": records}
        options.json.write_text(json.dumps(report, indent=1) + "\n", "utf-8")


def parse_arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=parse_count, default=9, help="measured runs of each side (9)")
    parser.add_argument(
        "--only",
        type=parse_comparisons,
        default=list(COMPARISONS),
        metavar="NAME,...",
        help=f"some of {', '.join(COMPARISONS)} (all)",
    )
    parser.add_argument(
        "--robots",
        type=Path,
        nargs="+",
        default=[],
        metavar="PATH",
        help="further xacro files, or folders with *.urdf.xacro; arguments have their defaults",
    )
    parser.add_argument(
        "--wheel", type=Path, metavar="FILE", help="the wheel to install (one built from this checkout)"
    )
    parser.add_argument(
        "--environment",
        type=Path,
        metavar="FOLDER",
        help="an existing virtual environment to use, or a new one to create and keep (a temporary one)",
    )
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the figures of each round")
    return parser.parse_args()


def parse_count(text: str) -> int:
    number = int(text)
    if number < 1:
        raise argparse.ArgumentTypeError("takes 1 or more")
    return number


def parse_comparisons(text: str) -> list[str]:
    """Parse names of comparisons, separated by commas."""
    names = text.split(",")
    for name in names:
        if name not in COMPARISONS:
            raise argparse.ArgumentTypeError(f"takes {', '.join(COMPARISONS)}; found '{name}'")
    return names


def find_robots(paths: list[Path]) -> dict[str, list[Path]]:
    """Return the xacro files of benchmarks/robots and of the paths given, by the name of their group in the table."""
    groups = {"benchmarks/robots": find_xacro_files(ROBOTS)}
    for path in paths:
        group = path.resolve().name if path.is_dir() else "files"
        groups[group] = groups.get(group, []) + find_xacro_files(path)
    return groups


def find_xacro_files(path: Path) -> list[Path]:
    files = [path] if path.is_file() else sorted(path.rglob("*.urdf.xacro"))
    if not files:
        sys.exit(f"no *.urdf.xacro in {path}")
    return [file.resolve() for file in files]


@contextmanager
def open_bench(options: argparse.Namespace) -> Iterator[Bench]:
    """Prepare the environment and a folder for outputs."""
    with tempfile.TemporaryDirectory() as text:
        folder = Path(text)
        place = (options.environment or folder / "environment").absolute()
        if not (place / "bin" / "python").exists():
            make_environment(place, options.wheel)
        elif options.wheel:
            sys.exit(f"{place} exists and is used as it is; give --wheel with a new folder")
        environment = Environment(place)
        with environment.worker("process") as spawner:
            yield Bench(environment, spawner, folder, options.rounds)


def describe(bench: Bench) -> dict[str, str]:
    """Return a description of the machine, the versions and the measurement."""
    installed = bench.environment.describe()
    load = ", ".join(f"{load:.1f}" for load in os.getloadavg())
    return {
        "machine": f"{os.cpu_count()} cores, {platform.platform()}; load of the last 1, 5 and 15 minutes: {load}",
        "python": installed.python,
        "packages": ", ".join(f"{name} {version}" for name, version in installed.packages.items()),
        "modules with bytecode": ", ".join(
            f"{package} {compiled} of {modules}" for package, (compiled, modules) in installed.compiled.items()
        ),
        "environment": f"PYTHONDONTWRITEBYTECODE=1; {bench.environment.protection}",
        "rounds": f"{bench.rounds}, in turns, after one that does not count; times are medians",
    }


def import_robots(bench: Bench, group: str, files: list[Path]) -> Iterator[str]:
    """Import robots from the URDF that xacro expands; yield a line for each that one side cannot read."""
    robots: list[Robot] = []
    for file in files:
        print(f"importing {file}", file=sys.stderr)
        folder = tempfile.mkdtemp(dir=bench.folder)
        name = file.name.removesuffix(".xacro").removesuffix(".urdf")
        urdf, spec = f"{folder}/{name}.urdf", f"{folder}/{name}.robot.yaml"
        for program, *words in (
            ("xacro", str(file), "-o", urdf),
            ("linkforge", "import", urdf, "-o", spec),
            ("linkforge", "compile", spec, "-o", f"{folder}/out/"),
        ):
            run = bench.environment.run(bench.environment.program(program), *words)
            if run.returncode:
                message = (run.stderr.strip() or "no message").splitlines()[0]
                step = program if program == "xacro" else f"{program} {words[0]}"
                yield f"left out: {file}; {step}: {message}"
                break
        else:
            robots.append(Robot(name, file, Path(spec)))
    if robots:
        bench.robots[group] = robots


if __name__ == "__main__":
    main()
