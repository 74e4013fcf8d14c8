"""The actions that the benchmarks measure, in a process of the measured environment; compare.py starts it.

    python worker.py ACTION [ARGUMENT ...]
    python worker.py describe

For each line of standard input, the action runs once, and a line of JSON answers: wall time [s], processor time [s],
and peak memory [MB] of a process. The line of input is the command of the process, as JSON; otherwise it is empty.
"""

from __future__ import annotations

import json
import os
import platform
import sys
from collections.abc import Callable
from functools import partial
from importlib import import_module
from importlib.metadata import distributions
from importlib.util import cache_from_source, find_spec
from itertools import count, pairwise
from pathlib import Path
from time import perf_counter, process_time
from types import ModuleType

Turn = Callable[[], object]
"""The work to measure; it is prepared anew for each turn, which is not measured."""


def prepare_compile(spec: str) -> Callable[[], Turn]:
    """Compile and render one spec."""
    from linkforge_compile import compile_file, render_urdf

    return lambda: lambda: render_urdf(compile_file(spec).result())


def prepare_xacro(xacro_file: str) -> Callable[[], Turn]:
    """Expand one xacro file."""
    import xacro

    return lambda: partial(xacro.process, xacro_file)


def prepare_compile_text(spec: str) -> Callable[[], Turn]:
    """Compile and render a spec with a different comment each time, so that no result can be reused."""
    from linkforge_compile import compile_text, render_urdf

    text, turns = Path(spec).read_text("utf-8"), count()

    def prepare() -> Turn:
        changed = f"# {next(turns)}\n{text}"
        return lambda: render_urdf(compile_text(changed).result())

    return prepare


def prepare_rewrite(urdf: str) -> Callable[[], Turn]:
    """Read, validate and write a URDF with linkforge-core."""
    core, text = import_module("linkforge.core"), Path(urdf).read_text("utf-8")

    def turn() -> None:
        robot = core.read_urdf(text)
        core.validate_robot(robot)
        core.URDFGenerator().generate(robot)

    return lambda: turn


def prepare_sweep(spec: str, values: str, count: str, anew: str = "") -> Callable[[], Turn]:
    """Compile and render a spec with so many values, `PARAMETER=FROM:TO`, and make the rows of the table.

    `anew` names what each robot makes anew: "files" or "modules".
    """
    from linkforge_compile.load import spec_tree
    from linkforge_compile.sweep.plan import Choice, plan_of
    from linkforge_compile.sweep.store import Chunk
    from linkforge_compile.sweep.work import Request, make

    plan = plan_of(Request(spec, "robot"), Choice((f"{values}:{count}",)))
    points = plan.points_of(Chunk(0, plan.size))
    modules = None if anew else plan.request.new_cache()

    def turn() -> None:
        for point in points:
            if anew == "files":
                spec_tree._cache = spec_tree._TreeCache()
            if make(plan.request, point, cache=modules).row["errors"]:
                sys.exit(f"{spec} has errors")

    make(plan.request, points[0], cache=modules)
    return lambda: turn


def prepare_xacro_loop(xacro_file: str, argument: str, count: str) -> Callable[[], Turn]:
    """Expand a xacro file with so many values of an argument."""
    import xacro

    def turn() -> None:
        for number in range(int(count)):
            xacro.process(xacro_file, mappings={argument: str(10 + 20 * number / int(count))})

    xacro.process(xacro_file)
    return lambda: turn


def prepare_core_loop(urdf: str, count: str) -> Callable[[], Turn]:
    """Read, validate and write a URDF with linkforge-core so many times."""
    turn = prepare_rewrite(urdf)()
    turn()

    def turns() -> None:
        for _ in range(int(count)):
            turn()

    return lambda: turns


def prepare_merge(library: str, modules: str, links: str) -> Callable[[], Turn]:
    """Merge copies of one module into a robot, with our core or that of linkforge-core."""
    core = import_module(library)

    def prepare() -> Turn:
        module, robot = make_module(core, int(links)), core.Robot("station")
        robot.add_link(core.Link("floor"))

        def turn() -> None:
            for number in range(int(modules)):
                robot.merge(module, "floor", f"mount{number}", prefix=f"m{number}_")

        return turn

    return prepare


