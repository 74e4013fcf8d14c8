"""The comparisons of the benchmarks; each function yields the rows of one."""

from __future__ import annotations

import shutil
import sys
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from chain import make_chain, make_repeated_chain
from environment import Environment, Sample, Worker
from table import Budget, Row, Side, average_rows

XACRO, CORE = "xacro", "linkforge-core"


class Robot(NamedTuple):
    """A robot that both sides can read."""

    name: str
    xacro: Path
    spec: Path
    """Imported from the URDF that xacro expands."""


@dataclass
class Bench:
    """The environment, number of rounds and robots of a measurement."""

    environment: Environment
    spawner: Worker
    """Runs whole processes."""
    folder: Path
    rounds: int
    robots: dict[str, list[Robot]] = field(default_factory=dict)
    """By the folder or file in which they were found."""

    def make_run(self, program: str, *arguments: object) -> Callable[[], Sample]:
        """Return a function that runs a program of the environment as a process."""
        command = (self.environment.program(program), *map(str, arguments))
        return lambda: self.spawner.measure(*command)

    def make_runs(self, commands: list[tuple[object, ...]]) -> Callable[[], Sample]:
        """Return a function that runs processes one after another, and adds up their costs."""
        runs = [self.make_run(str(program), *arguments) for program, *arguments in commands]

        def run() -> Sample:
            walls, processors, megabytes = zip(*(run() for run in runs), strict=True)
            return Sample(sum(walls), sum(processors), max(megabytes))

        return run

    def measure_in_turns(
        self, what: str, *sides: Callable[[], Sample], rounds: int | None = None
    ) -> list[list[Sample]]:
        """Return the times of each side in each round, after a first round that is not counted."""
        print(what, end=" ", file=sys.stderr, flush=True)
        taken: list[list[Sample]] = []
        for _ in range((rounds or self.rounds) + 1):
            taken.append([side() for side in sides])
            print(".", end="", file=sys.stderr, flush=True)
        print(file=sys.stderr)
        return [list(samples) for samples in zip(*taken[1:], strict=True)]

    def measure(
        self,
        what: str,
        other_is: str,
        ours: Callable[[], Sample],
        other: Callable[[], Sample],
        budget: Budget | None = None,
    ) -> Row:
        sides = (
            Side([sample.wall for sample in samples], [sample.processor for sample in samples])
            for samples in self.measure_in_turns(what, ours, other)
        )
        return Row(what, other_is, *sides, budget=budget)

    def measure_in_process(
        self, what: str, other_is: str, ours: tuple[str, ...], other: tuple[str, ...], budget: Budget | None = None
    ) -> Row:
        """Measure two actions of worker.py, each repeatedly in its own process."""
        with self.environment.worker(*ours) as one, self.environment.worker(*other) as another:
            return self.measure(what, other_is, one.measure, another.measure, budget)


def measure_cold(bench: Bench) -> Iterator[Row]:
    """Compare processes that compile a robot with processes of xacro."""
    for group, robots in bench.robots.items():
        rows = []
        for robot in robots:
            folder = robot.spec.parent
            ours = bench.make_run("linkforge", "compile", robot.spec, "-o", f"{folder}/out/")
            other = bench.make_run("xacro", robot.xacro, "-o", folder / "expanded.urdf")
            rows.append(bench.measure(f"cold: {robot.name}", XACRO, ours, other))
            yield rows[-1]
        yield average_rows(rows, f"cold: mean of {group}", Budget(2.5, 1.5))


def measure_warm(bench: Bench) -> Iterator[Row]:
    """Compare the second compile of a robot in a process with xacro in a process."""
    for group, robots in bench.robots.items():
        rows = []
        for robot in robots:
            ours, other = ("compile", str(robot.spec)), ("xacro", str(robot.xacro))
            rows.append(bench.measure_in_process(f"second: {robot.name}", XACRO, ours, other))
            yield rows[-1]
        yield average_rows(rows, f"second: mean of {group}", Budget(0.35, 0.2))


BULK = 30
"""How many robots `measure_bulk` compiles at once."""


