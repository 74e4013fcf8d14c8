"""SDF: links, frames, joints and shapes of a robot, and what it cannot hold."""

from pathlib import Path

import pytest

from linkforge_compile import compile_file
from linkforge_compile.formats import SDF, Rendering
from tests.formats.sdf import compiled, document, read, rendered, reported

TWO = """
links:
  base: {inertial: *unit}
  hand: {inertial: *unit}
"""


def test_a_link_is_at_its_joint_and_a_joint_at_its_parent():
    model = document(TWO + "joints: {turn: {type: continuous, parent: base, child: hand, axis: y, origin: [0, 0, 1]}}")[
        0
    ]
    assert model.find("link[@name='base']/pose") is None
    assert dict(model.find("link[@name='hand']/pose").attrib) == {"relative_to": "turn"}
    joint = model.find("joint")
    assert (joint.get("type"), joint.find("pose").get("relative_to"), joint.findtext("pose")) == (
        "revolute",
        "base",
        "0 0 1 0 0 0",
    )
    assert (joint.findtext("parent"), joint.findtext("child")) == ("base", "hand")
    assert joint.findtext("axis/xyz") == "0 1 0"
    assert joint.find("axis/limit") is None


def test_limits_and_dynamics_are_on_the_axis(tmp_path: Path):
    found = read(
        TWO
        + """
joints:
  slide:
    type: prismatic
    parent: base
    child: hand
    axis: x
    limits: {lower: -10 mm, upper: 0.3, effort: 5, velocity: 2}
    dynamics: {damping: 0.1, friction: 0.7}
    gazebo: {springStiffness: 3, springReference: 0.25, stop_cfm: 0.5, provide_feedback: true}
""",
        tmp_path,
    )
    joint = found.joints["slide"]
    (axis,) = joint["axes"]
    names = ("xyz", "lower", "upper", "effort", "velocity", "damping", "friction")
    assert [axis[name] for name in names] == [[1, 0, 0], -0.01, 0.3, 5, 2, 0.1, 0.7]
    assert "<spring_stiffness>3</spring_stiffness>" in axis["xml"]
    assert "<cfm>0.5</cfm>" in joint["xml"]
    assert "<provide_feedback>true</provide_feedback>" in joint["xml"]


FRAMES = """
links:
  footprint:
  base: {inertial: *unit}
  camera: {visual: {box: [1, 2, 3], origin: [0.5, 0, 0]}, collision: {sphere: 1}}
  optical:
  tool:
  hand: {inertial: *unit}
joints:
  up: {type: fixed, parent: footprint, child: base, origin: {xyz: [0, 0, 1], rpy: [0, 0, 90 deg]}}
  mount: {type: fixed, parent: base, child: camera, origin: [1, 0, 0]}
  lens: {type: fixed, parent: camera, child: optical, origin: {rpy: [-90 deg, 0, -90 deg]}}
  turn: {type: continuous, parent: optical, child: tool, axis: z, origin: [0, 0, 1]}
  grip: {type: fixed, parent: tool, child: hand, origin: [0, 2, 0]}
"""


def test_links_without_mass_are_frames_where_they_are(tmp_path: Path):
    """Also one that moves, and the root: they are on the link with a mass that is fixed to them."""
    found = read(FRAMES, tmp_path)
    assert list(found.links) == ["base", "hand"]
    assert [list(found.frames[name]["pose"][:3]) for name in ("footprint", "camera", "tool")] == [
        pytest.approx([0, 0, 0]),
        pytest.approx([0, 1, 1]),
        # The optical axis z is the camera's x, which is the y of the robot.
        pytest.approx([0, 2, 1]),
    ]
    joint = found.joints["turn"]
    assert (joint["parent"], joint["child"], list(found.joints)) == ("base", "hand", ["turn"])
    assert joint["pose"][:3] == pytest.approx([0, 2, 1])
    assert joint["axes"][0]["xyz"] == pytest.approx([0, 1, 0])
    assert {"up", "mount", "lens", "grip"} <= set(found.frames)


