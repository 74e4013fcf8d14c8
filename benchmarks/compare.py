"""Our speed as ratios: beside xacro and LinkForge (PyPI's linkforge-core) where they are installed, and to ourselves.

    python benchmarks/compare.py [--rounds 9] [--only cold,warm,chain,growth,merge,version] [--robots FILE.xacro ...]

The robots are those of `benchmarks/robots` unless said. README.md beside this file says what stands against what.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from functools import partial
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from statistics import geometric_mean, median
from typing import NamedTuple

from chain import chain, repeated_chain, write_chain
from merge import merges
from timing import medians, process, python, seconds_of, turns

ROBOTS = tuple(sorted((Path(__file__).parent / "robots").glob("*/*.urdf.xacro")))
XACRO = "import sys, xacro; sys.argv[0] = 'xacro'; xacro.main()"


class Setting(NamedTuple):
    """What all comparisons are given: how many rounds, the xacro robots, and a folder to write into."""

    rounds: int
    robots: tuple[Path, ...]
    folder: Path


class Row(NamedTuple):
    """A line of the table: ours against another, and the ratio to reach; None for a part of a mean."""

    what: str
    ours: float
    other: float
    other_is: str
    unit: str = "ms"
    reach: float | None = None

    @property
    def ratio(self) -> float:
        return self.ours / self.other


def cold(setting: Setting) -> Iterator[Row]:
    """Compile as a whole process, cold, against xacro as one."""
    rows = []
    for robot in setting.robots:
        spec, out = imported(robot, setting.folder), str(setting.folder / f"{robot.stem}.out")
        ours, other = ("-m", "linkforge_compile", "compile", str(spec), "-o", f"{out}/"), ("-c", XACRO)
        runs = {"ours": process(*ours), "xacro": process(*other, str(robot), "-o", f"{out}.urdf")}
        rows.append(against(f"cold process, {robot.parent.name}", setting, runs))
    yield from mean("cold process", rows, 1.5)


def warm(setting: Setting) -> Iterator[Row]:
    """Compile again in the same process, against xacro in this process."""
    import xacro

    from linkforge_compile import compile_file, render_urdf

    rows = []
    for robot in setting.robots:
        spec = imported(robot, setting.folder)
        runs = {
            "ours": partial(seconds_of, lambda spec=spec: render_urdf(compile_file(spec).result())),
            "xacro": partial(seconds_of, partial(xacro.process, str(robot))),
        }
        rows.append(against(f"second time, {robot.parent.name}", setting, runs))
    yield from mean("second time", rows, 0.25)


def long_chain(setting: Setting) -> Iterator[Row]:
    """Compile 1,000 links from YAML to URDF, against LinkForge reading, validating and writing the same URDF."""
    from linkforge_compile import compile_text, render_urdf

    core = import_module("linkforge.core")
    text, repeated = chain(1000), repeated_chain(1000)
    urdf = render_urdf(compile_text(text).result())
    assert render_urdf(compile_text(repeated).result()) == urdf
    turns = iter(range(10**6))

    def ours(text: str) -> None:
        # Another text each time, so that nothing of the last one can be remembered.
        render_urdf(compile_text(f"# {next(turns)}\n{text}").result())

    def other() -> None:
        robot = core.read_urdf(urdf)
        core.validate_robot(robot)
        core.URDFGenerator().generate(robot)

    for what, spec in (("each written", text), ("by a `for`", repeated)):
        runs = {"ours": partial(seconds_of, partial(ours, spec)), "linkforge-core": partial(seconds_of, other)}
        yield against(f"1,000 links, {what}", setting, runs, reach=1.0)


def growth(setting: Setting) -> Iterator[Row]:
    """Compile 10,000 links against 1,000: time and memory, without what a robot of one link takes."""
    specs = {links: str(write_chain(setting.folder, links)) for links in (1, 1000, 10000)}
    # Each beside its spec, and unchanged from the second turn on: what writing a file imports is the same for all.
    runs = {
        links: partial(python, "-m", "linkforge_compile", "compile", "-o", f"{spec}.urdf", spec)
        for links, spec in specs.items()
    }
    usages = turns(min(setting.rounds, 3), runs)
    for what, unit, scale in (("seconds", "ms", 1), ("megabytes", "MB", 1e-3)):
        one, small, large = (median(getattr(usage, what) * scale for usage in usages[links]) for links in specs)
        yield Row(f"10,000 links, {what}", large - one, small - one, "1,000 links", unit, 11.0)


def merge(setting: Setting) -> Iterator[Row]:
    """Merge 200 modules of 10 links into one robot."""
    yield against("200 modules merged", setting, merges(200, 10), reach=0.02)


def version(setting: Setting) -> Iterator[Row]:
    """Ask for the version, against a bare Python."""
    runs = {"ours": process("-m", "linkforge_compile", "--version"), "python": process("-c", "pass")}
    yield against("linkforge --version", setting, runs, reach=2.5)


class Comparison(NamedTuple):
    """What yields rows, and the module of the package that it takes besides ours; None for none."""

    rows: Callable[[Setting], Iterator[Row]]
    other: str | None = None


COMPARISONS = {
    "cold": Comparison(cold, "xacro"),
    "warm": Comparison(warm, "xacro"),
    "chain": Comparison(long_chain, "linkforge"),
    "growth": Comparison(growth),
    "merge": Comparison(merge, "linkforge"),
    "version": Comparison(version),
}


PACKAGES = {"xacro": "xacro", "linkforge": "linkforge-core"}
"""The package of each module that we compare with, as pip names it."""


def imported(robot: Path, folder: Path) -> Path:
    """Return the spec of a xacro robot, imported from xacro's own output."""
    urdf, spec = folder / f"{robot.stem}.urdf", folder / f"{robot.stem}.robot.yaml"
    if not spec.exists():
        subprocess.run([sys.executable, "-c", XACRO, str(robot), "-o", str(urdf)], check=True)
        command = [sys.executable, "-m", "linkforge_compile", "import", str(urdf), "-o", str(spec)]
        subprocess.run(command, check=True, capture_output=True)
    return spec


