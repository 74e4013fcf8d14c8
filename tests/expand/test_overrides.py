"""`override`: what a file changes in the modules that it uses, and what stays."""

from pathlib import Path
from textwrap import indent

import pytest

from linkforge_compile import compile_file
from tests.expand.assembling import Assembled, assemble, plain, write

ARM = """
    parameters: {reach: 1, camera: false}
    links:
      base: {visual: [{sphere: 1}, {box: [1, 1, 1]}, {mesh: a.stl}], inertial: {mass: 1}}
      cover: {visual: {box: [1, 1, 1], origin: [0, 0, 1]}, collision: visual}
      eye: {when: $(camera)}
    joints:
      lid: {type: fixed, parent: base, child: cover, origin: {xyz: [0, 0, 1], rpy: [1, 0, 0]}}
      wrist: {type: revolute, parent: base, child: hand, limits: {lower: 0, effort: 1}, axis: x}
    frames: {tool: {parent: base}}
    semantic:
      groups: {arm: {chain: {base_link: base, tip_link: cover}}}
      disabled_collisions: {base: {cover: Never, hand: Never}, cover: {hand: Never}}
      enabled_collisions: {hand: {cover: Never}}
      link_sphere_approximations: {cover: [{center: [0, 0, 0], radius: 1}], base: []}
"""


class Changed(Assembled):
    """What an override makes of the arm."""

    def at(self, *path: str) -> object:
        node = self.instance.modules[0].tree
        for key in path:
            node = node and node.child(key)
        return plain(node)


@pytest.fixture
def change(tmp_path: Path):
    write(tmp_path, {"arm.robot.yaml": ARM})

    def changed(override: str, variables: str = "{}") -> Changed:
        text = f"variables: {variables}\nmodules:\n  arm:\n    use: arm.robot.yaml\n    override:\n"
        return Changed(*assemble(text + indent(override, "      "), folder=tmp_path))

    return changed


def test_maps_merge_and_fields_may_be_added(change):
    made = change("joints: {wrist: {limits: {effort: 20, velocity: 3}, dynamics: {damping: 1}}}")
    assert made.at("joints", "wrist", "limits") == {"lower": 0, "effort": 20, "velocity": 3}
    assert made.at("joints", "wrist", "dynamics") == {"damping": 1}
    assert made.at("joints", "wrist", "axis") == "x"
    assert not made.messages


def test_short_forms_are_long_on_both_sides(change):
    made = change("joints: {lid: {origin: [0, 0, 2]}}\nlinks: {cover: {visual: {origin: {rpy: [1, 1, 1]}}}}")
    assert made.at("joints", "lid", "origin") == {"xyz": [0, 0, 2], "rpy": [1, 0, 0]}
    assert made.at("links", "cover", "visual") == [{"box": [1, 1, 1], "origin": {"xyz": [0, 0, 1], "rpy": [1, 1, 1]}}]
    assert made.at("links", "cover", "collision") == [{"box": [1, 1, 1], "origin": [0, 0, 1]}]


def test_a_written_null_deletes_and_an_expression_of_null_has_no_effect(change):
    made = change("joints: {wrist: {limits: {lower: null, effort: $(nothing)}, axis: ~}}", "{nothing: $(null)}")
    assert made.at("joints", "wrist", "limits") == {"effort": 1}
    assert made.at("joints", "wrist", "axis") is None
    assert not made.messages


def test_lists_are_patched_by_position_counted_before_deletions_or_replaced(change):
    made = change("links: {base: {visual: {0: null, 2: {mesh: {scale: 2}}, 1: {material: red}}}}")
    assert made.at("links", "base", "visual") == [
        {"box": [1, 1, 1], "material": "red"},
        {"mesh": {"file": "a.stl", "scale": 2}},
    ]
    assert change("links: {base: {visual: [{sphere: 2}]}}").at("links", "base", "visual") == [{"sphere": 2}]


def test_writing_one_of_a_choice_removes_the_others(change):
    made = change("links: {base: {inertial: {density: 9}, visual: {1: {cylinder: {radius: 1}}}}}")
    assert made.at("links", "base", "inertial") == {"density": 9}
    assert made.at("links", "base", "visual")[1] == {"cylinder": {"radius": 1}}


GAZEBO = "gazebo: {stop_cfm: 0.5, kp: 9, properties: {mu1: 0.50, stopErp: 0.10, serial: 7}}"


