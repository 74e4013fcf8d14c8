"""MJCF: what it has of a robot, and what it says about the rest."""

import shlex
import struct
import subprocess
import sys
from pathlib import Path

import pytest

from linkforge_compile import compile_file
from linkforge_compile.core import Robot
from linkforge_compile.diagnostics.grouping import group_alike
from linkforge_compile.formats import MJCF, Rendering
from tests.conftest import ROOT
from tests.consumers import mjcf_model
from tests.formats.mjcf import HEAD, compiled, document, reported

mujoco = pytest.importorskip("mujoco")

TURNING = """
links:
  base: {visual: {box: [0.2, 0.4, 0.6], material: {name: red, color: [1, 0, 0]}}}
  arm:
    inertial: {mass: 1 kg, inertia: {ixx: 0.01, iyy: 0.01, izz: 0.01}}
    collision: {cylinder: {radius: 0.1, length: 0.5}, origin: {xyz: [0, 0, 0.25], rpy: [0, 90 deg, 0]}}
joints:
  turn:
    type: revolute
    parent: base
    child: arm
    axis: [0, 1, 0]
    origin: {xyz: [0, 0, 0.6]}
    limits: {lower: -1, upper: 2, effort: 5, velocity: 3}
    dynamics: {damping: 0.5, friction: 0.25}
"""


def attributes(text: str, path: str) -> dict[str, str]:
    found = document(text).find(path)
    assert found is not None
    return dict(found.attrib)


def test_a_body_is_inside_the_one_that_holds_it():
    assert attributes(TURNING, "worldbody/body") == {"name": "base"}
    assert attributes(TURNING, "worldbody/body/body") == {"name": "arm", "pos": "0 0 0.6"}


def test_a_joint_has_its_range_damping_and_friction():
    assert attributes(TURNING, ".//joint") == {
        "name": "turn",
        "axis": "0 1 0",
        "range": "-1 2",
        "damping": "0.5",
        "frictionloss": "0.25",
        "actuatorfrcrange": "-5 5",
    }


def test_shapes_have_half_sizes_and_the_class_of_their_kind():
    assert attributes(TURNING, "worldbody/body/geom") == {
        "class": "visual",
        "type": "box",
        "size": "0.1 0.2 0.3",
        "rgba": "1 0 0 1",
    }
    assert attributes(TURNING, "worldbody/body/body/geom") == {
        "class": "collision",
        "type": "cylinder",
        "size": "0.1 0.25",
        "pos": "0 0 0.25",
        "euler": "0 1.5707963267948966 0",
    }


def test_products_of_inertia_are_in_the_axes_of_the_body():
    turned = """
links:
  a: {inertial: {mass: 1, inertia: {ixx: 2, iyy: 3, izz: 4, ixy: 0.5}, origin: {rpy: [0, 0, 90 deg]}}}
"""
    inertial = attributes(turned, ".//inertial")
    assert "euler" not in inertial
    assert [float(number) for number in inertial["fullinertia"].split()] == pytest.approx([3, 2, 4, -0.5, 0, 0])


def test_a_floating_base_is_an_option():
    free = document(TURNING.replace("base: {", "base: {inertial: *unit, "), base="free")
    assert free.find("worldbody/body/freejoint").get("name") == "base_free"
    assert document(TURNING, base="fixed").find(".//freejoint") is None


def test_a_root_link_named_world_is_the_world():
    robot = "links: {world: {visual: {sphere: 1}}, base: }\njoints: {weld: {type: fixed, parent: world, child: base}}"
    assert attributes(robot, "worldbody/geom")["size"] == "1"
    assert attributes(robot, "worldbody/body") == {"name": "base"}


@pytest.mark.parametrize(("kind", "freedom"), [("floating", 6), ("planar, axis: [0, 0, 1]", 3)])
def test_joints_of_several_freedoms_are_several_joints(kind: str, freedom: int):
    robot = """
links: {base: , cart: {inertial: *unit}}
joints: {drive: {parent: base, child: cart, type: KIND}}
"""
    assert mjcf_model(compiled(robot.replace("KIND", kind))).nv == freedom


