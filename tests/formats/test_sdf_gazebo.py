"""What Gazebo adds to a robot is in its SDF: sensors with their poses, contact settings, physics of joints, plugins."""

from pathlib import Path

import pytest
from lxml import etree

from linkforge_compile import compile_file
from linkforge_compile.formats import SDF, Rendering
from linkforge_compile.formats.render import render_urdf
from tests.conftest import ROOT
from tests.formats.sdf import HEAD, compiled, document, read, reported
from tests.libsdformat import read_with_libsdformat

LUMPED = """
links:
  base_link:
  root_link: {inertial: {mass: 1, origin: {xyz: [1, 2, 3], rpy: [0.1, 0.2, 0.3]}, inertia: {ixx: 1, iyy: 1, izz: 1}}}
joints: {weld: {type: fixed, parent: base_link, child: root_link, origin: [0, 0, 10]}}
sensors: {imu: {type: imu, link: root_link, origin: {xyz: [1, 2, 3], rpy: [0.1, 0.2, 0.3]}}}
"""


def test_a_sensor_on_a_link_below_a_fixed_joint_keeps_its_pose(tmp_path: Path):
    """The conversion of a URDF puts it at the origin of a merged link: icub-models-generator, issue 140."""
    (sensor,) = read(LUMPED, tmp_path).links["root_link"]["sensors"]
    assert sensor["pose"][:3] == pytest.approx([1, 2, 13])
    assert sensor["pose"][3:] == pytest.approx([0.98334744, 0.03427080, 0.10602051, 0.14357218], abs=1e-8)


IMU_ON_FRAME = """
links: {base: {inertial: *unit}, mast: , imu_link: }
joints:
  up: {type: fixed, parent: base, child: mast, origin: {xyz: [0, 0, 1], rpy: [0, 0, 90 deg]}}
  out: {type: fixed, parent: mast, child: imu_link, origin: [2, 0, 0]}
sensors: {imu: {type: imu, link: imu_link, origin: [3, 0, 0], topic: /imu, update_rate: 50}}
"""


def test_a_sensor_on_a_link_without_mass_is_where_the_frame_is(tmp_path: Path):
    (sensor,) = read(IMU_ON_FRAME, tmp_path).links["base"]["sensors"]
    assert sensor["pose"][:3] == pytest.approx([0, 5, 1])
    element = etree.fromstring(sensor["xml"])
    assert (element.get("type"), element.findtext("topic"), element.findtext("update_rate")) == ("imu", "/imu", "50")


def test_frames_that_the_conversion_of_a_urdf_loses_are_kept(tmp_path: Path):
    """gazebosim/sdformat, issue 986: fixed joints are lost, and massless links with all below them."""
    text = (
        "links: {base: {inertial: *unit}, arm: , tool: {inertial: *unit}}\njoints:\n"
        "  turn: {type: continuous, parent: base, child: arm, axis: z, origin: [0, 0, 1]}\n"
        "  flange: {type: fixed, parent: arm, child: tool, origin: [0, 1, 0]}\n"
        "  wrist: {type: continuous, parent: tool, child: hand, axis: z}\n"
        "frames: {tcp: {parent: tool, origin: [0, 0, 5]}}\n"
    ).replace("tool: {inertial: *unit}}", "tool: {inertial: *unit}, hand: {inertial: *unit}}")
    converted = read_with_libsdformat(render_urdf(compiled(text)), tmp_path, suffix=".urdf")
    # The conversion merges the tool into the arm, and has no joint at the flange.
    assert "tool" not in converted.links
    ours = read(text, tmp_path)
    assert list(ours.links) == ["base", "tool", "hand"]
    assert list(ours.joints) == ["turn", "wrist"]
    assert ours.frames["tcp"]["pose"][:3] == pytest.approx([0, 1, 6])
    assert ours.frames["arm"]["pose"][:3] == pytest.approx([0, 0, 1])


def test_every_type_of_sensor_is_read(tmp_path: Path):
    robot = compile_file(ROOT / "tests" / "cases" / "good" / "sensors" / "sensors.robot.yaml").result()
    found = read_with_libsdformat(SDF.render(robot, Rendering())[0].text, tmp_path)
    assert found.complaints == []
    types = {
        sensor["name"]: etree.fromstring(sensor["xml"]).get("type")
        for part in (*found.links.values(), *found.joints.values())
        for sensor in part["sensors"]
    }
    assert types == {
        "scanner": "gpu_lidar",
        "old_scanner": "gpu_lidar",
        "fast_scanner": "gpu_lidar",
        "imu": "imu",
        "plain_imu": "imu",
        "gps": "navsat",
        "eye": "camera",
        "depth": "depth_camera",
        "both": "rgbd_camera",
        "touch": "contact",
        "wrench": "force_torque",
    }
    # A force is sensed in the joint above the link, at the pose of the link.
    (wrench,) = found.joints["wrist"]["sensors"]
    assert wrench["pose"] == pytest.approx(found.links["finger"]["pose"])


