"""The configuration of MoveIt: names of files as `moveit_configs_utils` reads them, and declared parameters."""

import pytest
import yaml

from linkforge_compile import compile_file, compile_text
from linkforge_compile.diagnostics.grouping import group_alike
from linkforge_compile.export_spec import write_spec
from linkforge_compile.formats import JOINT_LIMITS, MOVEIT, ROS2_CONTROLLERS, SRDF, URDF, Rendering
from tests.conftest import ROOT
from tests.formats.test_joint_limits import DECLARED as LIMITS
from tests.formats.test_ros2_controllers import ARM_GROUP, ROBOT, robot_of
from tests.ros_parameters import parameters_in, require_declared

CASE = ROOT / "tests" / "cases" / "good" / "planning" / "planning.robot.yaml"
GOLDEN = CASE.with_name("planning_moveit_config")
BANNER = "Compiled by linkforge from planning.robot.yaml; edit that file, not this one."

KINEMATICS = {
    r"\w+\.kinematics_solver": "string",
    r"\w+\.kinematics_solver_(search_resolution|timeout)": "double",
    r"\w+\.(epsilon|orientation_vs_position)": "double",
    r"\w+\.max_solver_iterations": "int",
    r"\w+\.position_only_ik": "bool",
}
MANAGER = "moveit_simple_controller_manager"
CONTROLLERS = {
    "moveit_controller_manager": "string",
    rf"{MANAGER}\.controller_names": "string_array",
    rf"{MANAGER}\.\w+\.(type|action_ns)": "string",
    rf"{MANAGER}\.\w+\.joints": "string_array",
    rf"{MANAGER}\.\w+\.(default|parallel|allow_failure)": "bool",
    rf"{MANAGER}\.\w+\.max_effort": "double",
}
POSITIONS = {r"initial_positions\..+": "double"}
CARTESIAN = {r"cartesian_limits\.max_(trans_vel|trans_acc|trans_dec|rot_vel)": "double"}


def documents(robot, **options) -> dict[str, str]:
    return {name: text for text, name, _ in MOVEIT.render(robot, Rendering(**options))}


def written(text: str, name: str) -> dict[str, object]:
    document: dict[str, object] = yaml.safe_load(documents(robot_of(text))[f"config/{name}"])
    return document


def reported(text: str) -> list[str]:
    limits = MOVEIT.limits(robot_of(text), {})
    return [f"{one.code.id} {one.message}" for one in group_alike(limits) if one.code.id >= "LF7608"]


def test_the_case_compiles_to_the_files_next_to_it(update_golden: bool):
    texts = documents(compile_file(CASE).result(), banner=BANNER)
    assert tuple(texts) == MOVEIT.files
    if update_golden:
        for name, text in texts.items():
            (GOLDEN / name).parent.mkdir(parents=True, exist_ok=True)
            (GOLDEN / name).write_text(text, "utf-8")
    assert {path.relative_to(GOLDEN).as_posix() for path in GOLDEN.rglob("*.*")} == set(texts)
    assert texts == {name: (GOLDEN / name).read_text("utf-8") for name in texts}


def test_the_builder_of_moveit_finds_its_files():
    """`MoveItConfigsBuilder("robot", package_name=…)` reads these names below the package where none is stated."""
    needed = ("robot.urdf", "robot.srdf", "kinematics.yaml", "joint_limits.yaml", "pilz_cartesian_limits.yaml")
    assert {f"config/{name}" for name in needed} <= set(MOVEIT.files)
    # Of several `*_controllers.yaml` it prefers this one; the launch file of a demo reads the other.
    assert {"config/moveit_controllers.yaml", "config/ros2_controllers.yaml"} <= set(MOVEIT.files)


