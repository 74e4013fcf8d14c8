import math
import struct
from pathlib import Path

import pytest

from linkforge_compile import compile_file
from linkforge_compile.checks import check, mesh_files
from linkforge_compile.checks.bounding import ScanBudget
from linkforge_compile.checks.mesh_files import MAX_SAMPLES, MeshScan, scan_mesh
from linkforge_compile.checks.shapes import MAX_SINGLE_FILES
from linkforge_compile.core import Collision, FileSystemResolver, Link, Mesh, Robot, Vector3, Visual
from linkforge_compile.diagnostics import UnresolvedNames
from tests.checks.robots import messages_of

UNSCALED = Vector3(1.0, 1.0, 1.0)


def stl(*triangles: tuple[float, ...]) -> bytes:
    """Return a binary STL of triangles of nine numbers each."""
    records = (struct.pack("<12fH", 0, 0, 0, *triangle, 0) for triangle in triangles)
    return bytes(80) + struct.pack("<I", len(triangles)) + b"".join(records)


def strip(count: int, side: float) -> bytes:
    """Return a strip of triangles along x, `side` long in all."""
    step = side / count
    return stl(*((n * step, 0, 0, (n + 1) * step, 0, 0, n * step, 0.01, 0) for n in range(count)))


@pytest.fixture
def meshes(tmp_path: Path) -> Path:
    (tmp_path / "arm" / "meshes").mkdir(parents=True)
    (tmp_path / "arm" / "package.xml").write_text("<package><name>arm</name></package>")
    return tmp_path / "arm" / "meshes"


def of(meshes: Path, *resources: str, scale: Vector3 = UNSCALED, as_collision: bool = False) -> Robot:
    shapes = [Mesh(resource, scale) for resource in resources]
    collisions = [Collision(shape) for shape in shapes] if as_collision else []
    link = Link("a", visuals=[Visual(shape) for shape in shapes], collisions=collisions)
    return Robot("r", links=[link], resource_resolver=FileSystemResolver([meshes.parents[1]]))


@pytest.mark.parametrize(
    "resource",
    [
        "package://arm/meshes/a.stl",
        "package://elsewhere/b.stl",
        "http://example.org/b.stl",
        "model://b/c.stl",
        "b.stl",
        "",
    ],
)
def test_what_is_there_or_not_to_be_found_from_here_is_fine(meshes: Path, resource: str):
    (meshes / "a.stl").write_bytes(strip(2, 0.1))
    assert messages_of(of(meshes, resource)) == []


def test_a_name_in_other_capitals_is_missing_and_offered(meshes: Path):
    (meshes / "Base.STL").write_bytes(strip(2, 0.1))
    assert messages_of(of(meshes, "package://arm/meshes/base.stl")) == [
        "LF6021 there is no mesh 'package://arm/meshes/base.stl'; did you mean 'Base.STL'?"
    ]


def test_a_resolver_that_does_not_mind_capitals_changes_nothing(meshes: Path):
    """As the file systems of Windows and macOS do not."""
    (meshes / "Base.STL").write_bytes(strip(2, 0.1))
    (meshes / "link.stl").symlink_to(meshes / "Base.STL")
    assert messages_of(of(meshes, "package://arm/meshes/link.stl", f"file://{meshes}/Base.STL")) == []


def test_all_files_of_a_folder_that_is_not_there_are_one_fault(meshes: Path):
    subject = of(meshes, *(f"package://arm/mesh/{name}.stl" for name in "abc"), as_collision=True)
    (diagnostic,) = check(subject, UnresolvedNames())
    assert diagnostic.message == "there is no mesh 'package://arm/mesh/a.stl'; did you mean 'meshes'?"
    assert [note.message for note in diagnostic.notes] == [
        f"looked for it at {meshes.parent / 'mesh'}",
        "nor 'package://arm/mesh/b.stl'",
        "nor 'package://arm/mesh/c.stl'",
    ]


