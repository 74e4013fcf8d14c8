"""`linkforge_compile.launch` with the launch packages of ROS 2, or stand-ins if there is no ROS."""

import gc
import importlib
import importlib.util
import logging
import os
import re
import runpy
import shutil
import sys
import weakref
from collections.abc import Iterable, Iterator
from pathlib import Path
from types import ModuleType
from typing import NamedTuple

import pytest
import yaml
from lxml import etree

from linkforge_compile import CompileError, formats
from linkforge_compile.cli.main import main
from tests.conftest import ROOT
from tests.formats.example_formats import Folder, Joints

STAND_INS = Path(__file__).parent / "stand_ins"
ROS = {path.name for path in STAND_INS.iterdir() if path.is_dir()}

SPEC = """\
linkforge: 1
name: arm
parameters:
  reach: {type: length, default: 50 cm, minimum: 10 cm, maximum: 2 m, description: From base to tip.}
  width: {type: length, default: $(reach / 10)}
  hardware: {type: string, enum: [mock, real], default: mock, description: What drives it.}
  axes: {type: integer, enum: [1, 2], default: 1}
  step: {type: length, enum: [10 mm, 20 mm], default: 10 mm}
  camera: {type: boolean, default: true}
  serial: {type: string}
variants:
  long: {reach: 1 m}
links:
  base: {visual: {sphere: 0.1, name: $(serial)}}
  rod: {visual: {box: [$(reach), $(width), $(step)], name: $(hardware)}}
  eye: {when: $(camera)}
joints:
  turn: {type: fixed, parent: base, child: rod}
  look: {when: $(camera), type: fixed, parent: rod, child: eye}
semantic: {groups: {all: {links: [base]}}}
"""


class Ros(NamedTuple):
    """The module under test, and the stand-ins for ROS."""

    ours: ModuleType
    launch: ModuleType


@pytest.fixture
def ros(monkeypatch: pytest.MonkeyPatch) -> Iterator[Ros]:
    if importlib.util.find_spec("launch_ros") is None:
        monkeypatch.syspath_prepend(STAND_INS)
    yield Ros(importlib.import_module("linkforge_compile.launch"), importlib.import_module("launch"))
    for name in [*sys.modules]:
        if name.partition(".")[0] in ROS or name.startswith("linkforge_compile.launch"):
            del sys.modules[name]


@pytest.fixture
def spec(tmp_path: Path) -> Path:
    path = tmp_path / "arm.robot.yaml"
    path.write_text(SPEC)
    return path


def launched(ros: Ros, robot: object, /, **typed: str) -> object:
    """Return the context of a launch after the robot's arguments, with the given ones."""
    return launch_with(ros, robot.arguments, **typed)


def launch_with(ros: Ros, arguments: Iterable[object], /, **typed: str) -> object:
    context = ros.launch.LaunchContext()
    context.launch_configurations.update(typed)
    for argument in arguments:
        argument.execute(context)
    return context


def parameters_of(context: object, parameters: object) -> tuple[object, ...]:
    """Return what a node gets of its parameters: maps, and paths of files."""
    utilities = importlib.import_module("launch_ros.utilities")
    return utilities.evaluate_parameters(context, utilities.normalize_parameters(parameters))


def parameter_of(context: object, parameters: object, name: str) -> str:
    """Return the text of a parameter of a node, of which `parameters` are those that it was made with."""
    (values,) = parameters_of(context, parameters)
    return values[name]


def robot_description_of(context: object, publisher: object) -> str:
    """Return the URDF that a node of a launch file gets."""
    (values,) = evaluated(context, publisher)
    return values["robot_description"]


def evaluated(context: object, node: object) -> tuple[object, ...]:
    """Return the parameters of a node of a launch file; ROS has no public attribute for them."""
    return importlib.import_module("launch_ros.utilities").evaluate_parameters(context, node._Node__parameters)


def box_of(urdf: str) -> str:
    return etree.fromstring(urdf.encode()).find(".//box").get("size")


