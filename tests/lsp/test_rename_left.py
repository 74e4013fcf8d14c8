"""A rename changes a name also where no robot has it today, or is refused where that is not certain."""

from collections.abc import Sequence
from pathlib import Path

import pytest
from lsprotocol import types
from pygls.exceptions import JsonRpcException

from tests.lsp.editor import Editor
from tests.lsp.test_rename import renamed

ROBOT = """\
linkforge: 1
name: robot
parameters:
  with_tool: {type: boolean, default: false}
links:
  base: {}
  tool: {when: $(with_tool)}
joints:
  flange: {when: $(with_tool), type: fixed, parent: base, child: tool}
"""
MOVING = """\
linkforge: 1
name: robot
links:
  base: {}
  tool: {inertial: {mass: 1, inertia: {ixx: 0.01, iyy: 0.01, izz: 0.01}}}
joints:
  jj: {type: continuous, axis: z, parent: base, child: tool, limits: {velocity: 1, effort: 1}}
ros2_control:
  sys:
    hardware_plugin: mock_components/GenericSystem
    joints: {jj: {command_interfaces: [position], state_interfaces: [position]}}
controllers:
  atc: {type: joint_trajectory_controller/JointTrajectoryController, joints: [jj]}
"""
AT = """\
linkforge: 1
name: robot
parameters:
  at: {type: string, default: base}
links: {base: {}, tool: {}, lamp: {}}
joints:
  flange: {type: fixed, parent: base, child: tool}
  lamp: {type: fixed, parent: $(at), child: lamp}
"""
GRIPPER = """\
linkforge: 1
name: gripper
parameters: {reach: {type: length, default: 1 m}}
links: {palm: {visual: {box: [$(reach), 1, 1]}}, tip: {}}
joints: {finger: {type: fixed, parent: palm, child: tip}}
"""
ARM = """\
linkforge: 1
name: arm
parameters: {with_gripper: {type: boolean, default: false}}
links: {base: {}}
modules:
  hand: {when: $(with_gripper), use: gripper.robot.yaml, parent: base, with: {reach: 2 m}}
"""


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "robot.robot.yaml"


@pytest.mark.parametrize(
    ("mark", "old", "new"),
    [("  ba¦se:", "base", "trunk"), ("  to¦ol:", "tool", "hand"), ("  flan¦ge:", "flange", "mount")],
)
def test_a_part_under_a_condition_that_does_not_hold_is_renamed(
    editor: Editor, path: Path, mark: str, old: str, new: str
):
    found = renamed(editor, path, ROBOT.replace(mark.replace("¦", ""), mark), new)
    assert found == {
        "robot": ROBOT.replace(f"  {old}:", f"  {new}:")
        .replace(f" {old},", f" {new},")
        .replace(f" {old}}}", f" {new}}}")
    }


def test_a_name_that_a_part_under_a_condition_has_is_taken(editor: Editor, path: Path):
    with pytest.raises(JsonRpcException, match="there is a link 'tool' already"):
        renamed(editor, path, ROBOT.replace("  base:", "  ba¦se:"), "tool")


def test_names_that_expressions_would_make_under_a_condition_are_known(editor: Editor, path: Path):
    text = ROBOT.replace("links:", 'links:\n  "rod_$(s)": {when: $(with_tool), for: {s: [a, b]}}')
    text += '  "to_$(s)": {when: $(with_tool), for: {s: [a, b]}, type: fixed, parent: base, child: rod_$(s)}\n'
    with pytest.raises(JsonRpcException, match="there is a link 'rod_a' already"):
        renamed(editor, path, text.replace("  base:", "  ba¦se:"), "rod_a")
    found = renamed(editor, path, text.replace("  base:", "  ba¦se:"), "trunk")
    assert found == {"robot": text.replace("base", "trunk")}
    taken = text.replace("base", "to_c")
    found = renamed(editor, path, taken.replace("  to_c:", "  to¦_c:"), "trunk")
    assert found == {"robot": taken.replace("to_c", "trunk")}


def test_what_an_override_replaces_is_renamed(editor: Editor, path: Path):
    cell = """\
linkforge: 1
name: cell
links: {world: {}}
modules:
  left:
    use: robot.robot.yaml
    parent: world
    with: {with_tool: true}
    override: {links: {extra: null}, joints: {flange: {parent: other}}}
"""
    robot = ROBOT.replace("  base: {}\n", "  base: {}\n  other: {}\n  extra: {}\n").replace(
        "joints:\n",
        "joints:\n  a: {type: fixed, parent: base, child: other}\n  b: {type: fixed, parent: base, child: extra}\n",
    )
    (path.parent / "cell.robot.yaml").write_text(cell)
    found = renamed(editor, path, robot.replace("  base:", "  ba¦se:"), "trunk")
    assert found == {"robot": robot.replace("base", "trunk")}