def test_a_mimic_and_a_locked_joint_are_equalities():
    robot = """
links: {base: , left: {inertial: *unit}, right: {inertial: *unit}, lock: {inertial: *unit}}
joints:
  lead: {type: continuous, parent: base, child: left, axis: [0, 0, 1]}
  follow:
    type: continuous
    parent: base
    child: right
    axis: [0, 0, 1]
    mimic: {joint: lead, multiplier: -2, offset: 0.5}
  held:
    type: revolute
    parent: base
    child: lock
    axis: [0, 0, 1]
    limits: {lower: 1, upper: 1, effort: 1, velocity: 1}
"""
    equalities = document(robot).find("equality")
    assert equalities is not None
    follow, held = (dict(one.attrib) for one in equalities)
    assert follow == {"joint1": "follow", "joint2": "lead", "polycoef": "0.5 -2 0 0 0"}
    assert held == {"joint1": "held", "polycoef": "1 0 0 0 0"}
    assert mjcf_model(compiled(robot)).neq == 2


def test_a_chain_that_is_too_long_for_mujoco_is_an_error():
    links = "".join(f"  l{number}:\n" for number in range(500))
    joints = "".join(f"  j{n}: {{type: fixed, parent: l{n}, child: l{n + 1}}}\n" for n in range(499))
    chain = f"links:\n{links}joints:\n{joints}"
    assert reported(chain) == ["LF7401 MuJoCo cannot read bodies nested deeper than 490, found a chain of 500 links"]
    assert MJCF.render(compiled(chain), Rendering())[0].text.count("<body ") == 500


def test_a_link_named_world_below_a_joint_is_an_error():
    robot = "links: {base: , world: }\njoints: {weld: {type: fixed, parent: base, child: world}}"
    assert reported(robot) == [
        "LF7406 MuJoCo reserves the name 'world' for the ground, so no link below a joint can have it; rename this one"
    ]


def test_moving_bodies_without_mass_are_loaded_and_reported_once():
    robot = """
links: {base: , one: , two: , tip: }
joints:
  turn: {type: continuous, parent: base, child: one, axis: [0, 0, 1]}
  slide: {type: continuous, parent: one, child: two, axis: [0, 0, 1]}
  weld: {type: fixed, parent: two, child: tip}
"""
    assert reported(robot) == [
        "LF7402 MuJoCo refuses a moving body without mass, so 'one' has 1e-9 kg in the MJCF; give it an inertial; "
        "the same for 'two'"
    ]
    assert mjcf_model(compiled(robot)).nv == 2


def test_a_moving_body_has_the_mass_of_what_is_fixed_to_it():
    robot = """
links: {base: , joint_frame: , arm: {inertial: *unit}}
joints:
  turn: {type: continuous, parent: base, child: joint_frame, axis: [0, 0, 1]}
  weld: {type: fixed, parent: joint_frame, child: arm}
"""
    assert reported(robot) == []
    assert mjcf_model(compiled(robot)).body_mass.sum() == 1


@pytest.mark.parametrize("moments", ["ixx: 0.01, iyy: 0.01, izz: 0.05", "ixx: 1, iyy: 1, izz: 1, ixy: 0.9, ixz: 0.9"])
def test_an_inertia_that_mujoco_refuses_is_changed_and_reported(moments: str):
    robot = """
links: {base: , arm: {inertial: {mass: 1, inertia: {MOMENTS}}}}
joints: {turn: {type: continuous, parent: base, child: arm, axis: [0, 0, 1]}}
""".replace("MOMENTS", moments)
    assert [one[:6] for one in reported(robot)] == ["LF7403"]
    assert mjcf_model(compiled(robot)).body_mass.sum() == 1