@pytest.mark.parametrize(
    ("name", "declared"),
    [
        ("kinematics.yaml", KINEMATICS),
        ("joint_limits.yaml", LIMITS),
        ("moveit_controllers.yaml", CONTROLLERS),
        ("initial_positions.yaml", POSITIONS),
        ("pilz_cartesian_limits.yaml", CARTESIAN),
    ],
)
def test_moveit_declares_what_is_written(name: str, declared: dict[str, str]):
    parameters = parameters_in((GOLDEN / "config" / name).read_text("utf-8"))
    assert parameters
    require_declared(parameters, declared)


def test_the_files_of_other_formats_are_theirs():
    robot = compile_file(CASE).result()
    texts = documents(robot)
    others = {"robot.urdf": URDF, "robot.srdf": SRDF, "joint_limits.yaml": JOINT_LIMITS}
    others["ros2_controllers.yaml"] = ROS2_CONTROLLERS
    for name, other in others.items():
        assert texts[f"config/{name}"] == other.render(robot, Rendering())[0].text


def test_a_group_states_its_solver_and_keeps_it_in_a_spec():
    arm = "{chain: {base_link: base, tip_link: lower}, kinematics: {kinematics_solver: pick_ik/PickIkPlugin, "
    text = f"{ROBOT}semantic: {{groups: {{arm: {arm}mode: global, kinematics_solver_timeout: 1}}}}}}}}\n"
    expected = {
        "kinematics_solver": "pick_ik/PickIkPlugin",
        "kinematics_solver_search_resolution": 0.005,
        "kinematics_solver_timeout": 1.0,
        "mode": "global",
    }
    assert written(text, "kinematics.yaml") == {"arm": expected}
    assert type(written(text, "kinematics.yaml")["arm"]["kinematics_solver_timeout"]) is float
    assert documents(compile_text(write_spec(robot_of(text))).result()) == documents(robot_of(text))
    assert "pick_ik" not in SRDF.render(robot_of(text), Rendering())[0].text


def test_only_a_chain_that_is_no_tool_has_a_solver_by_default():
    arm = "arm: {chain: {base_link: base, tip_link: lower}}"
    groups = f"{arm}, wheels: {{joints: [left, right]}}, hand: {{joints: [elbow]}}"
    effector = "end_effectors: {hand: {group: hand, parent_link: upper}}"
    assert list(written(f"{ROBOT}semantic: {{groups: {{{groups}}}, {effector}}}\n", "kinematics.yaml")) == ["arm"]


ARM = """
defaults: {joint: {axis: y, limits: {lower: 0, upper: 1, effort: 1, velocity: 1, acceleration: 1}}}
links:
  world:
  base: &link {inertial: {mass: 1, inertia: {ixx: 1, iyy: 1, izz: 1}}}
  upper: *link
  lower: *link
  hand: *link
  eye: *link
  one: *link
  other: *link
joints:
  drive: {type: planar, parent: world, child: base}
  shoulder: {type: revolute, parent: base, child: upper}
  elbow: {type: revolute, parent: upper, child: lower}
  wrist: {type: fixed, parent: lower, child: hand}
  camera: {type: fixed, parent: lower, child: eye}
  thumb: {type: revolute, parent: hand, child: one}
  finger: {type: revolute, parent: hand, child: other, mimic: {joint: thumb}}
semantic:
  virtual_joints:
    fixed_to_map: {type: fixed, parent_frame: map, child_link: world}
    floating: {type: floating, parent_frame: odom, child_link: world}
  groups:
    upper_arm: {joints: [shoulder, elbow]}
    thumb: {joints: [wrist, thumb]}
"""


@pytest.mark.parametrize(
    ("group", "is_chain"),
    [
        ("joints: [shoulder, elbow]", True),
        ("joints: [shoulder, elbow, thumb]", True),
        ("chain: {base_link: base, tip_link: one}", True),
        ("subgroups: [thumb, upper_arm]", True),
        ("joints: [shoulder, thumb]", False),
        ("joints: [thumb, finger]", False),
        ("joints: [elbow, wrist, camera]", False),
        ("chain: {base_link: world, tip_link: hand}", False),
        ("joints: [floating, shoulder]", False),
        ("joints: [wrist]", False),
    ],
)
def test_the_default_solver_is_for_what_moveit_takes_for_a_chain(group: str, is_chain: bool):
    """Members follow each other, those that are fixed or mimic another one as well, and have at most one position."""
    text = f"{ARM}    group: {{{group}}}\n"
    assert ("group" in written(text, "kinematics.yaml")) is is_chain


