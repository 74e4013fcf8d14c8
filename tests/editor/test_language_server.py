"""What a person gets in an editor with yaml-language-server: completions, hovers and faults, at places of specs."""

from pathlib import Path

import pytest
import yaml

from linkforge_compile import compile_text
from tests.conftest import ROOT
from tests.editor.language_server import Fault, LanguageServer

MODELINE = "# yaml-language-server: $schema=robot.schema.json\n"
HEAD = f"{MODELINE}linkforge: 1\nname: arm\n"

EVERYWHERE = {"for", "when", "extra", "extra_attributes", "extra_inside"}
"""Keys of most objects; one test checks that they are offered."""

GEOMETRY = ["box", "capsule", "cylinder", "mesh", "sphere"]
JOINT_TYPES = ["continuous", "fixed", "floating", "planar", "prismatic", "revolute"]
JOINT_KEYS = ["axis", "calibration", "child", "dynamics", "gazebo", "limits", "mimic", "origin", "parent"]
TYPED_JOINT_KEYS = sorted([*JOINT_KEYS, "safety_controller"])
SENSOR_KEYS = ["always_on", "frame", "link", "origin", "plugin", "topic", "update_rate", "visualize"]
SENSOR_BLOCKS = ["camera", "contact", "force_torque", "gps", "imu", "lidar"]
LINK_KEYS = ["collision", "gazebo", "inertial", "physics", "shape_order", "visual"]
SENSOR_KINDS = ["camera", "contact", "depth_camera", "force_torque", "gps", "gpu_lidar", "imu", "lidar", "ray"]
ROBOT_KEYS = [
    *("controllers", "data", "defaults", "description", "frames", "gazebo", "include", "joints", "links", "materials"),
    *("metadata", "modules", "mount", "packages", "parameters", "robot", "ros2_control", "semantic", "sensors"),
    *("transmissions", "variables", "variants", "version"),
]
LIMITS = ["acceleration", "deceleration", "effort", "jerk", "lower", "upper", "velocity"]
SEMANTIC_KEYS = [
    *("disabled_collisions", "enabled_collisions", "end_effectors", "group_states", "groups", "joint_properties"),
    *("link_sphere_approximations", "no_default_collision_links", "passive_joints", "virtual_joints"),
]