def triangles(count: int) -> bytes:
    """Return a binary STL of triangles between corners that are not in one plane."""
    corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    faces = [[corners[(first + one) % 4] for one in range(3)] for first in range(count)]
    body = b"".join(struct.pack("<12fH", 0, 0, 0, *(at for corner in face for at in corner), 0) for face in faces)
    return bytes(80) + struct.pack("<I", count) + body


def compiled_in(folder: Path, text: str):
    (folder / "robot.robot.yaml").write_text(HEAD + text)
    compilation = compile_file(folder / "robot.robot.yaml")
    assert compilation.robot is not None, compilation.diagnostics
    return compilation.robot


def test_relative_meshes_stay_relative(tmp_path: Path):
    (tmp_path / "part.STL").write_bytes(triangles(4))
    robot = compiled_in(
        tmp_path, "links: {base: {visual: {mesh: part.STL}, collision: {mesh: {file: part.STL, scale: [2, 2, 2]}}}}"
    )
    text = MJCF.render(robot, Rendering())[0].text
    assert "meshdir" not in text
    assert '<mesh name="part" file="part.STL"/>' in text
    assert '<mesh name="part_2" file="part.STL" scale="2 2 2"/>' in text
    (tmp_path / "robot.mjcf").write_text(text)
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "robot.mjcf"))
    assert (model.nmesh, model.ngeom) == (2, 2)


def test_meshes_of_packages_are_files_below_one_folder(tmp_path: Path):
    for package in ("arm", "hand"):
        (tmp_path / package / "meshes").mkdir(parents=True)
        (tmp_path / package / "package.xml").write_text(f"<package><name>{package}</name></package>")
        (tmp_path / package / "meshes" / "part.stl").write_bytes(triangles(4))
    robot = compiled_in(
        tmp_path / "arm",
        "links: {base: {visual: {mesh: package://arm/meshes/part.stl}, collision: {mesh: ../hand/meshes/part.stl}}}",
    )
    text = MJCF.render(robot, Rendering())[0].text
    assert f'meshdir="{tmp_path.as_posix()}"' in text
    assert '<mesh name="part" file="arm/meshes/part.stl"/>' in text
    assert '<mesh name="part_2" file="hand/meshes/part.stl"/>' in text
    assert mjcf_model(robot).nmesh == 2


def test_a_relative_mesh_of_the_working_folder_alone_is_not_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    (tmp_path / "robots").mkdir()
    (tmp_path / "part.stl").write_bytes(triangles(4))
    monkeypatch.chdir(tmp_path)
    robot = compiled_in(tmp_path / "robots", "links: {base: {visual: {mesh: part.stl}}}")
    assert [one.message for one in MJCF.limits(robot, {})] == [
        "mesh 'part.stl' is omitted from the MJCF: the file is not found"
    ]
    assert mjcf_model(robot).ngeom == 0


def test_meshes_that_mujoco_cannot_read_are_left_out_and_reported_by_reason(tmp_path: Path):
    (tmp_path / "base.dae").write_text("<COLLADA/>")
    (tmp_path / "text.stl").write_text("solid text\nendsolid text\n")
    robot = compiled_in(tmp_path, "links: {base: {visual: [{mesh: base.dae}, {mesh: text.stl}, {mesh: no.stl}]}}")
    assert [one.message for one in MJCF.limits(robot, {})] == [
        "mesh 'base.dae' is omitted from the MJCF: MuJoCo reads STL, OBJ and MSH; 'linkforge explain LF7404' has a "
        "command that converts it",
        "mesh 'text.stl' is omitted from the MJCF: MuJoCo reads binary STL of up to 200,000 triangles; 'linkforge "
        "explain LF7404' has a command that converts it",
        "mesh 'no.stl' is omitted from the MJCF: the file is not found",
    ]
    assert mjcf_model(robot).ngeom == 0


