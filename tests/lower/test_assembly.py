from linkforge_compile.core import JointLimits, JointType, Robot, Vector3
from tests.lower.specs import Spec, lowered, robot_of

HAND = Spec(
    """
    name: hand
    materials: {skin: {color: [1, 0, 0]}}
    links: {palm: {visual: {sphere: 1, material: skin}}, finger: }
    joints: {grip: {type: continuous, parent: palm, child: finger, axis: x}}
    semantic:
      groups: {hand: {joints: [grip]}}
      group_states: {hand: {open: {grip: 1}}}
    """
)


def names(parts) -> list[str]:
    return [part.name for part in parts]


def test_a_module_hangs_on_its_parent_by_a_fixed_joint_of_its_name():
    robot = robot_of(
        Spec(
            "name: body\nlinks: {torso: }\nmodules: {left: {parent: torso, origin: [0, 1, 0]}}",
            {"left": HAND},
        )
    )
    joint = robot.joint("left_joint")
    assert (joint.type, joint.parent, joint.child) == (JointType.FIXED, "torso", "left_palm")
    assert joint.origin.xyz == Vector3(0, 1, 0)
    assert list(robot.materials) == ["left_skin"]
    assert robot.link("left_palm").visuals[0].material.name == "left_skin"


def test_the_joint_of_a_module_accepts_any_field_of_a_joint():
    robot = robot_of(
        Spec(
            """
            name: body
            links: {torso: }
            modules:
              left:
                parent: torso
                joint:
                  {name: w, type: revolute, axis: [0, 0, 2], limits: {effort: 1, velocity: 2}, dynamics: {damping: 3}}
            """,
            {"left": HAND},
        )
    )
    joint = robot.joint("w")
    assert (joint.type, joint.limits, joint.dynamics.damping) == (JointType.REVOLUTE, JointLimits(None, None, 1, 2), 3)
    assert joint.axis_as_written == Vector3(0, 0, 2)
    assert str(joint.source.at("parent")) == "spec.yaml:5:13"
    assert str(joint.source.at("limits", "effort")) == "spec.yaml:7:67"


def test_parts_come_in_the_order_written_whatever_hangs_on_what():
    robot = robot_of(
        Spec(
            """
            name: body
            links: {torso: , tail: }
            joints: {spine: {type: fixed, parent: right_finger, child: tail}}
            frames: {eye: {parent: left_palm}}
            modules:
              left: {parent: right_palm}
              right: {parent: torso}
            semantic:
              groups: {both: {subgroups: [left_hand, right_hand]}}
              group_states: {both: {open: {left_hand: left_open, right_hand: right_open}}}
            """,
            {"left": HAND, "right": HAND},
        )
    )
    assert names(robot.links) == ["torso", "tail", "eye", "left_palm", "left_finger", "right_palm", "right_finger"]
    assert names(robot.joints) == ["spine", "eye_joint", "left_grip", "left_joint", "right_grip", "right_joint"]
    assert names(robot.semantic.groups) == ["both", "left_hand", "right_hand"]
    assert names(robot.semantic.group_states) == ["open", "left_open", "right_open"]
    assert dict(robot.semantic.group_states[0].joint_values) == {"left_grip": (1,), "right_grip": (1,)}
    assert robot.root_link.name == "torso"


def test_prefixes_nest():
    arm = Spec("name: arm\nlinks: {upper: }\nmodules: {hand: {parent: upper}}", {"hand": HAND})
    robot = robot_of(Spec("name: body\nlinks: {torso: }\nmodules: {left: {parent: torso}}", {"left": arm}))
    assert names(robot.links) == ["torso", "left_upper", "left_hand_palm", "left_hand_finger"]
    assert names(robot.joints) == ["left_hand_grip", "left_hand_joint", "left_joint"]
    assert str(robot.link("left_hand_palm").source.trail[-1]) == "spec.yaml:3:11"
    assert robot.link("left_hand_palm").source.modules == ("left", "hand")