@pytest.mark.parametrize(
    ("patch", "left"),
    [
        ("{mu1: 2}", {"stop_cfm": 0.5, "kp": 9, "mu1": 2, "properties": {"stopErp": 0.1, "serial": 7}}),
        ("{mu1: null, stop_erp: null}", {"stop_cfm": 0.5, "kp": 9, "properties": {"serial": 7}}),
        ("{stop_erp: 0.2, mu1: 1, properties: {serial: null}}", {"stop_cfm": 0.5, "kp": 9, "stop_erp": 0.2, "mu1": 1}),
        (
            "{properties: {kp: 1.0, stopCfm: null}}",
            {"properties": {"mu1": 0.5, "stopErp": 0.1, "serial": 7, "kp": 1}},
        ),
    ],
)
def test_a_tag_of_gazebo_is_patched_under_its_key_and_under_properties(tmp_path: Path, patch: str, left: object):
    """An import writes under `properties` what would be spelled otherwise under its key."""
    write(tmp_path, {"arm.robot.yaml": f"links: {{base: {{{GAZEBO}}}}}"})
    override = f"links: {{base: {{gazebo: {patch}}}}}"
    made = Changed(*assemble(f"modules: {{arm: {{use: arm.robot.yaml, override: {{{override}}}}}}}", folder=tmp_path))
    assert not made.messages
    (block,) = made.at("links", "base", "gazebo")
    assert {name: value for name, value in block.items() if value != {}} == left


def test_frames_are_links_and_joints_by_then(change):
    made = change("links: {tool: {inertial: {mass: 1}}}\njoints: {tool_joint: {origin: [0, 0, 1]}}")
    assert made.at("links", "tool") == {"inertial": {"mass": 1}}
    assert made.at("joints", "tool_joint") == {
        "type": "fixed",
        "parent": "base",
        "child": "tool",
        "origin": {"xyz": [0, 0, 1]},
    }
    assert made.at("frames") is None


def test_a_chain_is_patched_as_it_is_written(change):
    made = change("semantic: {groups: {arm: {chain: {tip_link: hand}}}}")
    assert made.at("semantic", "groups", "arm") == {"chains": [{"base_link": "base", "tip_link": "hand"}]}


def test_deleting_a_link_deletes_its_joint_pairs_and_spheres(change):
    made = change("links: {cover: null}")
    assert "cover" not in made.at("links")
    assert set(made.at("joints")) == {"wrist", "tool_joint"}
    assert made.at("semantic", "disabled_collisions") == {"base": {"hand": "Never"}}
    assert made.at("semantic", "enabled_collisions") == {"hand": {}}
    assert made.at("semantic", "link_sphere_approximations") == {"base": []}
    assert made.at("semantic", "groups", "arm") == {"chain": {"base_link": "base", "tip_link": "cover"}}
    assert set(made.instance.modules[0].removed.names) == {"cover", "lid", "eye"}


def test_expressions_and_repetition_see_the_overriding_files_names(change):
    made = change(
        "links: {$(name)_: null, $(part): {for: {part: [base]}, inertial: {mass: $(heavy)}}}\n"
        "joints: {wrist: {when: false, axis: y}, lid: {origin: {when: $(heavy > 9), rpy: [0, 0, 0]}}}",
        "{heavy: 3}",
    )
    assert made.messages == ["there is no 'test_' among the links to override; there are 'base', 'cover' and 'tool'"]
    assert made.at("links", "base", "inertial") == {"mass": 3}
    assert made.at("joints", "wrist", "axis") == "x"


@pytest.mark.parametrize(
    ("shape_order", "left"),
    [("pairs", ["visual", "collision", "collision"]), ("[visual, visual, collision, collision]", None)],
)
def test_an_order_of_pairs_survives_a_deleted_shape_and_a_list_is_reported(tmp_path, shape_order, left):
    arm = f"links: {{base: {{visual: [{{sphere: 1}}, {{sphere: 2}}], collision: visual, shape_order: {shape_order}}}}}"
    override = "links: {base: {visual: {1: null}}}"
    write(tmp_path, {
        "arm.robot.yaml": arm,
        "robot.robot.yaml": f"modules: {{arm: {{use: arm.robot.yaml, override: {{{override}}}}}}}",
    })  # fmt: skip
    made = compile_file(tmp_path / "robot.robot.yaml")
    messages = {
        one.code.id: [note.message for note in one.notes] for one in made.diagnostics if one.severity == "error"
    }
    if left is None:
        assert messages == {"LF5140": ["'1' is changed by this override", "used here"]}
    else:
        assert not messages
        assert [type(shape).__name__.lower() for shape in made.result().links[0].shapes] == left


def test_a_whole_override_may_depend_on_a_condition(change):
    assert change("when: $(heavy > 9)\nlinks: {base: null}", "{heavy: 3}").at("links", "base") is not None
    assert change("when: $(heavy > 1)\nlinks: {base: null}", "{heavy: 3}").at("links", "base") is None


