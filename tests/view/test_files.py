"""The meshes of a robot, what they name, and what is missing."""

import json
import os
from pathlib import Path

import pytest
import trimesh

from linkforge_compile import compile_file
from linkforge_compile.view import files as files_module
from linkforge_compile.view.files import RobotFiles, collect_files, not_reported
from linkforge_compile.view.scene import make_scene
from tests.meshes import block, content

HEAD = "linkforge: 1\nname: r\n"
STL = (
    b"solid %s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n"
)
PNG = b"\x89PNG\r\n\x1a\n"


def files_of(folder: Path, *meshes: str, **options: bool) -> RobotFiles:
    (folder / "package.xml").write_text("<package><name>here</name></package>", "utf-8")
    links = "".join(f"  l{number}: {{visual: {{mesh: '{mesh}'}}}}\n" for number, mesh in enumerate(meshes))
    joints = "".join(f"  j{n}: {{type: fixed, parent: l0, child: l{n}}}\n" for n in range(1, len(meshes)))
    joints = f"joints:\n{joints}" if joints else ""
    (folder / "r.robot.yaml").write_text(f"{HEAD}links:\n{links}{joints}", "utf-8")
    return collect_files(compile_file(folder / "r.robot.yaml", **options).result())


def by_name(files: RobotFiles) -> dict[str, bytes]:
    return {file.name: file.content for file in files.files.values()}


def used(files: RobotFiles, name: str) -> dict[str, str]:
    """Return the names of the files that the file of a name uses, by what it calls them."""
    file = next(file for file in files.files.values() if file.name == name)
    return {called: files.files[digest].name for called, digest in file.uses.items()}


def write(folder: Path, **contents: str | bytes) -> None:
    for name, text in contents.items():
        path = folder / name.replace("__", ".")
        path.write_bytes(text.encode() if isinstance(text, str) else text)


def test_a_material_and_its_texture_come_with_an_obj(tmp_path: Path):
    write(
        tmp_path,
        a__obj="mtllib my part.mtl\nv 0 0 0\n",
        steel__png=PNG,
        bump__png=PNG + b"2",
    )
    mtl = "newmtl m\nmap_Kd -s 1 1 1 steel.png\nmap_bump -bm 0.2 bump.png\nKd 1 0 0\n"
    (tmp_path / "my part.mtl").write_text(mtl, "utf-8")
    files = files_of(tmp_path, "a.obj")
    assert not files.missing
    assert used(files, "a.obj") == {"my part.mtl": "my part.mtl"}
    assert used(files, "my part.mtl") == {"steel.png": "steel.png", "bump.png": "bump.png"}
    assert by_name(files)["steel.png"] == PNG


def test_images_come_with_collada_and_gltf(tmp_path: Path):
    (tmp_path / "my image.png").write_bytes(PNG)
    collada = '<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema"><library_images><image id="i">'
    collada += "<init_from>my%20image.png</init_from></image></library_images><library_effects><surface>"
    collada += "<init_from>i</init_from></surface></library_effects></COLLADA>"
    gltf = {"buffers": [{"uri": "a.bin"}, {"uri": "data:;base64,AA=="}], "images": [{"uri": "my%20image.png"}]}
    chunk = json.dumps({"images": [{"uri": "my%20image.png"}]}).encode()
    header = b"glTF" + (2).to_bytes(4, "little") + (20 + len(chunk)).to_bytes(4, "little")
    glb = header + len(chunk).to_bytes(4, "little") + b"JSON" + chunk
    write(tmp_path, a__dae=collada, b__gltf=json.dumps(gltf), a__bin=b"\1", c__glb=glb)
    files = files_of(tmp_path, "a.dae", "b.gltf", "c.glb")
    assert not files.missing
    assert used(files, "a.dae") == used(files, "c.glb") == {"my%20image.png": "my image.png"}
    assert used(files, "b.gltf") == {"a.bin": "a.bin", "my%20image.png": "my image.png"}


def test_blanks_before_the_declaration_of_collada_are_no_fault(tmp_path: Path):
    write(tmp_path, a__dae=b" \n" + content(block(1, 1, 1), "dae"))
    assert "a.dae" in files_of(tmp_path, "a.dae").digests