CONTACT = """
links:
  base:
    inertial: *unit
    physics: {mu: 0.6, mu2: 0.5, self_collide: true, gravity: false}
    gazebo: {kp: 1e6, kd: 100, minDepth: 1 mm, maxVel: 0.1 m/s, fdir1: [1, 0, 0], maxContacts: 4, laserRetro: 7}
    collision: [{sphere: 1}, {box: [1, 1, 1], name: lid}]
"""


def test_contact_settings_are_those_of_each_collision(tmp_path: Path):
    base = read(CONTACT, tmp_path).links["base"]
    assert (base["self_collide"], base["gravity"]) == (True, False)
    assert [shape["name"] for shape in base["collisions"]] == ["base_collision", "lid"]
    for shape in base["collisions"]:
        element = etree.fromstring(shape["xml"])
        friction, contact = element.find("surface/friction/ode"), element.find("surface/contact/ode")
        assert [friction.findtext(tag) for tag in ("mu", "mu2", "fdir1")] == ["0.6", "0.5", "1 0 0"]
        values = [float(contact.findtext(tag)) for tag in ("kp", "kd", "min_depth", "max_vel")]
        assert values == [1e6, 100, 0.001, 0.1]
        assert (element.findtext("max_contacts"), element.findtext("laser_retro")) == ("4", "7")


def test_a_surface_of_the_user_is_the_only_one():
    text = """
links:
  base:
    inertial: *unit
    collision: {box: [1, 1, 1]}
    gazebo:
      mu1: 0.5
      kp: 1000
      properties: {collision: {surface: {friction: {ode: {mu: "0.9"}}}}}
"""
    (surface,) = document(text).iterfind(".//collision/surface")
    assert [element.text for element in surface.iterfind(".//mu")] == ["0.9"]
    assert reported(text) == [
        "LF7501 SDF has no second <surface>, so no place for the setting 'mu1'; omitted for 'base'",
        "LF7501 SDF has no second <surface>, so no place for the setting 'kp'; omitted for 'base'",
    ]


def test_a_raw_surface_is_the_only_one():
    text = """
links:
  base:
    inertial: *unit
    collision: {box: [1, 1, 1]}
    gazebo: {mu1: 0.5, extra: "<collision><surface><bounce/></surface></collision>"}
"""
    (surface,) = document(text).iterfind(".//collision/surface")
    assert [child.tag for child in surface] == ["bounce"]
    assert [message[:6] for message in reported(text)] == ["LF7501"]


TWO_TAGS = """
links: {base: {inertial: *unit}, hand: {inertial: *unit}}
joints: {turn: {type: continuous, parent: base, child: hand, axis: z}}
gazebo:
  - reference: base
    extra:
      - <turnGravityOff>true</turnGravityOff><gravity>true</gravity>
      - <selfCollide>1</selfCollide><self_collide>0</self_collide>
  - reference: turn
    extra: <implicitSpringDamper>true</implicitSpringDamper><cfmDamping>false</cfmDamping>
"""


def test_of_two_tags_for_one_element_the_last_is_kept(tmp_path: Path):
    base = read(TWO_TAGS, tmp_path).links["base"]
    assert (base["gravity"], base["self_collide"]) == (True, False)
    model = document(TWO_TAGS)
    for tag, text in (("gravity", "true"), ("self_collide", "0"), ("implicit_spring_damper", "false")):
        assert [element.text for element in model.iter(tag)] == [text]


def test_a_material_of_gazebo_settings_is_that_of_the_visuals():
    text = """
links:
  base:
    inertial: *unit
    visual: {box: [1, 1, 1], material: {color: [1, 0, 0]}}
    gazebo: {properties: {visual: {material: {pbr: {metal: {roughness: "0.3"}}}}}}
"""
    (material,) = document(text).iterfind(".//visual/material")
    assert [child.tag for child in material] == ["pbr"]
    assert reported(text) == []


def test_plugins_of_the_robot_are_those_of_the_model(tmp_path: Path):
    text = """
links: {base: {inertial: *unit}}
gazebo: {static: true, plugins: {control: {filename: libcontrol.so, parameters: {rate: 5}}}}
"""
    (model,) = read(text, tmp_path).models.values()
    assert model["static"] is True
    assert [(plugin["name"], plugin["filename"]) for plugin in model["plugins"]] == [("control", "libcontrol.so")]
    assert "<rate>5</rate>" in model["plugins"][0]["xml"]


def test_a_force_torque_sensor_without_a_joint_is_reported():
    text = "links: {base: {inertial: *unit}}\nsensors: {wrench: {type: force_torque, link: base}}"
    assert reported(text) == ["LF7501 SDF has no force-torque sensors without a joint; omitted for 'wrench'"]


