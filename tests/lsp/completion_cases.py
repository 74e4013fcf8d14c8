"""Positions in specs of examples/, what completion offers there, and what accepting an item makes of them."""

from pathlib import Path
from typing import NamedTuple

EXAMPLES = Path(__file__).parents[2] / "examples"
ARM = "01_two_link_arm/two_link_arm.robot.yaml"
FAMILY = "04_ur_family/ur.robot.yaml"
GRIPPER = "05_gripper/ur5e_gripper.robot.yaml"
ROVER = "06_rover/rover.robot.yaml"
QUADRUPED = "07_quadruped/quadruped.robot.yaml"
HAND = "08_hand/hand.robot.yaml"
MOBILE = "09_mobile_manipulator/mobile_manipulator.robot.yaml"
VENDOR = "10_vendor_robots/vendor_robots.robot.yaml"
PAN_TILT = "11_ros2_package/robots/pan_tilt.robot.yaml"


class Case(NamedTuple):
    """A position in an example: `new` replaces `old`, with a ¦ at the position.

    `offered` are labels that must be there, `hidden` those that must not. `accepted` is the label to accept,
    `makes` what then is in place of `new`. The result parses; it has no diagnostics if `is_clean`.
    """

    file: str
    old: str
    new: str
    offered: str
    hidden: str = ""
    accepted: str = ""
    makes: str = ""
    is_clean: bool = True


KEYS = (
    Case(
        ARM,
        "  elbow:\n    type: revolute\n",
        "  elbow:\n    ¦\n",
        "type",
        "parent child axis",
        "type",
        "  elbow:\n    type: \n",
        False,
    ),
    Case(
        ARM,
        "    dynamics: {damping: 0.1}\n\n  elbow",
        "    dyn¦\n\n  elbow",
        "dynamics mimic",
        "limits",
        "dynamics",
        "    dynamics:\n      \n\n  elbow",
    ),
    Case(
        ARM,
        "limits: {lower: -120 deg, upper: 120 deg, ",
        "limits: {lower: -120 deg, ¦",
        "upper",
        "lower effort velocity",
        "upper",
        "limits: {lower: -120 deg, upper: , ",
        False,
    ),
    Case(
        ARM,
        "dynamics: {damping: 0.1}\n\n  elbow",
        "dynamics: {¦}\n\n  elbow",
        "damping friction",
        "",
        "friction",
        "dynamics: {friction: }\n\n  elbow",
    ),
    Case(
        ARM,
        "    inertial: {mass: 4 kg} ",
        "    inertial: {ma¦ss: 4 kg} ",
        "mass",
        "",
        "density",
        "    inertial: {density: 4 kg} ",
        False,
    ),
    Case(
        ARM,
        "      material: orange\n    collision: visual",
        "      ¦\n    collision: visual",
        "material mesh",
        "box origin",
        "material",
        "      material: \n    collision: visual",
    ),
    Case(
        ARM,
        "      - sphere: 30 mm ",
        "      - ¦: 30 mm ",
        "sphere cylinder",
        "origin material",
        "sphere",
        "      - sphere: 30 mm ",
    ),
    Case(ARM, "      - sphere: 30 mm ", "      - sphere: 30 mm\n        ¦\n ", "name", "sphere origin material"),
    Case(
        ARM,
        "frames:\n",
        "¦\nframes:\n",
        "sensors semantic mount",
        "frames links joints name",
        "sensors",
        "sensors:\n  \nframes:\n",
    ),
    Case(ARM, "frames:\n", "sem¦\nframes:\n", "semantic", "", "semantic", "semantic:\n  \nframes:\n"),
    Case(ARM, "  tool0: ", "  ¦:  {parent: upper}\n  tool0: ", "", "tool0"),
    Case(
        ARM,
        "links:\n  base:",
        "links:\n  ¦\n  base:",
        "link",
        "",
        "link",
        "links:\n  link_name:\n    visual:\n      box: [0.1, 0.1, 0.1]\n    collision: visual\n"
        "    inertial:\n      mass: 1 kg\n  base:",
        False,
    ),
    Case(
        ROVER,
        "    type: gpu_lidar\n",
        "    type: gpu_lidar\n    ¦\n",
        "always_on plugin",
        "lidar camera imu gps link type",
    ),
    Case(
        ROVER,
        "joints:\n  base_joint: {type: fixed, ",
        "joints:\n  base_joint: {type: fixed, ¦",
        "dynamics",
        "origin axis limits type parent child",
    ),
    Case(
        ROVER,
        "    odom_joint: {type: planar, ",
        "    odom_joint: {¦",
        "type",
        "parent_frame child_link",
        "type",
        "    odom_joint: {type: , ",
        False,
    ),
    Case(ROVER, "  sim: {hardware: gazebo}", "  sim: {¦}", "length hardware", "", "lidar", "  sim: {lidar: }"),
    Case(
        MOBILE,
        "semantic:\n  groups:\n",
        "semantic:\n  ¦\n  groups:\n",
        "virtual_joints passive_joints",
        "groups group_states",
        "virtual_joints",
        "semantic:\n  virtual_joints:\n    \n  groups:\n",
    ),
    Case(
        MOBILE,
        "      home: {arms: home, hands: closed}",
        "      home: {arms: home, ¦}",
        "hands left_elbow_joint",
        "arms torso_joint",
        "hands",
        "      home: {arms: home, hands: }",
        False,
    ),
    Case(
        MOBILE,
        "    base_link: {torso: Adjacent}",
        "    base_link: {¦: Adjacent}",
        "torso left_tool0",
        "",
        "torso",
        "    base_link: {torso: Adjacent}",
    ),
)