OFFERED = {
    # What is offered at the caret, in the order in which it is shown, but for the keys that stand everywhere.
    # Where a label is no key or word of the language, it is that of a snippet.
    "a half-typed section": ("jo|", ROBOT_KEYS),
    "a new link": ("links:\n  |", ["link"]),
    "a link": ("links:\n  base: |", ["link"]),
    "in a link": ("links:\n  base:\n    |", sorted([*LINK_KEYS, "link"])),
    "in a link that has shapes": (
        "links:\n  base:\n    visual: {box: [1, 1, 1]}\n    |\njoints:\n",
        ["collision", "gazebo", "inertial", "link", "physics", "shape_order"],
    ),
    "half a key of a link in flow style": ("links:\n  base: {v|}", sorted([*LINK_KEYS, "link"])),
    "in a visual": (
        "links:\n  base:\n    visual:\n      |",
        sorted([*GEOMETRY, "material", "name", "origin", "visual"]),
    ),
    "half a shape in flow style": (
        "links:\n  base:\n    visual: {cy|}",
        sorted([*GEOMETRY, "material", "name", "origin", "visual"]),
    ),
    "in a list of collisions": (
        # The server offers the snippet of an item twice, as a value and as keys.
        "links:\n  base:\n    collision:\n      - sp|",
        sorted([*GEOMETRY, "collision", "collision", "name", "origin"]),
    ),
    "a collision": ("links:\n  base:\n    collision: |", ["collision", "visual"]),
    "in a cylinder": (
        "links:\n  base:\n    visual:\n      cylinder:\n        |",
        ["cylinder", "length", "radius"],
    ),
    "an origin": ("links:\n  base:\n    visual:\n      origin: |", ["[x, y, z]", "xyz, rpy"]),
    "in an origin": ("joints:\n  elbow:\n    origin: {xy|}", ["[x, y, z]", "rpy", "xyz", "xyz, rpy"]),
    "in an inertial": ("links:\n  base:\n    inertial:\n      |", ["density", "inertia", "inertial", "mass", "origin"]),
    "a mass": ("links:\n  base:\n    inertial:\n      mass: |", ["1.2", "1.2 kg"]),
    "a new joint": ("joints:\n  |", ["fixed joint", "revolute joint"]),
    "in a joint": (
        "joints:\n  elbow:\n    |",
        sorted([*JOINT_KEYS, "fixed joint", "revolute joint", "safety_controller", "type"]),
    ),
    "in a fixed joint": (
        "joints:\n  weld:\n    type: fixed\n    |",
        [key for key in TYPED_JOINT_KEYS if key not in {"axis", "limits"}],
    ),
    "in a floating joint": (
        "joints:\n  weld: {type: floating, li|}",
        [key for key in TYPED_JOINT_KEYS if key != "axis"],
    ),
    "in a joint whose type is computed": (
        "joints:\n  weld:\n    type: $(kind)\n    |",
        TYPED_JOINT_KEYS,
    ),
    "in a module's fixed joint": (
        "modules: {arm: {use: a.robot.yaml, joint: {type: fixed, na|}}}",
        ["calibration", "dynamics", "gazebo", "mimic", "name", "safety_controller"],
    ),
    "in an imu": ("sensors:\n  front:\n    type: imu\n    |", sorted([*SENSOR_KEYS, "imu"])),
    "in a depth camera": ("sensors:\n  front: {type: depth_camera, ca|}", sorted([*SENSOR_KEYS, "camera"])),
    "in a sensor": (
        "sensors:\n  front:\n    |",
        # Two of them are also snippets.
        sorted([*SENSOR_KEYS, "camera", "lidar", *SENSOR_BLOCKS, "type"]),
    ),
    "a joint's type": ("joints:\n  elbow:\n    type: |", JOINT_TYPES),
    "half a joint's type in flow style": ("joints:\n  elbow: {type: rev|}", JOINT_TYPES),
    "an axis": ("joints:\n  elbow:\n    axis: |", ["-x", "-y", "-z", "x", "y", "z"]),
    "a joint's limits": ("joints:\n  elbow:\n    limits: |", ["limits"]),
    "in limits": ("joints:\n  elbow:\n    limits:\n      |", sorted([*LIMITS, "limits"])),
    "half a limit in flow style": (
        "joints:\n  elbow: {limits: {lo|}}",
        sorted([*LIMITS, "limits"]),
    ),
    "a flag": ("sensors:\n  front:\n    always_on: |", ["false", "true"]),
    "in a frame": ("frames:\n  tool0: {or|}", ["frame", "joint", "origin", "parent"]),
    "a new module": ("modules:\n  |", ["module"]),
    "in a module": (
        "modules:\n  arm:\n    |",
        ["joint", "macro", "module", "origin", "override", "parent", "prefix", "srdf", "use", "with"],
    ),
    "half a key of a module in flow style": (
        "modules:\n  arm: {us|}",
        ["joint", "macro", "module", "origin", "override", "parent", "prefix", "srdf", "use", "with"],
    ),
    "a module's file": (
        "modules:\n  arm:\n    use: |",
        ["arm.robot.yaml", "package://arm_description/robots/arm.robot.yaml"],
    ),
    "in a module's parameters": ("modules:\n  arm:\n    with:\n      |", ["parameter"]),
    "in an override": (
        "modules:\n  arm:\n    override:\n      |",
        [
            *("controllers", "gazebo", "joints", "links", "materials", "modules", "mount", "ros2_control", "semantic"),
            *("sensors", "transmissions"),
        ],
    ),
    "what deletes in an override": ("modules:\n  arm:\n    override:\n      links:\n        cover: |", ["null"]),
    "in a joint of an override": (
        "modules:\n  arm:\n    override:\n      joints:\n        elbow:\n          |",
        sorted([*JOINT_KEYS, "safety_controller", "type"]),
    ),
    "a new sensor": ("sensors:\n  |", ["camera", "lidar"]),
    "a sensor's kind": ("sensors:\n  front:\n    type: |", [*SENSOR_KINDS, "rgbd_camera"]),
    "half a sensor's kind in flow style": ("sensors:\n  front: {type: li|}", [*SENSOR_KINDS, "rgbd_camera"]),
    "in a camera": (
        "sensors:\n  front:\n    camera:\n      |",
        ["camera", "far_clip", "format", "height", "horizontal_fov", "near_clip", "noise", "width"],
    ),
    "in the semantic part": ("semantic:\n  |", SEMANTIC_KEYS),
    "half a key of the semantic part in flow style": ("semantic: {gr|}", SEMANTIC_KEYS),
    "a new group": ("semantic:\n  groups:\n    |", ["group"]),
    "in a group": (
        "semantic:\n  groups:\n    arm:\n      |",
        ["chain", "chains", "group", "joints", "kinematics", "links", "subgroups"],
    ),
    "in a chain": ("semantic:\n  groups:\n    arm: {chain: {ba|}}", ["base_link", "chain", "tip_link"]),
    "a group's states": ("semantic:\n  group_states:\n    arm: |", ["state"]),
    "a virtual joint's type": ("semantic:\n  virtual_joints:\n    w: {type: |}", ["fixed", "floating", "planar"]),
    "why a pair is disabled": (
        "semantic:\n  disabled_collisions:\n    base:\n      arm: |",
        ["Adjacent", "Always", "Default", "Never", "User"],
    ),
    "in a parameter": (
        "parameters:\n  reach:\n    |",
        ["default", "description", "enum", "maximum", "minimum", "parameter", "pattern", "type"],
    ),
    "in ros2_control": (
        "ros2_control:\n  arm:\n    |",
        ["gpios", "hardware_plugin", "joints", "parameters", "ros2_control", "sensors", "type"],
    ),
    "an interface": (
        "ros2_control:\n  arm:\n    joints:\n      elbow:\n        command_interfaces: [|]",
        ["effort", "position", "velocity"],
    ),
    "a list of interfaces": (
        "ros2_control:\n  arm:\n    joints:\n      elbow:\n        command_interfaces:\n          - |",
        ["effort", "position", "value", "velocity"],
    ),
    "interfaces that have ranges": (
        "ros2_control:\n  arm:\n    joints:\n      elbow:\n        command_interfaces:\n          |",
        ["interface"],
    ),
    "half a parameter of an interface in flow style": (
        "ros2_control: {arm: {joints: {elbow: {command_interfaces: {position: {mi|}}}}}}",
        ["initial_value", "interface", "max", "min"],
    ),
    "half a key of a frame's joint in flow style": (
        "frames: {tool0: {parent: arm, jo|}}",
        ["frame", "joint", "origin"],
    ),
    "half a key behind another in flow style": (
        "joints:\n  elbow: {type: revolute, pa|}",
        TYPED_JOINT_KEYS,
    ),
    "half a shape of a list in flow style": (
        "links: {base: {collision: [{cy|}]}}",
        sorted([*GEOMETRY, "collision", "collision", "name", "origin"]),
    ),
    "half a key of a module's joint in flow style": (
        "modules: {arm: {use: a.robot.yaml, joint: {ty|}}}",
        [
            *("axis", "calibration", "dynamics", "gazebo", "limits", "mimic", "moving joint", "name"),
            *("safety_controller", "type"),
        ],
    ),
    "half a limit of an override in flow style": (
        "modules: {arm: {override: {joints: {elbow: {limits: {lo|}}}}}}",
        LIMITS,
    ),
    "half a key of an end effector in flow style": (
        "semantic: {end_effectors: {hand: {pa|}}}",
        ["end effector", "group", "parent_group", "parent_link"],
    ),
    "half a reason in flow style": (
        "semantic: {disabled_collisions: {base: {arm: Ne|}}}",
        ["Adjacent", "Always", "Default", "Never", "User"],
    ),
    "passive joints": ("semantic:\n  passive_joints:\n    |", ["passive joint"]),
    "a file to include, which only the schema of a workspace knows": ("include: [|]", []),
    "in a plugin": ("gazebo:\n  plugins:\n    control:\n      |", ["filename", "parameters", "plugin"]),
}