@pytest.mark.parametrize("is_there", [True, False])
def test_after_a_hundred_missing_files_those_of_a_folder_are_reported_together(meshes: Path, is_there: bool):
    folder = "meshes" if is_there else "mesh"
    (meshes / "b100.STL").touch()
    subject = of(meshes, *(f"package://arm/{folder}/b{number}.stl" for number in range(131)))
    diagnostics = list(check(subject, UnresolvedNames()))
    alone, together = diagnostics[:-1], diagnostics[-1]
    assert len(alone) == (MAX_SINGLE_FILES if is_there else 0)
    names = [note.message for note in together.notes if note.message.startswith("nor ")]
    *_, rest = [note.message for note in together.notes]
    assert rest == f"and {131 - len(alone) - 1 - len(names)} more in this folder"
    assert (
        together.notes[0].message == f"looked for it at {meshes / 'b100.stl' if is_there else meshes.parent / 'mesh'}"
    )
    first, offered = ("b100", "b100.STL") if is_there else ("b0", "meshes")
    assert together.message == f"there is no mesh 'package://arm/{folder}/{first}.stl'; did you mean '{offered}'?"


def test_after_many_missing_packages_only_declared_ones_are_searched(meshes: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(mesh_files, "MAX_MISSING_PACKAGES", 2)
    found = [f"package://here{number}/a.stl" for number in range(3)]
    for number in range(3):
        (meshes / f"here{number}").mkdir()
    nowhere = [f"package://nowhere{number}/{name}.stl" for number in range(4) for name in "ab"]
    links = [
        Link(f"l{at}", visuals=[Visual(Mesh(one))]) for at, one in enumerate((*found, *nowhere, "package://p/b.stl"))
    ]
    resolver = FileSystemResolver([meshes], packages={"p": meshes})
    subject = Robot("r", links=links, resource_resolver=resolver)
    codes = [one.code.id for one in check(subject, UnresolvedNames()) if one.code.id in ("LF6021", "LF3403")]
    assert codes == ["LF6021"] * 4 + ["LF3403"]
    assert "in 2 packages that were not searched for" in next(one for one in messages_of(subject) if "LF3403" in one)


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (b"", "it is empty"),
        (b" \n", "it is empty"),
        (stl(), "it has no triangles"),
        (b"version https://git-lfs.github.com/spec/v1\n", "it is a pointer of Git LFS; run 'git lfs pull'"),
    ],
)
def test_a_file_without_a_shape_is_reported(meshes: Path, content: bytes, reason: str):
    (meshes / "a.stl").write_bytes(content)
    assert messages_of(of(meshes, "package://arm/meshes/a.stl")) == [
        f"LF6022 mesh 'package://arm/meshes/a.stl' contains no shape: {reason}"
    ]


def test_millimetres_are_reported_unless_they_are_scaled(meshes: Path):
    (meshes / "a.stl").write_bytes(strip(1000, 250.0))
    assert messages_of(of(meshes, "package://arm/meshes/a.stl", scale=Vector3(0.001, 0.001, 0.001))) == []
    (message,) = messages_of(of(meshes, "package://arm/meshes/a.stl"))
    assert message.startswith("LF6020 mesh 'package://arm/meshes/a.stl' is 2.5e+02 metres wide")


def test_a_few_triangles_from_all_over_the_file_tell_its_size(meshes: Path):
    (meshes / "a.stl").write_bytes(strip(100_000, 1.0))
    look = scan_mesh(meshes / "a.stl", ScanBudget())
    assert look.triangles == 100_000
    assert look.box is not None
    assert look.box.sides[0] > 1 - 2 / MAX_SAMPLES


@pytest.mark.parametrize(
    "content", [b"solid a", b"\0" * 200, strip(3, 1.0)[:-1], stl((math.nan,) * 9), stl((3e38, -3e38) + (0,) * 7)]
)
def test_an_invalid_binary_stl_is_not_checked(meshes: Path, content: bytes):
    (meshes / "a.stl").write_bytes(content)
    assert messages_of(of(meshes, "package://arm/meshes/a.stl"))[1:] == []


