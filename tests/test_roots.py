"""What a spec may make the compiler read: its package or repository, what its user named, and what is installed."""

import errno
import os
from collections.abc import Callable
from pathlib import Path

import pytest

from linkforge_compile import Compilation, check_file, compile_file, compile_text, import_urdf
from linkforge_compile.paths import find_package
from linkforge_compile.roots import ANYWHERE, Roots

PART = "linkforge: 1\nname: part\nlinks: {tip: }\n"
REFUSED = ["LF3401"]


def written(path: Path, text: str = PART) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, "utf-8")
    return path


def using(path: Path, file: str, more: str = "") -> Path:
    return written(
        path, f"linkforge: 1\nname: cell\nlinks: {{base: }}\nmodules: {{m: {{use: '{file}', parent: base}}}}\n{more}"
    )


def codes(compilation: Compilation) -> list[str]:
    return [diagnostic.code.id for diagnostic in compilation.diagnostics]


@pytest.fixture(autouse=True)
def nothing_installed(monkeypatch: pytest.MonkeyPatch) -> None:
    for variable in ("AMENT_PREFIX_PATH", "ROS_PACKAGE_PATH"):
        monkeypatch.delenv(variable, raising=False)


@pytest.mark.parametrize("marker", ["package.xml", ".git"])
def test_a_spec_reads_in_the_nearest_package_or_repository_above_it(marker: str, tmp_path: Path):
    written(tmp_path / "parts" / "part.robot.yaml")
    spec = using(tmp_path / "cells" / "one" / "cell.robot.yaml", "../../parts/part.robot.yaml")
    assert codes(compile_file(spec)) == REFUSED
    written(tmp_path / marker, "")
    assert codes(compile_file(spec)) == []
    written(tmp_path / "cells" / "package.xml", "")
    assert codes(compile_file(spec)) == REFUSED


def test_a_path_that_climbs_out_of_a_package_does_not_lie_in_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """Compiling an untrusted robot by `../..` from a package does not open that package to it."""
    written(tmp_path / "mine" / "package.xml", "<package><name>mine</name></package>")
    mine = written(tmp_path / "mine" / "part.robot.yaml")
    work = tmp_path / "mine" / "work"
    work.mkdir()
    using(tmp_path / "evil" / "cell.robot.yaml", str(mine))
    monkeypatch.chdir(work)
    assert codes(compile_file("../../evil/cell.robot.yaml")) == REFUSED
    using(tmp_path / "evil" / "cell.robot.yaml", "package://mine/part.robot.yaml")
    assert codes(compile_file("../../evil/cell.robot.yaml")) == ["LF3005"]


def test_a_path_that_climbs_out_of_a_link_does_not_lie_above_the_link(tmp_path: Path):
    written(tmp_path / "mine" / "package.xml", "")
    mine = written(tmp_path / "mine" / "part.robot.yaml")
    (tmp_path / "evil" / "deep").mkdir(parents=True)
    (tmp_path / "mine" / "link").symlink_to(tmp_path / "evil" / "deep")
    using(tmp_path / "evil" / "cell.robot.yaml", str(mine))
    assert codes(compile_file(tmp_path / "mine" / "link" / ".." / "cell.robot.yaml")) == REFUSED


def test_a_refused_path_is_shown_with_its_target_and_readable_folders(tmp_path: Path):
    spec = using(tmp_path / "cell" / "cell.robot.yaml", "../part.robot.yaml")
    [diagnostic] = compile_file(spec).diagnostics
    assert (diagnostic.span.line, diagnostic.span.column) == (4, 20)
    assert [note.message for note in diagnostic.notes] == [
        f"it leads to {os.path.realpath(tmp_path)}{os.sep}part.robot.yaml",
        f"files may be read only in {os.path.realpath(tmp_path)}{os.sep}cell",
    ]