@pytest.mark.parametrize(("document", "labels"), OFFERED.values(), ids=OFFERED)
def test_what_is_offered(server: LanguageServer, document: str, labels: list[str]):
    offered = [completion.label for completion in server.completions(HEAD + document)]
    assert [label for label in offered if label not in EVERYWHERE] == labels


IN_EXAMPLES = {
    # The same where a person is in the midst of a robot: a text of an example, and what stands there half-typed.
    "a joint's type": ("01_two_link_arm/two_link_arm", "    type: revolute", "    type: |", JOINT_TYPES),
    "a key of limits": (
        "01_two_link_arm/two_link_arm",
        "limits: {lower: -120 deg, upper: 120 deg,",
        "limits: {lower: -120 deg, up|,",
        ["acceleration", "deceleration", "jerk", "limits", "upper"],
    ),
    "a key of a link": (
        "01_two_link_arm/two_link_arm",
        "    inertial: {mass: 4 kg} ",
        "    i| ",
        ["gazebo", "inertial", "link", "physics", "shape_order"],
    ),
    "a key of a module": (
        "09_mobile_manipulator/mobile_manipulator",
        "    parent: torso\n",
        "    |\n",
        ["joint", "macro", "module", "override", "parent", "srdf", "with"],
    ),
    "a key of the semantic part": (
        "02_ur5e/ur5e_arm",
        "semantic:\n",
        "semantic:\n  |\n",
        [key for key in SEMANTIC_KEYS if key not in {"groups", "group_states", "disabled_collisions"}],
    ),
}