def test_a_folder_is_no_mesh(meshes: Path):
    (meshes / "a.stl").mkdir()
    assert [one[:6] for one in messages_of(of(meshes, "package://arm/meshes/a.stl"))] == ["LF6021"]


def test_collisions_as_fine_as_what_is_seen_are_reported_together(meshes: Path):
    (meshes / "fine.stl").write_bytes(strip(12_000, 1.0))
    (meshes / "coarse.stl").write_bytes(strip(100, 1.0))
    names = [f"package://arm/meshes/{name}.stl" for name in ("fine", "coarse")]
    assert messages_of(of(meshes, *names)) == []
    assert messages_of(of(meshes, *names, as_collision=True)) == [
        "LF6025 collisions of 'a' are the visual meshes, with 12,000 triangles; contacts will be slow"
    ]


def test_a_collision_that_is_turned_by_its_scale_is_fine(meshes: Path):
    turned, mirrored = Vector3(-1.0, -1.0, 1.0), Vector3(1.0, -1.0, 1.0)
    assert messages_of(of(meshes, "package://b/a.stl", scale=turned, as_collision=True)) == []
    assert messages_of(of(meshes, "package://b/a.stl", scale=mirrored)) == []
    assert [one[:6] for one in messages_of(of(meshes, "package://b/a.stl", scale=mirrored, as_collision=True))] == [
        "LF6024"
    ]


ASCII_STL = "solid a\n" + "".join(
    f"facet normal 0 0 1\nouter loop\nvertex {x} 0 0\n vertex {x + 1} 0 0\nvertex {x} -2e0 0.5\nendloop\nendfacet\n"
    for x in range(2000)
)
OBJ = "# a\no part\n" + "".join(f"v {x} -2 0.5\nv {x + 1}. 0 0 1 1 1\n" for x in range(2000)) + "vt 9 9 9\nf 1 2 3\n"


@pytest.mark.parametrize(("name", "text"), [("a.stl", ASCII_STL), ("a.STL", ASCII_STL), ("a.obj", OBJ)])
def test_a_few_pieces_of_a_mesh_of_text_tell_its_box(meshes: Path, name: str, text: str):
    (meshes / name).write_text(text)
    box = scan_mesh(meshes / name, ScanBudget()).box
    assert box is not None
    assert box.low[1:] == (-2.0, 0.0)
    assert box.high[1:] == (0.0, 0.5)
    assert box.low[0] == 0
    assert 1700 < box.high[0] <= 2000


def test_a_mesh_of_text_is_read_whole_where_it_is_short(meshes: Path):
    (meshes / "a.obj").write_text("v 1 2 3\nv 4 5 6\nv x y z\nv 1")
    assert scan_mesh(meshes / "a.obj", ScanBudget()).box == ((1, 2, 3), (4, 5, 6))


def test_each_file_is_looked_at_once(meshes: Path, monkeypatch: pytest.MonkeyPatch):
    (meshes / "a.stl").write_bytes(strip(12_000, 1.0))
    looks: list[Path] = []

    def counted(path: Path, budget: ScanBudget) -> MeshScan:
        looks.append(path)
        return scan_mesh(path, budget)

    monkeypatch.setattr(mesh_files, "scan_mesh", counted)
    subject = of(meshes, "package://arm/meshes/a.stl", "package://arm/meshes/a.stl", as_collision=True)
    assert len(messages_of(subject)) == 1
    assert len(looks) == 1