@pytest.mark.parametrize(
    ("file", "expected"),
    [
        ("../self/part.robot.yaml", "it leads to TMP/self/part.robot.yaml"),
        ("TMP/self/part.robot.yaml", "it leads to TMP/self/part.robot.yaml"),
        ("link/part.robot.yaml", "the link 'TMP/cell/link' leads out"),
        ("link/../part.robot.yaml", "the link 'TMP/cell/link' leads out"),
        ("within/../../part.robot.yaml", "it leads out by '..'"),
        ("within/../link/part.robot.yaml", "the link 'TMP/cell/within/../link' leads out"),
        ("within/link/part.robot.yaml", "the link 'TMP/cell/within/link' leads out"),
        ("exe.robot.yaml", "the link 'TMP/cell/exe.robot.yaml' leads out"),
    ],
)
def test_what_is_refused_tells_of_no_link_where_it_leads(file: str, expected: str, tmp_path: Path):
    """`/proc/self/exe` would tell a stranger of a server's folders, be it his link or one outside of his."""
    cell = tmp_path / "cell"
    for folder in (tmp_path / "secret", cell / "deep"):
        folder.mkdir(parents=True)
    for link, target in (
        (tmp_path / "self", tmp_path / "secret"),
        (cell / "link", tmp_path / "self"),
        (cell / "deep" / "link", tmp_path / "secret"),
        (cell / "within", cell / "deep"),
        (cell / "exe.robot.yaml", Path("/proc/self/exe")),
    ):
        link.symlink_to(target)
    [diagnostic] = compile_file(using(cell / "cell.robot.yaml", file.replace("TMP", str(tmp_path)))).diagnostics
    assert diagnostic.code.id == "LF3401"
    assert diagnostic.notes[0].message == expected.replace("TMP", str(tmp_path)).replace("/", os.sep)
    assert not any("secret" in note.message or "python" in note.message for note in diagnostic.notes)


@pytest.fixture
def closed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder that cannot be read, not even by root, who runs tests in containers."""
    folder = tmp_path / "closed"

    def refusing(look: Callable[..., object]) -> Callable[..., object]:
        def looked(path: object, *more: object, **options: object) -> object:
            if isinstance(path, str | Path) and Path(path).is_relative_to(folder):
                raise PermissionError(errno.EACCES, "Permission denied", str(path))
            return look(path, *more, **options)

        return looked

    for module, name in ((os.path, "realpath"), (os, "stat"), (os, "lstat")):
        monkeypatch.setattr(module, name, refusing(getattr(module, name)))
    return folder


MESH = "{visual: {mesh: 'CLOSED/x.stl'}}"


@pytest.mark.parametrize(
    ("section", "code"),
    [
        ("data: {d: 'CLOSED/d.yaml'}\nlinks: {base: }", "LF3401"),
        ("include: ['CLOSED/x.robot.yaml']\nlinks: {base: }", "LF3401"),
        ("links: {base: }\nmodules: {m: {use: 'CLOSED/x.robot.yaml', parent: base}}", "LF3401"),
        ("links: {base: }\nmodules: {m: {use: 'CLOSED/x.urdf', parent: base}}", "LF3401"),
        ("links: {base: }\nmodules: {m: {use: 'CLOSED/x.xacro', parent: base}}", "LF3401"),
        (f"links: {{base: {MESH}}}", "LF3402"),
        ("links: {base: {collision: {mesh: 'CLOSED/x.stl'}, inertial: {mass: 1}}}", "LF3401"),
    ],
)
@pytest.mark.parametrize("allow_outside", [False, True])
def test_what_may_not_be_read_is_reported_at_its_place(section: str, code: str, allow_outside: bool, closed: Path):
    """The rest is reported as usual."""
    text = f"linkforge: 1\nname: cell\nbogus: 1\n{section}\n".replace("CLOSED", str(closed))
    spec = written(closed.parent / "cell" / "cell.robot.yaml", text)
    diagnostics = check_file(spec, allow_outside=allow_outside).diagnostics
    assert "LF2101" in {one.code.id for one in diagnostics}
    [refused] = [one for one in diagnostics if one.code.id != "LF2101"]
    assert refused.span is not None
    assert refused.span.line >= 4
    assert allow_outside or refused.code.id == code


def test_what_is_refused_is_not_looked_for(tmp_path: Path):
    """An existing file, a missing one and a folder give the same report, so a stranger learns nothing of them."""
    written(tmp_path / "part.robot.yaml")
    (tmp_path / "folder.robot.yaml").mkdir()
    for name in ("part", "folder", "missing"):
        spec = using(tmp_path / "cell" / "cell.robot.yaml", f"../{name}.robot.yaml")
        assert codes(check_file(spec)) == REFUSED


def test_a_spec_in_an_unsearchable_folder_is_reported(closed: Path):
    """And no `package.xml` next to it."""
    [unreadable] = check_file(closed / "arm.robot.yaml").diagnostics
    assert str(unreadable).endswith(f"'{closed}/arm.robot.yaml' cannot be read: permission denied [LF3002]")


def through_a_link_to_a_file(folder: Path) -> str:
    (folder / "cell" / "link.robot.yaml").symlink_to(folder / "part.robot.yaml")
    return "link.robot.yaml"


def through_a_link_to_a_folder(folder: Path) -> str:
    (folder / "cell" / "link").symlink_to(folder)
    return "link/part.robot.yaml"


def back_through_a_link(folder: Path) -> str:
    """`..` after a link is the folder above the link's target."""
    (folder / "elsewhere").mkdir()
    (folder / "cell" / "link").symlink_to(folder / "elsewhere")
    return "link/../part.robot.yaml"


