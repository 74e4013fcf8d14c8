"""Beside linkforge-core, where that is installed: the same calls, the same answers."""

import inspect
from types import ModuleType

import pytest

from linkforge_compile import core as ours

theirs = pytest.importorskip("linkforge.core")

BUILDERS = ("RobotBuilder", "LinkBuilder")


def built(core: ModuleType) -> object:
    builder = core.RobotBuilder("r").material("steel", (0.1, 0.2, 0.3, 1)).ros2_control("system", "fake/Plugin")
    with builder.link("base").visual(core.box(1, 1, 1), material="steel").collision().mass(2.0):
        arm = builder.link("arm").revolute((0, 0, 2), (-1, 1)).visual(core.cylinder(0.1, 0.4)).mass(1.0)
        arm.transmission().ros2_control(["position"], ["position"]).camera("camera")
    builder.link("tip", parent="base").fixed().commit()
    builder.semantic.group("g", joints=["base_to_arm"]).group_state("home", "g", {"base_to_arm": 0.5})
    robot = core.Robot("main", links=[core.Link("floor")])
    component = builder.build()
    return robot.merge(component, "floor", "left", prefix="l_").merge(component, "floor", "right", prefix="r_")


@pytest.mark.parametrize(
    "answer",
    [
        str,
        lambda robot: robot.summary(),
        lambda robot: [link.name for link in robot.links],
        lambda robot: [str(joint.axis) for joint in robot.joints],
        lambda robot: [link.inertia.ixx for link in robot.links],
        lambda robot: robot.graph.get_topological_link_names(),
        lambda robot: [joint.name for joint in robot.graph.get_topological_joints()],
        lambda robot: [(state.name, dict(state.joint_values)) for state in robot.semantic.group_states],
        lambda robot: [(t.name, t.joints[0].mechanical_reduction, t.actuators[0].name) for t in robot.transmissions],
    ],
)
def test_one_script_gives_one_robot(answer):
    assert answer(built(ours)) == answer(built(theirs))


@pytest.mark.parametrize("name", BUILDERS)
def test_builders_take_the_same_arguments(name):
    def signatures(cls: type) -> dict[str, list[tuple[str, object]]]:
        return {
            method: [(each.name, each.default) for each in inspect.signature(function).parameters.values()]
            for method, function in inspect.getmembers(cls, inspect.isfunction)
            if not method.startswith("_") and method != "physics"
        }

    mine, others = signatures(getattr(ours, name)), signatures(getattr(theirs, name))
    assert {method: mine[method] for method in others} == others