@pytest.mark.parametrize(
    ("packages", "file", "is_reported"),
    [
        ("packages: {arm_description: .}\n", "a.stl", True),
        ("packages: {arm_description: .}\n", "gone.stl", False),
        ("packages: {hand: .}\n", "a.stl", False),
        ("", "a.stl", False),
    ],
)
def test_a_misspelt_package_is_reported_where_the_declared_one_has_the_file(
    packages: str, file: str, is_reported: bool, tmp_path: Path
):
    (tmp_path / "a.stl").write_bytes(strip(2, 0.1))
    links = f"links: {{a: {{visual: {{mesh: package://arm_descripton/{file}}}, collision: visual}}}}\n"
    (tmp_path / "r.robot.yaml").write_text(f"linkforge: 1\nname: r\n{packages}{links}")
    codes = [one.code.id for one in compile_file(tmp_path / "r.robot.yaml").diagnostics]
    assert codes == ["LF6026"] * is_reported


@pytest.mark.parametrize(
    ("package", "is_reported"),
    [
        ("ur5_descripton", True),
        ("Ur5-description", True),
        ("ur5_desciprtion", True),
        ("ur3_description", False),
        ("ur10_description", False),
        ("ur5e_description", False),
        ("ur_description", False),
        ("my_ur5_description", False),
    ],
)
def test_the_package_of_another_robot_is_no_misspelling(package: str, is_reported: bool, tmp_path: Path):
    (tmp_path / "a.stl").write_bytes(strip(2, 0.1))
    links = f"links: {{a: {{visual: {{mesh: package://{package}/a.stl}}, collision: visual}}}}\n"
    (tmp_path / "r.robot.yaml").write_text(f"linkforge: 1\nname: r\npackages: {{ur5_description: .}}\n{links}")
    codes = [one.code.id for one in compile_file(tmp_path / "r.robot.yaml").diagnostics]
    assert codes == ["LF6026"] * is_reported


def test_the_package_of_the_spec_itself_is_offered_and_all_meshes_are_one_report(tmp_path: Path):
    package = tmp_path / "arm_description"
    (package / "robots").mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>arm_description</name></package>")
    names = [f"m{number}.stl" for number in range(11)]
    for name in names:
        (package / name).write_bytes(strip(2, 0.1))
    shapes = ", ".join(f"{{mesh: package://arm_descripton/{name}}}" for name in names)
    (package / "robots" / "r.robot.yaml").write_text(f"linkforge: 1\nname: r\nlinks: {{a: {{visual: [{shapes}]}}}}\n")
    (misspelt,) = compile_file(package / "robots" / "r.robot.yaml").diagnostics
    assert misspelt.message == (
        "package 'arm_descripton' of mesh 'package://arm_descripton/m0.stl' is not found; "
        "did you mean 'arm_description'?"
    )
    assert [note.message for note in misspelt.notes[-2:]] == [
        "mesh 'package://arm_descripton/m8.stl' is in it, too",
        "and 2 more",
    ]


def test_packages_of_the_command_line_come_before_those_of_spec_and_modules(tmp_path: Path):
    for name in ("given", "declared", "of_module"):
        (tmp_path / name).mkdir()
    (tmp_path / "given" / "a.stl").write_bytes(strip(2, 0.1))
    (tmp_path / "of_module" / "b.stl").write_bytes(b"")
    module = "linkforge: 1\nname: m\npackages: {p: declared, q: of_module}\nlinks: {m: {visual: {mesh: package://q/b.stl}}}\n"
    (tmp_path / "m.robot.yaml").write_text(module)
    spec = "linkforge: 1\nname: r\npackages: {p: declared}\nlinks: {a: {visual: {mesh: package://p/a.stl}}}\n"
    (tmp_path / "r.robot.yaml").write_text(spec + "modules: {one: {use: m.robot.yaml, parent: a}}\n")

    def codes(**options: dict[str, Path]) -> list[str]:
        return [one.code.id for one in compile_file(tmp_path / "r.robot.yaml", **options).diagnostics]

    assert codes() == ["LF6021", "LF6022"]
    assert codes(packages={"p": tmp_path / "given"}) == ["LF6022"]