def through_a_package_of_its_own(folder: Path) -> str:
    using(folder / "cell" / "cell.robot.yaml", "package://parts/part.robot.yaml", "packages: {parts: ..}\n")
    return "package://parts/part.robot.yaml"


def out_of_its_own_package(folder: Path) -> str:
    written(folder / "cell" / "package.xml", "<package><name>cell</name></package>")
    return "package://cell/../part.robot.yaml"


WAYS = (
    through_a_link_to_a_file,
    through_a_link_to_a_folder,
    back_through_a_link,
    through_a_package_of_its_own,
    out_of_its_own_package,
)


@pytest.mark.parametrize("way", WAYS, ids=lambda way: way.__name__)
def test_no_way_leads_out(way: Callable[[Path], str], tmp_path: Path):
    written(tmp_path / "part.robot.yaml")
    (tmp_path / "cell").mkdir()
    file = way(tmp_path)
    packages = "packages: {parts: ..}\n" if file.startswith("package://parts") else ""
    spec = using(tmp_path / "cell" / "cell.robot.yaml", file, packages)
    assert codes(compile_file(spec)) == REFUSED
    assert codes(compile_file(spec, allow_outside=True)) == []


SECRET = "<package><name>secret</name></package>"


@pytest.mark.parametrize(
    ("link", "target"), [("x", ""), ("x", "secret"), ("x/y", "secret"), ("x/package.xml", "secret/package.xml")]
)
@pytest.mark.parametrize("allow_outside", [False, True])
def test_the_search_for_a_package_that_is_nowhere_leaves_by_no_link(
    link: str, target: str, allow_outside: bool, tmp_path: Path
):
    written(tmp_path / "far" / "away" / "secret" / "package.xml", SECRET)
    spec = using(tmp_path / "src" / "cell" / "cell.robot.yaml", "package://secret/part.robot.yaml")
    (spec.parent / link).parent.mkdir(exist_ok=True)
    (spec.parent / link).symlink_to(tmp_path / "far" / "away" / target)
    [unknown] = compile_file(spec, allow_outside=allow_outside).diagnostics
    assert unknown.code.id == "LF3005"
    assert len(unknown.notes) == allow_outside


MESH_OF_SECRET = "links: {base: {visual: {mesh: 'package://secret/part.stl'}}}\n"


