"""How long merging takes: 200 modules of 10 links into one robot, ours beside LinkForge's where that is installed.

python benchmarks/merge.py [--modules 200] [--links 10] [--rounds 5]
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from functools import partial
from importlib import import_module
from importlib.util import find_spec
from itertools import pairwise
from time import process_time
from types import ModuleType

from timing import medians

LIBRARIES = {"ours": "linkforge_compile.core", "linkforge-core": "linkforge.core"}


def module_of(core: ModuleType, links: int) -> object:
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


def seconds_to_merge(core: ModuleType, modules: int, links: int) -> float:
    module = module_of(core, links)
    robot = core.Robot("station")
    robot.add_link(core.Link("floor"))
    start = process_time()
    for number in range(modules):
        robot.merge(module, "floor", f"mount{number}", prefix=f"m{number}_")
    assert len(robot.links) == modules * links + 1
    assert len(robot.semantic.groups) == modules
    return process_time() - start


def merges(modules: int, links: int) -> dict[str, Callable[[], float]]:
    """Return what measures each library that is installed."""
    installed = {label: name for label, name in LIBRARIES.items() if find_spec(name.partition(".")[0]) is not None}
    return {label: partial(seconds_to_merge, import_module(name), modules, links) for label, name in installed.items()}


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for option, default in (("--modules", 200), ("--links", 10), ("--rounds", 5)):
        arguments.add_argument(option, type=int, default=default)
    options = arguments.parse_args()
    taken = medians(options.rounds, merges(options.modules, options.links))
    print(f"{options.modules} modules of {options.links} links, median of {options.rounds}")
    for label, seconds in taken.items():
        print(f"{label:<14} {seconds * 1000:10.1f} ms {seconds / taken['ours']:8.1f} x")


if __name__ == "__main__":
    main()
