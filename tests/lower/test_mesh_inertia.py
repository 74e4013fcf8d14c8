"""Inertia of meshes from specs: found by the spec's packages, read once, added to other shapes, or reported."""

import os
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from linkforge_compile import Compilation, check_file, compile_file, compile_text
from linkforge_compile.core import Vector3
from linkforge_compile.core.meshes import solid_in
from linkforge_compile.limits import Limit
from linkforge_compile.lower import mesh_solids
from tests.meshes import block, save, together, turned_inside_out

CUBE = block(2, 2, 2)


def spec(folder: Path, text: str, name: str = "arm.robot.yaml") -> Path:
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"linkforge: 1\nname: arm\n{text}", "utf-8")
    return path


def link(shapes: str, inertial: str = "{mass: 8 kg}") -> str:
    return f"links:\n  base:\n    collision: {shapes}\n    inertial: {inertial}\n"


def base(compilation: Compilation):
    return compilation.result().link("base")


def messages(compilation: Compilation) -> list[str]:
    return [f"{diagnostic.code.id}: {diagnostic.message}" for diagnostic in compilation.diagnostics]


@pytest.mark.parametrize("name", ["cube.stl", "cube.obj", "cube.dae", "CUBE.STL"])
def test_a_mesh_has_the_inertia_of_its_shape(tmp_path, name):
    save(CUBE, tmp_path / "meshes" / name)
    mesh, box = (
        base(compile_file(spec(tmp_path, link(shape)))) for shape in (f"{{mesh: meshes/{name}}}", "{box: [2, 2, 2]}")
    )
    assert (mesh.mass, mesh.inertia.ixx) == pytest.approx((box.mass, box.inertia.ixx))


def test_a_mesh_a_primitive_and_a_mirrored_scale_weigh_together(tmp_path):
    save(block(2, 2, 2, at=(5, 0, 0)), tmp_path / "cube.stl")
    shapes = "[{mesh: {file: cube.stl, scale: [-1, 1, 1]}}, {box: [2, 2, 2], origin: [5, 0, 0]}]"
    link_base = base(compile_file(spec(tmp_path, link(shapes, "{density: 1}"))))
    assert link_base.mass == 16
    assert link_base.inertial_origin.xyz == Vector3(0, 0, 0)
    assert link_base.inertia.izz == pytest.approx(16 * (8 / 12 + 25))


def test_a_mesh_is_scaled_to_metres(tmp_path):
    save(block(200, 200, 200), tmp_path / "cube.stl")
    compilation = compile_file(spec(tmp_path, link("{mesh: {file: cube.stl, scale: 0.001}}", "{density: 1000}")))
    assert base(compilation).mass == pytest.approx(8)
    assert messages(compilation) == []


def test_a_mesh_path_starts_at_the_file_that_wrote_it(tmp_path):
    parts = {"hand": "meshes/cube.stl", "foot": "package://feet/cube.stl", "head": "package://heads/cube.stl"}
    for folder in ("hand/meshes", "feet", "skulls"):
        save(CUBE, tmp_path / folder / "cube.stl")
    for part, mesh in parts.items():
        packages = "packages: {heads: ../skulls}\n" if part == "head" else ""
        spec(tmp_path, packages + link(f"{{mesh: {mesh}}}"), f"{part}/{part}.robot.yaml")
    uses = "\n".join(f"  {part}: {{use: {part}/{part}.robot.yaml, parent: trunk}}" for part in parts)
    whole = spec(tmp_path, f"links: {{trunk: }}\nmodules:\n{uses}\n")
    compilation = compile_file(whole, packages={"feet": tmp_path / "feet"})
    robot = compilation.result()
    assert [robot.link(f"{part}_base").inertia.ixx for part in parts] == pytest.approx([8 * 8 / 12] * 3)
    assert [path.name for path in compilation.files].count("cube.stl") == 3