def test_a_plugin_of_a_link_is_reported():
    text = "links: {base: {inertial: *unit, gazebo: {plugins: {glow: {filename: libglow.so}}}}}"
    assert reported(text) == ["LF7501 SDF has no plugins of links and joints; omitted for 'glow'"]


def test_settings_that_a_frame_cannot_hold_are_reported():
    """A link without a mass, the joint that holds it, and a floating joint, are frames in SDF."""
    text = """
links:
  base: {inertial: *unit, gazebo: {mu1: 1}}
  camera: {physics: {self_collide: true, gravity: false, mu: 0.5}, gazebo: {dampingFactor: 0.1}}
  ball: {inertial: *unit}
joints:
  mount: {type: fixed, parent: base, child: camera, gazebo: {preserveFixedJoint: true, springStiffness: 3}}
  loose: {type: floating, parent: base, child: ball, gazebo: {provide_feedback: true}}
"""
    assert reported(text) == [
        "LF7501 SDF has no place for the setting 'selfCollide' of a frame; omitted for 'camera'",
        "LF7501 SDF has no place for the setting 'gravity' of a frame; omitted for 'camera'",
        "LF7501 SDF has no place for the setting 'dampingFactor' of a frame; omitted for 'camera'",
        "LF7501 SDF has no place for the setting 'springStiffness' of a frame; omitted for 'mount'",
        "LF7501 SDF has no place for the setting 'provideFeedback' of a frame; omitted for 'loose'",
    ]


def test_settings_of_the_world_and_springs_of_fixed_joints_are_reported():
    text = """
links: {world: {gazebo: {mu1: 1, extra: "<light name='sun' type='point'/>"}}, base: {inertial: *unit}}
joints: {weld: {type: fixed, parent: world, child: base, gazebo: {springStiffness: 3, provide_feedback: true}}}
"""
    assert reported(text) == [
        "LF7501 SDF has no place for the setting 'mu1' of the world; omitted for 'world'",
        "LF7501 SDF has no place for the setting 'light' of the world; omitted for 'world'",
        "LF7501 SDF has no place for the setting 'springStiffness' of a fixed joint; omitted for 'weld'",
    ]


WRENCH = """
links: {base: {inertial: *unit}, flange: , plate: , tool: {inertial: *unit}}
joints:
  wrist: {type: fixed, parent: base, child: flange, origin: {xyz: [0, 0, 1], rpy: [0, 0, 90 deg]}}
  screw: {type: fixed, parent: flange, child: plate, origin: [0, 1, 0]}
  bolt: {type: fixed, parent: plate, child: tool, origin: [1, 0, 0]}
"""
TYPED = "sensors: {wrench: {type: force_torque, link: flange, origin: [0, 0, 2]}}"
RAW = """
gazebo:
  reference: wrist
  extra: "<sensor name='wrench' type='force_torque'><pose>0 0 2 0 0 0</pose>FRAME</sensor>"
"""


@pytest.mark.parametrize("sensor", [TYPED, RAW.replace("FRAME", "")])
def test_a_force_below_a_link_without_mass_is_that_of_the_body_fixed_to_it(tmp_path: Path, sensor: str):
    assert reported(WRENCH + sensor) == []
    found = read(WRENCH + sensor, tmp_path)
    assert list(found.links) == ["base", "tool"]
    joint = found.joints["wrist"]
    assert (joint["type"], joint["parent"], joint["child"]) == ("fixed", "base", "tool")
    assert [one["pose"][:3] for one in joint["sensors"]] == [pytest.approx([0, 0, 3])]
    assert found.frames["flange"]["pose"] == pytest.approx(joint["pose"])
    assert found.links["tool"]["pose"][:3] == pytest.approx([-1, 1, 1])


@pytest.mark.parametrize(
    ("sensor", "is_carried"),
    [
        (TYPED, False),
        (TYPED.replace("origin:", "force_torque: {frame: sensor}, origin:"), True),
        (RAW.replace("FRAME", ""), False),
        (RAW.replace("FRAME", "<force_torque><frame>parent</frame></force_torque>"), True),
    ],
)
def test_a_force_in_the_axes_of_a_link_without_mass_needs_that_link(tmp_path: Path, sensor: str, is_carried: bool):
    """Gazebo turns it into those of the child of the joint, which the tool below would be."""
    text = WRENCH.replace("origin: [1, 0, 0]", "origin: {xyz: [1, 0, 0], rpy: [0, 90 deg, 0]}") + sensor
    assert [message[:6] for message in reported(text)] == ([] if is_carried else ["LF7502"])
    assert read(text, tmp_path).joints["wrist"]["child"] == ("tool" if is_carried else "flange")