@pytest.mark.parametrize(("allow_outside", "expected"), [(False, ["LF3005"]), (True, ["LF6021"])])
def test_a_manifest_that_is_a_link_out_names_no_package(allow_outside: bool, expected: list[str], tmp_path: Path):
    """Otherwise `package://` would reveal whether that file exists and what it contains."""
    written(tmp_path / "far" / "package.xml", SECRET)
    spec = using(tmp_path / "cell" / "cell.robot.yaml", "package://secret/part.robot.yaml")
    written(spec.parent / "part.robot.yaml", f"linkforge: 1\nname: part\n{MESH_OF_SECRET}")
    (spec.parent / "package.xml").symlink_to(tmp_path / "far" / "package.xml")
    assert codes(compile_file(spec, allow_outside=allow_outside)) == expected
    mesh = written(spec.parent / "mesh.robot.yaml", f"linkforge: 1\nname: mesh\n{MESH_OF_SECRET}")
    assert codes(compile_file(mesh, allow_outside=allow_outside)) == [one for one in expected if allow_outside]


@pytest.mark.parametrize("link", ["secret", "hands/secret", "hands"])
@pytest.mark.parametrize("is_there", [False, True])
def test_a_link_out_of_ros_package_path_does_not_tell_whether_a_package_is_there(
    link: str, is_there: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    if is_there:
        written(tmp_path / "far" / "secret" / "package.xml", SECRET)
    (tmp_path / "ws" / link).parent.mkdir(parents=True)
    (tmp_path / "ws" / link).symlink_to(tmp_path / "far" / ("" if link == "hands" else "secret"))
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path / "ws"))
    spec = using(tmp_path / "cell" / "cell.robot.yaml", "package://secret/part.robot.yaml")
    assert codes(compile_file(spec)) == ["LF3005"]


@pytest.mark.parametrize("name", ["..", "/etc", "*", "a/../b", ""])
def test_what_is_no_name_of_a_folder_is_no_package(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """As `$(find /etc)` in a xacro of a stranger, by which he would learn what is there."""
    written(tmp_path / "ws" / "a" / "b" / "package.xml", "<package><name>b</name></package>")
    (tmp_path / "ws" / "share").mkdir()
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path / "ws"))
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path / "ws"))
    assert find_package("b", {}, None, ANYWHERE) == tmp_path / "ws" / "a" / "b"
    assert find_package(name, {}, None, ANYWHERE) is None


@pytest.mark.parametrize("is_there", [False, True])
def test_a_marker_that_is_a_link_is_one_wherever_it_leads(is_there: bool, tmp_path: Path):
    if is_there:
        written(tmp_path / "far")
    part = written(tmp_path / "cell" / "part.robot.yaml")
    (part.parent / "package.xml").symlink_to(tmp_path / "far")
    assert codes(compile_file(using(part.parent / "in" / "cell.robot.yaml", "../part.robot.yaml"))) == []


def test_a_package_that_the_user_names_may_be_read(tmp_path: Path):
    written(tmp_path / "parts" / "part.robot.yaml")
    spec = using(tmp_path / "cell" / "cell.robot.yaml", "package://parts/part.robot.yaml")
    assert codes(compile_file(spec, packages={"parts": tmp_path / "parts"})) == []


def test_a_file_that_the_user_names_may_be_read_and_no_other(tmp_path: Path):
    written(tmp_path / "mine.yaml", "mass: 3\n")
    spec = written(
        tmp_path / "cell" / "cell.robot.yaml",
        "linkforge: 1\nname: cell\nparameters: {table: {type: file, default: ../mine.yaml}}\n"
        "data: {row: $(table)}\nlinks: {base: {inertial: {mass: $(row.mass), inertia: {ixx: 1, iyy: 1, izz: 1}}}}\n",
    )
    assert codes(compile_file(spec)) == REFUSED
    assert codes(compile_file(spec, parameters={"table": tmp_path / "mine.yaml"})) == []
    assert codes(compile_file(spec, parameters=[f"table={tmp_path / 'mine.yaml'}"])) == []
    assert codes(compile_file(spec, parameters={"table": tmp_path / "cell" / ".." / "other.yaml"})) == ["LF3001"]