def test_a_mesh_of_an_override_or_an_included_file_is_found_from_there(tmp_path):
    (tmp_path / "package.xml").touch()
    save(CUBE, tmp_path / "robot" / "cube.stl")
    save(block(4, 4, 4), tmp_path / "parts" / "own.stl")
    spec(tmp_path, link("{sphere: 1}"), "leg/leg.robot.yaml")
    (tmp_path / "parts" / "more.yaml").write_text(
        "linkforge: 1\nlinks: {trunk: {collision: {mesh: own.stl}, inertial: {density: 1}}}\n", "utf-8"
    )
    override = "override: {links: {base: {collision: {mesh: cube.stl}}}}"
    uses = f"modules: {{leg: {{use: ../leg/leg.robot.yaml, parent: trunk, {override}}}}}"
    robot = compile_file(spec(tmp_path, f"include: [../parts/more.yaml]\n{uses}\n", "robot/arm.robot.yaml")).result()
    assert robot.link("trunk").mass == 64
    assert robot.link("leg_base").inertia.ixx == pytest.approx(8 * 8 / 12)


def test_a_mesh_is_found_by_an_absolute_path_and_by_file_uri(tmp_path):
    path = save(CUBE, tmp_path / "elsewhere" / "a cube.stl")
    for written in (str(path), path.as_uri()):
        text = "linkforge: 1\nname: arm\n" + link(f'{{mesh: "{written}"}}')
        assert base(compile_text(text, allow_outside=True)).inertia.ixx > 1


def test_a_relative_mesh_of_a_text_that_lies_nowhere_is_nowhere():
    compilation = compile_text(f"linkforge: 1\nname: arm\n{link('{mesh: cube.stl}')}")
    assert messages(compilation) == [
        "LF3006: 'cube.stl' cannot be found: it is relative, and this text is not in a folder"
    ]


def test_a_mesh_is_read_once_for_all_links_and_modules(tmp_path, monkeypatch):
    save(CUBE, tmp_path / "cube.stl")
    read = []
    monkeypatch.setattr(mesh_solids, "solid_in", lambda data, name, *, times: read.append(name) or solid_in(data, name))
    spec(tmp_path, link("[{mesh: cube.stl}, {mesh: {file: cube.stl, scale: 2}}]"), "leg.robot.yaml")
    uses = "modules: {a: {use: leg.robot.yaml, parent: base}, b: {use: leg.robot.yaml, parent: base}}\n"
    compile_file(spec(tmp_path, link("{mesh: cube.stl}") + uses)).result()
    assert read == ["cube.stl"]


def test_no_mesh_is_read_where_nothing_is_computed_from_it(tmp_path):
    shapes = "{mesh: missing.stl}"
    written = "{mass: 1, inertia: {ixx: 1, iyy: 1, izz: 1}}"
    compilation = compile_file(spec(tmp_path, link(shapes, written)))
    assert (compilation.result().name, len(compilation.files)) == ("arm", 1)
    pretty = "links:\n  base: {visual: {mesh: missing.stl}, collision: {sphere: 1}, inertial: {mass: 1}}\n"
    assert compile_file(spec(tmp_path, pretty)).result()


def test_without_trimesh_the_package_to_install_is_reported_once(tmp_path, monkeypatch):
    save(CUBE, tmp_path / "cube.stl")
    path = spec(tmp_path, link("[{mesh: cube.stl}, {mesh: {file: cube.stl, scale: 2}}]"))
    for name in [name for name in sys.modules if name.startswith("linkforge_compile.core.meshes.c")]:
        monkeypatch.delitem(sys.modules, name)
    for name in ["trimesh", *(name for name in sys.modules if name.startswith("trimesh."))]:
        monkeypatch.setitem(sys.modules, name, None)
    assert messages(check_file(path)) == [
        "LF6010: the inertia of mesh 'cube.stl' needs the Python package trimesh; "
        "run \"pip install 'linkforge-compile[mesh]'\", or specify 'inertia'"
    ]


def test_a_huge_file_is_not_read(tmp_path, monkeypatch):
    save(CUBE, tmp_path / "cube.stl")
    monkeypatch.setattr(mesh_solids, "MAX_BYTES", 100)
    assert messages(compile_file(spec(tmp_path, link("{mesh: cube.stl}")))) == [
        "LF6014: mesh 'cube.stl' is too large to compute an inertia from: it is larger than 0 MiB; "
        "give it a simpler collision mesh"
    ]


