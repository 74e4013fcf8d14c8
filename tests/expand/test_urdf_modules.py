"""Test URDF files as modules: mounted, prefixed, overridden, faults reported in the file."""

import re
from pathlib import Path
from shutil import copy

import numpy as np
import pytest

from linkforge_compile import Compilation, compile_file, compile_text, import_urdf, render_srdf, render_urdf
from linkforge_compile.diagnostics import Where
from linkforge_compile.limits import Budget, Limit
from tests.consumers import check_urdf, mujoco_model, pinocchio_model
from tests.importers.robots import CORPUS

CASES = Path(__file__).parents[1] / "cases"
BOX = '<box size="0.1 0.1 0.1"/>'
GRIPPER = """\
<robot name="gripper">
  <link name="palm">
    <visual><geometry><box size="0.1 0.1 0.1"/></geometry></visual>
    <inertial><mass value="0.5"/><inertia ixx="0.001" iyy="0.001" izz="0.001" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  <link name="finger"/>
  <joint name="slide" type="prismatic">
    <parent link="palm"/><child link="finger"/><axis xyz="1 0 0"/>
    <limit lower="0" upper="0.04" effort="20" velocity="0.1"/>
  </joint>
  <link name="pad"/>
  <joint name="slide_mimic" type="prismatic">
    <parent link="palm"/><child link="pad"/><axis xyz="-1 0 0"/>
    <limit lower="0" upper="0.04" effort="20" velocity="0.1"/><mimic joint="slide"/>
  </joint>
  <gazebo reference="finger"><mu1>0.9</mu1></gazebo>
</robot>
"""


def compiled(folder: Path, modules: str, gripper: str = GRIPPER, **options: object) -> Compilation:
    (folder / "vendor").mkdir()
    (folder / "vendor" / "gripper.urdf").write_text(gripper, "utf-8")
    spec = folder / "cell.robot.yaml"
    spec.write_text(f"linkforge: 1\nname: cell\nlinks: {{table: }}\nmodules:\n  {modules}\n", "utf-8")
    return compile_file(spec, **options)  # type: ignore[arg-type]  # passed on as they are


def texts_of(compilation: Compilation) -> list[str]:
    return [str(diagnostic) for diagnostic in compilation.diagnostics]


def test_its_names_get_the_prefix_and_its_paths_stay_relative_to_it(tmp_path):
    gripper = GRIPPER.replace(BOX, '<mesh filename="meshes/palm.stl"/>')
    robot = compiled(tmp_path, "left: {use: vendor/gripper.urdf, parent: table, origin: [0, 0, 1]}", gripper).result()
    assert [link.name for link in robot.links] == ["table", "left_palm", "left_finger", "left_pad"]
    assert robot.joint("left_slide_mimic").mimic.joint == "left_slide"
    assert robot.joint("left_joint").origin.xyz.z == 1
    assert [block.reference for block in robot.gazebo_elements] == ["left_finger"]
    assert robot.link("left_palm").visuals[0].geometry.resource == "vendor/meshes/palm.stl"


def test_one_file_serves_two_uses_each_with_its_own_override(tmp_path):
    robot = compiled(
        tmp_path,
        "left: {use: vendor/gripper.urdf, parent: table, override: {joints: {slide: {limits: {effort: 5}}}}}\n"
        "  right: {use: vendor/gripper.urdf, parent: table, override: {links: {pad: null}}}",
    ).result()
    assert [robot.joint(f"{side}_slide").limits.effort for side in ("left", "right")] == [5, 20]
    assert "left_pad" in robot.links
    assert "right_pad" not in robot.links


def test_an_unknown_name_is_reported_with_the_known_ones(tmp_path):
    [line] = texts_of(
        compiled(tmp_path, "g: {use: vendor/gripper.urdf, parent: table, override: {joints: {slid: {axis: y}}}}")
    )
    assert "did you mean 'slide'" in line