def test_shapes_of_frames_are_on_the_link_that_holds_them(tmp_path: Path):
    base = read(FRAMES, tmp_path).links["base"]
    assert [visual["pose"][:3] for visual in base["visuals"]] == [pytest.approx([0, 1.5, 1])]
    assert [shape["name"] for shape in (*base["visuals"], *base["collisions"])] == ["camera_visual", "camera_collision"]


def test_a_root_link_named_world_is_the_world(tmp_path: Path):
    found = read(
        "links: {world: , base: {inertial: *unit}, plate: }\njoints:\n"
        "  weld: {type: fixed, parent: world, child: base, origin: [0, 0, 1]}\n"
        "  bolt: {type: fixed, parent: world, child: plate, origin: [0, 0, 2]}\n",
        tmp_path,
    )
    assert (found.joints["weld"]["parent"], found.joints["weld"]["child"]) == ("world", "base")
    assert found.links["base"]["pose"][:3] == [0, 0, 1]
    # A frame would move with the robot.
    assert found.joints["bolt"]["parent"] == "world"
    assert found.links["plate"]["mass"] == 1e-9


def test_a_floating_joint_is_a_frame_of_a_link_without_a_joint(tmp_path: Path):
    found = read(TWO + "joints: {loose: {type: floating, parent: base, child: hand, origin: [0, 0, 3]}}", tmp_path)
    assert found.joints == {}
    assert found.links["hand"]["pose"][:3] == [0, 0, 3]


def test_an_inertial_keeps_its_numbers(tmp_path: Path):
    text = (
        "links: {base: {inertial: {mass: 0.1, origin: {xyz: [1, 2, 3], rpy: [0.1, 0.2, 0.3]}, "
        "inertia: {ixx: 1.1, iyy: 1.2, izz: 1.3, ixy: 0.01, ixz: 0.02, iyz: 0.03}}}}"
    )
    inertial = document(text).find(".//inertial")
    assert inertial.findtext("pose") == "1 2 3 0.1 0.2 0.3"
    assert [entry.text for entry in inertial.find("inertia")] == ["1.1", "0.01", "0.02", "1.2", "0.03", "1.3"]
    assert read(text, tmp_path).links["base"]["mass"] == 0.1


def test_shapes_have_materials_and_files_of_packages_are_of_models():
    text = """
materials: {rust: {color: [1, 0, 0], texture: package://arm/rust.png}}
links:
  base:
    inertial: *unit
    visual:
      - {mesh: {file: package://arm/base.stl, scale: [1, 1, 2]}, material: rust}
      - {mesh: {file: meshes/base.stl}}
      - {capsule: {radius: 1, length: 2}}
"""
    mesh, relative, capsule = document(text).iterfind(".//visual")
    assert (mesh.findtext(".//uri"), mesh.findtext(".//scale")) == ("model://arm/base.stl", "1 1 2")
    assert [mesh.findtext(f"material/{tag}") for tag in ("ambient", "diffuse", "specular")] == ["1 0 0 1"] * 3
    assert mesh.findtext("material/pbr/metal/albedo_map") == "model://arm/rust.png"
    assert relative.findtext(".//uri") == "meshes/base.stl"
    assert (capsule.findtext(".//radius"), capsule.findtext(".//length")) == ("1", "2")
    names = [shape.get("name") for shape in (mesh, relative, capsule)]
    assert names == ["base_visual", "base_visual_1", "base_visual_2"]


def test_meshes_are_files_where_that_is_requested(tmp_path: Path):
    package = tmp_path / "of José" / "arm"
    package.mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>arm</name></package>")
    (package / "base.stl").write_bytes(b"")
    spec = package / "arm.robot.yaml"
    spec.write_text("linkforge: 1\nname: arm\nlinks: {base: {visual: {mesh: {file: package://arm/base.stl}}}}\n")
    robot = compile_file(spec).result()
    text = SDF.render(robot, Rendering({"meshes": "file"}))[0].text
    # Gazebo looks for a file of this very name, and decodes no `%20`.
    assert f"<uri>{package.as_posix()}/base.stl</uri>" in text