WORDS_AND_NAMES = (
    Case(
        ARM,
        "    type: revolute\n    parent: base",
        "    type: ¦\n    parent: base",
        "revolute prismatic fixed",
        "axis",
        "revolute",
        "    type: revolute\n    parent: base",
    ),
    Case(
        ARM, "    parent: base\n", "    parent: ¦\n", "base", "shoulder upper lower tool0", "base", "    parent: base\n"
    ),
    Case(ARM, "    child: lower\n", "    child: lo¦\n", "lower", "", "lower", "    child: lower\n"),
    Case(ARM, "    parent: lower\n", '    parent: "¦"\n', "base lower", "", "lower", '    parent: "lower"\n'),
    Case(
        ARM,
        "      material: steel\n    collision: visual                #",
        "      material: ¦\n    collision: visual                #",
        "steel orange",
        "",
        "orange",
        "      material: orange\n    collision: visual                #",
    ),
    Case(
        ARM,
        "    collision: visual\n    inertial: {density: 540}",
        "    collision: ¦\n    inertial: {density: 540}",
        "visual",
        "",
        "visual",
        "    collision: visual\n    inertial: {density: 540}",
    ),
    Case(ARM, "    type: length\n", "    type: ¦\n", "", "", "length", "    type: length\n"),
    Case(
        ARM,
        "    axis: y\n    limits: {lower: -120",
        "    axis: ¦\n    limits: {lower: -120",
        "x y z",
        "",
        "y",
        "    axis: y\n    limits: {lower: -120",
    ),
    Case(ROVER, "    for: {side: $(sides)}", "    for: {side: ¦}", "3", "", "3", "    for: {side: 3}", False),
    Case(
        ROVER,
        "    link: lidar_link\n",
        "    link: ¦\n",
        "lidar_link base_link left_wheel",
        "",
        "lidar_link",
        "    link: lidar_link\n",
    ),
    Case(
        ROVER,
        "child_link: base_footprint",
        "child_link: ¦",
        "base_footprint base_link",
        "odom",
        "base_footprint",
        "child_link: base_footprint",
    ),
    Case(
        ROVER,
        "        state_interfaces: [position, velocity]\n",
        "        state_interfaces: [¦]\n",
        "position velocity effort",
    ),
    Case(
        MOBILE,
        "torso_joint: {type: fixed, parent: deck",
        "torso_joint: {type: fixed, parent: ¦",
        "deck base_link front_caster",
        "torso left_tool0 right_gripper_palm tool0",
        "deck",
        "torso_joint: {type: fixed, parent: deck",
    ),
    Case(
        MOBILE,
        "    upper_body: {subgroups: [arms, hands]}",
        "    upper_body: {subgroups: [arms, ¦]}",
        "hands left_ur_manipulator",
        "ur_manipulator",
        "hands",
        "    upper_body: {subgroups: [arms, hands]}",
    ),
    Case(
        MOBILE,
        "      home: {arms: home, hands: closed}",
        "      home: {arms: ¦, hands: closed}",
        "home up",
        "open closed",
        "up",
        "      home: {arms: up, hands: closed}",
    ),
    Case(
        MOBILE,
        "    left_wheels: [left_wheel_joint]",
        "    left_wheels: [¦]",
        "left_wheel_joint",
        "left_wheel",
        "left_wheel_joint",
        "    left_wheels: [left_wheel_joint]",
    ),
    Case(
        MOBILE,
        "base_link: {torso: Adjacent}",
        "base_link: {torso: ¦}",
        "Adjacent Never",
        "",
        "Adjacent",
        "base_link: {torso: Adjacent}",
    ),
    Case(GRIPPER, "    parent: tool0 ", "    parent: ¦ ", "tool0 wrist_3_link", "", "tool0", "    parent: tool0 "),
    Case(
        GRIPPER,
        "parent_group: ur_manipulator}",
        "parent_group: ¦}",
        "ur_manipulator arm_and_gripper",
        "gripper",
        "ur_manipulator",
        "parent_group: ur_manipulator}",
    ),
    Case(
        QUADRUPED,
        "  imu: {type: imu, link: trunk,",
        "  imu: {type: ¦, link: trunk,",
        "imu camera contact",
        "",
        "imu",
        "  imu: {type: imu, link: trunk,",
    ),
)

