"""Test references to names that `when` or an override removed: the removal is shown."""

from pathlib import Path
from unittest.mock import patch

import pytest

from linkforge_compile import Compilation, compile_file
from linkforge_compile.expand import deletions
from tests.expand.assembling import write

ARM = """
    parameters: {has_tool: {type: boolean, default: false}}
    links: {base: , link1: {when: $(has_tool)}}
    joints: {j1: {when: $(has_tool), type: fixed, parent: base, child: link1}}
    frames: {tcp: {when: $(has_tool), parent: base}, eye: {when: $(has_tool), parent: base, joint: eyeball}}
    semantic: {groups: {g: {when: $(has_tool), links: [base]}}}
"""
PAIR = """
    links: {base: }
    semantic: {groups: {g: {links: [base]}}}
    modules:
      a1: {use: arm.robot.yaml, parent: base}
      a2: {use: arm.robot.yaml, parent: base, joint: wrist}
      a3: {use: arm.robot.yaml, parent: base, joint: {name: thumb}}
"""
CELL = """
    links: {table: }
    modules:
      left: {use: arm.robot.yaml, parent: table}
      right: {when: false, use: arm.robot.yaml, parent: table, prefix: r_, joint: mount}
      pair: {use: pair.robot.yaml, parent: table, override:
        {modules: {a1: null, a2: null, a3: null}, semantic: {groups: {g: null}}}}
      w$(i): {for: {i: 2}, when: $(i > 0), use: arm.robot.yaml, parent: table}
"""


@pytest.mark.parametrize(
    ("use", "code", "why"),
    [
        ("{joints: [left_j1]}", "LF4103", "'j1' is disabled by 'when' here arm.robot.yaml:5:21"),
        ("{links: [left_tcp]}", "LF4102", "'tcp' is disabled by 'when' here arm.robot.yaml:6:22"),
        ("{joints: [left_tcp_joint]}", "LF4103", "'tcp' is disabled by 'when' here arm.robot.yaml:6:22"),
        ("{joints: [left_eyeball]}", "LF4103", "'eye' is disabled by 'when' here arm.robot.yaml:6:62"),
        ("{subgroups: [left_g]}", "LF4104", "'g' is disabled by 'when' here arm.robot.yaml:7:31"),
        ("{links: [r_base]}", "LF4102", "'right' is disabled by 'when' here cell.robot.yaml:6:17"),
        ("{subgroups: [r_g]}", "LF4104", "'right' is disabled by 'when' here cell.robot.yaml:6:17"),
        ("{joints: [mount]}", "LF4103", "'right' is disabled by 'when' here cell.robot.yaml:6:17"),
        ("{links: [w0_base]}", "LF4102", "'w0' is disabled by 'when' here cell.robot.yaml:9:30"),
        ("{links: [pair_a1_base]}", "LF4102", "'a1' is deleted by this override cell.robot.yaml:8:16"),
        ("{joints: [pair_a1_joint]}", "LF4103", "'a1' is deleted by this override cell.robot.yaml:8:16"),
        ("{joints: [pair_wrist]}", "LF4103", "'a2' is deleted by this override cell.robot.yaml:8:26"),
        ("{joints: [pair_thumb]}", "LF4103", "'a3' is deleted by this override cell.robot.yaml:8:36"),
        ("{subgroups: [pair_g]}", "LF4104", "'g' is deleted by this override cell.robot.yaml:8:67"),
    ],
)
def test_a_removed_name_is_reported_once_with_the_place(tmp_path: Path, use: str, code: str, why: str):
    group = f"    semantic: {{groups: {{all: {use}}}}}\n"
    write(tmp_path, {"arm.robot.yaml": ARM, "pair.robot.yaml": PAIR, "cell.robot.yaml": CELL + group})
    (diagnostic,) = compile_file(tmp_path / "cell.robot.yaml").diagnostics
    assert diagnostic.code.id == code
    (note,) = diagnostic.notes
    assert note.span
    assert f"{note.message} {note.span.file.path.name}:{note.span.line}:{note.span.column}" == why
    assert "did you mean" not in diagnostic.message


def test_a_joint_deleted_with_its_link_is_reported_with_the_deletion(tmp_path: Path):
    arm = """
        links: {base: , link1: }
        joints: {j1: {type: fixed, parent: base, child: link1}}
    """
    cell = """
        links: {table: }
        modules:
          arm: {use: arm.robot.yaml, parent: table, override: {
            joints: {j1: {origin: [0, 0, 1]}},
            links: {link1: null}}}
        semantic: {groups: {all: {joints: [arm_j1]}}}
    """
    write(tmp_path, {"arm.robot.yaml": arm, "cell.robot.yaml": cell})
    change, diagnostic = compile_file(tmp_path / "cell.robot.yaml").diagnostics
    (note,) = diagnostic.notes
    assert (note.message, note.span and note.span.line) == ("to delete link 'link1' deletes 'j1', the joint to it", 7)
    assert change.code.id == "LF3228"