def test_a_force_in_a_joint_with_nothing_below_needs_a_body(tmp_path: Path):
    text = """
links: {base: {inertial: *unit}, hand: }
joints:
  wrist: {type: fixed, parent: base, child: hand, gazebo: {extra: "<sensor name='wrench' type='force_torque'/>"}}
"""
    assert [message[:6] for message in reported(text)] == ["LF7502"]
    joint = read(text, tmp_path).joints["wrist"]
    assert (joint["type"], [sensor["name"] for sensor in joint["sensors"]]) == ("fixed", ["wrench"])


RAW_IN_JOINT = """
links: {base: {inertial: *unit}, mast: MAST}
joints:
  up: {type: fixed, parent: base, child: mast, origin: {xyz: [0, 0, 1], rpy: [0, 0, 90 deg]}}
gazebo:
  - reference: up
    extra:
      - <sensor name='imu' type='imu'><pose>1 0 0 0 0 0</pose></sensor>
"""


def test_a_raw_sensor_in_a_joint_that_is_a_frame_is_on_its_link(tmp_path: Path):
    """Gazebo Sim has no sensors but those of forces in joints."""
    text = RAW_IN_JOINT.replace("MAST", "")
    assert reported(text) == []
    found = read(text, tmp_path)
    assert list(found.links) == ["base"]
    (sensor,) = found.links["base"]["sensors"]
    assert sensor["pose"][:3] == pytest.approx([0, 1, 1])


@pytest.mark.parametrize("of_joint", ["type: fixed", "type: continuous, axis: z"])
def test_a_raw_sensor_in_a_joint_is_on_the_link_below_it_at_the_same_place(tmp_path: Path, of_joint: str):
    text = RAW_IN_JOINT.replace("MAST", "{inertial: *unit}").replace("type: fixed", of_joint)
    wrench = "      - <sensor name='wrench' type='force_torque'/>\n"
    assert reported(text + wrench) == []
    found = read(text + wrench, tmp_path)
    (imu,) = found.links["mast"]["sensors"]
    assert (imu["name"], imu["pose"][:3]) == ("imu", pytest.approx([0, 1, 1]))
    assert [sensor["name"] for sensor in found.joints["up"]["sensors"]] == ["wrench"]


RAW_SENSORS = """
links:
  base: {inertial: *unit}
  mast:
    gazebo:
      extra:
        - <sensor name="a" type="imu"/>
        - <sensor name="b" type="imu"><topic>/b</topic><pose>1 0 0 0 0 0</pose></sensor>
        - <sensor name="c" type="imu"><pose relative_to="base">1 0 0 0 0 0</pose></sensor>
  top: {gazebo: {properties: {sensor: [{_name: d, _type: imu, pose: 0 1 0 0 0 0}, {_name: e, _type: imu}]}}}
joints:
  up: {type: fixed, parent: base, child: mast, origin: {xyz: [0, 0, 1], rpy: [0, 0, 90 deg]}}
  higher: {type: fixed, parent: mast, child: top, origin: [0, 0, 1]}
gazebo:
  - {reference: top, extra: "<sensor name='f' type='altimeter'/>"}
  - {reference: top, extra: "<sensor name='g' type='altimeter'/>"}
"""


def test_raw_sensors_on_links_without_mass_are_where_the_frame_is(tmp_path: Path):
    assert reported(RAW_SENSORS) == []
    found = read(RAW_SENSORS, tmp_path)
    assert list(found.links) == ["base"]
    positions = {sensor["name"]: sensor["pose"][:3] for sensor in found.links["base"]["sensors"]}
    assert positions == {
        "a": pytest.approx([0, 0, 1]),
        "b": pytest.approx([0, 1, 1]),
        "c": pytest.approx([1, 0, 0]),
        "d": pytest.approx([-1, 0, 2]),
        "e": pytest.approx([0, 0, 2]),
        "f": pytest.approx([0, 0, 2]),
        "g": pytest.approx([0, 0, 2]),
    }


def test_a_source_map_has_each_line_of_raw_xml():
    text = """
links:
  base: {inertial: *unit}
  mast:
    gazebo:
      extra: |
        <sensor name="imu" type="imu">
          <topic>/imu</topic>
        </sensor>
joints: {up: {type: fixed, parent: base, child: mast}}
gazebo:
  extra: |
    <plugin name="glow" filename="libglow.so">
      <rate>5</rate>
    </plugin>
"""
    result = SDF.render(compiled(text), Rendering(has_map=True))[0]
    assert result.map is not None
    lines = result.text.splitlines()
    spec = (HEAD + text).splitlines()
    for word in ("<topic>", "<rate>"):
        place = result.map.at(next(number for number, line in enumerate(lines, 1) if word in line))
        assert place is not None
        assert word in spec[place.span.line - 1]
