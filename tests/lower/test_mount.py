"""`mount`: the joint that attaches a file to the file that uses it."""

from pathlib import Path

import pytest

from linkforge_compile import Robot, Severity, compile_file, compile_text

LEG = """\
linkforge: 1
name: leg
links: {hip: , foot: }
joints: {ankle: {type: fixed, parent: hip, child: foot}}
mount: {hip_joint: {type: revolute, child: hip, axis: x, limits: {lower: -1, upper: 1, effort: 9, velocity: 3}}}
semantic:
  groups: {leg: {joints: [hip_joint]}}
  group_states: {leg: {up: {hip_joint: 1}}}
"""


def ends(robot: Robot) -> list[tuple[str, str, str]]:
    return [(joint.name, joint.parent, joint.child) for joint in robot.joints]


def use(folder: Path, text: str) -> Robot:
    (folder / "leg.robot.yaml").write_text(LEG)
    return compile_text(f"linkforge: 1\nname: walker\n{text}", folder=folder).result()


def test_alone_it_hangs_on_a_world_that_is_made_as_the_first_link():
    robot = compile_text(LEG).result()
    assert robot.links.names == ("world", "hip", "foot")
    assert ends(robot)[0] == ("hip_joint", "world", "hip")
    assert robot.root_link.name == "world"


def test_a_declared_world_is_used():
    robot = compile_text(LEG.replace("{hip: , foot: }", "{hip: , foot: , world: }")).result()
    assert robot.links.names == ("world", "hip", "foot")
    assert ends(robot)[0] == ("hip_joint", "world", "hip")


def test_used_it_is_the_connecting_joint_with_the_prefix_at_the_instances_origin(tmp_path):
    robot = use(tmp_path, "links: {trunk: }\nmodules: {left: {use: leg.robot.yaml, parent: trunk, origin: [0, 2, 0]}}")
    assert ends(robot) == [("left_ankle", "left_hip", "left_foot"), ("left_hip_joint", "trunk", "left_hip")]
    hip = robot.joints["left_hip_joint"]
    assert (hip.origin.xyz.y, hip.limits.effort) == (2.0, 9.0)
    assert robot.semantic.groups[0].joints == ("left_hip_joint",)


def test_without_a_parent_it_is_handed_on(tmp_path):
    (tmp_path / "leg.robot.yaml").write_text(LEG)
    (tmp_path / "shod.robot.yaml").write_text(
        "linkforge: 1\nname: shod\nmodules: {bare: {use: leg.robot.yaml}}\n"
        "links: {shoe: }\njoints: {lace: {type: fixed, parent: bare_foot, child: shoe}}\n"
    )
    alone = compile_file(tmp_path / "shod.robot.yaml").result()
    assert ("bare_hip_joint", "world", "bare_hip") in ends(alone)
    robot = use(tmp_path, "links: {trunk: }\nmodules: {left: {use: shod.robot.yaml, parent: trunk}}")
    assert ("left_bare_hip_joint", "trunk", "left_bare_hip") in ends(robot)
    assert "world" not in robot.links


def test_an_override_patches_it(tmp_path):
    override = "override: {mount: {hip_joint: {limits: {effort: 20}}}}"
    robot = use(tmp_path, f"links: {{trunk: }}\nmodules: {{left: {{use: leg.robot.yaml, parent: trunk, {override}}}}}")
    assert robot.joints["left_hip_joint"].limits.effort == 20.0


def test_its_parent_is_found_where_its_module_is_used(tmp_path):
    robot = use(tmp_path, "links: {trunk: }\nmodules: {left: {use: leg.robot.yaml, parent: trunk, origin: [0, 2, 0]}}")
    source = robot.joints["left_hip_joint"].source
    places = [(Path(place.file.name).name, place.line) for place in map(source.at, ("parent", "origin", "child"))]
    assert places == [("<text>", 4), ("<text>", 4), ("leg.robot.yaml", 5)]


@pytest.mark.parametrize(
    ("leg", "expected"),
    [
        ("parent: trunk, override: {joints: {ankle: null}}", ["LF5404"]),
        ("parent: trunk, prefix: right_", ["LF4106"]),
        ("origin: [0, 1, 0]", ["LF5301"]),
        ("joint: hip", ["LF5301"]),
    ],
)
def test_an_error_in_a_robot_is_not_reported_at_references_to_it(tmp_path, leg, expected):
    (tmp_path / "leg.robot.yaml").write_text(LEG)
    right = "right: {use: leg.robot.yaml, parent: trunk}"
    text = f"linkforge: 1\nname: w\nlinks: {{trunk: }}\nmodules: {{{right}, left: {{use: leg.robot.yaml, {leg}}}}}"
    compiled = compile_text(text, folder=tmp_path)
    assert [one.code.id for one in compiled.diagnostics if one.severity is Severity.ERROR] == expected


def test_a_module_without_parent_is_reported_with_its_written_links(tmp_path):
    (tmp_path / "leg.robot.yaml").write_text(LEG)
    text = "linkforge: 1\nname: w\nlinks: {trunk: }\nmodules: {left: {use: leg.robot.yaml}}"
    (message,) = [
        one.message for one in compile_text(text, folder=tmp_path).diagnostics if one.severity is Severity.ERROR
    ]
    assert message.startswith("the robot has 2 roots, 'trunk' and 'left_hip'")


def test_a_mount_joint_is_not_a_link(tmp_path):
    (tmp_path / "leg.robot.yaml").write_text(LEG)
    joints = "joints: {weld: {type: fixed, parent: left_hip_joint, child: box}}"
    text = f"links: {{trunk: , box: }}\n{joints}\nmodules: {{left: {{use: leg.robot.yaml, parent: trunk}}}}"
    compiled = compile_text(f"linkforge: 1\nname: w\n{text}", folder=tmp_path)
    assert [one.code.id for one in compiled.diagnostics if one.severity is Severity.ERROR] == ["LF4102"]