def test_every_parameter_is_a_launch_argument(ros: Ros, spec: Path):
    arguments = {one.name: one for one in ros.ours.RobotDescription(spec).arguments}
    assert list(arguments) == ["reach", "width", "hardware", "axes", "step", "camera", "serial"]
    assert arguments["reach"].description == "From base to tip. (length, 0.1 m to 2 m)"
    assert arguments["reach"].default_value[0].text == "50 cm"
    assert (arguments["hardware"].description, arguments["hardware"].choices) == (
        "What drives it. (string). Valid choices are: ['mock', 'real']",
        ["mock", "real"],
    )
    assert arguments["axes"].choices == ["1", "2"]
    assert (arguments["step"].description, arguments["step"].choices) == ("(length, 0.01 m | 0.02 m)", None)
    assert arguments["serial"].default_value is None


def test_what_is_typed_at_a_launch_is_what_is_compiled(ros: Ros, spec: Path):
    robot = ros.ours.RobotDescription(spec)
    context = launched(ros, robot, serial="A1", reach="2 m", step="20 mm", camera="False")
    urdf = robot.urdf.perform(context)
    assert box_of(urdf) == "2 0.2 0.02"
    assert 'name="A1"' in urdf
    assert 'link name="eye"' not in urdf


def test_defaults_stay_the_specs_affair(ros: Ros, spec: Path):
    """So a default that is computed follows what is typed, and a variant sets what is not."""
    robot = ros.ours.RobotDescription(spec, {"serial": "A1"}, variant="long")
    assert box_of(robot.urdf.perform(launched(ros, robot))) == "1 0.1 0.01"
    assert box_of(robot.urdf.perform(launched(ros, robot, reach="50 cm"))) == "0.5 0.05 0.01"


def test_what_the_launch_file_sets_is_no_argument(ros: Ros, spec: Path):
    configuration = importlib.import_module("launch.substitutions").LaunchConfiguration("robot")
    given = {"serial": ["unit-", configuration], "camera": False, "reach": 2.0, "axes": 2}
    robot = ros.ours.RobotDescription(spec, given)
    assert [one.name for one in robot.arguments] == ["width", "hardware", "step"]
    urdf = robot.urdf.perform(launched(ros, robot, robot="7", reach="not asked for"))
    assert 'name="unit-7"' in urdf
    assert box_of(urdf) == "2 0.2 0.01"
    assert 'link name="eye"' not in urdf


def test_two_robots_in_one_launch_file_have_arguments_of_their_own(ros: Ros, spec: Path):
    left = ros.ours.RobotDescription(spec, {"serial": "L"}, argument_prefix="left_")
    right = ros.ours.RobotDescription(spec, {"serial": "R"}, argument_prefix="right_")
    assert left.arguments[0].name == "left_reach"
    context = launched(ros, left, left_reach="2 m")
    for argument in right.arguments:
        argument.execute(context)
    assert box_of(left.urdf.perform(context)).startswith("2 ")
    assert box_of(right.urdf.perform(context)).startswith("0.5 ")


def test_a_node_gets_texts_and_no_yaml(ros: Ros, spec: Path):
    robot = ros.ours.RobotDescription(spec, {"serial": "A1"})
    context = launched(ros, robot)
    urdf = parameter_of(context, [robot.description], "robot_description")
    srdf = parameter_of(context, [robot.semantic], "robot_description_semantic")
    assert etree.fromstring(urdf.encode()).find("link").get("name") == "base"
    assert etree.fromstring(srdf.encode()).find("group").get("name") == "all"


def test_a_fault_fails_the_launch_and_is_reported_at_its_place(ros: Ros, spec: Path):
    robot = ros.ours.RobotDescription(spec, {"serial": "A1"})
    context = launched(ros, robot, reach="3 m")
    failure = importlib.import_module("launch.substitutions").SubstitutionFailure
    with pytest.raises(failure, match=r"(?s)has errors:.*reach.*\[LF\d{4}\]"):
        robot.urdf.perform(context)


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ({"serial": "A1"}, "<launch argument>:1:13: error: parameter 'reach'"),
        ({"serial": "A1", "reach": 3}, "<launch file>:1:8: error: parameter 'reach'"),
    ],
)
def test_a_wrong_value_is_reported_in_the_form_of_a_launch_argument(
    ros: Ros, spec: Path, given: dict[str, object], expected: str
):
    robot = ros.ours.RobotDescription(spec, given, argument_prefix="left_")
    failure = importlib.import_module("launch.substitutions").SubstitutionFailure
    with pytest.raises(failure) as caught:
        robot.urdf.perform(launched(ros, robot, left_reach="3 m"))
    assert expected in str(caught.value)
    assert "command line" not in str(caught.value)


