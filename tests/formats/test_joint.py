import pytest

from linkforge_compile.core.models.geometry import Transform, Vector3
from linkforge_compile.core.models.joint import (
    Joint,
    JointCalibration,
    JointDynamics,
    JointLimits,
    JointMimic,
    JointSafetyController,
    JointType,
)
from tests.formats.inside import urdf, xml

Y = Vector3(0, 1, 0)


def test_a_fixed_joint_writes_only_required_parts():
    assert urdf(joints=[Joint("mount", JointType.FIXED, "base", "arm")]) == xml("""
        <joint name="mount" type="fixed">
          <parent link="base"/>
          <child link="arm"/>
        </joint>
    """)


def test_a_joint_with_everything():
    elbow = Joint(
        "elbow",
        JointType.REVOLUTE,
        "upper",
        "lower",
        Transform(Vector3(0, 0, 0.4), Vector3(0, -1.5707963267948966, 0)),
        Y,
        JointLimits(-2.0, 2.5, 50, 3.0),
        JointDynamics(0.1, 0.2),
        JointMimic("shoulder", -1, 0.5),
        JointSafetyController(-1.9, 2.4, 20, 40),
        JointCalibration(0.0, 1e-7),
    )
    assert urdf(joints=[elbow]) == xml("""
        <joint name="elbow" type="revolute">
          <origin xyz="0 0 0.4" rpy="0 -1.5707963267948966 0"/>
          <parent link="upper"/>
          <child link="lower"/>
          <axis xyz="0 1 0"/>
          <limit lower="-2" upper="2.5" effort="50" velocity="3"/>
          <dynamics damping="0.1" friction="0.2"/>
          <mimic joint="shoulder" multiplier="-1" offset="0.5"/>
          <safety_controller soft_lower_limit="-1.9" soft_upper_limit="2.4" k_position="20" k_velocity="40"/>
          <calibration rising="0" falling="1e-7"/>
        </joint>
    """)


def test_what_is_not_stated_is_not_written():
    wheel = Joint(
        "wheel",
        JointType.CONTINUOUS,
        "base",
        "rim",
        axis=Y,
        limits=JointLimits(effort=5, velocity=30),
        mimic=JointMimic("other"),
        safety_controller=JointSafetyController(k_velocity=1),
        calibration=JointCalibration(rising=0.1),
    )
    assert urdf(joints=[wheel]) == xml("""
        <joint name="wheel" type="continuous">
          <parent link="base"/>
          <child link="rim"/>
          <axis xyz="0 1 0"/>
          <limit effort="5" velocity="30"/>
          <mimic joint="other"/>
          <safety_controller k_velocity="1"/>
          <calibration rising="0.1"/>
        </joint>
    """)


def test_an_axis_comes_out_as_it_was_written():
    joint = Joint("j", JointType.FLOATING, "a", "b")
    slide = Joint("s", JointType.PLANAR, "b", "c", axis=Vector3(0, 0, -1), axis_as_written=Vector3(0, 0, -2))
    assert '<axis xyz="0 0 -2"/>' in urdf(joints=[joint, slide])


def test_extras_of_a_part_stay_in_that_part():
    limits = JointLimits(-1, 1, 2, 3, extra_attributes=[("jerk", "4")], extra_elements=["<drake:note/>"])
    joint = Joint("j", JointType.PRISMATIC, "a", "b", axis=Y, limits=limits, extra_elements=["<hardwareInterface/>"])
    assert urdf(joints=[joint]) == xml("""
        <joint name="j" type="prismatic">
          <parent link="a"/>
          <child link="b"/>
          <axis xyz="0 1 0"/>
          <limit lower="-1" upper="1" effort="2" velocity="3" jerk="4">
            <drake:note/>
          </limit>
          <hardwareInterface/>
        </joint>
    """)


@pytest.mark.parametrize("kind", JointType)
def test_the_type_is_the_word_of_the_model(kind: JointType):
    turns = kind not in (JointType.FIXED, JointType.FLOATING)
    joint = Joint("j", kind, "a", "b", axis=Y if turns else None, limits=JointLimits() if turns else None)
    assert f'type="{kind.value}"' in urdf(joints=[joint])
