"""What the benchmarks time, in a process of the environment that is measured; compare.py starts it.

    python worker.py ACTION [ARGUMENT ...]

For each line of standard input, the action runs once, and a line of JSON answers: wall time [s], time of the processor
[s], and peak memory [MB] of a whole process. The line is what a process is to run, as JSON; otherwise it is empty.
"""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable
from functools import partial
from importlib import import_module
from itertools import count, pairwise
from pathlib import Path
from time import perf_counter, process_time
from types import ModuleType

Turn = Callable[[], object]
"""What is timed; each turn is prepared anew, outside the time that counts."""


def prepare_compile(spec: str) -> Callable[[], Turn]:
    """Compile and render one spec."""
    from linkforge_compile import compile_file, render_urdf

    return lambda: lambda: render_urdf(compile_file(spec).result())


def prepare_xacro(xacro_file: str) -> Callable[[], Turn]:
    """Expand one xacro file."""
    import xacro

    return lambda: partial(xacro.process, xacro_file)


def prepare_compile_text(spec: str) -> Callable[[], Turn]:
    """Compile and render a spec that differs each time by a comment, so that no earlier result serves."""
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


def prepare_merge(library: str, modules: str, links: str) -> Callable[[], Turn]:
    """Merge copies of one module into a robot, with our core or linkforge-core's."""
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
    """Return a chain of links with what a module has: shapes, mass, a motor for each joint, groups and pairs."""
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
}


def run_process(command: list[str]) -> tuple[float, float, float]:
    """Run a process to its end; return its wall time [s], processor time [s] and peak memory [MB]."""
    # A process inherits the peak memory of the one that starts it, and this one is small.
    silent = [(os.POSIX_SPAWN_OPEN, 1, os.devnull, os.O_WRONLY, 0)]
    start = perf_counter()
    pid = os.posix_spawn(command[0], command, os.environ, file_actions=silent)
    _, status, usage = os.wait4(pid, 0)
    wall = perf_counter() - start
    if status:
        sys.exit(f"exit code {os.waitstatus_to_exitcode(status)} of {' '.join(command)}")
    # Linux counts in kilobytes, macOS in bytes.
    return wall, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / (1e6 if sys.platform == "darwin" else 1e3)


def run_turn(turn: Turn) -> tuple[float, float, float]:
    """Run a turn in this process; return its wall time and processor time [s], and no memory."""
    start, processor_start = perf_counter(), process_time()
    turn()
    return perf_counter() - start, process_time() - processor_start, 0.0


def main(action: str, *arguments: str) -> None:
    answers = os.fdopen(os.dup(1), "w", buffering=1)
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    prepare = None if action == "process" else ACTIONS[action](*arguments)
    for line in sys.stdin:
        sample = run_turn(prepare()) if prepare else run_process(json.loads(line))
        print(json.dumps(sample), file=answers)


if __name__ == "__main__":
    main(*sys.argv[1:])