VENDOR = """
    links: {world: , base: , link1: , link2: }
    joints:
      fix: {type: fixed, parent: world, child: base, origin: [0, 0, 1]}
      j1: {type: fixed, parent: base, child: link1}
      j2: {type: continuous, axis: z, parent: link1, child: link2}
    semantic: {virtual_joints: {anchor: {type: fixed, parent_frame: map, child_link: base}}}
"""


def vendor_without(folder: Path, override: str, arm: str = VENDOR) -> Compilation:
    cell = f"""
        links: {{table: }}
        modules: {{arm: {{use: arm.robot.yaml, parent: table, prefix: "", override: {override}}}}}
    """
    write(folder, {"arm.robot.yaml": arm, "cell.robot.yaml": cell})
    return compile_file(folder / "cell.robot.yaml")


@pytest.mark.parametrize(
    ("override", "joints"),
    [
        ("{links: {world: null}}", ["j1", "j2"]),
        ("{links: {world: null}, joints: {fix: null}}", ["j1", "j2"]),
        ("{links: {world: null, link2: null}}", ["j1"]),
        ("{links: {world: null, base: null}, semantic: {virtual_joints: null}}", ["j2"]),
    ],
)
def test_what_is_above_a_fixed_joint_is_deleted_with_it(tmp_path: Path, override: str, joints: list[str]):
    robot = vendor_without(tmp_path, override).result()
    assert [joint.name for joint in robot.joints] == [*joints, "arm_joint"]
    assert robot.joints["arm_joint"].child == robot.joints[joints[0]].parent


@pytest.mark.parametrize(
    ("override", "joint", "expected"),
    [
        ("{links: {base: null}}", "", "'base' is deleted by this override, and joint 'j1' below it is not; "),
        ("{links: {link1: null}}", "", "'link1' is deleted by this override, and joint 'j2' below it is not; "),
        (
            "{links: {world: null}}",
            "j3: {type: fixed, parent: world, child: link3}",
            "'world' is deleted by this override, and joints 'fix' and 'j3' below it are not; ",
        ),
        (
            "{links: {world: null, link1: null}}",
            "",
            "'link1' is deleted by this override, and joint 'j2' below it is not; ",
        ),
    ],
)
def test_joints_below_a_deleted_link_are_named_with_the_override(
    tmp_path: Path, override: str, joint: str, expected: str
):
    arm = f"{VENDOR.replace('link2: }', 'link2: , link3: }')}".replace("    semantic", f"      {joint}\n    semantic")
    found = vendor_without(tmp_path, override, arm if joint else VENDOR).diagnostics
    first = expected.split("joint")[1].split("'")[1]
    ways_out = f"write 'joints: {{{first}: null}}' or 'joints: {{{first}: {{parent: …}}}}' as well"
    assert {one.code.id for one in found} >= {"LF4102"}
    assert f"{expected}{ways_out}" in [note.message for one in found for note in one.notes]


@pytest.mark.parametrize(
    ("override", "code"),
    [
        ("{links: {world: null}}", "LF3229"),
        ("{links: {world: null}, joints: {fix: null}}", None),
        ("{links: {world: null}, joints: {fix: {origin: [1, 2, 3]}}}", "LF3228"),
        ("{links: {link2: null}, joints: {j2: {axis: x}}}", "LF3228"),
        ("{links: {world: null, base: null}, semantic: {virtual_joints: null}}", None),
        ("{links: {world: null}, joints: {fix: {parent: link2}}}", None),
    ],
)
def test_what_goes_with_a_link_against_the_intent_is_a_warning(tmp_path: Path, override: str, code: str | None):
    found = [one.code.id for one in vendor_without(tmp_path, override).diagnostics]
    assert [one for one in found if one in {"LF3228", "LF3229"}] == [code] * (code is not None)


@pytest.mark.parametrize(
    ("origin", "is_reported"),
    [("[0, 0.0, 0 mm]", False), ("{rpy: [0, 0, 0]}", False), ("{rpy: [0, 0, 90 deg]}", True), ("[0, 0, $(1)]", True)],
)
def test_only_a_pose_that_moves_the_module_is_reported(tmp_path: Path, origin: str, is_reported: bool):
    arm = VENDOR.replace("[0, 0, 1]", origin)
    found = vendor_without(tmp_path, "{links: {world: null}}", arm).diagnostics
    assert ("LF3229" in {one.code.id for one in found}) is is_reported


def joints_read_to_delete_half(folder: Path, count: int) -> int:
    """Return how often `deletions` reads a joint to delete half of the links around one."""
    links = "".join(f", l{number}: " for number in range(count))
    joints = ", ".join(f"j{number}: {{type: fixed, parent: base, child: l{number}}}" for number in range(count))
    arm = f"""
        links: {{base: {links}}}
        joints: {{{joints}}}
    """
    deleted = ", ".join(f"l{number}: null" for number in range(0, count, 2))
    with patch.object(deletions, "_ends_of", wraps=deletions._ends_of) as read:
        vendor_without(folder, f"{{links: {{{deleted}}}}}", arm).result()
    return read.call_count


def test_deleting_twice_as_many_links_does_twice_the_work(tmp_path: Path):
    assert 0 < joints_read_to_delete_half(tmp_path, 400) < 2.5 * joints_read_to_delete_half(tmp_path, 200)