def test_it_has_no_parameters(tmp_path):
    [diagnostic] = compiled(tmp_path, "g: {use: vendor/gripper.urdf, parent: table, with: {stroke: 1}}").diagnostics
    assert diagnostic.message == "no parameter named 'stroke'"
    assert [note.message for note in diagnostic.notes] == ["this file declares no parameters"]


def test_its_faults_are_reported_in_its_file_with_the_use(tmp_path):
    gripper = GRIPPER.replace('link="finger"/><axis', 'link="fingre"/><axis')
    compilation = compiled(tmp_path, "g: {use: vendor/gripper.urdf, parent: table}", gripper)
    diagnostic = next(one for one in compilation.diagnostics if "fingre" in one.message)
    assert Path(diagnostic.span.file.name).name == "gripper.urdf"
    assert (diagnostic.span.line, diagnostic.span.column) == (8, 39)
    assert diagnostic.notes[-1].message == "used here"
    assert Path(diagnostic.notes[-1].span.file.name).name == "cell.robot.yaml"


def test_malformed_xml_is_reported_in_its_file_with_the_use(tmp_path):
    [diagnostic] = compiled(tmp_path, "g: {use: vendor/gripper.urdf, parent: table}", "<robot name='g'>").diagnostics
    assert diagnostic.code.id == "LF8001"
    assert [note.message for note in diagnostic.notes] == ["the element that is open begins here", "used here"]


def test_what_the_language_refuses_stays_raw(tmp_path):
    gripper = GRIPPER.replace(
        '<link name="pad"/>', '<link name="pad"><visual><geometry><sphere radius="0"/></geometry></visual></link>'
    )
    compilation = compiled(tmp_path, "g: {use: vendor/gripper.urdf, parent: table}", gripper)
    assert [diagnostic.code.id for diagnostic in compilation.diagnostics] == ["LF8021"]
    assert '<sphere radius="0"/>' in render_urdf(compilation.result())


SENSORS = """\
  <gazebo reference="finger">
    <sensor name="touch" type="contact">
      <contact><collision>finger_collision</collision></contact>
      <topic>touched</topic>
      <plugin name="bumper" filename="b.so"><frameName>base_link</frameName><rate>7</rate><on>palm</on></plugin>
    </sensor>
  </gazebo>
  <gazebo reference="finger">
    <!-- raw, for keys would lose the place of its text -->
    <sensor name="eye" type="camera"><a/>text<gz_frame_id>finger</gz_frame_id><topic>/seen</topic></sensor>
  </gazebo>
  <gazebo>
    <plugin name="p" filename="p.so"><topicName>state</topicName><map_frame>base_link</map_frame></plugin>
  </gazebo>
</robot>
"""


USED = "g: {use: vendor/gripper.urdf, parent: table}"


def test_names_in_sensors_take_the_prefix_where_they_are_certain(tmp_path):
    urdf = render_urdf(
        compiled(
            tmp_path, "left: {use: vendor/gripper.urdf, parent: table}", GRIPPER.replace("</robot>", SENSORS)
        ).result()
    )
    for expected in (
        '<sensor name="left_touch" type="contact">',
        "<collision>left_finger_collision</collision>",
        "<topic>left_touched</topic>",
        '<plugin name="left_bumper" filename="b.so">',
        '<sensor name="left_eye" type="camera">',
        "<gz_frame_id>left_finger</gz_frame_id>",
        "<topic>/seen</topic>",
        "<frameName>base_link</frameName>",
    ):
        assert expected in urdf


LUMP = "palm_fixed_joint_lump__finger_collision_1"


@pytest.mark.parametrize("before", ["", "<a/>text"], ids=["keys", "raw"])
def test_a_missing_collision_stays_missing_and_is_reported(tmp_path, before: str):
    contact = f"<contact>{before}<collision>{LUMP}</collision><topic>__default_topic__</topic></contact>"
    block = f'<gazebo reference="finger"><sensor name="s" type="contact">{contact}</sensor></gazebo></robot>'
    compilation = compiled(tmp_path, USED.replace("g:", "left:"), GRIPPER.replace("</robot>", block))
    urdf = render_urdf(compilation.result())
    assert f"<collision>{LUMP}</collision>" in urdf
    assert "<topic>__default_topic__</topic>" in urdf
    (message,) = [one.message for one in compilation.diagnostics if one.code.id == "LF5754"]
    assert f"no prefix: '{LUMP}';" in message


