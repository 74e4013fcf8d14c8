from linkforge_compile.checks import check
from linkforge_compile.core import GazeboElement, GazeboPlugin, Joint, JointType, Link, Robot
from linkforge_compile.diagnostics import UnresolvedNames
from tests.checks.robots import X, body, fixed, messages_of, robot, turning


def wheel(name: str, parent: str, child: str) -> Joint:
    return Joint(name, JointType.CONTINUOUS, parent, child, axis=X)


def test_a_moving_frame_with_a_body_below_is_dropped_by_gazebo():
    subject = robot("base hand", turning("pan", "base", "head"), turning("tilt", "head", "hand"))
    subject.add_link(Link("head"))
    assert messages_of(subject) == [
        "LF6004 joint 'pan' moves link 'head', which has no mass: Gazebo drops it with everything below it, "
        "joint 'tilt' too"
    ]


def test_a_moving_frame_is_fine_with_a_body_fixed_to_it():
    subject = robot("base hand camera", turning("pan", "base", "head"), turning("tilt", "head", "hand"))
    subject.links += (Link("head"), Link("bracket"))
    subject.joints += (fixed("bolt", "head", "bracket"), fixed("glue", "bracket", "camera"))
    assert messages_of(subject) == []


def test_frames_that_carry_nothing_are_fine():
    subject = robot("base", turning("pan", "base", "head"), fixed("tool", "head", "tool0"))
    subject.links += (Link("head"), Link("tool0"))
    assert messages_of(subject) == []


def test_mass_is_not_missed_while_parts_of_the_robot_are_missing():
    subject = robot("base hand", turning("pan", "base", "head"), turning("tilt", "head", "hand"))
    subject.add_link(Link("head"))
    assert messages_of(subject, UnresolvedNames(frozenset({"counterweight"}))) == []


def test_a_chain_of_moving_frames_is_reported_once_with_the_dropped_joints():
    subject = robot(
        "base hand tip", wheel("z", "base", "roll"), wheel("y", "roll", "pitch"), wheel("x", "pitch", "hand")
    )
    subject.links += (Link("roll"), Link("pitch"))
    subject.joints += (fixed("glue", "hand", "tip"),)
    (diagnostic,) = check(subject, UnresolvedNames())
    assert diagnostic.message == (
        "joint 'z' moves link 'roll', which has no mass: Gazebo drops it with everything below it, joints 'y' and "
        "'x' too"
    )
    assert [note.message for note in diagnostic.notes] == ["joint 'y' is lost", "joint 'x' is lost"]


def test_a_massless_root_loses_the_whole_robot_in_gazebo_alone():
    subject = Robot("r", links=[Link("base"), body("arm")], joints=[wheel("turn", "base", "arm")])
    assert messages_of(subject) == []
    subject.add_gazebo_element(GazeboElement("arm", {"mu1": "0.2"}))
    assert messages_of(subject) == [
        "LF6006 root link 'base' has no mass: Gazebo drops it with everything below it, joint 'turn' too"
    ]


def test_the_world_needs_no_mass():
    subject = Robot("r", links=[Link("world"), body("arm")], joints=[wheel("turn", "world", "arm")])
    subject.add_gazebo_element(GazeboElement("arm", {"mu1": "0.2"}))
    assert messages_of(subject) == []


def test_a_frame_on_a_preserved_fixed_joint_is_dropped_as_if_movable():
    subject = robot("base hand", fixed("mount", "base", "plate"), wheel("turn", "plate", "hand"))
    subject.add_link(Link("plate"))
    assert messages_of(subject) == []
    subject.add_gazebo_element(GazeboElement("mount", {"preserveFixedJoint": "true"}))
    assert [one[:6] for one in messages_of(subject)] == ["LF6004"]


def test_masses_that_are_fixed_to_one_another_count_together():
    subject = robot("base", wheel("turn", "base", "a"), fixed("glue", "a", "b"))
    subject.links += (body("a", 0.9e-6), body("b", 0.9e-6))
    assert messages_of(subject) == []
    subject.links = (body("base"), body("a", 0.5e-6), body("b", 0.4e-6))
    assert messages_of(subject) == ["LF6005 joint 'turn' moves link 'a' of 9e-07 kg, which Gazebo drops as massless"]


def test_a_block_that_only_keeps_its_joint_or_does_not_is_fine():
    subject = robot("base hand", fixed("wrist", "base", "hand"))
    subject.add_gazebo_element(GazeboElement("wrist", {"preserveFixedJoint": "false"}))
    assert messages_of(subject) == []
    subject.add_gazebo_element(GazeboElement("wrist", stop_cfm=0.1))
    assert [one[:6] for one in messages_of(subject)] == ["LF6040"]


def test_a_plugin_may_speak_of_links_that_stay_and_of_frames():
    plugin = GazeboPlugin(
        "p", "libp.so", {"link_name": "base", "robot_base_frame": "hand", "sub": {"link_name": "hand"}}
    )
    subject = robot("base hand", fixed("wrist", "base", "hand"))
    subject.add_gazebo_element(GazeboElement(plugins=[plugin]))
    assert messages_of(subject) == [
        "LF6041 plugin 'p': Gazebo merges 'hand' into 'base', so this plugin finds no such link; "
        "set `preserveFixedJoint: true` in the `gazebo` of joint 'wrist'"
    ]


def test_10000_merged_or_dropped_links_need_no_recursion():
    links = [Link("l0"), *(Link(f"l{number}") for number in range(1, 9_999)), body("l9999")]
    glued = [fixed(f"j{number}", f"l{number}", f"l{number + 1}") for number in range(9_999)]
    assert messages_of(Robot("r", links=links, joints=glued)) == []
    turned = [wheel(joint.name, joint.parent, joint.child) for joint in glued]
    assert len(messages_of(Robot("r", links=links, joints=turned))) == 1