MIMIC = """
  thumb: {inertial: *unit}
joints:
  turn: {type: continuous, parent: base, child: hand, axis: z}
  follow: {type: continuous, parent: hand, child: thumb, axis: z, mimic: {joint: turn, multiplier: -2, offset: 0.5}}
"""


def test_a_mimic_joint_needs_version_1_11():
    root = document(TWO + MIMIC)
    mimic = root.find(".//mimic")
    assert (root.get("version"), mimic.get("joint")) == ("1.11", "turn")
    assert [mimic.findtext(tag) for tag in ("multiplier", "offset", "reference")] == ["-2", "0.5", "0"]
    assert document(TWO + MIMIC, sdf="1.9").find(".//mimic") is None
    assert reported(TWO + MIMIC, sdf="1.9") == [
        "LF7506 SDF 1.9 has no mimic joints, so 'follow' moves freely; remove `--sdf 1.9`, or set it to 1.11"
    ]
    assert reported(TWO + MIMIC) == [
        "LF7514 DART, Gazebo's default engine, ignores mimic joints, so 'follow' moves freely; "
        "choose bullet-featherstone, or have gz_ros2_control move it"
    ]


@pytest.mark.parametrize("kind", ["fixed", "floating"])
def test_a_mimic_joint_whose_leader_has_no_axis_moves_by_itself(kind: str):
    """Gazebo refuses the model with an error about its axis."""
    text = TWO + MIMIC.replace("turn: {type: continuous", f"turn: {{type: {kind}").replace(
        "hand, axis: z}\n", "hand}\n"
    )
    root = document(text)
    assert (root.get("version"), root.find(".//mimic")) == ("1.9", None)
    assert reported(text) == ["LF7501 SDF has no mimic with a joint of other than one axis; omitted for 'follow'"]


def test_limits_and_dynamics_of_a_floating_joint_are_reported():
    text = TWO + (
        "joints: {loose: {type: floating, parent: base, child: hand, dynamics: {damping: 1}, "
        "limits: {effort: 1, velocity: 1}}}"
    )
    assert reported(text) == [
        "LF7501 SDF has no limits of floating joints; omitted for 'loose'",
        "LF7501 SDF has no dynamics of floating joints; omitted for 'loose'",
    ]


def test_a_joint_with_the_name_of_a_link_is_renamed(tmp_path: Path):
    text = TWO + "joints: {hand: {type: continuous, parent: base, child: hand, axis: z}}"
    assert list(read(text, tmp_path).joints) == ["hand_joint"]
    assert reported(text) == [
        "LF7504 links and joints share their names in SDF, so joint 'hand' is 'hand_joint' there; "
        "rename the joint or the link"
    ]


