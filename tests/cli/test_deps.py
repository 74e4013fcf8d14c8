"""`linkforge deps` and `compile --depfile`: what a robot is made from, as Make itself reads it."""

import json
import os
import subprocess
from pathlib import Path

import pytest

from linkforge_compile import compile_file
from linkforge_compile.cli.main import main
from linkforge_compile.cli.output import refuse_to_replace
from linkforge_compile.cli.targets import name_of
from linkforge_compile.resources import templates_folder
from tests.meshes import block, save
from tests.programs import program

ROBOT = """\
linkforge: 1
name: cell
include: [colours.yaml]
data: {table: table.yaml}
links:
  base: {visual: {box: [$(table.width), 1, 1], material: red}}
  die: {visual: {mesh: die.stl}, inertial: {mass: 1}}
joints: {glue: {type: fixed, parent: base, child: die}}
modules:
  arm: {use: arm.robot.yaml, parent: base}
  tool: {use: tool.urdf, srdf: tool.srdf, parent: base}
"""

FILES = {
    "cell.robot.yaml": ROBOT,
    "colours.yaml": "linkforge: 1\nmaterials: {red: {color: [1, 0, 0, 1]}}\n",
    "table.yaml": "width: 2\n",
    "arm.robot.yaml": "linkforge: 1\nname: arm\nlinks: {hand: }\n",
    "tool.urdf": '<robot name="tool"><link name="grip"/></robot>',
    "tool.srdf": '<robot name="tool"><group name="all"><link name="grip"/></group></robot>',
}