def test_patched_nodes_keep_their_place_in_the_overriding_file(change):
    made = change("joints: {wrist: {limits: {effort: 20}}}")
    effort = made.instance.modules[0].tree.get("joints").get("wrist").get("limits").get("effort")
    assert (effort.span.file.name, effort.span.line) == ("test.robot.yaml", 8)


def test_a_missing_name_that_a_when_took_out_is_shown(change):
    made = change("links: {eye: {inertial: {mass: 1}}}")
    assert made.messages == ["there is no 'eye' among the links to override"]


@pytest.mark.parametrize(
    ("override", "message"),
    [
        ("links: {bse: {}}", "there is no 'bse' among the links to override; did you mean 'base'?"),
        ("links: {base: {visual: {3: null}}}", "there is no item 3 in 'visual', which has 3 items; the first is 0"),
        ("joints: {wrist: {axis: x}}", "'axis' already has this value, so the override changes nothing"),
        ("joints: {wrist: {mimic: null}}", "'mimic' is not set, so there is nothing to delete"),
        ("joints: {wrist: {axis: }}", "the override of 'axis' is empty; write a value, or 'null' to delete it"),
    ],
)
def test_an_override_that_changes_nothing_is_reported(change, override: str, message: str):
    assert message in change(override).messages


def test_nested_modules_are_reached_through_their_entries(tmp_path):
    write(
        tmp_path,
        {
            "hand.robot.yaml": "parameters: {width: 1}\nlinks: {palm: {inertial: {mass: $(width)}}, thumb: }",
            "arm.robot.yaml": """
                links: {wrist: }
                modules:
                  hand: {use: hand.robot.yaml, parent: wrist, override: {links: {palm: {inertial: {mass: 5}}}}}
                  tool: {use: hand.robot.yaml, parent: wrist}
            """,
        },
    )
    made = assemble(
        """
        modules:
          arm:
            use: arm.robot.yaml
            override:
              modules:
                hand: {parent: base, with: {width: 2}, override: {links: {palm: {visual: {sphere: 1}}, thumb: null}}}
                tool: null
        """,
        folder=tmp_path,
    )
    (arm,) = made.instance.modules
    (hand,) = arm.modules
    assert not made.messages
    assert plain(hand.entry.node.get("parent")) == "base"
    assert plain(hand.tree.get("links")) == {"palm": {"inertial": {"mass": 5}, "visual": [{"sphere": {"radius": 1}}]}}


def test_an_override_may_give_a_parameter_and_take_one_back(tmp_path):
    hand = "parameters: {width: 1, depth: 2}\nmetadata: {size: [$(width), $(depth)]}"
    write(
        tmp_path,
        {"hand.robot.yaml": hand, "arm.robot.yaml": "modules: {hand: {use: hand.robot.yaml, with: {depth: $(3)}}}"},
    )
    made = assemble(
        "modules: {arm: {use: arm.robot.yaml, override: {modules: {hand: {with: {width: 9, depth: null}}}}}}",
        folder=tmp_path,
    )
    assert plain(made.instance.modules[0].modules[0].tree.get("metadata")) == {"size": [9, 2]}


def test_gazebo_blocks_about_what_is_deleted_go_with_it(tmp_path):
    from linkforge_compile import compile_file

    (tmp_path / "arm.robot.yaml").write_text(
        "linkforge: 1\nname: arm\nlinks: {base: , cover: }\n"
        "joints: {lid: {type: fixed, parent: base, child: cover}}\n"
        "gazebo: [{reference: cover, mu1: 1}, {reference: lid, provide_feedback: true}, {reference: base, mu1: 2}]\n"
    )
    (tmp_path / "cell.robot.yaml").write_text(
        "linkforge: 1\nname: cell\nlinks: {floor: }\n"
        "modules: {a: {use: arm.robot.yaml, parent: floor, override: {links: {cover: null}}}}\n"
    )
    compilation = compile_file(tmp_path / "cell.robot.yaml")
    assert not compilation.diagnostics
    assert [element.reference for element in compilation.result().gazebo_elements] == ["a_base"]


def test_a_position_reaches_lists_of_interfaces(tmp_path: Path):
    arm = """
        links: {base: }
        ros2_control:
          rig: {joints: {j: {state_interfaces: [position, velocity]}}, gpios: {io: {command_interfaces: [a, b]}}}
    """
    write(tmp_path, {"arm.robot.yaml": arm})
    patch = "{rig: {joints: {j: {state_interfaces: {1: effort}}}, gpios: {io: {command_interfaces: {0: null}}}}}"
    found = assemble(
        f"modules: {{arm: {{use: arm.robot.yaml, override: {{ros2_control: {patch}}}}}}}\n", folder=tmp_path
    )
    assert found.messages == []
    rig = found.instance.modules[0].tree.get("ros2_control").get("rig")
    assert plain(rig.get("joints")) == {"j": {"state_interfaces": ["position", "effort"]}}
    assert plain(rig.get("gpios")) == {"io": {"command_interfaces": ["b"]}}