def test_topics_and_frames_that_may_be_anything_are_reported_once_with_all_of_them(tmp_path):
    gripper = GRIPPER.replace("</robot>", SENSORS)
    compilation = compiled(tmp_path, "g: {use: vendor/gripper.urdf, parent: table}", gripper)
    assert [(one.code.id, one.span.line, one.message) for one in compilation.diagnostics if one.span] == [
        (
            "LF5754",
            21,
            "plugins of this file name topics, frames or collisions, which get no prefix: "
            "'base_link', 'state', '/seen'; where the file is used, change with 'override' those that two uses must "
            "not share",
        ),
        (
            "LF5704",
            21,
            "'palm' is a link of this file and gets the prefix, but not here; change it to 'g_palm' by 'override: "
            "{links: {finger: {gazebo: {1: {properties: {sensor: {plugin: {on: ...}}}}}}}}' where this file is used",
        ),
    ]


def test_the_override_that_is_reported_reaches_the_name(tmp_path):
    gripper = GRIPPER.replace("</robot>", SENSORS)
    (one,) = (one for one in texts_of(compiled(tmp_path, USED, gripper)) if "LF5704" in one)
    [override] = re.findall("by '(override: .*)' where", one)
    (tmp_path / "again").mkdir()
    again = compiled(tmp_path / "again", USED.replace("}", f", {override.replace('...', 'g_palm')}}}"), gripper)
    assert "<on>g_palm</on>" in render_urdf(again.result())
    assert not [line for line in texts_of(again) if "LF5704" in line]


TURN = """\
  <link name="tip"/>
  <joint name="turn" type="revolute">
    <parent link="finger"/><child link="tip"/><axis xyz="1 0 0"/><limit lower="-1" upper="1"/>
  </joint>
</robot>
"""


def test_an_override_adds_missing_limits_to_the_range_of_the_file(tmp_path):
    gripper = GRIPPER.replace("</robot>", TURN)
    override = "override: {joints: {turn: {limits: {effort: 5, velocity: 1}}}}"
    compilation = compiled(tmp_path, f"g: {{use: vendor/gripper.urdf, parent: table, {override}}}", gripper)
    written = render_urdf(compilation.result()).partition('name="g_turn"')[2].partition("</joint>")[0]
    assert re.findall("<limit.*", written) == ['<limit lower="-1" upper="1" effort="5" velocity="1"/>']


def test_a_plugin_is_offered_the_joints_of_its_own_use(tmp_path):
    plugin = '<gazebo><plugin name="p" filename="p.so"><joint_name>slide</joint_name></plugin></gazebo></robot>'
    uses = "left: {use: vendor/gripper.urdf, parent: table}\n  right: {use: vendor/gripper.urdf, parent: table}"
    compilation = compiled(tmp_path, uses, GRIPPER.replace("</robot>", plugin))
    assert [one.message for one in compilation.diagnostics if one.code.id == "LF4203"] == [
        f"no joint named 'slide' for plugin '{side}_p'; did you mean '{side}_slide'?" for side in ("left", "right")
    ]


def test_topics_of_a_robot_without_prefix_are_not_reported(tmp_path):
    gripper = GRIPPER.replace("</robot>", SENSORS)
    assert not texts_of(compiled(tmp_path, "g: {use: vendor/gripper.urdf, prefix: '', parent: table}", gripper))


@pytest.mark.parametrize(("uses", "names"), [(1, []), (2, ["'image'"])])
def test_topics_of_a_spec_are_reported_where_it_is_used_again(uses: int, names: list[str], tmp_path):
    (tmp_path / "eye.robot.yaml").write_text(
        "linkforge: 1\nname: eye\nlinks: {lens: }\n"
        "extra: <a><topicName>image</topicName><frame>$(prefix)hull</frame></a>\n",
        "utf-8",
    )
    modules = "\n  ".join(f"eye{number}: {{use: eye.robot.yaml, parent: table}}" for number in range(uses))
    found = compiled(tmp_path, modules).diagnostics
    assert [re.findall("'image'|'.*hull'", one.message) for one in found if one.code.id == "LF5754"] == [
        [name] for name in names
    ]


