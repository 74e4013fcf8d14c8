import pytest

from linkforge_compile.core import Joint, JointLimits, JointMimic, JointSafetyController, JointType
from tests.checks.robots import X, fixed, messages_of, robot, turning


def sliding(name: str, parent: str, child: str, mimic: str) -> Joint:
    limits = JointLimits(-1.0, 1.0)
    return Joint(name, JointType.PRISMATIC, parent, child, axis=X, limits=limits, mimic=JointMimic(mimic))


def test_a_mimic_of_a_mimic_is_fine():
    lead, second = turning("lead", "base", "a"), turning("second", "a", "b", mimic="lead")
    assert messages_of(robot("base a b c", lead, second, turning("third", "b", "c", mimic="second"))) == []


def test_a_rack_may_mimic_its_pinion():
    assert (
        messages_of(robot("base a b", turning("pinion", "base", "a"), sliding("rack", "base", "b", mimic="pinion")))
        == []
    )


def test_a_mimic_of_an_unknown_joint_is_reported():
    subject = robot("base a b", turning("right", "base", "a"), turning("left", "base", "b", mimic="rigth"))
    assert messages_of(subject) == ["LF4103 joint 'left': no joint named 'rigth'; did you mean 'right'?"]


def test_joints_that_mimic_in_a_circle_are_reported_once():
    subject = robot("base a b", turning("left", "base", "a", mimic="right"), turning("right", "a", "b", mimic="left"))
    assert messages_of(subject) == ["LF5501 joint 'right': joints mimic each other in a cycle: left → right → left"]


def test_who_mimics_a_joint_of_a_circle_is_not_reported_of_it():
    left, right = turning("left", "base", "a", mimic="right"), turning("right", "a", "b", mimic="left")
    assert len(messages_of(robot("base a b c", turning("third", "b", "c", mimic="left"), left, right))) == 1


def test_a_joint_that_mimics_itself_is_a_circle_of_one():
    assert messages_of(robot("base a", turning("left", "base", "a", mimic="left"))) == [
        "LF5501 joint 'left': joints mimic each other in a cycle: left → left"
    ]


def test_a_fixed_joint_cannot_lead():
    subject = robot("base a b", fixed("rigid", "base", "a"), turning("loose", "a", "b", mimic="rigid"))
    assert messages_of(subject) == [
        "LF5502 joint 'loose': revolute joint 'loose' mimics fixed joint 'rigid', but both must have one axis"
    ]


@pytest.mark.parametrize(
    ("joint_type", "limits", "codes"),
    [
        (JointType.REVOLUTE, JointLimits(0.5, 0.5), ["LF5504"]),
        (JointType.PRISMATIC, JointLimits(0.0, 0.0, 0.0, 1.0), ["LF5504", "LF5506"]),
        (JointType.CONTINUOUS, JointLimits(0.0, 0.0), []),
        (JointType.CONTINUOUS, JointLimits(None, 1.0), ["LF5505"]),
        (JointType.CONTINUOUS, JointLimits(effort=5.0, velocity=0.0), ["LF5506"]),
    ],
)
def test_limits_that_do_not_fit_a_joint_are_reported(joint_type: JointType, limits: JointLimits, codes: list[str]):
    joint = Joint("j", joint_type, "base", "a", axis=X, limits=limits)
    assert [one[:6] for one in messages_of(robot("base a", joint))] == codes


@pytest.mark.parametrize(
    ("safety", "codes"),
    [
        (JointSafetyController(-0.9, 0.9, 100.0, 1.0), []),
        (JointSafetyController(-1.00005, 1.0, 100.0, 1.0), []),
        (JointSafetyController(-5.0, 5.0, None, 1.0), []),
        (JointSafetyController(-5.0, 5.0, 100.0, 1.0), ["LF5508", "LF5508"]),
        (JointSafetyController(0.5, -0.5, 100.0, 1.0), ["LF5507"]),
        (JointSafetyController(None, None, 100.0, 1.0), ["LF5507"]),
    ],
)
def test_soft_limits_are_checked_against_the_limits(safety: JointSafetyController, codes: list[str]):
    limits = JointLimits(-1.0, 1.0)
    joint = Joint("j", JointType.REVOLUTE, "base", "a", axis=X, limits=limits, safety_controller=safety)
    assert [one[:6] for one in messages_of(robot("base a", joint))] == codes