@pytest.mark.parametrize(
    ("text", "messages"),
    [
        (
            "links: {base: {inertial: *unit}, hand: }\n"
            "joints: {turn: {type: continuous, parent: base, child: hand, axis: z}}",
            ["LF7502 Gazebo needs a mass for each body, so 'hand' has 1e-9 kg in the SDF; give it an inertial"],
        ),
        (
            "links: {base: {inertial: {mass: 1, inertia: {ixx: 1, iyy: 1, izz: 3}}}}",
            [
                "LF7503 Gazebo refuses the inertia of 'base', so all its moments are larger in the SDF; "
                "correct the tensor"
            ],
        ),
        (
            "links: {base: {inertial: *unit}, world: {inertial: *unit}}\n"
            "joints: {weld: {type: fixed, parent: base, child: world}}",
            ["LF7505 'world' is reserved in SDF; rename this one"],
        ),
        (
            "links: {base: {inertial: *unit, gazebo: {properties: {sensor: {_name: 'head::imu', _type: imu}}}}}",
            ["LF7505 'head::imu' is reserved in SDF; rename this one"],
        ),
        (
            TWO + "joints: {glide: {type: planar, parent: base, child: hand, axis: z}}",
            ["LF7507 SDF has no planar joints, so 'glide' is omitted and link 'hand' moves freely"],
        ),
        (
            "links: {base: {inertial: *unit, gazebo: {material: Gazebo/Orange, mu1: 1}}}",
            ["LF7501 SDF has no place for the setting 'material'; omitted for 'base'"],
        ),
        (
            "links: {base: {inertial: *unit, extra: <thermal/>}}",
            ["LF7501 SDF has no raw XML of a URDF; omitted for 'base'"],
        ),
        (
            "links: {world: {visual: {box: [1, 1, 1]}}, base: {inertial: *unit}}\n"
            "joints: {weld: {type: fixed, parent: world, child: base}}",
            ["LF7501 SDF has no shapes of the world; omitted for 'world'"],
        ),
        (
            TWO + "joints: {turn: {type: revolute, parent: base, child: hand, axis: z, "
            "limits: {lower: 0, upper: 1, effort: 1, velocity: 1}, safety_controller: {k_velocity: 1}}}",
            ["LF7501 SDF has no safety controllers; omitted for 'turn'"],
        ),
    ],
)
def test_a_loss_or_change_is_reported(text: str, messages: list[str]):
    assert reported(text) == messages


def test_an_inertia_that_no_body_can_have_is_changed(tmp_path: Path):
    found = read("links: {base: {inertial: {mass: 1, inertia: {ixx: 1, iyy: 1, izz: 3}}}}", tmp_path)
    assert found.links["base"]["inertia"][:3] == pytest.approx([2, 2, 4])


def test_a_flat_body_with_products_of_inertia_is_accepted(tmp_path: Path):
    """The tensor of a body in a plane, from a CAD program; one of its moments is 0."""
    tensor = (
        "{ixx: 6.11447595931231e-08, iyy: 1.04273395497727e-05, izz: 1.04884810136062e-05, "
        "ixy: 7.98473472450901e-07, ixz: 4.14523819570641e-09, iyz: -3.17421643702653e-10}"
    )
    found = read(f"links: {{base: {{inertial: {{mass: 0.03, inertia: {tensor}}}}}}}", tmp_path)
    assert found.links["base"]["inertia"][2] == pytest.approx(1.04884810136062e-05, rel=1e-6)


def test_a_file_that_is_not_found_is_reported_where_files_are_requested():
    text = (
        "materials: {rust: {texture: package://gone/rust.png}}\n"
        "links: {base: {inertial: *unit, visual: {mesh: {file: package://gone/base.stl}, material: rust}}}"
    )
    assert reported(text) == []
    assert reported(text, meshes="file") == [
        "LF7508 the URI of mesh 'package://gone/base.stl' stays in the SDF: package 'gone' is not found; "
        "specify its folder with `--package gone=FOLDER`",
        "LF7508 the URI of texture 'package://gone/rust.png' stays in the SDF: package 'gone' is not found; "
        "specify its folder with `--package gone=FOLDER`",
    ]
    assert "<uri>model://gone/base.stl</uri>" in rendered(text, meshes="file")


def test_a_plugin_of_gazebo_classic_is_reported():
    text = (
        "links: {base: {inertial: *unit}}\n"
        "sensors: {imu: {type: imu, link: base, plugin: {name: imu, filename: libgazebo_ros_imu_sensor.so}}}\n"
        "gazebo: {plugins: {control: {filename: libgazebo_ros_control.so}, own: {filename: libmine.so}, "
        "'gz_ros2_control::GazeboSimROS2ControlPlugin': {filename: libgz_ros2_control-system.so}}}"
    )
    assert reported(text) == [
        "LF7515 'libgazebo_ros_control.so' is a plugin of Gazebo Classic, which Gazebo Sim does not load; write one of "
        "Gazebo Sim, such as gz_ros2_control-system; the same for 'libgazebo_ros_imu_sensor.so'"
    ]