def test_a_name_in_raw_xml_that_the_prefix_does_not_reach_is_reported_once(tmp_path):
    raw = '<sensing><of link="finger"/><again>finger</again><visual name="palm"/></sensing>'
    gripper = GRIPPER.replace("</robot>", f"{raw}</robot>")
    [diagnostic] = compiled(tmp_path, "g: {use: vendor/gripper.urdf, parent: table}", gripper).diagnostics
    assert diagnostic.code.id == "LF5704"
    assert diagnostic.message == (
        "'finger' is a link of this file and gets the prefix, but not here; "
        "change it to 'g_finger' by 'override: {extra: ...}' where this file is used, "
        "'...' being the whole element with that name in it"
    )
    assert Path(diagnostic.span.file.name).name == "gripper.urdf"


def test_an_override_replaces_a_list_and_a_text_with_several_names_as_a_whole(tmp_path):
    plugin = '<plugin name="p" filename="p.so"><on>palm</on><on>table</on><all>palm, table</all></plugin>'
    gripper = GRIPPER.replace("</robot>", f"<gazebo>{plugin}</gazebo></robot>")
    [one] = compiled(tmp_path, USED, gripper).diagnostics
    messages = " ".join((one.message, *(note.message for note in one.notes)))
    assert "{on: ...}}}}}' where this file is used, '...' being the whole list with that name in it" in messages
    assert "{all: ...}}}}}' where this file is used, '...' being the whole text with that name in it" in messages


def test_an_override_repeats_one_of_several_raw_elements(tmp_path):
    gripper = GRIPPER.replace("</robot>", '<sensing range="1"/><sensing link="finger"/></robot>')
    [one] = texts_of(compiled(tmp_path, "g: {use: vendor/gripper.urdf, parent: table}", gripper))
    assert "change it to 'g_finger' by 'override: {extra: {1: ...}}' where" in one
    (tmp_path / "again").mkdir()
    override = """override: {extra: {1: '<sensing link="g_finger"/>'}}"""
    again = compiled(tmp_path / "again", f"g: {{use: vendor/gripper.urdf, parent: table, {override}}}", gripper)
    assert not again.diagnostics
    assert render_urdf(again.result()).count('<sensing range="1"/>') == 1


def test_raw_names_that_stay_are_not_reported(tmp_path):
    gripper = GRIPPER.replace("</robot>", '<sensing link="finger"/></robot>')
    compilation = compiled(tmp_path, "g: {use: vendor/gripper.urdf, parent: table, prefix: ''}", gripper)
    assert not compilation.diagnostics


def test_its_packages_are_those_of_the_file_that_uses_it(tmp_path):
    """A URDF has no `packages`: those of the spec give the mesh for its inertia."""
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "palm.stl").write_text("solid broken", "utf-8")
    gripper = GRIPPER.replace(BOX, '<mesh filename="package://parts/palm.stl"/>')
    override = "override: {links: {palm: {inertial: {density: 1000, inertia: null}}}}"
    compilation = compiled(
        tmp_path, f"g: {{use: vendor/gripper.urdf, parent: table, {override}}}\npackages: {{parts: parts}}", gripper
    )
    assert tmp_path / "parts" / "palm.stl" in {path.resolve() for path in compilation.files}


def test_a_urdf_compiles_and_is_checked_alone(tmp_path):
    path = tmp_path / "gripper.urdf"
    path.write_text(GRIPPER.replace('lower="0"', 'lower="1"'), "utf-8")
    diagnostics = compile_file(path).diagnostics
    assert {diagnostic.span.file.name for diagnostic in diagnostics} == {str(path)}
    assert any("lower" in diagnostic.message for diagnostic in diagnostics)