def test_the_meshes_of_a_compile_are_bounded_together_each_file_once(tmp_path, monkeypatch):
    for name in ("one.stl", "two.stl"):
        save(CUBE, tmp_path / name)
    size = (tmp_path / "one.stl").stat().st_size
    monkeypatch.setattr(Limit.MESH_BYTES, "_value_", replace(Limit.MESH_BYTES.value, most=2 * size - 1))
    assert messages(compile_file(spec(tmp_path, link("[{mesh: one.stl}, {mesh: {file: one.stl, scale: 2}}]")))) == []
    (fault,) = compile_file(spec(tmp_path, link("[{mesh: one.stl}, {mesh: two.stl}]"))).diagnostics
    assert fault.code.id == "LF3301"
    assert f"more than {2 * size - 1:,} bytes in the meshes" in fault.message
    assert fault.span.text == "two.stl"


def test_a_fault_of_a_mesh_has_notes_of_its_purpose_and_use(tmp_path):
    save(turned_inside_out(CUBE), tmp_path / "cube.stl")
    spec(tmp_path, link("{mesh: {file: cube.stl}}"), "leg.robot.yaml")
    whole = spec(tmp_path, "links: {trunk: }\nmodules: {leg: {use: leg.robot.yaml, parent: trunk}}\n")
    (fault,) = compile_file(whole).diagnostics
    assert Path(fault.span.file.name).name == "leg.robot.yaml"
    assert (fault.span.line, fault.span.column) == (5, 30)
    assert [note.message for note in fault.notes] == ["its inertia is needed here", "used here"]


def test_every_faulty_mesh_of_a_link_is_reported(tmp_path):
    save(together(CUBE, turned_inside_out(block(1, 1, 1, at=(9, 0, 0)))), tmp_path / "two.stl")
    messages_found = messages(compile_file(spec(tmp_path, link("[{mesh: two.stl}, {mesh: lost.stl}, {sphere: 1}]"))))
    assert [message.partition(":")[0] for message in messages_found] == ["LF6018", "LF6011"]


def test_a_scale_that_leaves_nothing_is_refused(tmp_path):
    save(CUBE, tmp_path / "cube.stl")
    messages_found = messages(compile_file(spec(tmp_path, link("{mesh: {file: cube.stl, scale: 1e-200}}"))))
    assert messages_found == [
        "LF5011: inertial of link 'base': a scale of 1e-200 1e-200 1e-200 takes the volume of the mesh to 0.0 m³"
    ]


def test_a_pipe_is_no_mesh(tmp_path):
    if not hasattr(os, "mkfifo"):
        pytest.skip("no pipes here")
    os.mkfifo(tmp_path / "cube.stl")
    (message,) = messages(compile_file(spec(tmp_path, link("{mesh: cube.stl}"))))
    assert message.endswith("it is not a regular file")


def test_mujoco_weighs_the_meshes_of_the_good_case_as_we_do():
    """By its own integrals: the wedge turned, moved and joined with a cylinder."""
    mujoco = pytest.importorskip("mujoco")
    folder = Path(__file__).parents[1] / "cases" / "good" / "mesh_inertia"
    ours = compile_file(folder / "mesh_inertia.robot.yaml").result().link("assembled").inertial
    model = mujoco.MjModel.from_xml_string(
        """
        <mujoco>
          <compiler angle="radian"/>
          <asset><mesh name="wedge" file="wedge.obj" scale=".001 .001 .001" inertia="exact"/></asset>
          <worldbody><body>
            <geom type="mesh" mesh="wedge" density="2700" pos=".1 0 0" euler="0 0 1.5707963267948966"/>
            <geom type="cylinder" size=".02 .05" density="2700" pos=".1 0 .1"/>
          </body></worldbody>
        </mujoco>
        """,
        {"wedge.obj": (folder / "wedge.obj").read_bytes()},
    )
    turn = np.zeros(9)
    mujoco.mju_quat2Mat(turn, model.body_iquat[1])
    turn = turn.reshape(3, 3)
    tensor = turn @ np.diag(model.body_inertia[1]) @ turn.T
    assert model.body_mass[1] == pytest.approx(ours.mass)
    assert model.body_ipos[1] == pytest.approx(tuple(ours.origin.xyz))
    one = ours.inertia
    assert tensor == pytest.approx(
        np.array([[one.ixx, one.ixy, one.ixz], [one.ixy, one.iyy, one.iyz], [one.ixz, one.iyz, one.izz]]), abs=1e-9
    )