def test_a_robot_without_chains_has_no_solvers():
    text = f"{ROBOT}semantic: {{groups: {{wheels: {{joints: [left, right]}}}}}}\n"
    assert written(text, "kinematics.yaml") == {}


def test_positions_are_of_the_hardware_then_of_a_state_then_the_nearest_to_0():
    text = ROBOT.replace("[velocity, position, effort]", "{position: {initial_value: 0.75}}")
    text = text.replace("axis: y, limits: {lower: 0,", "axis: y, limits: {lower: 0.25,")
    assert written(text + ARM_GROUP, "initial_positions.yaml")["initial_positions"] == {
        "shoulder": 0.75,
        "elbow": 0.25,
        "left": 0.0,
        "right": 0.0,
    }
    states = f"{ARM_GROUP.rstrip()[:-1]}, group_states: {{arm: {{home: {{shoulder: 1, elbow: 0.5}}}}}}}}\n"
    assert written(text + states, "initial_positions.yaml")["initial_positions"] == {
        "shoulder": 0.75,
        "elbow": 0.5,
        "left": 0.0,
        "right": 0.0,
    }


@pytest.mark.parametrize(
    ("replaced", "controllers", "reason"),
    [
        (
            "",
            "{w: {type: forward_command_controller/ForwardCommandController, group: wheels}, o: {type: a/B}}",
            "no controller of trajectories has 'left' and 'right'",
        ),
        (
            "left: &wheel {command_interfaces: [velocity], ",
            "{}",
            "none of its joints has a command interface in `ros2_control`",
        ),
        ("ros2_control", "{}", "the robot has no `ros2_control`; add it"),
    ],
)
def test_a_group_that_nothing_moves_is_reported_with_the_reason(replaced: str, controllers: str, reason: str):
    text = ROBOT
    if replaced == "ros2_control":
        text = text[: text.index("ros2_control")]
    elif replaced:
        text = text.replace(replaced, "left: &wheel {")
    text += f"semantic: {{groups: {{wheels: {{joints: [left, right]}}}}}}\ncontrollers: {controllers}\n"
    assert reported(text) == [f"LF7609 MoveIt cannot execute motions of group 'wheels': {reason}"]
    manager = "moveit_simple_controller_manager/MoveItSimpleControllerManager"
    assert written(text, "moveit_controllers.yaml") == {"moveit_controller_manager": manager}


def test_a_robot_without_controller_of_joint_states_is_reported():
    arm = "{type: joint_trajectory_controller/JointTrajectoryController, group: arm}"
    assert reported(f"{ROBOT}{ARM_GROUP}controllers: {{arm: {arm}}}\n") == [
        "LF7615 no controller publishes the states of the joints, which MoveIt needs; write `joint_state_broadcaster: "
        "{type: joint_state_broadcaster/JointStateBroadcaster}` in `controllers`"
    ]
    for states in ("joint_state_broadcaster/JointStateBroadcaster", "my_package/States"):
        assert reported(f"{ROBOT}{ARM_GROUP}controllers: {{arm: {arm}, states: {{type: {states}}}}}\n") == []


def test_of_controllers_with_a_joint_in_common_the_first_is_the_default():
    arm = "{type: joint_trajectory_controller/JointTrajectoryController, "
    text = f"{ROBOT}{ARM_GROUP}controllers: {{a: {arm}group: arm}}, b: {arm}joints: [elbow]}}}}\n"
    manager = written(text, "moveit_controllers.yaml")[MANAGER]
    assert (manager["a"]["default"], manager["b"]["default"]) == (True, False)