@pytest.fixture
def cell(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The working folder, with a robot that is made from seven files, and another file."""
    monkeypatch.chdir(tmp_path)
    for name, text in FILES.items():
        (tmp_path / name).write_text(text)
    save(block(1, 1, 1), tmp_path / "die.stl")
    (tmp_path / "other.yaml").write_text("width: 3\n")
    return tmp_path


def listed(capfd: pytest.CaptureFixture[str], *words: str) -> dict[str, list[str]]:
    capfd.readouterr()
    main(["deps", "--format", "json", *words])
    found: dict[str, list[str]] = json.loads(capfd.readouterr().out)
    return found


def test_every_file_that_a_robot_is_made_from_is_listed_and_no_other(cell: Path, capfd: pytest.CaptureFixture[str]):
    found = listed(capfd, "cell.robot.yaml")
    assert found["files"][0] == "cell.robot.yaml"
    assert set(found["files"]) == {*FILES, "die.stl"}
    assert found["unread"] == []
    names = {Path(path).name for path in found["linkforge"]}
    assert {"robot.xml.j2", "link.xml.j2", "_version.py"} <= names
    assert "CMakeLists.txt.j2" not in names, "that is of init"
    assert all(Path(path).is_file() for path in found["linkforge"])


@pytest.mark.parametrize(
    ("words", "folders"),
    [
        ((), {"urdf"}),
        (("--for", "mjcf"), {"mjcf"}),
        (("-o", "cell.sdf"), {"sdf", "urdf"}),
        (("--for", "moveit"), {"moveit", "urdf", "srdf", "joint_limits", "ros2_controllers"}),
        (("--for", "srdf", "--for", "joint_limits"), {"srdf", "joint_limits"}),
    ],
)
def test_linkforges_own_templates_are_those_of_the_formats(
    cell: Path, capfd: pytest.CaptureFixture[str], words: tuple[str, ...], folders: set[str]
):
    templates = (Path(path) for path in listed(capfd, "cell.robot.yaml", *words)["linkforge"])
    found = {path.relative_to(templates_folder()).parts[0] for path in templates if path.suffix == ".j2"}
    assert found == folders


def test_a_depfile_names_the_templates_of_its_outputs(cell: Path, capfd: pytest.CaptureFixture[str]):
    assert main(["compile", "cell.robot.yaml", "-o", "cell.mjcf", "--depfile", "-"]) == 0
    rule = capfd.readouterr().out
    assert "mjcf/body.xml.j2" in rule
    assert "urdf/link.xml.j2" not in rule


@pytest.mark.parametrize("name", [name for name in FILES if name != "cell.robot.yaml"] + ["die.stl"])
def test_a_file_that_is_missed_is_listed_as_such(cell: Path, capfd: pytest.CaptureFixture[str], name: str):
    (cell / name).unlink()
    found = listed(capfd, "cell.robot.yaml")
    assert found["unread"] == [name]
    assert name not in found["files"]


def test_a_spec_with_errors_has_no_rule(cell: Path, capfd: pytest.CaptureFixture[str]):
    (cell / "table.yaml").unlink()
    assert main(["deps", "cell.robot.yaml"]) == 1
    printed = capfd.readouterr()
    assert printed.out == ""
    assert "table.yaml" in printed.err


def rule(capfd: pytest.CaptureFixture[str], *words: str) -> str:
    capfd.readouterr()
    assert main(["deps", *words]) == 0
    return capfd.readouterr().out.partition(":")[0]


def test_a_rule_names_the_given_outputs(cell: Path, capfd: pytest.CaptureFixture[str]):
    assert rule(capfd, "cell.robot.yaml") == "cell.urdf"
    assert rule(capfd, "cell.robot.yaml", "-o", "b/a.urdf", "-o", "b/a.srdf") == "b/a.urdf b/a.srdf"
    assert rule(capfd, "cell.robot.yaml", "-o", "b/") == "b/cell.urdf b/cell.srdf"
    assert rule(capfd, "arm.robot.yaml", "-o", "b/") == "b/arm.urdf", "it has nothing for an SRDF"


class Makefile:
    """A makefile that compiles one robot, and Make that runs it."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._make = program("make")
        (folder / "Makefile").write_text("robot.urdf:\n\t@echo compiling\n\t@touch $@\n-include robot.d\n")

    def compiles(self) -> bool:
        run = subprocess.run([self._make], cwd=self._folder, capture_output=True, text=True, check=False, timeout=60)
        assert run.returncode == 0, run.stderr
        return "compiling" in run.stdout


def aged(path: Path, seconds: float) -> None:
    """Let a file be older than all that is written in this test, or newer where that is negative."""
    now = path.stat().st_ctime
    os.utime(path, (now - seconds, now - seconds))


def test_make_builds_again_when_a_file_changes_and_else_not(cell: Path):
    for path in cell.iterdir():
        aged(path, 100)
    assert main(["compile", "cell.robot.yaml", "-o", "robot.urdf", "--depfile", "robot.d"]) == 0
    makefile = Makefile(cell)
    assert not makefile.compiles()
    aged(cell / "other.yaml", -100)
    assert not makefile.compiles()
    for name in (*FILES, "die.stl"):
        aged(cell / name, -100)
        assert makefile.compiles(), name
        aged(cell / name, 100)
        assert not makefile.compiles()


def test_a_file_that_is_gone_stops_no_make(cell: Path):
    assert main(["compile", "cell.robot.yaml", "-o", "robot.urdf", "--depfile", "robot.d"]) == 0
    makefile = Makefile(cell)
    for name in (*FILES, "die.stl"):
        (cell / name).unlink()
    assert makefile.compiles()
    _, *empty = (cell / "robot.d").read_text().replace("\\\n", "").splitlines()
    assert "arm.robot.yaml: " in empty
    assert all(line.endswith(": ") for line in empty), "CMake 3.20 would read 'arm.robot.yaml:' as a name"


@pytest.mark.parametrize("name", ["a b.yaml", "a#b.yaml", "a$b.yaml", "a:b.yaml", "a%b.yaml", "a'b.yaml", "ä.yaml"])
def test_make_reads_names_with_what_means_something_to_it(cell: Path, name: str):
    (cell / name).write_text("width: 2\n")
    (cell / "cell.robot.yaml").write_text(ROBOT.replace("table.yaml", f'"{name}"'))
    for path in cell.iterdir():
        aged(path, 100)
    assert main(["compile", "cell.robot.yaml", "-o", "robot.urdf", "--depfile", "robot.d"]) == 0
    makefile = Makefile(cell)
    assert not makefile.compiles()
    aged(cell / name, -100)
    assert makefile.compiles()
    (cell / name).unlink()
    assert "%" in name or makefile.compiles()


def test_a_name_that_no_makefile_can_hold_is_reported(cell: Path, capfd: pytest.CaptureFixture[str]):
    (cell / "a;b.yaml").write_text("width: 2\n")
    (cell / "cell.robot.yaml").write_text(ROBOT.replace("table.yaml", "a;b.yaml"))
    assert main(["compile", "cell.robot.yaml", "-o", "robot.urdf", "--depfile", "robot.d"]) == 2
    assert "a depfile cannot contain 'a;b.yaml', because it has ';' in it; rename it" in capfd.readouterr().err


@pytest.mark.parametrize("mark", ["=", "%"])
def test_an_output_name_that_make_or_ninja_cannot_read_is_reported(
    cell: Path, capfd: pytest.CaptureFixture[str], mark: str
):
    assert main(["compile", "cell.robot.yaml", "-o", f"reach{mark}2.urdf", "--depfile", "robot.d"]) == 2
    assert f"a depfile cannot contain 'reach{mark}2.urdf', because it has {mark!r} in it" in capfd.readouterr().err


@pytest.mark.parametrize("name", ["a b.urdf", "a#b.urdf", "a$b.urdf", "a:b.urdf", "a'b.urdf", "ä.urdf"])
def test_make_reads_outputs_with_what_means_something_to_it(cell: Path, name: str):
    for path in cell.iterdir():
        aged(path, 100)
    assert main(["compile", "cell.robot.yaml", "-o", name, "--depfile", "robot.d"]) == 0
    (cell / "Makefile").write_text("include robot.d\n%.urdf:\n\t@touch made\n")
    question = [program("make"), "-q", name]
    assert subprocess.run(question, cwd=cell, check=False, timeout=60).returncode == 0
    aged(cell / "table.yaml", -100)
    assert subprocess.run(question, cwd=cell, check=False, timeout=60).returncode == 1


def test_a_build_with_a_depfile_prints_faults_only(cell: Path, capfd: pytest.CaptureFixture[str]):
    assert main(["compile", "cell.robot.yaml", "-o", "robot.urdf", "--depfile", "robot.d"]) == 0
    assert "".join(capfd.readouterr()) == ""


def test_a_depfile_called_by_a_dash_is_standard_output(cell: Path, capfd: pytest.CaptureFixture[str]):
    assert main(["compile", "cell.robot.yaml", "-o", "robot.urdf", "--depfile", "-"]) == 0
    assert capfd.readouterr().out.startswith("robot.urdf: \\\n  cell.robot.yaml ")
    assert not (cell / "-").exists()


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (("--depfile", "robot.d"), "--depfile lists what files are made from, so it takes -o"),
        (("-o", "robot.urdf", "--check", "--depfile", "robot.d"), "--check writes nothing"),
    ],
)
def test_a_depfile_of_nothing_is_wrong_usage(
    cell: Path, capfd: pytest.CaptureFixture[str], words: tuple[str, ...], expected: str
):
    assert main(["compile", "cell.robot.yaml", *words]) == 2
    assert expected in capfd.readouterr().err
    assert not (cell / "robot.d").exists()