def test_raw_xml_of_a_urdf_is_reported_at_its_place():
    text = TWO + (
        "joints: {turn: {type: continuous, parent: base, child: hand, axis: z, "
        "dynamics: {damping: 1, extra_attributes: {stiction: 2}}}}"
    )
    (found,) = SDF.limits(compiled(text), {})
    assert (found.message, found.span and found.span.text) == (
        "SDF has no raw XML of a URDF; omitted for 'turn'",
        "2",
    )


@pytest.mark.parametrize("raw", ["extra: <axis/>", "extra_attributes: {dont_collapse: true}"])
def test_an_axis_or_lumping_of_a_fixed_joint_is_no_loss(raw: str):
    assert reported(TWO + f"joints: {{weld: {{type: fixed, parent: base, child: hand, {raw}}}}}") == []


def test_a_source_map_says_where_a_limit_was_written():
    text = TWO + (
        "joints:\n  turn:\n    type: revolute\n    parent: base\n    child: hand\n    axis: z\n"
        "    limits:\n      lower: -1\n      upper: 2\n      effort: 5\n      velocity: 1\n"
    )
    robot = compiled(text)
    result = SDF.render(robot, Rendering(has_map=True))[0]
    assert result.text == rendered(text)
    assert result.map is not None
    lines = result.text.splitlines()
    place = result.map.at(next(number for number, line in enumerate(lines, 1) if "<upper>" in line))
    assert place is not None
    assert place.span.text == "2"


def test_a_robot_without_links_is_no_model():
    missing = SDF.missing(compiled("links: {world: }"))
    assert missing is not None
    assert missing.code.id == "LF7513"
    assert SDF.missing(compiled("links: {base: {inertial: *unit}}")) is None


ARM = """\
linkforge: 1
name: arm
links: {hand: {inertial: {mass: 1, inertia: {ixx: 1, iyy: 1, izz: 1}}}}
sensors: {eye: {type: imu, link: hand, update_rate: 100, topic: /eye}}
"""
TWO_WITH_PLUGIN = """\
linkforge: 1
name: two
links: {base: {inertial: {mass: 1, inertia: {ixx: 1, iyy: 1, izz: 1}}}}
modules:
  left: {use: arm.robot.yaml, parent: base}
gazebo:
  plugins:
    glow: {filename: libglow.so, parameters: {rate: 5}}
"""


@pytest.mark.parametrize(
    ("line", "file", "number", "words"),
    [
        ('<link name="left_hand">', "arm", 3, "hand"),
        ('<sensor name="left_eye"', "arm", 4, "eye"),
        ("<update_rate>", "arm", 4, "100"),
        ("<topic>", "arm", 4, "/eye"),
        ('<model name="left">', "two", 5, "arm.robot.yaml"),
        ("<child>left::left_hand", "two", 5, "left"),
        ('<plugin name="glow"', "two", 8, "glow"),
        ("<rate>", "two", 8, "5"),
    ],
)
def test_a_source_map_has_nested_models_sensors_and_plugins(
    tmp_path: Path, line: str, file: str, number: int, words: str
):
    (tmp_path / "arm.robot.yaml").write_text(ARM)
    (tmp_path / "two.robot.yaml").write_text(TWO_WITH_PLUGIN)
    robot = compile_file(tmp_path / "two.robot.yaml").result()
    result = SDF.render(robot, Rendering({"nested": "yes"}, has_map=True))[0]
    assert result.map is not None
    lines = result.text.splitlines()
    place = result.map.at(next(place for place, text in enumerate(lines, 1) if line in text))
    assert place is not None
    assert (Path(place.span.file.name).name, place.span.line, place.span.text) == (f"{file}.robot.yaml", number, words)
