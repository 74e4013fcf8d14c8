"""Measure `linkforge sweep`: robots a second on one core, two cores against one, and memory.

    python benchmarks/sweep.py
    python benchmarks/sweep.py --environment /tmp/measured --only core,modules,cores,memory --robots 400

README.md beside this file explains the rows. The environment is that of compare.py with the extra `sweep`.
"""

from __future__ import annotations

import argparse
import os
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from statistics import median
from typing import NamedTuple

from environment import Environment, make_environment

ROBOTS = Path(__file__).resolve().parent / "robots"
STIFFNESS = "k_position: 20"
"""What the sweep of the arm varies, as its imported spec has it."""

MANIPULATOR = Path(__file__).resolve().parents[1] / "examples/09_mobile_manipulator/mobile_manipulator.robot.yaml"
TORSO = "torso_height=0.5m:0.9m"
"""What the sweep of the manipulator varies: its own torso, the place of its arms, and its sensors."""

SMALL = """\
linkforge: 1
name: small
parameters: {reach: {type: length, default: 0.5 m, minimum: 0.2 m, maximum: 2 m}}
links:
  base: {visual: {box: [0.1, 0.1, 0.1]}, inertial: {mass: 2 kg}}
  arm: {visual: {box: [0.05, 0.05, $(reach)]}, inertial: {mass: 1 kg}}
joints:
  shoulder: {type: continuous, parent: base, child: arm, axis: y, limits: {effort: 1, velocity: 1}}
"""


def main() -> None:
    options = parse_arguments()
    with tempfile.TemporaryDirectory() as text:
        folder = Path(text)
        place = (options.environment or folder / "environment").absolute()
        if not (place / "bin" / "python").exists():
            make_environment(place, None, "xacro,sweep")
        environment = Environment(place)
        print(
            f"{os.cpu_count()} cores; load of the last 1, 5 and 15 minutes: {os.getloadavg()}; {options.rounds} rounds"
        )
        comparisons = {
            "core": compare_on_one_core,
            "modules": compare_modules,
            "cores": compare_cores,
            "memory": compare_memory,
        }
        for name in options.only.split(","):
            for line in comparisons[name](environment, folder, options):
                print(line, flush=True)


def parse_arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=5, help="measured runs of each side, in turns (5)")
    parser.add_argument("--robots", type=int, default=200, help="robots of a run (200)")
    parser.add_argument("--counts", default="10000,100000", help="robots for the peak memory (10000,100000)")
    parser.add_argument(
        "--only", default="core,modules,cores,memory", help="some of core, modules, cores, memory (all)"
    )
    parser.add_argument("--environment", type=Path, metavar="FOLDER", help="use or make an environment, and keep it")
    return parser.parse_args()


def make_arm(environment: Environment, folder: Path) -> tuple[Path, Path]:
    """Return the URDF that xacro makes of the arm, and its spec with a parameter for the stiffness of its limits."""
    urdf, spec = folder / "arm.urdf", folder / "arm.robot.yaml"
    if not spec.exists():
        require(environment.run(environment.program("xacro"), str(ROBOTS / "arm/arm.urdf.xacro"), "-o", str(urdf)))
        require(environment.run(environment.program("linkforge"), "import", str(urdf), "-o", str(spec)))
        text = spec.read_text("utf-8")
        if STIFFNESS not in text:
            sys.exit(f"{spec} has no '{STIFFNESS}'")
        text = text.replace(STIFFNESS, "k_position: $(stiffness)")
        spec.write_text(f"{text}\nparameters: {{stiffness: 20}}\n", "utf-8")
    return urdf, spec


def compare_on_one_core(environment: Environment, folder: Path, options: argparse.Namespace) -> Iterator[str]:
    """Yield robots a second, each side in one process after its imports: ours also writes nothing and has no table."""
    urdf, spec = make_arm(environment, folder)
    count, xacro = str(options.robots), ROBOTS / "arm/arm.urdf.xacro"
    sides = {
        "sweep": ("sweep", str(spec), "stiffness=10:30", count),
        "sweep, files read anew": ("sweep-files-anew", str(spec), "stiffness=10:30", count),
        "xacro": ("xacro-loop", str(xacro), "safety_stiffness", count),
        "linkforge-core": ("core-loop", str(urdf), count),
    }
    yield from compare_sides("core", sides, environment, options)


def compare_modules(environment: Environment, _folder: Path, options: argparse.Namespace) -> Iterator[str]:
    """Yield robots a second of a robot of eight modules, of which no swept parameter reaches five."""
    count = str(options.robots)
    sides = {
        "sweep": ("sweep", str(MANIPULATOR), TORSO, count),
        "sweep, modules made anew": ("sweep-modules-anew", str(MANIPULATOR), TORSO, count),
    }
    yield from compare_sides("modules", sides, environment, options)