def test_a_module_without_parent_is_the_base():
    robot = robot_of(
        Spec("name: car\nframes: {mast: {parent: base_palm}}\nmodules: {base: {}}", {"base": HAND}),
    )
    assert robot.root_link.name == "base_palm"


def test_the_compiled_file_keeps_its_name_version_and_metadata():
    spec = "name: body\nversion: 1.10\nmetadata: {author: Ada, tags: [a, 1], by: {year: 1843}}\nmodules: {left: {}}"
    robot = robot_of(Spec(spec, {"left": Spec("name: hand\nversion: 2\nmetadata: {author: Bob}\nlinks: {palm: }")}))
    assert (robot.name, robot.version, robot.version_stated) == ("body", "1.10", True)
    assert robot.metadata == {"author": "Ada", "tags": ["a", 1], "by": {"year": 1843}}
    assert robot_of("name: body").version_stated is False


def test_equal_materials_may_share_a_name():
    spec = Spec(
        """
        name: body
        materials: {skin: {color: [1, 0, 0]}}
        links: {torso: }
        modules: {left: {parent: torso, prefix: ""}}
        """,
        {"left": HAND},
    )
    assert list(robot_of(spec).materials) == ["skin"]


def test_a_module_with_duplicate_names_is_reported_and_checked_alone():
    result = lowered(
        Spec(
            """
            name: body
            materials: {skin: {color: [0, 0, 1]}}
            links: {torso: , palm: }
            semantic: {group_states: {hand: {open: {}}}}
            modules:
              left:
                parent: torso
                prefix: ""   # E[LF4107]:13 module 'left' and this file both have PARTS
            """.replace("PARTS", "link 'palm' and 2 more; give the module another prefix"),
            {
                "left": Spec(
                    """
                    name: hand
                    materials: {skin: {color: [1, 0, 0]}}
                    links: {palm: }
                    semantic:
                      groups: {hand: {links: [palm]}}
                      group_states: {hand: {open: {}}}
                    """
                )
            },
        )
    )
    assert names(result.robot.links) == ["torso", "palm"]
    assert names(result.unmerged) == ["hand"]
    assert "left_joint" in result.unresolved


def test_modules_of_one_prefix_are_reported_at_the_second():
    blue, red = (
        Spec(f"links: {{{part}: }}\nmaterials: {{skin: {{color: {color}}}}}")
        for part, color in (("palm", "[0, 0, 1]"), ("wrist", "[1, 0, 0]"))
    )
    result = lowered(
        Spec(
            """
            name: body
            links: {torso: }
            modules:
              left: {parent: torso, prefix: x_}
              right: {parent: torso, prefix: x_}   # E[LF4113]:34 module 'right' declares PARTS
            """.replace(
                "PARTS",
                "material 'x_skin' differently from module 'left'; make the declarations equal, or give the module "
                "another prefix",
            ),
            {"left": blue, "right": red},
        )
    )
    assert names(result.robot.links) == ["torso", "x_palm"]


def test_a_module_that_is_no_tree_is_handed_out_for_its_own_check():
    broken = Spec("name: hand\nlinks: {palm: , finger: }\nsemantic: {groups: {hand: {links: [palm]}}}")
    result = lowered(
        Spec(
            """
            name: body
            links: {torso: }
            modules: {left: {parent: torso}}
            semantic:
              groups: {all: {subgroups: [left_hand]}}
              group_states: {all: {home: {left_hand: left_open}}}
            """,
            {"left": broken},
        )
    )
    (unmerged,) = result.unmerged
    assert names(unmerged.robot.links) == ["palm", "finger"]
    assert all(name in result.unresolved for name in ("left_palm", "left_finger", "left_hand", "left_joint"))
    assert names(result.robot.links) == ["torso"]