def test_a_duplicate_element_is_reported_once_as_on_import():
    urdf = CASES / "LF7145_second_of_one.urdf"
    assert [*map(str, compile_file(urdf).diagnostics)] == [*map(str, import_urdf(urdf).diagnostics)]


@pytest.mark.parametrize("name", ["ur_ur5e", "lbr_iiwa7", "turtlebot3_burger"])
def test_a_vendor_s_robot_moves_as_it_does_alone(name: str, tmp_path: Path):
    """Behind a mount and a prefix every frame of the robot is where the vendor's own file has it."""
    vendor = CORPUS / f"{name}.urdf"
    if not vendor.exists():
        pytest.skip("the corpus is not at hand")
    spec = tmp_path / "cell.robot.yaml"
    spec.write_text(
        f"linkforge: 1\nname: cell\nlinks: {{floor: }}\n"
        f"modules: {{it: {{use: {vendor}, parent: floor, origin: [1, 2, 3]}}}}\n"
    )
    urdf = render_urdf(compile_file(spec, allow_outside=True).result())
    assert check_urdf(urdf) == "floor"
    mujoco_model(urdf)
    pinocchio = pytest.importorskip("pinocchio")
    alone, mounted = pinocchio_model(vendor.read_text("utf-8")), pinocchio_model(urdf)
    alone_data, mounted_data = alone.createData(), mounted.createData()
    generator = np.random.default_rng(1)
    assert mounted.nq == alone.nq
    for _ in range(5):
        angles = pinocchio.integrate(alone, pinocchio.neutral(alone), generator.uniform(-1, 1, alone.nv))
        pinocchio.framesForwardKinematics(alone, alone_data, angles)
        pinocchio.framesForwardKinematics(mounted, mounted_data, angles)
        for frame in alone.frames[1:]:
            ours = mounted_data.oMf[mounted.getFrameId(f"it_{frame.name}", frame.type)]
            theirs = alone_data.oMf[alone.getFrameId(frame.name, frame.type)]
            assert np.allclose(ours.translation, theirs.translation + np.array([1, 2, 3]), atol=1e-12)
            assert np.allclose(ours.rotation, theirs.rotation, atol=1e-12)


def test_a_vendor_s_gripper_on_a_vendor_s_arm(tmp_path: Path):
    """Both from URDF and SRDF, each without its own world link; every consumer reads the output."""
    arm, gripper = CORPUS / "ur_ur5e", CORPUS / "robotiq_2f_85"
    if not CORPUS.exists():
        pytest.skip("the corpus is not at hand")
    spec = tmp_path / "cell.robot.yaml"
    spec.write_text(
        f"""
linkforge: 1
name: cell
links: {{floor: }}
modules:
  arm:
    use: {arm}.urdf
    srdf: {arm}.srdf
    parent: floor
    origin: [0, 0, 0.5]
    override: {{links: {{world: null}}, joints: {{base_joint: null, elbow_joint: {{limits: {{effort: 99}}}}}}}}
  hand:
    use: {gripper}.urdf
    parent: arm_tool0
    override: {{links: {{world: null}}, joints: {{robotiq_85_base_joint: null}}}}
semantic: {{end_effectors: {{hand: {{group: arm_ur_manipulator, parent_link: arm_tool0}}}}}}
""",
        "utf-8",
    )
    robot = compile_file(spec, allow_outside=True).result()
    urdf = render_urdf(robot)
    assert check_urdf(urdf) == "floor"
    freedom = sum(len(pinocchio_model(Path(f"{one}.urdf").read_text("utf-8")).names) - 1 for one in (arm, gripper))
    assert len(pinocchio_model(urdf).names) - 1 == freedom
    assert mujoco_model(urdf).njnt == freedom
    assert robot.joint("arm_elbow_joint").limits.effort == 99
    assert "arm_ur_manipulator" in [group.name for group in robot.semantic.groups]


SRDF = """\
<robot name="gripper">
  <group name="fingers"><joint name="slide"/></group>
  <group_state name="open" group="fingers"><joint name="slide" value="0.04"/></group_state>
  <disable_collisions link1="palm" link2="finger" reason="Adjacent"/>
</robot>
"""