@pytest.mark.parametrize(("spec", "text", "typed", "labels"), IN_EXAMPLES.values(), ids=IN_EXAMPLES)
def test_what_is_offered_in_an_example(server: LanguageServer, spec: str, text: str, typed: str, labels: list[str]):
    written = (ROOT / "examples" / f"{spec}.robot.yaml").read_text("utf-8")
    assert text in written
    offered = server.completions(MODELINE + written.replace(text, typed, 1))
    assert [completion.label for completion in offered if completion.label not in EVERYWHERE] == labels


INSERTED = {
    # What is written where one of the offered is taken.
    "links": ("l|", "links:\n  ${1:link_name}:\n    visual:\n      box: [${2:0.1}, ${3:0.1}, ${4:0.1}]"),
    "limits": (
        "joints:\n  elbow:\n    |",
        "limits:\n  lower: ${1:-90 deg}\n  upper: ${2:90 deg}\n  effort: ${3:50 N*m}\n  velocity: ${4:90 deg/s}",
    ),
    "cylinder": (
        "links:\n  base:\n    visual:\n      |",
        "cylinder:\n  radius: ${1:40 mm}\n  length: ${2:0.3}",
    ),
    "chain": ("semantic:\n  groups:\n    arm:\n      |", "chain:\n  base_link: ${1:base}\n  tip_link: ${2:tool0}"),
    "link": ("links:\n  base: |", "\n  visual:\n    box: [${2:0.1}, ${3:0.1}, ${4:0.1}]"),
    "variables": ("v|", "variables:\n  ${1:half}: \\$(${2:reach / 2})"),
}


@pytest.mark.parametrize(("label", "place"), INSERTED.items(), ids=INSERTED)
def test_what_is_put_in(server: LanguageServer, label: str, place: tuple[str, str]):
    document, text = place
    found = {completion.label: completion.inserted for completion in server.completions(HEAD + document)}
    assert found[label].startswith(text)


def test_the_keys_that_stand_everywhere_are_offered_with_what_they_mean(server: LanguageServer):
    found = {
        completion.label: completion.description for completion in server.completions(f"{HEAD}joints:\n  elbow:\n    |")
    }
    assert found.keys() >= EVERYWHERE
    assert "for each item of a list" in found["for"]
    assert "[rad]" in found["limits"] or "Limits of its position" in found["limits"]


def test_a_new_file_is_begun_with_the_first_lines_of_a_robot(server: LanguageServer):
    found = {completion.label: completion.inserted for completion in server.completions(f"{MODELINE}|")}
    assert found["robot"].startswith("linkforge: 1\nname: ${1:my_robot}\nlinks:\n")
    assert found["linkforge"] == "linkforge: 1"


