from linkforge_compile.core.models.gazebo import GazeboElement, GazeboPlugin
from linkforge_compile.core.models.link import Link, LinkPhysics
from tests.formats.inside import urdf, xml


def test_only_physics_that_differ_are_written():
    links = [Link("base"), Link("wheel", physics=LinkPhysics(self_collide=True, gravity=False, mu=1.5, kp=1e6))]
    assert urdf(links=links) == xml("""
        <link name="base"/>
        <link name="wheel"/>
        <gazebo reference="wheel">
          <selfCollide>true</selfCollide>
          <gravity>false</gravity>
          <mu1>1.5</mu1>
          <kp>1000000</kp>
        </gazebo>
    """)


def test_what_is_stated_is_written_though_it_is_the_default():
    assert urdf(links=[Link("wheel", physics=LinkPhysics(stated=["mu", "gravity"]))]) == xml("""
        <link name="wheel"/>
        <gazebo reference="wheel">
          <gravity>true</gravity>
          <mu1>1</mu1>
        </gazebo>
    """)


def test_every_field_has_the_tag_that_sdformat_knows():
    block = GazeboElement(
        "elbow",
        {"springStiffness": "400", "empty": ""},
        material="Gazebo/Red",
        static=False,
        stop_cfm=0.0,
        stop_erp=0.2,
        provide_feedback=True,
        implicit_spring_damper=True,
    )
    assert urdf(gazebo_elements=[block]) == xml("""
        <gazebo reference="elbow">
          <material>Gazebo/Red</material>
          <static>false</static>
          <stopCfm>0</stopCfm>
          <stopErp>0.2</stopErp>
          <provideFeedback>true</provideFeedback>
          <implicitSpringDamper>true</implicitSpringDamper>
          <springStiffness>400</springStiffness>
          <empty/>
        </gazebo>
    """)


def test_plugins_hold_parameters_or_the_xml_that_was_read():
    plugins = [
        GazeboPlugin("drive", "libdrive.so", {"wheel_radius": "0.10", "odom": "true"}),
        GazeboPlugin("cam", "libcam.so", {"seen": "no"}, "<ros><remapping>~/out:=cam</remapping><namespace/></ros>"),
        GazeboPlugin("bare", "libbare.so"),
    ]
    assert urdf(gazebo_elements=[GazeboElement(plugins=plugins)]) == xml("""
        <gazebo>
          <plugin name="drive" filename="libdrive.so">
            <wheel_radius>0.10</wheel_radius>
            <odom>true</odom>
          </plugin>
          <plugin name="cam" filename="libcam.so">
            <ros>
              <remapping>~/out:=cam</remapping>
              <namespace/>
            </ros>
          </plugin>
          <plugin name="bare" filename="libbare.so"/>
        </gazebo>
    """)


def test_blocks_stay_apart_and_in_order():
    blocks = [GazeboElement("b"), GazeboElement("a"), GazeboElement("b")]
    assert urdf(gazebo_elements=blocks) == '<gazebo reference="b"/>\n<gazebo reference="a"/>\n<gazebo reference="b"/>\n'
