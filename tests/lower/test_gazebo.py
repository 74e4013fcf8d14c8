"""Gazebo: blocks of links, joints and the robot, with tags that are keys, other elements, and plugins."""

from linkforge_compile import compile_text
from linkforge_compile.core import LinkPhysics, Robot
from linkforge_compile.lower import devices
from tests.lower.specs import Spec, lowered, robot_of

ARM = """
    name: arm
    links:
      base: {}
      upper: {}
    joints:
      shoulder: {type: fixed, parent: base, child: upper, gazebo: {preserveFixedJoint: true}}
"""


def references(robot: Robot) -> list[str | None]:
    return [block.reference for block in robot.gazebo_elements]


def test_a_block_refers_to_the_entry_that_contains_it():
    robot = robot_of("""
        name: arm
        gazebo: {static: true}
        joints:
          shoulder: {type: fixed, parent: base, child: upper, gazebo: {provide_feedback: true}}
        links:
          base: {gazebo: [{material: Gazebo/Grey}, {mu1: 1}]}
          upper:
    """)
    assert references(robot) == ["base", "base", "shoulder", None]
    assert robot.gazebo_elements[0].material == "Gazebo/Grey"
    assert robot.gazebo_elements[2].provide_feedback is True
    assert robot.gazebo_elements[3].static is True


def test_the_tags_of_sdformat_are_read_with_their_units():
    [block] = robot_of("""
        name: cart
        links:
          base:
            gazebo:
              properties: {custom: 1.0}
              mu1: 8e-1
              mu2: 1.0
              maxVel: 1 cm/s
              minDepth: 1 mm
              maxContacts: 4
              selfCollide: true
              fdir1: [1, 0, 0.50]
              springReference: 180 deg
    """).gazebo_elements
    assert block.properties == {
        "mu1": "0.8",
        "mu2": "1.0",
        "maxVel": "0.01",
        "minDepth": "0.001",
        "maxContacts": "4",
        "selfCollide": "true",
        "fdir1": "1 0 0.5",
        "springReference": "3.141592653589793",
        "custom": "1.0",
    }


def test_a_block_of_the_robot_may_be_about_a_link_of_a_module():
    spec = Spec("name: cell\nlinks: {table: }\nmodules: {left: {parent: table}}\n", {"left": Spec(ARM)})
    spec.text += "gazebo: {reference: left_upper, mu2: 1}\n"
    assert references(robot_of(spec)) == ["left_upper", "left_shoulder"]


def test_the_joint_of_a_module_has_a_block_of_its_own():
    spec = Spec(
        """
        name: cell
        links: {table: }
        modules:
          left: {parent: table, joint: {name: clamp, gazebo: {preserveFixedJoint: true}}}
        """,
        {"left": Spec(ARM)},
    )
    assert references(robot_of(spec)) == ["left_shoulder", "clamp"]


def test_plugins_of_one_name_stand_in_a_list():
    [block] = robot_of("""
        name: cart
        links: {base: }
        gazebo:
          plugins:
            - {name: states, filename: a.so}
            - {name: states, filename: b.so}
    """).gazebo_elements
    assert [(plugin.name, plugin.filename) for plugin in block.plugins] == [("states", "a.so"), ("states", "b.so")]


def test_physics_are_the_link_s_own():
    robot = robot_of("""
        name: cart
        links: {base: {physics: {self_collide: true, mu: 0.5, kp: 1e6}}}
    """)
    assert robot.link("base").physics == LinkPhysics(self_collide=True, mu=0.5, kp=1e6)


def test_a_faulty_field_leaves_the_rest_of_its_block():
    robot = lowered("""
        name: cart
        links:
          base:
            gazebo:
              stop_erp: 2   # E[LF5006]:17 stop_erp must be from 0 to 1, found 2
              mu1: slippery   # E[LF5001]:12 mu1 takes a bare number, found 'slippery'
              mu2: 1
    """).robot
    assert robot.gazebo_elements[0].properties == {"mu2": "1"}


def test_blocks_that_name_their_joint_look_through_the_joints_once(monkeypatch):
    looked = []

    def joints_of(file):
        looked.append(file)
        return original(file)

    original = devices.joints_of
    monkeypatch.setattr(devices, "joints_of", joints_of)
    blocks = ", ".join("{reference: base, kp: 1}" for _ in range(5))
    robot = compile_text(f"linkforge: 1\nname: case\nlinks: {{base: }}\ngazebo: [{blocks}]\n").result()
    assert (len(robot.gazebo_elements), len(looked)) == (5, 1)