def test_a_file_of_two_shapes_is_there_once(tmp_path: Path):
    write(tmp_path, a__stl=STL % b"a", b__stl=STL % b"a", c__stl=STL % b"c")
    files = files_of(tmp_path, "a.stl", "b.stl", "c.stl", "package://here/c.stl")
    assert len(files.files) == 2
    assert files.digests["a.stl"] == files.digests["b.stl"] != files.digests["c.stl"]
    assert files.digests["c.stl"] == files.digests["package://here/c.stl"]


def test_meshes_alike_that_name_unlike_files_are_two(tmp_path: Path):
    for folder, color in (("red", "Kd 1 0 0"), ("blue", "Kd 0 0 1")):
        (tmp_path / folder).mkdir()
        write(tmp_path / folder, a__obj="mtllib a.mtl\n", a__mtl=f"newmtl m\n{color}\n")
    files = files_of(tmp_path, "red/a.obj", "blue/a.obj")
    assert files.digests["red/a.obj"] != files.digests["blue/a.obj"]


def test_what_is_missing_has_its_reason_and_links(tmp_path: Path):
    write(tmp_path, empty__stl=b"", lfs__stl=b"version https://git-lfs.github.com/spec/v1\n", a__fbx=b"x")
    write(tmp_path, a__obj="mtllib gone.mtl\n")
    meshes = ("gone.stl", "package://nowhere/a.stl", "empty.stl", "lfs.stl", "a.fbx", "a.obj", "gone.stl")
    files = files_of(tmp_path, *meshes)
    missing = {one.resource: one for one in files.missing}
    assert missing["gone.stl"].use.links == ("l0", "l6")
    assert missing["gone.stl"].use.place.line == 4
    reasons = {resource: one.reason for resource, one in missing.items()}
    assert reasons["gone.stl"] == "the file is not found"
    assert "--package nowhere=FOLDER" in reasons["package://nowhere/a.stl"]
    assert reasons["empty.stl"] == "it is empty"
    assert "git lfs pull" in reasons["lfs.stl"]
    assert "does not show .fbx, only .dae, .glb" in reasons["a.fbx"]
    assert reasons["gone.mtl in a.obj"] == "the file is not found"
    assert by_name(files).keys() == {"a.obj"}


def test_only_files_within_the_roots_are_read(tmp_path: Path):
    inside, outside = tmp_path / "inside", tmp_path / "outside"
    inside.mkdir()
    outside.mkdir()
    write(outside, secret__stl=STL % b"s", secret__png=PNG)
    (inside / "link.stl").symlink_to(outside / "secret.stl")
    write(inside, a__obj="mtllib a.mtl\n", a__mtl="newmtl m\nmap_Kd ../outside/secret.png\n")
    meshes = ("../outside/secret.stl", "link.stl", str(outside / "secret.stl"), "a.obj")
    files = files_of(inside, *meshes)
    assert by_name(files).keys() == {"a.obj", "a.mtl"}
    assert {one.reason.partition(";")[0] for one in files.missing} == {
        "it is outside of the folders that the robot may read"
    }
    assert len(files.missing) == 4
    (outside / "secret.stl").unlink()
    without = files_of(inside, *meshes).missing
    assert [one[:2] for one in without] == [one[:2] for one in files.missing], "a reason reveals whether a file exists"
    (outside / "secret.stl").write_bytes(STL % b"s")
    assert len(files_of(inside, *meshes, allow_outside=True).missing) == 0


def test_a_mesh_cannot_bring_a_file_of_another_kind(tmp_path: Path):
    write(
        tmp_path,
        key__pem=b"secret",
        a__obj="mtllib key.pem\n",
        a__dae="<a><image><init_from>key.pem</init_from></image></a>",
    )
    files = files_of(tmp_path, "a.obj", "a.dae")
    assert b"secret" not in by_name(files).values()
    assert len(files.missing) == 2


def test_a_collada_file_expands_nothing(tmp_path: Path):
    write(tmp_path, secret__png=PNG, other__txt=b"secret.png")
    entity = '<!DOCTYPE a [<!ENTITY e SYSTEM "other.txt">]><a><image><init_from>&e;</init_from></image></a>'
    write(tmp_path, a__dae=entity)
    assert by_name(files_of(tmp_path, "a.dae")).keys() == {"a.dae"}


