from linkforge_compile.core.models.transmission import Transmission, TransmissionActuator, TransmissionJoint
from tests.formats.inside import urdf, xml


def test_a_simple_transmission_states_its_reductions():
    assert urdf(transmissions=[Transmission.create_simple("t1", "shoulder")]) == xml("""
        <transmission name="t1">
          <type>transmission_interface/SimpleTransmission</type>
          <joint name="shoulder">
            <hardwareInterface>position</hardwareInterface>
            <mechanicalReduction>1</mechanicalReduction>
          </joint>
          <actuator name="shoulder_motor">
            <hardwareInterface>position</hardwareInterface>
            <mechanicalReduction>1</mechanicalReduction>
          </actuator>
        </transmission>
    """)


def test_a_transmission_with_everything():
    transmission = Transmission(
        "t2",
        "my_package/Belt",
        [TransmissionJoint("j", ["position", "hardware_interface/EffortJointInterface"], -2.5, 0.1)],
        [TransmissionActuator("m", ["effort"], None, extra_elements=["<encoder bits='12'/>"])],
        {"slip": "0.10"},
    )
    assert urdf(transmissions=[transmission]) == xml("""
        <transmission name="t2">
          <type>my_package/Belt</type>
          <joint name="j">
            <hardwareInterface>position</hardwareInterface>
            <hardwareInterface>hardware_interface/EffortJointInterface</hardwareInterface>
            <mechanicalReduction>-2.5</mechanicalReduction>
            <offset>0.1</offset>
          </joint>
          <actuator name="m">
            <hardwareInterface>effort</hardwareInterface>
            <encoder bits="12"/>
          </actuator>
          <slip>0.10</slip>
        </transmission>
    """)