def test_a_variant_may_be_known_at_the_launch_only(ros: Ros, spec: Path):
    chosen = importlib.import_module("launch.substitutions").LaunchConfiguration("size")
    robot = ros.ours.RobotDescription(spec, {"serial": "A1"}, variant=chosen)
    assert box_of(robot.urdf.perform(launched(ros, robot, size="long"))) == "1 0.1 0.01"
    assert box_of(robot.urdf.perform(launched(ros, robot, size=""))) == "0.5 0.05 0.01"


def test_a_list_with_a_number_is_a_vector(ros: Ros, tmp_path: Path):
    path = tmp_path / "box.robot.yaml"
    path.write_text(
        "linkforge: 1\nname: box\nparameters: {size: {type: vector, default: [1, 1, 1]}}\n"
        "links: {base: {visual: {box: $(size)}}}\n"
    )
    height = importlib.import_module("launch.substitutions").LaunchConfiguration("height")
    robot = ros.ours.RobotDescription(path, {"size": [2, 0.5, height]})
    assert box_of(robot.urdf.perform(launched(ros, robot, height="0.25"))) == "2 0.5 0.25"


def test_an_invalid_launch_value_is_reported_with_its_parameter(ros: Ros, spec: Path):
    with pytest.raises(TypeError, match=r"'reach' takes text, a number, .*; found {'a': 1}"):
        ros.ours.RobotDescription(spec, {"reach": {"a": 1}})


def test_a_launch_compiles_once_and_logs_diagnostics(
    ros: Ros, spec: Path, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
):
    warned = SPEC.replace("sphere: 0.1", "capsule: {radius: 0.1, length: 1}")
    spec.write_text(f"{warned}# linkforge: ignore LF6003\n")  # nothing there, which is a note
    module, compiled = importlib.import_module(ros.ours.RobotDescription.__module__), []
    compile_file = module.compile_file
    monkeypatch.setattr(
        module, "compile_file", lambda *words, **more: compiled.append(1) or compile_file(*words, **more)
    )
    robot = ros.ours.RobotDescription(spec, {"serial": "A1"})
    context = launched(ros, robot)
    with caplog.at_level(logging.INFO):
        for _ in range(2):
            robot.srdf.perform(context)
            robot.urdf.perform(context)
    assert len(compiled) == 1
    records = {record.levelname: record.message for record in caplog.records}
    assert len(caplog.records) == len(records) == 2, caplog.messages
    assert "arm.robot.yaml:14:" in records["WARNING"]
    assert "[LF7002]" in records["WARNING"]
    assert "note: " in records["INFO"]
    assert ": note: " not in records["WARNING"]
    robot.urdf.perform(launched(ros, robot))
    assert len(compiled) == 2, "another launch is told as well"