def test_standard_output_is_the_target_of_no_rule(cell: Path, capfd: pytest.CaptureFixture[str]):
    assert main(["deps", "cell.robot.yaml", "-o", "-"]) == 2
    captured = capfd.readouterr()
    assert captured.out == ""
    assert "a Make rule lists what files are made from, so it takes -o with a folder or a file" in captured.err


@pytest.mark.parametrize(
    "words",
    [
        ("cell.robot.yaml", "-o", "tool.urdf"),
        ("cell.robot.yaml", "-o", "robot.urdf", "-o", "tool.srdf"),
        ("cell.robot.yaml", "-o", "robot.urdf", "--depfile", "table.yaml"),
        ("tool.urdf", "-o", "."),
    ],
)
def test_what_a_robot_is_made_from_is_not_written_over(
    cell: Path, capfd: pytest.CaptureFixture[str], words: tuple[str, ...]
):
    before = {path: path.read_bytes() for path in cell.iterdir()}
    assert main(["compile", *words]) == 2
    assert "would be replaced, and the robot is made from it; write to another place" in capfd.readouterr().err
    assert {path: path.read_bytes() for path in cell.iterdir()} == before


def test_each_file_is_resolved_once_for_all_outputs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    resolved: list[Path] = []
    resolve = os.path.realpath
    monkeypatch.setattr(os.path, "realpath", lambda path: resolved.append(path) or resolve(path))
    files, outputs = ([tmp_path / f"{number}{ending}" for number in range(4)] for ending in (".yaml", ".urdf"))
    refuse_to_replace(files, outputs)
    assert sorted(resolved) == sorted([*files, *outputs])


@pytest.mark.parametrize(
    "words",
    [
        ("-o", "out/a.urdf", "--depfile", "out/a.urdf"),
        ("-o", "out/a.urdf", "-o", "out/a.srdf", "--depfile", "out/../out/a.srdf"),
        ("-o", "out/a.urdf", "--source-map", "--depfile", "out/a.urdf.map.json"),
    ],
)
def test_one_output_does_not_replace_another(cell: Path, capfd: pytest.CaptureFixture[str], words: tuple[str, ...]):
    (cell / "cell.robot.yaml").write_text(ROBOT + "semantic: {groups: {all: {links: [base]}}}\n")
    assert main(["compile", "cell.robot.yaml", *words]) == 2
    assert "would be written twice; write each output to its own file" in capfd.readouterr().err
    assert not (cell / "out").exists()


