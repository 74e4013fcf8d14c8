"""Entries that a spec nests under a name are adjacent in the robot, from whichever file they come."""

from tests.lower.specs import Spec, robot_of

ARM = """
    linkforge: 1
    name: arm
    links: {base: , tool: , cover: }
    joints:
      turn: {type: continuous, parent: base, child: tool, axis: z}
      lid: {type: fixed, parent: base, child: cover}
    semantic:
      groups: {all: {joints: [turn]}}
      group_states: {all: {home: {turn: 0}}}
      disabled_collisions: {base: {tool: Adjacent}, tool: {cover: Never}}
      joint_properties: {turn: {colour: red}}
"""
CELL = """
    linkforge: 1
    name: cell
    links: {table: }
    modules:
      left: {use: arm, parent: table}
    semantic:
      groups: {both: {subgroups: [left_all]}}
      group_states: {left_all: {up: {left_turn: 1}}, both: {up: {left_turn: 1}}}
      disabled_collisions: {left_tool: {table: Never}, table: {left_base: Adjacent}}
      joint_properties: {left_turn: {size: big}, left_lid: {size: small}}
"""


def test_entries_of_a_module_are_next_to_those_of_its_user_for_one_name():
    semantic = robot_of(Spec(CELL, {"left": Spec(ARM)})).semantic
    assert [(state.group, state.name) for state in semantic.group_states] == [
        ("left_all", "up"),
        ("left_all", "left_home"),
        ("both", "up"),
    ]
    assert [(pair.link1, pair.link2) for pair in semantic.disabled_collisions] == [
        ("left_tool", "table"),
        ("left_tool", "left_cover"),
        ("table", "left_base"),
        ("left_base", "left_tool"),
    ]
    assert [(one.joint_name, one.property_name) for one in semantic.joint_properties] == [
        ("left_turn", "size"),
        ("left_turn", "colour"),
        ("left_lid", "size"),
    ]