def test_a_launch_has_the_text_of_any_format_and_a_file_with_it(
    ros: Ros, spec: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
):
    monkeypatch.setattr(formats, "FORMATS", (*formats.FORMATS, Joints(), Folder()))
    robot = ros.ours.RobotDescription(spec, {"serial": "A1"}, options={"base": "free", "case": "upper"})
    mjcf, links = robot.text("mjcf"), robot.file("folder", "links.txt")
    assert (mjcf.describe(), links.describe()) == (f"MJCF of {spec}", f"FOLDER links.txt of {spec}")
    context = launched(ros, robot)
    with caplog.at_level(logging.WARNING):
        assert "<freejoint" in mjcf.perform(context)
    assert "LF74" in caplog.text, "losses are in the log"
    path = Path(links.perform(context))
    assert (path.read_text(), path.parts[-2:]) == ("links.txt\n", ("arm_config", "links.txt"))
    # After the first compile as well, and as the file of parameters of a node.
    (file,) = parameters_of(context, [robot.file("joints")])
    assert (file.name, file.read_text()) == ("arm.joints", "TURN\nLOOK\n")
    spec.write_text(SPEC.replace("turn:", "twist:"))
    assert Path(robot.file("joints").perform(context)).read_text() == "TWIST\nLOOK\n"


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("sdff",), "there is no format 'sdff'"),
        (("mjcf", "links.txt"), "the format mjcf is a single file, found 'links.txt'"),
    ],
)
def test_a_text_that_no_format_has_stops_the_launch_file(ros: Ros, spec: Path, words: tuple[str, ...], message: str):
    robot = ros.ours.RobotDescription(spec, {"serial": "A1"})
    with pytest.raises(ValueError, match=message):
        robot.text(*words)
    with pytest.raises(ValueError, match="no format has an option 'bsae'"):
        ros.ours.RobotDescription(spec, {"serial": "A1"}, options={"bsae": "free"})


def test_a_launch_that_goes_on_meets_a_spec_as_it_is_now(ros: Ros, spec: Path):
    robot = ros.ours.RobotDescription(spec, {"serial": "A1"})
    context = launched(ros, robot)
    assert 'name="A1"' in robot.urdf.perform(context)
    assert 'name="A1"' in parameter_of(context, [robot.description], "robot_description")
    spec.write_text(SPEC.replace("name: $(serial)", "name: of-$(serial)"))
    assert 'name="of-A1"' in robot.urdf.perform(context)
    assert 'name="of-A1"' in parameter_of(context, [robot.description], "robot_description")


def test_each_launch_has_its_own_parameters(ros: Ros, spec: Path):
    robot = ros.ours.RobotDescription(spec)
    for serial in ("A1", "A2"):
        context = launched(ros, robot, serial=serial)
        assert f'name="{serial}"' in parameter_of(context, [robot.description], "robot_description")


def test_a_launch_that_is_over_is_let_go(ros: Ros, spec: Path):
    robot = ros.ours.RobotDescription(spec, {"serial": "A1"})
    context = launched(ros, robot)
    robot.urdf.perform(context)
    over = weakref.ref(context)
    del context
    gc.collect()
    assert over() is None


def test_an_unknown_variant_is_reported_where_it_is_named(ros: Ros, spec: Path):
    with pytest.raises(ValueError, match=r"arm.robot.yaml has no variant named 'lnog'; did you mean 'long'\?$"):
        ros.ours.RobotDescription(spec, variant="lnog")
    with pytest.raises(ValueError, match=r"no variant named 'simulation'; its variants are long$"):
        ros.ours.RobotDescription(spec, variant="simulation")
    substitutions = importlib.import_module("launch.substitutions")
    robot = ros.ours.RobotDescription(spec, {"serial": "A1"}, variant=substitutions.LaunchConfiguration("size"))
    with pytest.raises(substitutions.SubstitutionFailure, match="no variant named 'logn'; did you mean 'long'"):
        robot.urdf.perform(launched(ros, robot, size="logn"))


def test_an_unknown_parameter_is_reported_where_it_is_set(ros: Ros, spec: Path):
    with pytest.raises(ValueError, match=r"arm.robot.yaml has no parameter named 'raech'; did you mean 'reach'\?$"):
        ros.ours.RobotDescription(
            spec, {"raech": importlib.import_module("launch.substitutions").LaunchConfiguration("r")}
        )
    with pytest.raises(ValueError, match=r"no parameter named 'gripper'; its parameters are reach, width, hardware, "):
        ros.ours.RobotDescription(spec, {"gripper": "none"})
    with pytest.raises(TypeError, match=r"values by name, {'NAME': VALUE}; found \[{'reach': 0.1}\]"):
        ros.ours.RobotDescription(spec, [{"reach": 0.1}])