def test_its_srdf_joins_under_the_prefix(tmp_path):
    (tmp_path / "gripper.srdf").write_text(SRDF, "utf-8")
    compilation = compiled(tmp_path, "left: {use: vendor/gripper.urdf, srdf: gripper.srdf, parent: table}")
    semantic = compilation.result().semantic
    assert [(group.name, group.joints) for group in semantic.groups] == [("left_fingers", ("left_slide",))]
    assert [state.joint_values for state in semantic.group_states] == [{"left_slide": (0.04,)}]
    assert [(pair.link1, pair.link2) for pair in semantic.disabled_collisions] == [("left_palm", "left_finger")]
    assert "gripper.srdf" in {path.name for path in compilation.files}


def test_a_name_in_an_srdf_is_reported_with_the_override_that_sets_the_final_one(tmp_path):
    group = '<robot name="gripper"><group name="hand"><link name="palm"/><tool at="finger"/></group></robot>'
    again_in = tmp_path / "again"
    again_in.mkdir()
    for folder in (tmp_path, again_in):
        (folder / "gripper.srdf").write_text(group, "utf-8")
    use = "use: vendor/gripper.urdf, srdf: gripper.srdf, parent: table"
    [one] = texts_of(compiled(tmp_path, f"left: {{{use}}}"))
    [(name, override)] = re.findall("change it to '(.*)' by '(override: .*)' where", one)
    raw = f"'<tool at=\"{name}\"/>'"
    again = compiled(again_in, f"left: {{{use}, {override.replace('...', raw)}}}")
    assert '<tool at="left_finger"/>' in render_srdf(again.result())
    assert not texts_of(again)


def test_checking_its_srdf_is_not_charged_to_the_robot(tmp_path, monkeypatch):
    """A robot of as many links as there may be has an SRDF, although it is expanded once more to judge it."""
    left: list[int] = []

    def spend(budget: Budget, limit: Limit, amount: int, where: Where) -> None:
        original(budget, limit, amount, where)
        left.append(budget.left(Limit.ENTRIES))

    original = Budget.spend
    monkeypatch.setattr(Budget, "spend", spend)
    ends = []
    for srdf in ("", "srdf: gripper.srdf, "):
        folder = tmp_path / str(len(ends))
        folder.mkdir()
        (folder / "gripper.srdf").write_text(SRDF, "utf-8")
        compiled(folder, f"left: {{use: vendor/gripper.urdf, {srdf}parent: table}}").result()
        ends.append(min(left))
        left.clear()
    assert ends[0] - ends[1] == 2 * 3, "a group, a state and a pair, in the module and in the file around it"


def test_faults_of_its_srdf_are_reported_in_the_srdf(tmp_path):
    (tmp_path / "gripper.srdf").write_text(SRDF.replace('link2="finger"', 'link2="fingre"'), "utf-8")
    compilation = compiled(tmp_path, "left: {use: vendor/gripper.urdf, srdf: gripper.srdf, parent: table}")
    assert {Path(one.span.file.name).name for one in compilation.diagnostics} == {"gripper.srdf"}


def test_what_the_language_refuses_of_an_srdf_stays_raw_as_on_import(tmp_path):
    urdf, srdf = (
        Path(copy(CASES / "bad_urdf" / f"LF8021_semantic_part.{kind}", tmp_path)) for kind in ("urdf", "srdf")
    )
    spec = tmp_path / "cell.robot.yaml"
    use = f"{{use: {urdf.name}, srdf: {srdf.name}, prefix: ''}}"
    spec.write_text(f"linkforge: 1\nname: arm\nmodules: {{left: {use}}}\n", "utf-8")
    used, imported = compile_file(spec), import_urdf(urdf, srdf=srdf)
    assert {one.message for one in used.diagnostics} == {one.message for one in imported.diagnostics}
    assert render_srdf(used.result()) == render_srdf(compile_text(imported.text).result())