def compare_sides(
    row: str, sides: dict[str, tuple[str, ...]], environment: Environment, options: argparse.Namespace
) -> Iterator[str]:
    """Run the actions of worker.py in turns, and yield the robots a second of each, and its ratio to the first."""
    times: dict[str, list[float]] = {name: [] for name in sides}
    for number in range(options.rounds + 1):
        for name, action in sides.items():
            with environment.worker(*action) as worker:
                sample = worker.measure()
            if number:
                times[name].append(sample.processor)
    for name, seconds in times.items():
        ratio = median(times["sweep"]) / median(seconds)
        cost = f"{options.robots / median(seconds):8.1f} robots a second of processor time"
        yield f"{row:<7} {name:<24} {cost}; a sweep takes {ratio:.2f} times that"


class Run(NamedTuple):
    """What a run of the command took."""

    wall: float
    """[s]"""
    processor: float
    """Of all its processes [s]."""
    client: float
    """Peak memory of the command [MB]."""
    other: float
    """Peak memory of its largest other process [MB]."""


def compare_cores(environment: Environment, folder: Path, options: argparse.Namespace) -> Iterator[str]:
    """Yield how much faster two processes are than one, without the start of the processes."""
    _, spec = make_arm(environment, folder)
    # The same cluster with another number of robots; a difference of two sizes leaves the start out.
    sizes, robots = (6 * options.robots, options.robots), 5 * options.robots
    pairs: dict[int, list[list[Run]]] = {1: [], 2: []}
    for _ in range(options.rounds):
        for jobs, measured in pairs.items():
            measured.append([run_sweep(environment, folder, spec, f"stiffness=10:30:{size}", jobs) for size in sizes])
    wall, processor = (
        [median(getattr(long, name) - getattr(short, name) for long, short in measured) for measured in pairs.values()]
        for name in ("wall", "processor")
    )
    rate = f"{robots / wall[0]:.1f} robots a second in one process, {robots / wall[1]:.1f} in two"
    yield f"cores   {rate}: {wall[0] / wall[1]:.2f} times (at least 1.8)"
    cost = [1000 * seconds / robots for seconds in processor]
    costs = f"{cost[0]:.2f} ms of processor time a robot in one process, {cost[1]:.2f} ms in all of two"
    yield f"cores   {costs}: {2 * cost[0] / cost[1]:.2f} times while both cores are busy"


def compare_memory(environment: Environment, folder: Path, options: argparse.Namespace) -> Iterator[str]:
    """Yield the peak memory of the client and of its largest other process, for sweeps of small robots."""
    spec = folder / "small.robot.yaml"
    spec.write_text(SMALL, "utf-8")
    for count in map(int, options.counts.split(",")):
        run = run_sweep(environment, folder, spec, f"reach=0.2m:2m:{count}", os.cpu_count() or 1, pack="tar")
        yield (
            f"memory  {count:7,} robots: client {run.client:.0f} MB, largest other process {run.other:.0f} MB; "
            f"{run.wall:.0f} s, {count / run.wall:.0f} a second"
        )


def run_sweep(environment: Environment, folder: Path, spec: Path, values: str, jobs: int, *, pack: str = "") -> Run:
    """Run the command."""
    out = folder / "out"
    shutil.rmtree(out, ignore_errors=True)
    words = ["sweep", str(spec), "--set", values, "-o", str(out), "--jobs", str(jobs), "--quiet"]
    words += ["--pack", pack] if pack else ["--table-only"]
    begin, before = time.perf_counter(), processor_time_of_children()
    with subprocess.Popen([*environment.prefix, environment.program("linkforge"), *words]) as process:
        peaks = watch(process)
    if process.returncode:
        sys.exit(f"exit code {process.returncode} of linkforge {' '.join(words)}")
    client = peaks.pop(process.pid, 0.0)
    wall, processor = time.perf_counter() - begin, processor_time_of_children() - before
    return Run(wall, processor, client, max(peaks.values(), default=0.0))


def processor_time_of_children() -> float:
    """Return the processor time of all processes that ended below this one [s]."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def watch(process: subprocess.Popen[bytes]) -> dict[int, float]:
    """Return the peak memory [MB] of a process and its descendants by number, as /proc has it, once it ends."""
    peaks: dict[int, float] = {}
    while process.poll() is None:
        parents = {int(path.name): parent_of(path) for path in Path("/proc").iterdir() if path.name.isdigit()}
        family = {process.pid}
        while more := {pid for pid, parent in parents.items() if parent in family} - family:
            family |= more
        for pid in family:
            peaks[pid] = max(peaks.get(pid, 0.0), peak_of(pid))
        time.sleep(0.2)
    return peaks


def parent_of(path: Path) -> int:
    try:
        return int((path / "stat").read_text().rpartition(")")[2].split()[1])
    except OSError:
        return 0


def peak_of(pid: int) -> float:
    try:
        lines = Path(f"/proc/{pid}/status").read_text().splitlines()
    except OSError:
        return 0.0
    return next((int(line.split()[1]) / 1000 for line in lines if line.startswith("VmHWM")), 0.0)


def require(run: subprocess.CompletedProcess[str]) -> None:
    if run.returncode:
        sys.exit(run.stderr)


if __name__ == "__main__":
    main()