def test_no_text_is_no_variant(ros: Ros, spec: Path):
    robot = ros.ours.RobotDescription(spec, {"serial": "A1"}, variant="")
    assert box_of(robot.urdf.perform(launched(ros, robot))).startswith("0.5 ")


def test_an_argument_without_a_value_is_reported_as_a_launch_argument(ros: Ros, spec: Path):
    robot = ros.ours.RobotDescription(spec, argument_prefix="left_")
    failure = importlib.import_module("launch.substitutions").SubstitutionFailure
    with pytest.raises(failure, match=r"launch arguments that have no value: 'left_serial'; the 'arguments' of"):
        robot.urdf.perform(ros.launch.LaunchContext())
    spec.write_text(SPEC.replace("long: {reach: 1 m}", "long: {reach: 1 m, serial: A1}"))
    robot = ros.ours.RobotDescription(spec, variant="long")
    assert 'name="A1"' in robot.urdf.perform(ros.launch.LaunchContext())


def test_a_spec_that_cannot_be_read_stops_the_launch_file(ros: Ros, tmp_path: Path):
    with pytest.raises(CompileError, match="no file"):
        ros.ours.RobotDescription(tmp_path / "hand.robot.yaml")


PAGE = (ROOT / "docs/how-to/launch.md").read_text("utf-8")
IN_PROCESS, _, BY_COMMAND = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
WARNED = SPEC.replace("sphere: 0.1", "capsule: {radius: 0.1, length: 1}")


