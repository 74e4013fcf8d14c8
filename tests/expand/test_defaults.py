"""`defaults`: what fills the gaps of entries, and what stays out of them."""

from tests.expand.assembling import assemble, plain, write


def section(name: str, text: str, *pairs: str) -> object:
    made = assemble(text, *pairs)
    assert not made.messages
    return plain(made.instance.tree.get(name))


def test_maps_merge_and_the_entry_goes_first():
    assert section(
        "joints",
        """
        defaults: {joint: {limits: {effort: 50, velocity: 2}, dynamics: {damping: 0.1}}}
        joints:
          a: {type: revolute, limits: {effort: 9, upper: 1}, dynamics: {damping: }}
          b: {type: prismatic}
        """,
    ) == {
        "a": {"type": "revolute", "limits": {"effort": 9, "upper": 1, "velocity": 2}, "dynamics": {"damping": 0.1}},
        "b": {"type": "prismatic", "limits": {"effort": 50, "velocity": 2}, "dynamics": {"damping": 0.1}},
    }


def test_short_forms_meet_long_ones_and_lists_are_the_entrys_own():
    assert section(
        "links",
        """
        defaults:
          link: {visual: {box: [1, 1, 1], origin: {rpy: [1, 0, 0]}}}
        links:
          a: {visual: {origin: [1, 2, 3]}}
          b: {visual: [{sphere: 1}]}
        """,
    ) == {
        "a": {"visual": [{"origin": {"xyz": [1, 2, 3], "rpy": [1, 0, 0]}, "box": [1, 1, 1]}]},
        "b": {"visual": [{"sphere": 1}]},
    }


def test_one_of_a_choice_removes_the_others():
    assert section(
        "links",
        """
        defaults: {link: {inertial: {density: 700}}, visual: {box: [1, 1, 1], material: steel}}
        links:
          a: {visual: [{sphere: 1}, {material: wood}], inertial: {mass: 1}}
        """,
    ) == {
        "a": {
            "visual": [{"sphere": 1, "material": "steel"}, {"material": "wood", "box": [1, 1, 1]}],
            "inertial": {"mass": 1},
        }
    }


def test_a_joint_type_gets_nothing_that_it_may_not_have():
    assert section(
        "joints",
        """
        defaults: {joint: {type: fixed, axis: y, limits: {effort: 1}, dynamics: {damping: 1}, origin: [0, 0, 1]}}
        joints:
          a: {}
          b: {type: floating}
          c: {type: planar}
          d: {type: continuous}
        """,
    ) == {
        "a": {"type": "fixed", "origin": [0, 0, 1]},
        "b": {"type": "floating", "origin": [0, 0, 1]},
        "c": {"type": "planar", "axis": "y", "origin": [0, 0, 1]},
        "d": {
            "type": "continuous",
            "axis": "y",
            "limits": {"effort": 1},
            "dynamics": {"damping": 1},
            "origin": [0, 0, 1],
        },
    }


def test_a_link_without_shapes_gets_no_copy_and_nothing_to_compute():
    assert section(
        "links",
        """
        defaults: {link: {collision: visual, inertial: {density: 700}}}
        links: {a: {visual: {sphere: 1}}, frame: , b: {collision: {sphere: 1}}}
        """,
    ) == {
        "a": {"visual": {"sphere": 1}, "collision": "visual", "inertial": {"density": 700}},
        "frame": {},
        "b": {"collision": {"sphere": 1}, "inertial": {"density": 700}},
    }


def test_expressions_see_the_files_names_and_when_decides_about_the_default():
    text = """
        parameters: {sim: false, effort: 5}
        defaults: {joint: {limits: {effort: $(effort)}, dynamics: {when: $(sim), damping: 1}}}
        joints: {j_$(i): {for: {i: 1}, type: continuous}}
    """
    assert section("joints", text) == {"j_0": {"type": "continuous", "limits": {"effort": 5}}}
    assert section("joints", text, "sim=true") == {
        "j_0": {"type": "continuous", "limits": {"effort": 5}, "dynamics": {"damping": 1}}
    }


def test_all_defaults_may_depend_on_a_condition():
    text = "defaults: {when: false, joint: {axis: x}}\njoints: {a: {type: continuous}}"
    assert section("joints", text) == {"a": {"type": "continuous"}}


def test_for_names_are_unknown_to_defaults():
    made = assemble("""
        defaults: {joint: {origin: [0, 0, $(i)]}}
        joints: {j_$(i): {for: {i: 2}, type: fixed}}
    """)
    assert made.messages == ["no parameter, variable or 'for' name 'i' here"]


def test_defaults_do_not_reach_into_modules_frames_and_mounts(tmp_path):
    write(tmp_path, {"arm.robot.yaml": "joints: {elbow: {type: continuous}}"})
    made = assemble(
        """
        defaults: {joint: {axis: y, origin: [0, 0, 1]}}
        frames: {tool: {parent: a}}
        mount: {hip: {type: continuous, child: a}}
        modules: {arm: {use: arm.robot.yaml, parent: a, joint: {type: continuous}}}
        """,
        folder=tmp_path,
    )
    (arm,) = made.instance.modules
    assert plain(arm.tree.get("joints")) == {"elbow": {"type": "continuous"}}
    assert plain(arm.entry.node.get("joint")) == {"type": "continuous"}
    assert plain(made.instance.tree.get("frames")) == {"tool": {"parent": "a"}}
    assert plain(made.instance.tree.get("mount")) == {"hip": {"type": "continuous", "child": "a"}}


def test_sensors_are_filled_too():
    assert section("sensors", "defaults: {sensor: {update_rate: 30}}\nsensors: {eye: {type: camera}}") == {
        "eye": {"type": "camera", "update_rate": 30}
    }


def test_a_default_keeps_its_own_place():
    made = assemble("defaults: {joint: {axis: q}}\njoints: {a: {type: continuous}}")
    axis = made.instance.tree.get("joints").get("a").get("axis")
    assert (axis.span.line, axis.span.column) == (3, 26)


def test_a_copy_of_the_visuals_gets_the_default_of_collisions():
    found = assemble("""
        defaults: {collision: {origin: [0, 0, 1], name: hull}}
        links:
          arm: {visual: [{sphere: 1}, {box: [1, 1, 1], origin: [1, 0, 0], material: steel}], collision: visual}
    """)
    assert found.messages == []
    assert plain(found.instance.tree.get("links").get("arm").get("collision")) == [
        {"sphere": 1, "origin": [0, 0, 1], "name": "hull"},
        {"box": [1, 1, 1], "origin": {"xyz": [1, 0, 0]}, "name": "hull"},
    ]


def test_defaults_that_are_no_map_are_reported():
    found = assemble("variables: {list: [1]}\ndefaults: $(list)\nlinks: {arm: }\n")
    assert found.messages == ["'defaults' takes a map, found a list"]