@pytest.mark.parametrize(
    ("patch", "is_same"),
    [
        ("axis: [1, 0, 0]", True),
        ("axis: [-1, 0, 0]", False),
        ("axis: -x", False),
        ("limits: {effort: 1}", True),
        # Of a joint that slides it would be another: whether it is right, its own check tells.
        ("limits: {effort: 1 N*m}", False),
        ("limits: {effort: 1 m/s}", False),
        ("origin: {xyz: [0, 0, 1]}", False),
    ],
)
def test_a_value_equal_to_the_old_one_is_reported_in_any_form(change, patch: str, is_same: bool):
    found = change(f"joints: {{wrist: {{{patch}}}}}")
    assert [
        one for one in found.messages if one.endswith("already has this value, so the override changes nothing")
    ] == found.messages
    assert bool(found.messages) is is_same


def test_a_faulty_section_stays_faulty_with_frames(tmp_path: Path):
    text = "links: {hip: , knee: }\njoints: $(nope)\nframes: {tool: {parent: knee}}\n"
    write(tmp_path, {"leg.robot.yaml": text})
    use = "modules: {leg: {use: leg.robot.yaml, override: {links: {knee: {inertial: {mass: 1}}}}}}"
    made = Changed(*assemble(use, folder=tmp_path))
    assert made.at("joints") == "FAULT"
    assert made.at("links") == {"hip": None, "knee": {"inertial": {"mass": 1}}, "tool": {}}
    assert len(made.messages) == 1


ELBOW = """\
linkforge: 1
name: arm
links: {base: {}, upper: {}, hand: {inertial: {mass: 1, inertia: {ixx: 1, iyy: 1, izz: 1}}}}
joints:
  elbow: {type: revolute, parent: base, child: upper, axis: z, limits: {lower: 0, upper: 2, effort: 3, velocity: 1}}
  wrist: {type: fixed, parent: upper, child: hand}
"""


@pytest.mark.parametrize(
    ("patch", "expected", "changed"),
    [
        ("joints: {elbow: {limits: {effort: null}}}", "joint 'elbow' has no 'limits.effort'", ["effort"]),
        ("joints: {elbow: {limits: {upper: -1}}}", "lower must not be above upper, found 0 and -1", ["upper"]),
        (
            "joints: {elbow: {type: fixed, limits: null}}",
            "joint 'elbow' is fixed and cannot have 'axis'",
            ["type", "limits"],
        ),
        ("links: {hand: {inertial: {inertia: {ixx: 9}}}}", "one principal moment of inertia", ["ixx"]),
        # What is wrong with the override's own words stands there already.
        ("joints: {elbow: {limits: {effort: 2 kg, velocity: 2}}}", "effort takes a torque", []),
        ("joints: {wrist: {origin: [0, 0, 1]}, elbow: {limits: {lower: 3}}}", "lower must not be above upper", []),
    ],
)
def test_an_error_caused_by_an_override_names_the_override(
    tmp_path: Path, patch: str, expected: str, changed: list[str]
):
    (tmp_path / "arm.robot.yaml").write_text(ELBOW)
    cell = (
        "linkforge: 1\nname: cell\nlinks: {table: {}}\nmodules:\n  left:\n    use: arm.robot.yaml\n    parent: table\n"
    )
    (tmp_path / "cell.robot.yaml").write_text(f"{cell}    override: {{{patch}}}\n")
    (found,) = (each for each in compile_file(tmp_path / "cell.robot.yaml").diagnostics if expected in each.message)
    notes = [note for note in found.notes if "override" in note.message]
    assert [note.message for note in notes] == [f"'{key}' is changed by this override" for key in changed]
    assert all(note.span and Path(note.span.file.name).name == "cell.robot.yaml" for note in notes)


@pytest.mark.parametrize(("mass", "is_same"), [("1000 g", True), ("1 m", False), ("1", True)])
def test_a_number_without_a_unit_is_as_much_in_the_unit_of_its_field_only(change, mass: str, is_same: bool):
    found = change(f"links: {{base: {{inertial: {{mass: {mass}}}}}}}")
    assert found.messages == (["'mass' already has this value, so the override changes nothing"] if is_same else [])