def measure_bulk(bench: Bench) -> Iterator[Row]:
    """Compare one process that compiles thirty robots with thirty processes of xacro, and of linkforge."""
    for group, robots in bench.robots.items():
        folder = Path(tempfile.mkdtemp(dir=bench.folder))
        turns = [robots[number % len(robots)] for number in range(BULK)]
        specs = [folder / "specs" / f"{robot.name}_{number}.robot.yaml" for number, robot in enumerate(turns)]
        (folder / "specs").mkdir()
        for spec, robot in zip(specs, turns, strict=True):
            shutil.copy(robot.spec, spec)
        ours = bench.make_run("linkforge", "compile", folder / "specs", "-o", f"{folder}/bulk/")
        what = f"{BULK} robots of {group}"
        others = bench.make_runs([("xacro", robot.xacro, "-o", folder / f"{robot.name}.urdf") for robot in turns])
        yield bench.measure(what, f"{BULK} of {XACRO}", ours, others, Budget(0.25, 0.15))
        each = bench.make_runs([("linkforge", "compile", spec, "-o", f"{folder}/each/") for spec in specs])
        yield bench.measure(what, f"{BULK} processes", ours, each)


def measure_chain(bench: Bench) -> Iterator[Row]:
    """Compile 1,000 links to URDF, checked, against linkforge-core reading, validating and writing the same URDF."""
    specs = {"each written": make_chain(1000), "by a `for`": make_repeated_chain(1000)}
    for number, (what, text) in enumerate(specs.items()):
        spec = bench.folder / str(number) / "chain.robot.yaml"
        spec.parent.mkdir()
        spec.write_text(text, "utf-8")
        urdf = spec.with_name("chain.urdf")
        compiled = bench.environment.run(bench.environment.program("linkforge"), "compile", str(spec), "-o", str(urdf))
        if compiled.returncode:
            sys.exit(compiled.stderr)
        ours, other = ("compile-text", str(spec)), ("rewrite-urdf", str(urdf))
        yield bench.measure_in_process(f"1,000 links, {what}", CORE, ours, other, Budget(1.1, 0.8))


def measure_growth(bench: Bench) -> Iterator[Row]:
    """Compare compiling 10,000 links with 1,000, each less the cost of a robot with one link."""
    runs = []
    for links in (10000, 1000, 1):
        spec = bench.folder / f"chain_{links}.robot.yaml"
        spec.write_text(make_chain(links), "utf-8")
        runs.append(bench.make_run("linkforge", "compile", spec, "-o", spec.with_suffix(".urdf")))
    large, small, one = bench.measure_in_turns("10,000 links", *runs, rounds=min(bench.rounds, 3))

    def beyond_one(samples: list[Sample], figure: str) -> list[float]:
        return [getattr(sample, figure) - getattr(base, figure) for sample, base in zip(samples, one, strict=True)]

    times = (Side(beyond_one(samples, "wall"), beyond_one(samples, "processor")) for samples in (large, small))
    yield Row("10,000 links, time", "1,000 links", *times, budget=Budget(11, 10))
    memory = (Side(beyond_one(samples, "megabytes"), []) for samples in (large, small))
    yield Row("10,000 links, peak memory", "1,000 links", *memory, budget=Budget(11, 10), unit="MB")


def measure_merge(bench: Bench) -> Iterator[Row]:
    """Merge 200 modules of 10 links into one robot."""
    ours, other = (("merge", library, "200", "10") for library in ("linkforge_compile.core", "linkforge.core"))
    yield bench.measure_in_process("200 modules merged", CORE, ours, other, Budget(0.1, 0.05))


def measure_start(bench: Bench) -> Iterator[Row]:
    """Compare starting the command with starting Python; there is no budget."""
    for option in ("--version", "--help"):
        ours, other = bench.make_run("linkforge", option), bench.make_run("python", "-c", "pass")
        yield bench.measure(f"linkforge {option}", "python -c pass", ours, other)


COMPARISONS: dict[str, Callable[[Bench], Iterator[Row]]] = {
    "cold": measure_cold,
    "warm": measure_warm,
    "bulk": measure_bulk,
    "chain": measure_chain,
    "growth": measure_growth,
    "merge": measure_merge,
    "start": measure_start,
}
OF_ROBOTS = {"cold", "warm", "bulk"}
"""The comparisons that use `Bench.robots`."""