def test_standard_output_gets_nothing_of_an_output_that_is_not_written(cell: Path, capfd: pytest.CaptureFixture[str]):
    assert main(["compile", "cell.robot.yaml", "-o", "table.yaml/sub/cell.urdf", "--depfile", "-"]) == 2
    captured = capfd.readouterr()
    assert (captured.out, "'table.yaml' is not a folder" in captured.err) == ("", True)


@pytest.mark.parametrize(
    ("words", "is_listed"),
    [(("--for", "mjcf"), True), (("--for", "sdf"), False), (("--for", "urdf"), False), (("-o", "a.mjcf"), True)],
)
def test_an_mjcf_depends_on_its_meshes(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capfd: pytest.CaptureFixture[str],
    words: tuple[str, ...],
    is_listed: bool,
):
    """It leaves out those that are missing."""
    monkeypatch.chdir(tmp_path)
    shapes = "{visual: {mesh: here.stl}, collision: {mesh: gone.stl}}"
    (tmp_path / "arm.robot.yaml").write_text(f"linkforge: 1\nname: arm\nlinks: {{base: {shapes}}}\n")
    (tmp_path / "here.stl").write_bytes(bytes(80) + (2).to_bytes(4, "little") + bytes(100))
    assert main(["deps", "arm.robot.yaml", "--format", "json", *words]) == 0
    found = json.loads(capfd.readouterr().out)
    assert (str(tmp_path / "here.stl") in found["files"]) == is_listed
    assert (str(tmp_path / "gone.stl") in found["unread"]) == is_listed


TEXTURED = """\
linkforge: 1
name: arm
materials: {rust: {texture: package://arm/rust.png}, moss: {texture: moss.png}, ice: {texture: package://far/ice.png}}
links:
  base:
    visual:
      - {mesh: package://arm/base.stl, material: rust}
      - {box: [1, 1, 1], material: moss}
      - {box: [1, 1, 1], material: ice}
"""


@pytest.mark.parametrize("is_file", [True, False])
def test_an_sdf_with_files_depends_on_its_meshes_and_textures(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str], is_file: bool
):
    """What a missing package would contain could be anywhere, and an SDF with `model://` is the same without files."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "package.xml").write_text("<package><name>arm</name></package>")
    (tmp_path / "arm.robot.yaml").write_text(TEXTURED)
    (tmp_path / "rust.png").write_bytes(b"")
    compilation = compile_file("arm.robot.yaml", formats=("sdf",), options={"meshes": "file"} if is_file else {})
    assert list(compilation.files[1:]) == ([tmp_path / "rust.png"] if is_file else [])
    assert list(compilation.unread) == ([tmp_path / "base.stl", tmp_path / "moss.png"] if is_file else [])
    assert main(["compile", "arm.robot.yaml", "-o", "arm.sdf", "--meshes", "file", "--depfile", "-"]) == 0
    assert "rust.png" in capfd.readouterr().out


def test_folders_of_an_output_that_is_not_written_are_not_left(cell: Path):
    assert main(["compile", "cell.robot.yaml", "-o", "new/sub/", "--depfile", "table.yaml/cell.d"]) == 2
    assert not (cell / "new").exists()


@pytest.mark.parametrize(
    "name", ["cell.robot.yaml", "cell.yaml", "cell.yml", "cell.urdf", "cell.urdf.xacro", "cell.xacro"]
)
def test_files_are_named_after_the_spec(name: str):
    assert name_of(f"robots/{name}") == "cell"


def test_options_of_a_format_decide_about_its_files(cell: Path, capfd: pytest.CaptureFixture[str]):
    """An SDF depends on its meshes if it refers to them as files."""
    (cell / "disc.robot.yaml").write_text("linkforge: 1\nname: disc\nlinks: {disc: {visual: {mesh: die.stl}}}\n")
    die = str(cell / "die.stl")
    assert die in listed(capfd, "disc.robot.yaml", "--for", "sdf", "--meshes", "file")["files"]
    assert die not in listed(capfd, "disc.robot.yaml", "--for", "sdf")["files"]
    assert main(["deps", "disc.robot.yaml", "--meshes", "file"]) == 2
    assert "--meshes is an option of sdf, found urdf; add --for sdf" in capfd.readouterr().err