@pytest.fixture
def described(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder for a launch file of the manual, with its package, whose spec has a warning, and the command."""
    robots, command = tmp_path / "share/arm_description/robots", tmp_path / "bin/linkforge"
    for path, text in (
        (robots / "arm.robot.yaml", WARNED),
        (command, f'#!/bin/sh\nexec "{sys.executable}" -m linkforge_compile "$@"\n'),
    ):
        path.parent.mkdir(parents=True)
        path.write_text(text)
    command.chmod(0o755)
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path))
    monkeypatch.setenv("PATH", str(command.parent), prepend=os.pathsep)
    monkeypatch.setenv("PYTHONPATH", str(ROOT), prepend=os.pathsep)
    return tmp_path


def described_by(ros: Ros, folder: Path, launch_file: str) -> str:
    """Return the `robot_description` that a launch file gives robot_state_publisher."""
    (folder / "view.launch.py").write_text(launch_file)
    file = runpy.run_path(str(folder / "view.launch.py"))
    *arguments, publisher = file["generate_launch_description"]().entities
    return robot_description_of(launch_with(ros, arguments, serial="A1"), publisher)


def test_the_launch_file_of_the_manual_describes_its_robot(ros: Ros, described: Path):
    assert 'name="real"' in described_by(ros, described, IN_PROCESS)


def test_the_command_of_the_manual_describes_a_robot_with_warnings(ros: Ros, described: Path):
    assert 'name="A1"' in described_by(ros, described, BY_COMMAND)


@pytest.mark.parametrize(("on_stderr", "is_described"), [("fail", False), ("warn", True), ("ignore", True)])
def test_a_warning_fails_the_command_unless_it_is_told_otherwise(
    ros: Ros, described: Path, on_stderr: str, is_described: bool
):
    spec = described / "share/arm_description/robots/arm.robot.yaml"
    substitutions = importlib.import_module("launch.substitutions")
    command = substitutions.Command(["linkforge compile serial:=A1 ", str(spec)], on_stderr=on_stderr)
    context = ros.launch.LaunchContext()
    if is_described:
        assert 'name="A1"' in command.perform(context)
    else:
        with pytest.raises(substitutions.SubstitutionFailure, match=r"showed stderr output.*\s.*\s.*LF7002"):
            command.perform(context)


def test_the_launch_file_of_the_examples_describes_its_robot(ros: Ros, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    share = tmp_path / "share" / "pan_tilt_description"
    shutil.copytree(ROOT / "examples" / "11_ros2_package", share)
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path))
    file = runpy.run_path(str(share / "launch" / "view.launch.py"))
    *arguments, publisher, _, _ = file["generate_launch_description"]().entities
    assert [one.name for one in arguments] == ["servo", "stalk", "camera_rate"]
    context = launch_with(ros, arguments, servo="mx28", stalk="10 cm")
    urdf = robot_description_of(context, publisher)
    assert '<origin xyz="0 -0.02 0.1"' in urdf
    assert 'effort="2.5"' in urdf


def test_the_controllers_of_the_examples_are_those_of_the_launched_robot(
    ros: Ros, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    share = tmp_path / "share" / "pan_tilt_description"
    shutil.copytree(ROOT / "examples" / "11_ros2_package", share)
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path))
    file = runpy.run_path(str(share / "launch" / "control.launch.py"))
    *arguments, _, manager, _ = file["generate_launch_description"]().entities
    description, controllers = evaluated(launch_with(ros, arguments), manager)
    assert "mock_components/GenericSystem" in description["robot_description"]
    parameters = yaml.safe_load(Path(controllers).read_text())
    assert parameters["head_controller"]["ros__parameters"]["joints"] == ["pan_turn", "tilt_turn"]


MOVEIT = ROOT / "examples" / "13_moveit_package"


@pytest.fixture
def moveit_nodes(ros: Ros, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> list[object]:
    """The nodes of the example for MoveIt, with the configuration as it is installed."""
    pytest.importorskip("moveit_configs_utils")
    share = tmp_path / "share" / "picker_moveit_config"
    shutil.copytree(MOVEIT / "launch", share / "launch")
    spec = MOVEIT / "robots" / "picker.robot.yaml"
    assert main(["compile", str(spec), "--format", "moveit", "--strict", "-o", str(share)]) == 0
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path))
    description = runpy.run_path(str(share / "launch" / "move_group.launch.py"))["generate_launch_description"]()
    return list(nodes_of(description))


def nodes_of(description: object) -> Iterator[object]:
    for entity in description.entities:
        if hasattr(entity, "entities"):
            yield from nodes_of(entity)
        elif hasattr(entity, "node_package"):
            yield entity


def test_the_launch_file_for_moveit_starts_all_that_a_plan_needs(ros: Ros, moveit_nodes: list[object]):
    context = ros.launch.LaunchContext()
    publisher, manager, arm, broadcaster, move_group, _ = moveit_nodes
    assert (arm.node_executable, broadcaster.node_executable) == ("spawner", "spawner")
    (controllers,) = evaluated(context, manager)
    loaded = yaml.safe_load(Path(controllers).read_text("utf-8"))["controller_manager"]["ros__parameters"]
    assert {"arm_controller", "joint_state_broadcaster"} <= loaded.keys()
    given, _ = evaluated(context, move_group)
    urdf, srdf = (etree.fromstring(given[f"robot_description{name}"].encode()) for name in ("", "_semantic"))
    assert evaluated(context, publisher)[0]["robot_description"] == given["robot_description"]
    joints = [joint.get("name") for joint in urdf.iter("joint") if joint.get("type") == "revolute"]
    assert given["moveit_simple_controller_manager.arm_controller.joints"] == joints
    assert given["moveit_simple_controller_manager.controller_names"] == ["arm_controller"]
    groups = [f"robot_description_kinematics.{group.get('name')}.kinematics_solver" for group in srdf.iter("group")]
    assert [given[group] for group in groups] == ["kdl_kinematics_plugin/KDLKinematicsPlugin"]
    assert all(given[f"robot_description_planning.joint_limits.{joint}.max_acceleration"] for joint in joints)
    assert given["robot_description_planning.cartesian_limits.max_trans_vel"] > 0


def test_the_package_for_moveit_depends_on_what_it_starts(moveit_nodes: list[object]):
    manifest = etree.parse(MOVEIT / "package.xml")
    packages = {one.text for one in manifest.iter("exec_depend")}
    assert {node.node_package for node in moveit_nodes} <= packages
    configuration = yaml.safe_load((MOVEIT / "robots" / "picker.robot.yaml").read_text("utf-8"))
    assert {one["type"].partition("/")[0] for one in configuration["controllers"].values()} <= packages