def test_a_mesh_of_an_unknown_package_names_the_package(tmp_path: Path):
    files = [f"package://unknown_description/meshes/visual/{number}.stl" for number in range(8)]
    visuals = ", ".join(f"{{mesh: {{file: {file}}}}}" for file in files)
    robot = compiled_in(tmp_path, f"links: {{base: {{visual: [{visuals}]}}}}")
    (found,) = group_alike(MJCF.limits(robot, {}))
    assert found.message == (
        f"mesh '{files[0]}' is omitted from the MJCF: package 'unknown_description' is not found; specify its folder "
        f"with `--package unknown_description=FOLDER`; the same for '{files[1]}', '{files[2]}', '{files[3]}', "
        f"'{files[4]}' and 3 more"
    )


def test_a_mesh_of_one_triangle_is_left_out_as_mujoco_refuses_it(tmp_path: Path):
    (tmp_path / "one.stl").write_bytes(triangles(1))
    (tmp_path / "flat.stl").write_bytes(triangles(2))
    robot = compiled_in(tmp_path, "links: {base: {visual: [{mesh: one.stl}, {mesh: flat.stl}]}}")
    assert [one.message for one in MJCF.limits(robot, {})] == [
        "mesh 'one.stl' is omitted from the MJCF: MuJoCo refuses a mesh of one triangle"
    ]
    (tmp_path / "robot.mjcf").write_text(MJCF.render(robot, Rendering())[0].text)
    assert mujoco.MjModel.from_xml_path(str(tmp_path / "robot.mjcf")).ngeom == 1


def test_the_command_of_the_manual_converts_a_mesh(tmp_path: Path):
    trimesh = pytest.importorskip("trimesh")
    page = (ROOT / "docs" / "diagnostics" / "LF7404.md").read_text()
    command = next(line for line in page.splitlines() if line.startswith("python -c"))
    (tmp_path / "base.dae").write_bytes(trimesh.creation.box((1, 2, 3)).export(file_type="dae"))
    subprocess.run([sys.executable, *shlex.split(command)[1:]], cwd=tmp_path, check=True, timeout=60)
    robot = compiled_in(tmp_path, "links: {base: {visual: {mesh: base.stl}}}")
    assert list(MJCF.limits(robot, {})) == []
    (tmp_path / "robot.mjcf").write_text(MJCF.render(robot, Rendering())[0].text)
    assert mujoco.MjModel.from_xml_path(str(tmp_path / "robot.mjcf")).nmeshface == 12


def test_parts_without_counterpart_are_reported_by_kind():
    assert reported(TURNING + "transmissions: {gear: {type: t, joints: {turn: }, actuators: {motor: }}}\n") == [
        "LF7413 MuJoCo does not read transmissions; omitted for 'gear'"
    ]


def test_keeping_a_fixed_joint_is_no_loss():
    kept = "links: {base: , tip: }\njoints: {weld: {type: fixed, parent: base, child: tip, gazebo: {SETTING}}}"
    assert reported(kept.replace("SETTING", "preserveFixedJoint: true")) == []
    assert reported(kept.replace("SETTING", "stop_cfm: 0.5")) == [
        "LF7413 MuJoCo does not read settings for Gazebo; omitted for 'weld'"
    ]


def test_a_robot_without_links_is_a_document_without_bodies():
    text = MJCF.render(Robot("empty"), Rendering())[0].text
    assert mujoco.MjModel.from_xml_string(text).nbody == 1  # the world


def test_a_missing_limit_is_zero_as_in_urdf():
    text = TURNING.replace("lower: -1, ", "")
    assert attributes(text, ".//joint")["range"] == "0 2"


def test_a_floating_base_stays_on_the_ground_of_its_world():
    text = """
links:
  world: {collision: {box: [9, 9, 1]}}
  base: {inertial: {mass: 1, inertia: {ixx: 1, iyy: 1, izz: 1}}, collision: {box: [1, 1, 1]}}
joints: {free: {type: floating, parent: world, child: base}}
"""
    assert document(text).find(".//exclude") is None