@pytest.mark.parametrize(
    ("text", "mark", "reason"),
    [
        pytest.param(
            AT + "variants: {v: {at: tool}}\n", " tool: {", r"'tool' is made of '\$\(at\)' at .*:8:", id="variant"
        ),
        pytest.param(
            AT.replace("default: base", "default: base, enum: [base, tool]"),
            " tool: {",
            r"'tool' at .*:4:\d+ may be the link",
            id="choice",
        ),
        pytest.param(
            AT.replace("parent: $(at)", "parent: \"$('base' if at == 'base' else 'tool')\""),
            " tool: {",
            r"'tool' at .*:8:\d+ may be the link",
            id="text in an expression",
        ),
        pytest.param(
            ROBOT + "gazebo: {plugins: [{when: $(with_tool), name: p, filename: p.so, parameters: {frame: tool}}]}\n",
            " tool: {",
            r"'tool' at .*:10:\d+ may be the link",
            id="plugin under a condition",
        ),
        pytest.param(
            ROBOT + "gazebo: {when: $(with_tool), extra: <a b='tool'/>}\n",
            " tool: {",
            r"at .*:10:\d+ may be the link",
            id="XML under a condition",
        ),
        pytest.param(
            MOVING.replace("[jj]}", "[jj], parameters: {gains: {jj: {p: 1}}}}"),
            "jj: {type",
            r"'jj' at .*:13:\d+ may be the joint",
            id="gains",
        ),
        pytest.param(
            MOVING + "  controller_manager: {parameters: {fallback_controllers: [atc]}}\n",
            "atc: {",
            r"'atc' at .*:14:\d+ may be the controller",
            id="manager",
        ),
    ],
)
def test_a_text_that_may_be_the_name_is_refused_with_its_place(
    editor: Editor, path: Path, text: str, mark: str, reason: str
):
    with pytest.raises(JsonRpcException, match=reason):
        renamed(editor, path, text.replace(mark, mark[:2] + "¦" + mark[2:], 1), "other")


def test_a_text_that_is_no_name_is_no_reason_to_refuse(editor: Editor, path: Path):
    text = AT.replace("default: base", "default: base, description: tool").replace("name: robot", "name: tool")
    text = (
        text.replace("lamp: {}}", "lamp: {when: $(at != 'tool')}}") + "metadata: {tool: tool}\nvariants: {tool: {}}\n"
    )
    found = renamed(editor, path, text.replace(", tool: {}", ", to¦ol: {}"), "hand")
    assert found == {"robot": text.replace(", tool: {}", ", hand: {}").replace("child: tool", "child: hand")}


def test_all_that_use_an_edited_module_are_renamed(editor: Editor, path: Path):
    module = "linkforge: 1\nname: m\nlinks: {palm: {}, tip: {}}\njoints: {j: {type: fixed, parent: palm, child: tip}}\n"
    (path.parent / "m.robot.yaml").write_text(module)
    user = """\
linkforge: 1
name: user
links: {a: {}}
modules: {l: {use: m.robot.yaml, parent: a}}
frames: {f: {parent: l_tip}}
"""
    (path.parent / "other.robot.yaml").write_text(user)
    found = renamed(editor, path, user.replace("l_tip", "l_¦tip"), "l_end")
    changed = user.replace("l_tip", "l_end")
    assert found == {"robot": changed, "other": changed, "m": module.replace("tip", "end")}


def test_a_parameter_is_renamed_where_a_module_that_is_not_used_sets_it(editor: Editor, path: Path):
    (path.parent / "arm.robot.yaml").write_text(ARM)
    found = renamed(editor, path.parent / "gripper.robot.yaml", GRIPPER.replace("reach:", "re¦ach:"), "span")
    assert found == {"gripper": GRIPPER.replace("reach", "span"), "arm": ARM.replace("reach", "span")}