def test_a_module_with_gaps_is_joined_as_far_as_it_goes():
    faulty = Spec(
        """
        name: hand
        links: {palm: , finger: }
        joints:
          grip: {type: fixed, child: finger}
          # ^E[LF5005]:3 joint 'grip' has no 'parent'; write one, such as 'parent: palm'
        """
    )
    result = lowered(Spec("name: body\nlinks: {torso: }\nmodules: {left: {parent: torso}}", {"left": faulty}))
    assert result.unmerged == ()
    assert names(result.robot.links) == ["torso", "left_palm", "left_finger"]
    assert "left_grip" in result.unresolved
    assert "left_joint" in result.unresolved


def test_all_names_of_a_file_that_could_not_be_read_may_be_missing():
    result = lowered(Spec("name: body\nlinks: {torso: }\nmodules: {left: {parent: torso}}", {"left": None}))
    assert "left_anything" in result.unresolved
    assert "right_anything" not in result.unresolved
    assert result.robot.joints == ()


def test_a_parent_that_is_not_there_is_left_to_the_check_of_joints():
    robot = robot_of(Spec("name: body\nlinks: {torso: }\nmodules: {left: {parent: torsoo}}", {"left": HAND}))
    assert robot.joint("left_joint").parent == "torsoo"


def test_an_invalid_prefix_is_reported_at_the_prefix():
    result = lowered(
        Spec(
            """
            name: body
            links: {torso: }
            modules:
              left:
                parent: torso
                prefix: "left "   # E[LF4001]:13 'left ' is not a valid prefix: it may not contain ' '
            """,
            {"left": HAND},
        )
    )
    assert names(result.unmerged) == ["hand"]


STANDING = """
name: stand
links: {foot: }
semantic: {virtual_joints: {ground: {type: fixed, parent_frame: world, child_link: foot}}}"""
LEFT_OUT = (
    "   # N[LF5302]:29 virtual joint 'ground' is omitted: the file that uses this one attaches 'foot' to another link"
)


def test_a_virtual_joint_of_a_module_that_hangs_is_left_out_with_a_note():
    by_parent = Spec(
        "name: body\nlinks: {torso: }\nmodules: {leg: {parent: torso}}", {"leg": Spec(STANDING + LEFT_OUT)}
    )
    by_joint = Spec(
        """
        name: body
        links: {torso: }
        joints: {hip: {type: fixed, parent: torso, child: leg_foot}}
        modules: {leg: {}}
        """,
        {"leg": Spec(STANDING + LEFT_OUT)},
    )
    for spec in (by_parent, by_joint):
        assert robot_of(spec).semantic.virtual_joints == ()


def test_a_virtual_joint_of_the_base_stays():
    robot: Robot = robot_of(Spec("name: body\nmodules: {leg: {}}", {"leg": Spec(STANDING)}))
    assert names(robot.semantic.virtual_joints) == ["leg_ground"]


DRIVER = Spec(
    """
    name: driver
    links: {shoulder: }
    controllers: {controller_manager: {parameters: {update_rate: 500, lock_memory: true}}}
    """
)


def test_a_robot_has_one_manager_of_controllers_with_what_its_modules_agree_on():
    modules = "modules: {left: {parent: base}, right: {parent: base}}"
    robot = robot_of(Spec(f"name: cell\nlinks: {{base: }}\n{modules}", {"left": DRIVER, "right": DRIVER}))
    (manager,) = robot.controllers
    assert manager.parameters == {"update_rate": 500, "lock_memory": True}


def test_what_a_file_states_of_the_manager_wins_over_its_modules():
    own = "controllers: {controller_manager: {parameters: {update_rate: 100, cpu_affinity: 2}}}"
    spec = Spec(f"name: cell\nlinks: {{base: }}\nmodules: {{left: {{parent: base}}}}\n{own}", {"left": DRIVER})
    (manager,) = robot_of(spec).controllers
    assert manager.parameters == {"update_rate": 100, "cpu_affinity": 2, "lock_memory": True}