def test_files_have_limits_of_their_size(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    mebibyte = 1024**2
    monkeypatch.setattr(files_module, "MAX_BYTES", 2 * mebibyte)
    monkeypatch.setattr(files_module, "MAX_ALL_BYTES", 3 * mebibyte)
    write(tmp_path, a__obj=b"a" * 3 * mebibyte, b__obj=b"b" * 2 * mebibyte, c__obj=b"c" * 2 * mebibyte, d__obj=b"d")
    files = files_of(tmp_path, "a.obj", "b.obj", "c.obj", "d.obj")
    assert by_name(files).keys() == {"b.obj", "d.obj"}
    assert {one.resource: one.reason for one in files.missing} == {
        "a.obj": "it is larger than 2 MiB",
        "c.obj": "all files of the robot are larger than 3 MiB together",
    }


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no named pipes")
def test_a_pipe_is_not_read(tmp_path: Path):
    os.mkfifo(tmp_path / "a.stl")
    (missing,) = files_of(tmp_path, "a.stl").missing
    assert missing.reason == "it is not a regular file"


def test_textures_of_materials_are_files_of_the_scene(tmp_path: Path):
    write(tmp_path, wood__png=PNG)
    spec = "links: {a: {visual: {box: [1, 1, 1], material: {name: wood, texture: wood.png}}}}\n"
    (tmp_path / "r.robot.yaml").write_text(HEAD + spec, "utf-8")
    robot = compile_file(tmp_path / "r.robot.yaml").result()
    scene = make_scene(robot, collect_files(robot))
    (digest,) = scene["files"]
    assert scene["links"][0]["visuals"][0]["texture"] == digest
    assert scene["files"][digest] == {
        "name": "wood.png",
        "kind": "png",
        "size": len(PNG),
        "links": ("a",),
        "source": {"file": str(tmp_path / "r.robot.yaml"), "line": 3, "column": 70},
    }


def _cut(mesh: trimesh.Trimesh, form: str) -> bytes:
    whole = content(mesh, form)
    return whole[: len(whole) // 2]


@pytest.mark.parametrize(
    ("name", "written", "reason"),
    [
        ("a.stl", _cut(block(1, 1, 1), "stl"), "the file ends before its data does, after 5 of 12 triangles"),
        ("a.stl", b"solid".ljust(80) + b"\2\0\0\0" + bytes(98), "after 1 of 2 triangles"),
        ("a.stl", b"solid of nothing", "it has no triangles"),
        ("a.stl", b"<html>404</html>", "its length is not that of a binary STL file, nor does it begin with 'solid'"),
        ("a.dae", _cut(block(1, 1, 1), "dae"), "the file ends before its data does"),
        ("a.dae", b"<a>\n<b></a>\n</b>", "it is not well-formed XML at line 2"),
        ("a.glb", _cut(block(1, 1, 1), "glb"), "the file ends before its data does"),
        ("a.glb", b"<html>", "it does not begin with 'glTF'"),
        ("a.gltf", b'{"asset": {"version": "2.0"', "the file ends before its data does"),
        ("a.gltf", b'{"asset": "2.0', "the file ends before its data does"),
        ("a.gltf", b"{\nasset: 1}", "it is not JSON at line 2"),
        ("a.ply", b"<html>", "it does not begin with 'ply'"),
        ("http://example.com/a.dae", b"", "nothing is downloaded; save it next to the spec"),
        ("model://arm/a.dae", b"", "files of 'model://' are not looked for"),
        (
            "package:///arm/a.dae",
            b"",
            "'package:///' names no package, and RViz refuses it too; write 'package://arm/…'",
        ),
    ],
)
def test_a_file_that_cannot_be_shown_has_the_reason_and_its_link(
    name: str, written: bytes, reason: str, tmp_path: Path
):
    if "/" not in name:
        (tmp_path / name).write_bytes(written)
    (missing,) = files_of(tmp_path, name).missing
    assert (missing.resource, missing.use.links, missing.use.place.line) == (name, ("l0",), 4)
    assert reason in missing.reason


def test_files_of_a_folder_that_a_diagnostic_is_about_are_not_named_again(tmp_path: Path):
    meshes = [f"gone/{n}.stl" for n in range(9)]
    files_of(tmp_path, *meshes, "http://example.com/a.stl")
    compilation = compile_file(tmp_path / "r.robot.yaml")
    missing = collect_files(compilation.result()).missing
    assert len(compilation.diagnostics) == 1
    assert [one.resource for one in not_reported(missing, compilation.diagnostics)] == ["http://example.com/a.stl"]
    assert not_reported(missing, ()) == missing