def test_a_name_of_a_module_that_is_not_used_is_refused(editor: Editor, path: Path):
    arm = ARM + "frames: {eye: {when: $(with_gripper), parent: hand_tip}}\n"
    (path.parent / "arm.robot.yaml").write_text(arm)
    with pytest.raises(JsonRpcException, match=r"'hand_tip' at .*arm\.robot\.yaml:7:\d+ may be the link 'tip'"):
        renamed(editor, path.parent / "gripper.robot.yaml", GRIPPER.replace("tip: {}", "t¦ip: {}"), "end")


def test_a_parameter_that_a_nested_override_sets_is_renamed(editor: Editor, path: Path):
    (path.parent / "gripper.robot.yaml").write_text(GRIPPER)
    (path.parent / "arm.robot.yaml").write_text(ARM.replace("when: $(with_gripper), ", ""))
    cell = """\
linkforge: 1
name: cell
links: {world: {}}
modules:
  left:
    use: arm.robot.yaml
    parent: world
    override: {modules: {hand: {with: {reach: 3 m}, override: {links: {tip: null}}}}}
"""
    (path.parent / "cell.robot.yaml").write_text(cell)
    found = renamed(editor, path.parent / "gripper.robot.yaml", GRIPPER.replace("reach:", "re¦ach:"), "span")
    assert found["cell"] == cell.replace("reach", "span")
    found = renamed(editor, path.parent / "gripper.robot.yaml", GRIPPER.replace("tip: {}", "t¦ip: {}"), "end")
    assert found["cell"] == cell.replace("tip", "end")


@pytest.mark.parametrize(
    ("condition", "reason"), [("", "LF3203"), ("when: false, ", r"'i' would be another name at .*:7:\d+: part_0")]
)
def test_a_name_that_a_for_hides_is_refused(editor: Editor, path: Path, condition: str, reason: str):
    text = f"""\
linkforge: 1
name: robot
variables:
  half: 2
links:
  base: {{}}
  part_0: {{{condition}visual: [{{for: {{i: 2}}, box: [$(half), 1, 1]}}]}}
  used: {{visual: {{box: [$(half), 1, 1]}}}}
joints:
  j: {{type: fixed, parent: base, child: used}}
  to_0: {{{condition}type: fixed, parent: base, child: part_0}}
"""
    with pytest.raises(JsonRpcException, match=reason):
        renamed(editor, path, text.replace("  half:", "  ha¦lf:"), "i")


def test_a_rename_that_breaks_the_robot_is_refused_with_the_error(editor: Editor, path: Path):
    (path.parent / "gripper.robot.yaml").write_text(GRIPPER)
    text = """\
linkforge: 1
name: robot
links: {a: {}}
modules:
  left: {use: gripper.robot.yaml, parent: a, prefix: left_}
frames: {f_$(s): {for: {s: [left]}, parent: $(s)_tip}}
"""
    with pytest.raises(JsonRpcException, match=r"renaming would break the robot: .*LF3090"):
        renamed(editor, path, text.replace("{s: [", "{¦s: ["), "prefix")


def test_a_malformed_text_is_refused_with_its_place(editor: Editor, path: Path):
    with pytest.raises(JsonRpcException, match=r"cannot be read; mend it first: .*robot\.robot\.yaml:10:1"):
        renamed(editor, path, ROBOT.replace("child: tool}", "child: [tool").replace("  base:", "  ba¦se:"), "trunk")


def test_versions_are_those_of_the_open_texts(path: Path):
    resource = types.WorkspaceEditClientCapabilities(document_changes=True)
    abilities = types.ClientCapabilities(workspace=types.WorkspaceClientCapabilities(workspace_edit=resource))
    (path.parent / "gripper.robot.yaml").write_text(GRIPPER)
    (path.parent / "arm.robot.yaml").write_text(ARM.replace("when: $(with_gripper), ", ""))
    with Editor(path.parent, abilities=abilities) as editor:
        gripper = path.parent / "gripper.robot.yaml"
        editor.open(gripper, GRIPPER)
        document = editor.open(gripper, GRIPPER)
        params = types.RenameParams(document, types.Position(2, 14), "span")
        found = editor.ask(lambda client: client.text_document_rename_async(params))
    assert found is not None
    assert found.changes is None
    changes = found.document_changes
    assert isinstance(changes, Sequence)
    shown = {}
    for one in changes:
        assert isinstance(one, types.TextDocumentEdit)
        shown[one.text_document.uri.rpartition("/")[2]] = one.text_document.version, len(one.edits)
    assert shown == {"gripper.robot.yaml": (2, 2), "arm.robot.yaml": (None, 1)}