HOVERS = {
    "links": ("li|nks: {}", ["The rigid bodies.", "inertial: {mass: 4 kg}"]),
    "a link": ("links:\n  ba|se: {visual: {}}", ["A rigid body"]),
    "limits": ("joints: {elbow: {lim|its: {}}}", ["Limits of its position, effort and velocity", "velocity: 90 deg/s"]),
    "a unit": ("joints: {elbow: {limits: {eff|ort: 3 N}}}", ["torque [N*m] or force [N]", "50 N*m"]),
    "a word": ("joints: {elbow: {type: revo|lute}}", ["`revolute`: Turns about its axis between two limits."]),
    "a mass": ("links: {base: {inertial: {ma|ss: 4}}}", ["Mass of the link [kg].", "1.2 kg"]),
    "a range of angles": (
        "joints: {elbow: {limits: {lo|wer: 0}}}",
        ["[rad] for revolute, [m] for prismatic", "-120 deg"],
    ),
    "an orientation": ("joints: {elbow: {origin: {r|py: [0, 0, 0]}}}", ["roll, pitch, yaw", "[rad]", "[0, 90 deg, 0]"]),
    "a rate": ("sensors: {front: {update|_rate: 30}}", ["[Hz]", "30 Hz by default", "100 Hz"]),
    "a shape": (
        "links: {base: {visual: {cyl|inder: {}}}}",
        ["A cylinder along z, centred on its origin.", "radius: 40 mm"],
    ),
    "a module's file": ("modules: {arm: {u|se: arm.robot.yaml}}", ["or a vendor's `.urdf` or `.xacro`", "Required."]),
    "an override": ("modules: {arm: {over|ride: {}}}", ["`null` deletes", "joints: {elbow: {limits: {effort: 20}}}"]),
    "the semantic part": ("seman|tic: {groups: {}}", ["Becomes the SRDF."]),
    "a sensor's kind": ("sensors: {front: {type: lid|ar}}", ["`lidar`: A laser scanner; settings in `lidar`."]),
}


@pytest.mark.parametrize(("document", "phrases"), HOVERS.values(), ids=HOVERS)
def test_hover_text_contains_the_phrases(server: LanguageServer, document: str, phrases: list[str]):
    shown = server.hover(HEAD + document)
    assert [phrase for phrase in phrases if phrase not in shown] == []


FAULTS = {
    # What is underlined, and the message; flow maps of one entry, since the server joins equal messages.
    "an unknown key": ("links: {base: {colision: visual}}", [("colision", "Property colision is not allowed.")]),
    "an unknown key within": (
        "joints: {elbow: {limits: {uper: 1}}}",
        [("uper", "Property uper is not allowed.")],
    ),
    "no quantity": (
        "links: {base: {inertial: {mass: heavy}}}",
        [("heavy", "expected a number [kg] or a quantity such as '3 kg'")],
    ),
    "a unit of another dimension": (
        "links: {base: {inertial: {mass: 3 mm}}}",
        [("3 mm", "expected a number [kg] or a quantity such as '3 kg'")],
    ),
    "a unit of another dimension in a vector": (
        "joints: {elbow: {origin: {xyz: [0, 0, 90 deg]}}}",
        [("90 deg", "expected a number [m] or a quantity such as '25 mm'")],
    ),
    "a misspelt unit": (
        "joints: {elbow: {limits: {lower: -90 degrees}}}",
        [("-90 degrees", "expected a number [rad or m] or a quantity such as '90 deg' or '40 mm'")],
    ),
    "a product and a power": (
        "links: {base: {inertial: {mass: 3kg, inertia: {ixx: 1 g·cm², iyy: 1 kg*m**2, izz: 1e-3 kg*cm^2}}}}",
        [],
    ),
    "no word": (
        "joints: {elbow: {axis: up}}",
        [("up", 'Value is not accepted. Valid values: "x", "y", "z", "-x", "-y", "-z".')],
    ),
    "a list for a map": (
        "joints: [elbow]",
        [("[elbow]", "expected a map of joints by name")],
    ),
    "a number for a map": (
        "joints: {elbow: {limits: 3}}",
        [("3", "expected a map of lower, upper, effort and velocity")],
    ),
    "URDF's parent": ("joints: {elbow: {parent: {link: base}}}", [("{link: base}", "expected a name")]),
    "two numbers for three": (
        "joints: {elbow: {origin: [1, 2]}}",
        [("[1, 2]", "Array has too few items. Expected 3 or more.")],
    ),
    "no flag": ("sensors: {front: {always_on: yes}}", [("yes", "expected true or false")]),
    "a file for a list": ("include: palette.yaml", [("palette.yaml", "expected a list of file names")]),
    "an empty section": ("links:\n  base:\n    visual:\njoints:\n", []),
    "an expression": ("joints: {elbow: {type: $(kind), axis: $(axis), limits: $(limits), parent: $(a)}}", []),
    "a name that YAML reads as another kind": ("joints: {elbow: {parent: true, child: 3}}", []),
    "what is repeated": ("semantic: {groups: {g: {joints: [{for: {i: 3}, value: j_$(i)}, elbow]}}}", []),
}