MODULES = (
    Case(
        MOBILE,
        "      length: 0.9 m\n",
        "      ¦\n",
        "length lidar camera",
        "width hardware mass",
        "length",
        "      length: \n",
    ),
    Case(
        MOBILE,
        "      length: 0.9 m\n",
        "      length: 900 ¦\n",
        "m mm",
        "kg deg",
        "mm",
        "      length: 900 mm\n",
        False,
    ),
    Case(
        MOBILE,
        "      hardware: $(hardware)\n",
        "      hardware: ¦\n",
        "mock gazebo real",
        "",
        "mock",
        "      hardware: mock\n",
    ),
    Case(
        MOBILE,
        "        lidar_joint: {origin: ",
        "        ¦: {origin: ",
        "left_wheel_joint lidar_joint",
        "torso_joint",
        "lidar_joint",
        "        lidar_joint: {origin: ",
    ),
    Case(
        MOBILE,
        "        lidar_joint: {origin: {xyz: [0.35, 0, 25 mm]}} ",
        "        lidar_joint: {¦} ",
        "origin",
        "xyz",
        "origin",
        "        lidar_joint: {origin: } ",
        False,
    ),
    Case(
        HAND,
        "    with: {length: 60 mm, thickness: 18 mm}",
        "    with: {length: 60 mm, ¦}",
        "thickness",
        "length",
        "thickness",
        "    with: {length: 60 mm, thickness: }",
        False,
    ),
    Case(
        GRIPPER,
        "    with: {model: ur5e, hardware: mocked}",
        "    with: {model: ¦, hardware: mocked}",
        "ur3e ur5e ur10e",
        "",
        "ur10e",
        "    with: {model: ur10e, hardware: mocked}",
    ),
    Case(
        VENDOR,
        "        shoulder_pan_joint: {limits",
        "        ¦: {limits",
        "shoulder_pan_joint elbow_joint",
        "arm_shoulder_pan_joint",
        "shoulder_pan_joint",
        "        shoulder_pan_joint: {limits",
    ),
    Case(
        VENDOR,
        "      links: {world: null}           # the",
        "      links: {world: ¦}           # the",
        "null",
        "",
        "null",
        "      links: {world: null}           # the",
    ),
    Case(
        VENDOR,
        "    use: ../02_ur5e/ur5e.urdf\n",
        "    use: ../02_ur5e/¦\n",
        "ur5e.robot.yaml ur5e.urdf",
        "ur5e.srdf",
        "ur5e.urdf",
        "    use: ../02_ur5e/ur5e.urdf\n",
    ),
    Case(
        VENDOR,
        "    srdf: ../02_ur5e/ur5e.srdf ",
        "    srdf: ../02¦/ur5e.srdf ",
        "02_ur5e/",
        "",
        "02_ur5e/",
        "    srdf: ../02_ur5e//ur5e.srdf ",
        False,
    ),
    Case(
        VENDOR,
        "    parent: arm_tool0\n",
        "    parent: ¦\n",
        "pedestal arm_tool0",
        "tool0 gripper_robotiq_85_base_link",
        "arm_tool0",
        "    parent: arm_tool0\n",
    ),
    Case(  # the gripper is on the arm
        VENDOR,
        "    parent: pedestal",
        "    parent: ¦",
        "pedestal",
        "arm_tool0 gripper_robotiq_85_base_link",
        "pedestal",
        "    parent: pedestal",
    ),
)