def test_an_installation_may_be_read_wherever_its_links_lead(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """colcon build --symlink-install leads every file into the source tree; `..` leads out all the same."""
    written(tmp_path / "src" / "parts" / "part.robot.yaml")
    share = tmp_path / "install" / "share" / "parts"
    share.mkdir(parents=True)
    (share / "part.robot.yaml").symlink_to(tmp_path / "src" / "parts" / "part.robot.yaml")
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path / "install"))
    spec = using(tmp_path / "cell" / "cell.robot.yaml", "package://parts/part.robot.yaml")
    assert codes(compile_file(spec)) == []
    using(spec, "package://parts/../../../src/parts/part.robot.yaml")
    assert codes(compile_file(spec)) == REFUSED


def test_a_linked_spec_reads_files_next_to_the_link_and_to_itself(tmp_path: Path):
    spec = using(tmp_path / "src" / "cell.robot.yaml", "part.robot.yaml")
    written(tmp_path / "src" / "part.robot.yaml")
    installed = tmp_path / "share"
    installed.mkdir()
    for name in ("cell", "part"):
        (installed / f"{name}.robot.yaml").symlink_to(tmp_path / "src" / f"{name}.robot.yaml")
    assert codes(compile_file(installed / spec.name)) == []


def test_ros_package_path_may_be_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    written(tmp_path / "ws" / "parts" / "part.robot.yaml")
    written(tmp_path / "ws" / "parts" / "package.xml", "<package><name>parts</name></package>")
    spec = using(tmp_path / "cell" / "cell.robot.yaml", "package://parts/part.robot.yaml")
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path / "ws"))
    assert codes(compile_file(spec)) == []


@pytest.mark.parametrize("packages", ["packages: {arm: ../arm}\n", ""])
def test_a_package_next_to_that_of_the_spec_may_be_read_in_the_way_that_the_message_names(
    packages: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    for name in ("arm", "cell"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "package.xml").write_text(f"<package><name>{name}</name></package>")
    (tmp_path / "arm" / "arm.robot.yaml").write_text("linkforge: 1\nname: arm\nlinks: {tool: }\n")
    cell = tmp_path / "cell" / "cell.robot.yaml"
    use = "modules: {arm: {use: package://arm/arm.robot.yaml, parent: base}}\n"
    cell.write_text(f"linkforge: 1\nname: cell\n{packages}links: {{base: }}\n{use}")
    (refused,) = compile_file(cell).diagnostics
    if packages:
        assert refused.code.id == "LF3401"
        assert (
            "set ROS_PACKAGE_PATH to the folder that has the folder of package 'arm' in it" in refused.notes[-1].message
        )
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path))
    assert compile_file(cell).diagnostics == ()


def test_a_text_that_lies_nowhere_reads_nothing(tmp_path: Path):
    part = written(tmp_path / "part.robot.yaml")
    text = f"linkforge: 1\nname: cell\nlinks: {{base: }}\nmodules: {{m: {{use: '{part}', parent: base}}}}\n"
    assert codes(compile_text(text)) == REFUSED
    assert codes(compile_text(text, folder=tmp_path)) == []


def test_the_meshes_of_an_import_are_looked_at_within_its_roots(tmp_path: Path):
    urdf = written(
        tmp_path / "urdf" / "a.urdf",
        "<robot name='a'><link name='l'><visual><geometry><mesh filename='../empty.stl'/></geometry></visual></link>"
        "</robot>",
    )
    written(tmp_path / "empty.stl", "")
    assert import_urdf(urdf).text
    assert codes(compile_file(urdf)) == ["LF3402"]
    assert codes(compile_file(urdf, allow_outside=True)) == ["LF6022"]


def test_roots_hold_what_lies_in_them_and_not_what_begins_alike(tmp_path: Path):
    (tmp_path / "arm").mkdir()
    roots = Roots.around(tmp_path / "arm")
    assert roots.hold(tmp_path / "arm" / "a" / ".." / "b.yaml")
    assert not roots.hold(tmp_path / "arm2" / "b.yaml")
    assert not roots.hold(tmp_path / "arm" / ".." / "b.yaml")