def test_misspelled_parameters_of_solvers_are_reported():
    arm = "{chain: {base_link: base, tip_link: lower}, kinematics: {kinematics_sover: pick_ik/PickIkPlugin, mode: a}}"
    assert reported(f"{ROBOT}semantic: {{groups: {{arm: {arm}}}}}\n") == [
        "LF7616 MoveIt does not read 'kinematics_sover' in the `kinematics` of a group; did you mean "
        "'kinematics_solver'?"
    ]


def test_a_chain_without_a_solver_is_reported():
    group = "{chain: {base_link: base, tip_link: lower}}"
    effector = "end_effectors: {arm: {group: arm, parent_link: base}}"
    assert reported(f"{ROBOT}semantic: {{groups: {{arm: {group}}}, {effector}}}\n") == [
        "LF7617 group 'arm' has no solver, because it is that of an end effector; write its `kinematics`"
    ]


def test_joints_without_a_command_interface_are_named():
    text = ROBOT.replace("elbow: {command_interfaces: [position], ", "elbow: {")
    assert reported(text + ARM_GROUP) == [
        "LF7609 MoveIt cannot execute motions of group 'arm': 'elbow' has no command interface in `ros2_control`"
    ]


def test_a_robot_without_groups_has_no_configuration():
    diagnostic = MOVEIT.missing(robot_of(ROBOT))
    assert diagnostic is not None
    assert diagnostic.code.id == "LF7608"


def test_each_file_has_a_source_map():
    for text, name, map_ in MOVEIT.render(compile_file(CASE).result(), Rendering(has_map=True)):
        assert map_ is not None
        assert len(map_.lines) == len(text.splitlines()) + 1, name
    rendered = MOVEIT.render(robot_of(ROBOT + ARM_GROUP), Rendering(has_map=True))
    text, _, map_ = next(one for one in rendered if one.name == "config/kinematics.yaml")
    assert map_ is not None
    place = map_.at(text.splitlines().index("arm:") + 1)
    assert place is not None
    assert place.span.text == "arm"


NEIGHBORS = """\
links:
  base: {collision: {sphere: 0.1}}
  arm: {collision: {sphere: 0.1}}
  flange:
  hand: {collision: {sphere: 0.1}}
  ball: {collision: {sphere: 0.1}}
joints:
  turn: {type: continuous, parent: base, child: arm, axis: z}
  tip: {type: fixed, parent: arm, child: flange}
  tool: {type: fixed, parent: flange, child: hand}
  throw: {type: floating, parent: base, child: ball}
semantic:
  groups: {arm: {joints: [turn]}}
"""


def undecided_pairs(semantic: str) -> list[str]:
    limits = MOVEIT.limits(robot_of(NEIGHBORS + semantic), {})
    return [one.subject for one in limits if one.code.id == "LF7704"]


def test_neighbors_without_a_pair_are_reported_at_the_section():
    assert undecided_pairs("") == ["base and arm", "arm and hand"]
    compilation = compile_text(
        f"linkforge: 1\nname: robot\n{NEIGHBORS}  disabled_collisions: {{hand: {{ball: Never}}}}\n", formats=["moveit"]
    )
    assert [str(one) for one in compilation.diagnostics if one.code.id == "LF7704"] == [
        "<text>:16:24: warning: MoveIt checks 'base and arm' for collisions, although a joint connects them; list "
        "adjacent links in `disabled_collisions`, as 'linkforge collisions SPEC --write' does; the same for 'arm and "
        "hand' [LF7704]"
    ]


@pytest.mark.parametrize(
    "semantic",
    [
        "disabled_collisions: {arm: {base: Adjacent, hand: Adjacent}}",
        "enabled_collisions: {base: {arm: }, arm: {hand: }}",
        "no_default_collision_links: [arm]",
    ],
)
def test_neighbors_whose_check_is_decided_are_not_reported(semantic: str):
    assert undecided_pairs(f"  {semantic}\n") == []
