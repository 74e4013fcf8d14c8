from linkforge_compile.core import Joint, JointLimits, JointMimic, JointType
from tests.checks.robots import X, fixed, robot, told, turning


def sliding(name: str, parent: str, child: str, mimic: str) -> Joint:
    limits = JointLimits(0.0, 0.1)
    return Joint(name, JointType.PRISMATIC, parent, child, axis=X, limits=limits, mimic=JointMimic(mimic))


def test_a_mimic_of_a_mimic_is_fine():
    lead, second = turning("lead", "base", "a"), turning("second", "a", "b", mimic="lead")
    assert told(robot("base a b c", lead, second, turning("third", "b", "c", mimic="second"))) == []


def test_a_rack_may_mimic_its_pinion():
    assert told(robot("base a b", turning("pinion", "base", "a"), sliding("rack", "base", "b", mimic="pinion"))) == []


def test_a_mimic_of_an_unknown_joint_is_told():
    subject = robot("base a b", turning("right", "base", "a"), turning("left", "base", "b", mimic="rigth"))
    assert told(subject) == ["LF4103 joint 'left': no joint named 'rigth'; did you mean 'right'?"]


def test_joints_that_mimic_in_a_circle_are_told_once():
    subject = robot("base a b", turning("left", "base", "a", mimic="right"), turning("right", "a", "b", mimic="left"))
    assert told(subject) == ["LF5501 joint 'right': joints mimic one another in a circle: left → right → left"]


def test_who_mimics_a_joint_of_a_circle_is_not_told_of_it():
    left, right = turning("left", "base", "a", mimic="right"), turning("right", "a", "b", mimic="left")
    assert len(told(robot("base a b c", turning("third", "b", "c", mimic="left"), left, right))) == 1


def test_a_joint_that_mimics_itself_is_a_circle_of_one():
    assert told(robot("base a", turning("left", "base", "a", mimic="left"))) == [
        "LF5501 joint 'left': joints mimic one another in a circle: left → left"
    ]


def test_a_fixed_joint_cannot_lead():
    subject = robot("base a b", fixed("rigid", "base", "a"), turning("loose", "a", "b", mimic="rigid"))
    assert told(subject) == [
        "LF5502 joint 'loose': revolute joint 'loose' mimics fixed joint 'rigid', but both must have one axis"
    ]