@pytest.mark.parametrize(("document", "faults"), FAULTS.values(), ids=FAULTS)
def test_what_is_underlined(server: LanguageServer, document: str, faults: list[tuple[str, str]]):
    assert server.faults(HEAD + document) == [Fault(*fault) for fault in faults]


CONTINUED = {
    # A list or map in brackets on several lines, and whether editors take it.
    "at column 0": ("links: {base: ,\ntip: }\n", False),
    "by a tab": ("links: {base: ,\n\ttip: }\n", False),
    "by a space": ("links: {base: ,\n tip: }\n", True),
    "by a space and a tab": ("links: {base: ,\n \ttip: }\n", True),
    "at the column of its key": ("links:\n  base: {visual: {box: [1,\n  1, 1]}}\n", False),
    "beyond its key": ("links:\n  base: {visual: {box: [1,\n   1, 1]}}\n", True),
    "below the key": ("links:\n  base:\n    {visual:\n   {box: [1, 1, 1]}}\n", True),
    "in a list at the column of the dash": ("include:\n- a.yaml\ndata: {}\nlinks: {base: {collision: [\n]}}\n", False),
    "in an item, at the column of its key": ("gazebo:\n  - plugins: {a: {filename: b,\n    parameters: }}\n", False),
    "in an item, beyond its key": ("gazebo:\n  - plugins: {a: {filename: b,\n     parameters: }}\n", True),
    "in an item in brackets": ("gazebo:\n  - {material: a,\n  mu1: 1}\n", False),
    "in an item in brackets, beyond the dash": ("gazebo:\n  - {material: a,\n   mu1: 1}\n", True),
    "in an item after an anchor": ("gazebo: &all\n  - {material: a,\n  mu1: 1}\nvariables: {again: *all}\n", False),
    "in an item after an anchor, beyond the dash": (
        "gazebo: &all\n  - {material: a,\n   mu1: 1}\nvariables: {again: *all}\n",
        True,
    ),
    "in an item after an anchor, in the column of the key": (
        "include: &all\n- [a.yaml,\nb.yaml]\nvariables: {again: *all}\n",
        False,
    ),
    "after an anchor and a comment": (
        "gazebo: &all # two\n\n  - {material: a,\n   mu1: 1}\nvariables: {again: *all}\n",
        True,
    ),
    "closed at the column of its key": ("links: {\n  base: {visual: {sphere: 1}},\n}\n", True),
    "closed at the column of its key by two": ("links: {base: {\n}}\n", False),
    "closed by a tab": ("links: {\n  base: ,\n\t}\n", True),
    "a comment and an empty line": ("links: {\n# base\n\n  base: }\n", True),
    "in quotes": ("description: 'x'\nlinks: {base: {collision: [], extra: '<a>\n</a>'}}\n", False),
}


@pytest.mark.parametrize(("document", "is_taken"), CONTINUED.values(), ids=CONTINUED)
def test_check_warns_of_lines_that_editors_refuse(server: LanguageServer, document: str, is_taken: bool):
    spec = f"linkforge: 1\nname: arm\n{document}"
    warned = [one for one in compile_text(spec).diagnostics if one.code.id == "LF1077"]
    assert (server.faults(MODELINE + spec) == [], warned == []) == (is_taken, is_taken)


SPECS = [
    path
    for folder in ("examples", "tests/cases/good")
    for path in sorted((ROOT / folder).rglob("*.yaml"))
    if path.read_text("utf-8").startswith("linkforge:") or "\nlinkforge:" in path.read_text("utf-8")
]


@pytest.mark.parametrize("path", SPECS, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_nothing_is_underlined_in_a_spec_that_compiles(server: LanguageServer, path: Path):
    assert server.faults(MODELINE + path.read_text("utf-8")) == []


def test_the_specs_are_those_of_the_examples_and_cases():
    assert len(SPECS) > 20
    assert all("linkforge" in yaml.safe_load(path.read_text("utf-8")) for path in SPECS)