def make_module(core: ModuleType, links: int) -> object:
    """Return a chain of links with shapes, masses, a motor for each joint, groups and disabled pairs."""
    robot = core.Robot("arm")
    steel = core.Material("steel", core.Color(0.6, 0.6, 0.65))
    robot.materials["steel"] = steel
    names = [f"link{number}" for number in range(links)]
    for name in names:
        shape = core.Cylinder(0.05, 0.3)
        inertial = core.Inertial(1.5, core.Transform(), core.InertiaTensor(0.01, 0.01, 0.002))
        robot.add_link(core.Link(name, inertial, core.LinkPhysics(), [core.Visual(shape, core.Transform(), steel)]))
        robot.link(name).add_collision(core.Collision(shape, core.Transform()))
    for parent, child in pairwise(names):
        axis, limits = core.Vector3(0.0, 0.0, 1.0), core.JointLimits(-1.0, 1.0, 50.0, 2.0)
        joint = f"{parent}_to_{child}"
        robot.add_joint(core.Joint(joint, core.JointType.REVOLUTE, parent, child, core.Transform(), axis, limits))
        robot.add_transmission(core.Transmission.create_simple(f"{joint}_drive", joint))
        robot.disable_collisions(parent, child)
    robot.add_group("arm", base_link=names[0], tip_link=names[-1])
    return robot


ACTIONS: dict[str, Callable[..., Callable[[], Turn]]] = {
    "compile": prepare_compile,
    "xacro": prepare_xacro,
    "compile-text": prepare_compile_text,
    "rewrite-urdf": prepare_rewrite,
    "merge": prepare_merge,
    "sweep": prepare_sweep,
    "sweep-files-anew": partial(prepare_sweep, anew="files"),
    "sweep-modules-anew": partial(prepare_sweep, anew="modules"),
    "xacro-loop": prepare_xacro_loop,
    "core-loop": prepare_core_loop,
}


def run_process(command: list[str]) -> tuple[float, float, float]:
    """Run a process to its end; return its wall time [s], processor time [s] and peak memory [MB]."""
    # A process inherits the peak memory of its parent, so this one must be small.
    silent = [(os.POSIX_SPAWN_OPEN, 1, os.devnull, os.O_WRONLY, 0)]
    start = perf_counter()
    pid = os.posix_spawn(command[0], command, os.environ, file_actions=silent)
    _, status, usage = os.wait4(pid, 0)
    wall = perf_counter() - start
    if status:
        sys.exit(f"exit code {os.waitstatus_to_exitcode(status)} of {' '.join(command)}")
    # The unit is kilobytes on Linux, bytes on macOS.
    return wall, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / (1e6 if sys.platform == "darwin" else 1e3)


def run_turn(turn: Turn) -> tuple[float, float, float]:
    """Run a turn in this process; return its wall time and processor time [s], and no memory."""
    start, processor_start = perf_counter(), process_time()
    turn()
    return perf_counter() - start, process_time() - processor_start, 0.0


def describe() -> dict[str, object]:
    """Return the fields of environment.Description for this environment."""

    def count_compiled(package: str) -> tuple[int, int]:
        folder = (find_spec(package) or sys.exit(f"no package {package}")).submodule_search_locations or [""]
        sources = [*Path(folder[0]).rglob("*.py")]
        return sum(Path(cache_from_source(str(source))).exists() for source in sources), len(sources)

    packages = sorted(distributions(), key=lambda one: one.name.lower())
    return {
        "python": platform.python_version(),
        "packages": {one.name: one.version for one in packages},
        "compiled": {package: count_compiled(package) for package in ("linkforge_compile", "xacro", "linkforge")},
    }


def main(action: str, *arguments: str) -> None:
    if action == "describe":
        print(json.dumps(describe()))
        return
    answers = os.fdopen(os.dup(1), "w", buffering=1)
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    prepare = None if action == "process" else ACTIONS[action](*arguments)
    for line in sys.stdin:
        sample = run_turn(prepare()) if prepare else run_process(json.loads(line))
        print(json.dumps(sample), file=answers)


if __name__ == "__main__":
    main(*sys.argv[1:])