UNITS = (
    Case(ARM, "inertial: {mass: 4 kg}", "inertial: {mass: 4 ¦}", "kg g lb", "m mm", "kg", "inertial: {mass: 4 kg}"),
    Case(ARM, "inertial: {mass: 0.8 kg}", "inertial: {mass: 0.8 k¦}", "kg", "", "kg", "inertial: {mass: 0.8 kg}"),
    Case(
        ARM,
        "limits: {lower: -120 deg,",
        "limits: {lower: -120 ¦,",
        "rad deg",
        "m mm",
        "deg",
        "limits: {lower: -120 deg,",
    ),
    Case(ARM, "effort: 20 N*m,", "effort: 20 N*¦,", "N*m", "kg N", "N*m", "effort: 20 N*m,"),
    Case(ARM, "rpy: [0, 90 deg, 0]", "rpy: [0, 90 ¦, 0]", "rad deg", "m", "deg", "rpy: [0, 90 deg, 0]"),
    Case(ARM, "    default: 0.8 m\n", "    default: 800 ¦\n", "m mm", "deg", "mm", "    default: 800 mm\n"),
)

EXPRESSIONS = (
    Case(ARM, "  half: $(reach / 2)", "  half: $(¦ / 2)", "reach half tube min", "", "reach", "  half: $(reach / 2)"),
    Case(
        ARM,
        "      box: $(tube)\n      origin: [0, 0, $(half / 2)]\n      material",
        "      box: $(tu¦)\n      origin: [0, 0, $(half / 2)]\n      material",
        "tube",
        "",
        "tube",
        "      box: $(tube)\n      origin: [0, 0, $(half / 2)]\n      material",
    ),
    Case(
        HAND, "$(palm.thickness), ", "$(palm.¦), ", "width length thickness", "palm", "thickness", "$(palm.thickness), "
    ),
    Case(MOBILE, "$(side.y * 0.15)", "$(side.¦ * 0.15)", "name y", "side", "y", "$(side.y * 0.15)"),
    Case(
        MOBILE, "  $(side.name)_gripper:\n", "  $(side.¦)_gripper:\n", "name y", "", "name", "  $(side.name)_gripper:\n"
    ),
    Case(MOBILE, "$(plugins[hardware])", "$(plugins['¦'])", "mock gazebo", "", "mock", "$(plugins['mock'])"),
    Case(
        ROVER,
        '$(hardware == "gazebo")',
        '$(hardware == "¦")',
        "mock gazebo real",
        "",
        "gazebo",
        '$(hardware == "gazebo")',
    ),
    Case(
        ROVER,
        "    origin: [0, 0, $(lidar_length / 2)]",
        "    origin: [0, 0, $(lidar_¦ / 2)]",
        "lidar_length lidar",
        "",
        "lidar_length",
        "    origin: [0, 0, $(lidar_length / 2)]",
    ),
    Case(
        ROVER,
        "      parameters: {parameters: $(controllers)}",
        "      parameters: {parameters: $(controllers), joint: $(joint('¦'))}",
        "base_joint left_wheel_joint",
        "base_link",
        "lidar_joint",
        "      parameters: {parameters: $(controllers), joint: $(joint('lidar_joint'))}",
    ),
    Case(FAMILY, "$(numbers.base)", "$(numbers.¦)", "base", "model", "base", "$(numbers.base)"),
)

MALFORMED = (
    Case(
        ARM,
        "    parent: lower\n    origin: {xyz: [0, 0, $(half)], rpy: [0, 90 deg, 0]}",
        "    parent: ¦\n    origin: {xyz: [0, 0,",
        "base upper lower",
        "shoulder",
    ),
    Case(
        ARM,
        "joints:\n  shoulder:\n    type: revolute\n    parent: base\n",
        "joints: [\n  shoulder:\n    type: revolute\n    parent: ¦\n",
        "base",
        "upper",
    ),
    Case(
        MOBILE,
        "torso_joint: {type: fixed, parent: deck, child: torso}",
        "torso_joint: {type: fixed, parent: ¦",
        "deck torso left_tool0",
        "",
    ),
    Case(
        MOBILE,
        "torso_joint: {type: fixed, parent: deck, child: torso}",
        "torso_joint: {type: fixed, ¦",
        "parent child origin",
        "type",
    ),
    Case(
        MOBILE, "      length: 0.9 m\n      width: 0.6 m\n", "      length: 0.9 m: 3\n      ¦\n", "camera lidar", "mass"
    ),
    Case(
        MOBILE,
        "name: mobile_manipulator\n",
        "name: mobile: manipulator\nlinks:\n  base_link: {¦\n",
        "visual inertial",
        "",
    ),
    Case(HAND, "$(palm.thickness), $(palm.width), $(palm.length)]", "$(palm.¦", "width length thickness", ""),
    Case(ROVER, '  when: $(hardware == "gazebo")\n', '  when: $(hardware == "¦\n', "mock gazebo real", ""),
)

CASES = (*KEYS, *WORDS_AND_NAMES, *MODULES, *UNITS, *EXPRESSIONS, *MALFORMED)