def against(what: str, setting: Setting, runs: dict[str, Callable[[], float]], reach: float | None = None) -> Row:
    ours, other = medians(setting.rounds, runs).values()
    return Row(what, ours, other, [*runs][1], reach=reach)


def mean(what: str, rows: list[Row], reach: float) -> Iterator[Row]:
    yield from rows
    ours, other = (geometric_mean(getattr(row, side) for row in rows) for side in ("ours", "other"))
    yield Row(f"{what}, geometric mean", ours, other, rows[0].other_is, reach=reach)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=9, help="how many runs of each the median is of, 9 unless told")
    some = "some of the comparisons, with commas between"
    parser.add_argument("--only", type=comparisons_in, default=list(COMPARISONS), metavar="NAMES", help=some)
    parser.add_argument("--robots", type=Path, nargs="+", default=ROBOTS, help="other robots, as .urdf.xacro")
    options = parser.parse_args()
    print("medians of the processor's time, in turns; of the ratios, less is better\n")
    print(f"{'what':<32} {'ours':>12} {'the other':>12} {'which is':<14} {'ratio':>8} {'to reach':>9}")
    left_out = False
    with tempfile.TemporaryDirectory() as folder:
        setting = Setting(options.rounds, tuple(options.robots), Path(folder))
        for name in options.only:
            rows, other = COMPARISONS[name]
            if other and find_spec(other) is None:
                left_out = True
                print(f"{name}: not compared, since {PACKAGES[other]} is not installed: pip install '.[dev]' does that")
                continue
            for row in rows(setting):
                show(row)
    sys.exit(left_out)


def comparisons_in(text: str) -> list[str]:
    """Read names of comparisons with commas between them."""
    names = text.split(",")
    for name in names:
        if name not in COMPARISONS:
            raise argparse.ArgumentTypeError(f"takes {', '.join(COMPARISONS)}; found '{name}'")
    return names


def show(row: Row) -> None:
    sides = [f"{side * 1000:9.1f} {row.unit}" for side in (row.ours, row.other)]
    reach = "" if row.reach is None else f"{row.reach:9.2f} {'reached' if row.ratio <= row.reach else 'missed'}"
    print(f"{row.what:<32} {' '.join(sides)} {row.other_is:<14} {row.ratio:8.3f} {reach}", flush=True)


if __name__ == "__main__":
    main()
