"""A format is one object in `formats.FORMATS`: commands, the compiler and source maps learn of it from that."""

import json
import re
from pathlib import Path

import pytest

from linkforge_compile import formats
from linkforge_compile.cli import INTERRUPTED, watching
from linkforge_compile.cli.main import main
from linkforge_compile.cli.watching import Watched
from linkforge_compile.formats.environment import xml_endings
from linkforge_compile.formats.format import Format, TemplateFormat
from linkforge_compile.resources import format_templates
from tests.conftest import ROOT
from tests.formats.example_formats import Folder, Joints, Limits

SPEC = """\
linkforge: 1
name: arm
links:
  base:
  rod:
joints:
  elbow: {type: fixed, parent: base, child: rod}
"""


@pytest.fixture(autouse=True)
def spec(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(formats, "FORMATS", (*formats.FORMATS, Joints(), Folder(), Limits()))
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "arm.robot.yaml"
    path.write_text(SPEC)
    return path


def test_format_names_it(capsys: pytest.CaptureFixture[str]):
    assert main(["compile", "arm.robot.yaml", "--format", "joints", "--case", "upper"]) == 0
    assert capsys.readouterr().out == "ELBOW\n"


def test_the_help_describes_it(capsys: pytest.CaptureFixture[str]):
    with pytest.raises(SystemExit):
        main(["compile", "--help"])
    words = " ".join(capsys.readouterr().out.split())
    assert f"{{{','.join(one.name for one in formats.FORMATS)}}}" in words
    assert "joints: the names of the joints" in words
    endings = [one.suffix for one in formats.FORMATS if not one.files]
    assert f"a file that ends in {', '.join(endings)} or .xml" in words
    assert "--case {lower,upper}" in words


def test_a_file_of_its_suffix_is_of_it(tmp_path: Path):
    assert main(["compile", "arm.robot.yaml", "-o", "a.joints", "-o", "a.urdf"]) == 0
    assert (tmp_path / "a.joints").read_text() == "elbow\n"
    assert (tmp_path / "a.urdf").read_text().startswith("<?xml")
    assert main(["compile", "arm.robot.yaml", "--format", "urdf", "-o", "a.joints"]) == 2


def test_a_folder_has_it_only_where_it_is_requested(tmp_path: Path):
    assert main(["compile", "arm.robot.yaml", "-o", "all/"]) == 0
    assert [path.name for path in (tmp_path / "all").iterdir()] == ["arm.urdf"]
    assert main(["compile", "arm.robot.yaml", "-o", "one/", "--format", "joints"]) == 0
    assert [path.name for path in (tmp_path / "one").iterdir()] == ["arm.joints"]


def test_its_limits_are_reported_where_it_is_requested(capsys: pytest.CaptureFixture[str]):
    for arguments in (["check", "arm.robot.yaml"], ["compile", "arm.robot.yaml"]):
        assert main(arguments) == 0
        assert "LF7999" not in capsys.readouterr().err
    assert main(["check", "arm.robot.yaml", "--for", "joints"]) == 0
    assert "LF7999" in capsys.readouterr().err
    assert main(["check", "arm.robot.yaml", "--for", "joints", "--strict"]) == 1
    assert main(["compile", "arm.robot.yaml", "-o", "a.joints"]) == 0
    assert "arm.robot.yaml:7:3: warning: 'elbow' is longer than 4 characters [LF7999]" in capsys.readouterr().err


OF_GAZEBO = """\
linkforge: 1
name: arm
links:
  base: {inertial: &body {mass: 1, inertia: {ixx: 1, iyy: 1, izz: 1}}}
  rod: {inertial: *body}
  tip:
joints:
  rod: {type: fixed, parent: base, child: rod}  # linkforge: ignore LF4108
  turn: {type: fixed, parent: rod, child: tip, gazebo: {provide_feedback: true}}
sensors:
  # linkforge: ignore LF7102
  force: {type: force_torque, link: rod}
  # linkforge: ignore LF7412
  other: {type: force_torque, link: rod}
"""


LOSSY = """\
linkforge: 1
name: arm
links:
  base:
  rod: {inertial: {mass: 1 kg, inertia: {ixx: 1, iyy: 1, izz: 1}}}
  cap: {inertial: {mass: 1 kg, inertia: {ixx: 1, iyy: 1, izz: 1}}}
joints:
  one: {type: continuous, parent: base, child: cap, axis: z, limits: {effort: 5, velocity: 3}}
  two: {type: fixed, parent: cap, child: rod}
"""


def codes(words: list[str], capsys: pytest.CaptureFixture[str]) -> set[str]:
    assert main(words) == 0
    return set(re.findall(r"\[(LF[0-9]+)\]", capsys.readouterr().err))


@pytest.mark.parametrize("words", [["check"], ["check", "--for", "urdf"], ["compile", "-o", "a.urdf"]], ids=" ".join)
def test_what_gazebo_makes_of_a_urdf_is_reported_where_one_is_written(
    words: list[str], capsys: pytest.CaptureFixture[str]
):
    Path("arm.robot.yaml").write_text(OF_GAZEBO)
    assert codes([*words, "arm.robot.yaml"], capsys) == {"LF6040", "LF7102"}


@pytest.mark.parametrize("words", [["check", "--for", "joints"], ["compile", "-o", "a.joints"]], ids=" ".join)
def test_other_formats_are_not_blamed_for_a_urdf(words: list[str], capsys: pytest.CaptureFixture[str]):
    Path("arm.robot.yaml").write_text(OF_GAZEBO)
    assert codes([*words, "arm.robot.yaml"], capsys) <= {"LF7999"}


@pytest.mark.parametrize("name", ["urdf", "sdf", "mjcf"])
def test_formats_of_xml_report_what_no_xml_holds(name: str, capsys: pytest.CaptureFixture[str]):
    Path("arm.robot.yaml").write_text(SPEC.replace("rod:\n", "rod: {extra: [<broken]}\n"))
    assert main(["compile", "arm.robot.yaml", "--format", name]) == 1
    assert "arm.robot.yaml:5:17: error: this cannot be written as XML" in capsys.readouterr().err


def test_strict_fails_on_what_it_cannot_hold_and_writes_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    words = ["compile", "arm.robot.yaml", "-o", "a.joints", "--strict"]
    assert main(words) == 1
    assert "arm.robot.yaml:7:3: error: 'elbow' is longer than 4 characters [LF7999]" in capsys.readouterr().err
    assert not (tmp_path / "a.joints").exists()
    Path("arm.robot.yaml").write_text(SPEC.replace("  elbow:", "  # linkforge: ignore LF7999\n  elbow:"))
    assert main(words) == 0
    assert (tmp_path / "a.joints").exists()


@pytest.mark.parametrize(
    "words",
    [
        ("compile", "arm.robot.yaml", "-o", "arm.mjcf"),
        ("compile", "arm.robot.yaml", "-o", "arm.mjcf", "--depfile", "arm.d"),  # as CMake calls it
        ("check", "arm.robot.yaml", "--for", "mjcf"),
    ],
)
def test_losses_of_a_format_are_counted_while_there_are_errors(
    words: tuple[str, ...], capsys: pytest.CaptureFixture[str]
):
    Path("arm.robot.yaml").write_text(LOSSY.replace("child: rod", "child: rood"))
    assert main([*words]) == 1
    report = capsys.readouterr().err
    assert "did you mean 'rod'? [LF4102]" in report
    assert "LF7411" not in report
    assert "1 warning, 1 note about output formats not shown while there are errors\n" in report
    assert main([*words, "--quiet"]) == 1
    assert "not shown" not in capsys.readouterr().err
    assert main([*words, "--strict"]) == 1
    assert "error: MuJoCo does not limit velocities" in capsys.readouterr().err
    Path("arm.robot.yaml").write_text(LOSSY)
    assert main([*words]) == 0
    report = capsys.readouterr().err
    assert "warning: MuJoCo does not limit velocities" in report
    assert "not shown" not in report


def test_errors_of_one_spec_hide_no_losses_of_another_that_is_written(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
):
    Path("good.robot.yaml").write_text(LOSSY)
    Path("bad.robot.yaml").write_text(LOSSY.replace("child: rod", "child: rood"))
    words = ("good.robot.yaml", "bad.robot.yaml")
    for command in (["compile", *words, "--format", "mjcf", "-o", "out/"], ["check", *words, "--for", "mjcf"]):
        assert main(command) == 1
        report = capsys.readouterr().err
        shown = [line.split(":")[0] for line in report.splitlines() if "MuJoCo does not limit velocities" in line]
        assert shown == ["good.robot.yaml"]
        assert "1 warning, 1 note about output formats not shown while there are errors\n" in report
    assert (tmp_path / "out" / "good.mjcf").is_file()


def test_errors_of_one_variant_hide_no_losses_of_another_that_is_written(capsys: pytest.CaptureFixture[str]):
    variants = "parameters: {end: {type: string, default: rod}}\nvariants: {ok: {end: rod}, bad: {end: rood}}\n"
    Path("arm.robot.yaml").write_text(
        LOSSY.replace("links:", f"{variants}links:").replace("child: rod", "child: $(end)")
    )
    words = ["arm.robot.yaml", "--variant", "ok", "--variant", "bad"]
    for command in (["compile", *words, "--format", "mjcf", "-o", "out/"], ["check", *words, "--for", "mjcf"]):
        assert main(command) == 1
        report = capsys.readouterr().err
        assert "warning: MuJoCo does not limit velocities" in report
        assert "not shown" not in report


def test_errors_hide_no_faults_of_controllers(capsys: pytest.CaptureFixture[str]):
    """A misspelt class is no loss of the format: it is to be mended, as the error is."""
    Path("arm.robot.yaml").write_text(
        LOSSY.replace("child: rod", "child: rood")
        + "ros2_control: {hw: {hardware_plugin: mock_components/GenericSystem, joints: {one: }}}\n"
        + "controllers: {c: {type: joint_trajectory_controller/JointTrajectoryContoller, joints: [one]}}\n"
    )
    assert main(["check", "arm.robot.yaml", "--for", "ros2_controllers"]) == 1
    report = capsys.readouterr().err
    assert "[LF7613]" in report
    assert "not shown" not in report


def test_strict_leaves_warnings_about_the_robot_as_they_are(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    Path("arm.robot.yaml").write_text(
        SPEC.replace("  base:", "  base: {inertial: {mass: 1 kg, inertia: {ixx: 1, iyy: 1, izz: 5}}}")
    )
    assert main(["compile", "arm.robot.yaml", "-o", "a.urdf", "--strict"]) == 0
    assert "warning: " in capsys.readouterr().err
    assert main(["compile", "arm.robot.yaml", "-o", "a.urdf", "--werror"]) == 1


def test_deps_depfile_and_check_know_its_files(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    assert main(["deps", "arm.robot.yaml", "-o", "a.joints"]) == 0
    rule = capsys.readouterr().out
    assert rule.startswith("a.joints: \\\n")
    assert main(["compile", "arm.robot.yaml", "-o", "a.joints", "--depfile", "a.d"]) == 0
    assert (tmp_path / "a.d").read_text() == rule
    assert main(["compile", "arm.robot.yaml", "-o", "a.joints", "--check"]) == 0
    (tmp_path / "a.joints").write_text("other\n")
    assert main(["compile", "arm.robot.yaml", "-o", "a.joints", "--check"]) == 1


def test_its_source_map_is_written(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    assert main(["compile", "arm.robot.yaml", "-o", "a.joints", "--source-map"]) == 0
    assert json.loads((tmp_path / "a.joints.map.json").read_text())["file"] == "a.joints"
    capsys.readouterr()
    assert main(["where", "a.joints:1"]) == 0
    assert "arm.robot.yaml:7:3" in capsys.readouterr().out


def test_several_files_lie_below_their_target(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    arguments = ["arm.robot.yaml", "-o", "out/", "--format", "folder"]
    assert main(["compile", *arguments]) == 0
    config = tmp_path / "out" / "arm_config"
    assert (config / "links.txt").read_text() == "links.txt\n"
    assert (config / "config" / "joints.yaml").read_text() == "joints:\nelbow: [0, 1]\n"
    capsys.readouterr()
    assert main(["compile", *arguments, "--check"]) == 0
    (config / "links.txt").write_text("other\n")
    assert main(["compile", *arguments, "--check"]) == 1
    assert main(["compile", "arm.robot.yaml", "--format", "folder"]) == 2
    assert "folder is 2 files, and standard output takes one" in capsys.readouterr().err


def test_a_suffix_may_have_an_ending_that_other_files_have(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    assert main(["compile", "arm.robot.yaml", "-o", "arm_limits.yaml"]) == 0
    assert main(["compile", "arm.robot.yaml", "-o", "out/", "--format", "limits", "--name", "left"]) == 0
    assert main(["compile", "arm.robot.yaml", "-o", "any.yaml", "--format", "limits"]) == 0
    texts = [(tmp_path / name).read_text() for name in ("arm_limits.yaml", "out/left_limits.yaml", "any.yaml")]
    assert texts == ["elbow: 0\n"] * 3
    capsys.readouterr()
    assert main(["compile", "arm.robot.yaml", "-o", "any.yaml"]) == 2
    assert "or a file that ends in .urdf, " in capsys.readouterr().err
    assert main(["compile", "arm.robot.yaml", "-o", "arm.robot.yaml", "--format", "limits"]) == 2
    assert "'arm.robot.yaml' would be replaced, and the robot is made from it" in capsys.readouterr().err


def test_a_folder_with_the_suffix_of_a_format_is_that_of_its_files(tmp_path: Path):
    for output in ("my_config", "my_config/"):
        assert main(["compile", "arm.robot.yaml", "--format", "folder", "-o", output]) == 0
    files = {path.relative_to(tmp_path).as_posix() for path in (tmp_path / "my_config").rglob("*.txt")}
    assert files == {"my_config/links.txt", "my_config/arm_config/links.txt"}


def test_outputs_have_the_name_that_is_given(tmp_path: Path):
    words = ["compile", "arm.robot.yaml", "-o", "out/", "--name", "a/left"]
    assert main([*words, "--format", "folder", "--format", "urdf"]) == 0
    files = {path.relative_to(tmp_path / "out").as_posix() for path in (tmp_path / "out").rglob("*") if path.is_file()}
    assert files == {"a/left.urdf", "a/left_config/links.txt", "a/left_config/config/joints.yaml"}


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--name", "left"], "--name is for the files in a folder, so it takes -o FOLDER/"),
        (["--name", "left", "-o", "a.urdf"], "--name is for the files in a folder, so it takes -o FOLDER/"),
        (["--name", "", "-o", "out/"], "--name takes the name of files without their ending, found ''"),
        (["--name", "../a", "-o", "out/"], "--name takes the name of files without their ending, found '../a'"),
        (["--name", "left", "-o", "out/", "arm.robot.yaml"], "--name is for the outputs of one spec, found 2 specs"),
    ],
)
def test_a_name_that_cannot_be_given_is_reported(words: list[str], message: str, capsys: pytest.CaptureFixture[str]):
    Path("b.robot.yaml").write_text(SPEC)
    assert main(["compile", "b.robot.yaml", *words]) == 2
    assert message in capsys.readouterr().err


def test_every_command_knows_the_files_of_a_format_of_several(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    words = ["arm.robot.yaml", "-o", "out/"]
    yaml_file, text = "out/arm_config/config/joints.yaml", "out/arm_config/links.txt"
    assert main(["deps", *words, "--for", "folder"]) == 0
    rule = capsys.readouterr().out
    assert rule.startswith(f"{yaml_file} {text}: \\\n  arm.robot.yaml")
    assert main(["compile", *words, "--format", "folder", "--depfile", "arm.d"]) == 0
    assert Path("arm.d").read_text() == rule
    assert main(["compile", *words, "--format", "folder", "--source-map"]) == 0
    assert sorted(path.name for path in Path("out").rglob("*") if path.is_file()) == [
        *("joints.yaml", "joints.yaml.map.json", "links.txt")
    ]
    capsys.readouterr()
    for place in (f"{yaml_file}:2", f"{yaml_file}:2:9"):
        assert main(["where", place]) == 0
        assert "arm.robot.yaml:7:3" in capsys.readouterr().out
    assert main(["where", yaml_file, "elbow"]) == 0
    assert f"{yaml_file}:2: elbow: [0, 1]\nwritten at arm.robot.yaml:7:3" in capsys.readouterr().out
    assert main(["where", yaml_file, "elbw"]) == 2
    assert "there is no 'elbw' in out/arm_config/config/joints.yaml; did you mean 'elbow'?" in capsys.readouterr().err
    assert main(["where", f"{text}:1"]) == 2
    assert "`linkforge compile SPEC.robot.yaml --source-map`" in capsys.readouterr().err
    Path(text).unlink()
    assert main(["compile", *words, "--format", "folder", "--check"]) == 1
    assert "there is no 'out/arm_config/links.txt', which 'arm.robot.yaml' compiles to" in capsys.readouterr().err


def test_deps_without_a_folder_names_the_files_here(capsys: pytest.CaptureFixture[str]):
    assert main(["deps", "arm.robot.yaml", "--for", "joints", "--for", "urdf"]) == 0
    assert capsys.readouterr().out.startswith("arm.urdf arm.joints: \\\n")


def test_watch_makes_a_file_of_several_again_that_is_gone(monkeypatch: pytest.MonkeyPatch):
    waited: list[list[str]] = []

    def wait(watched: Watched) -> tuple[tuple[Path, ...], tuple[Path, ...]]:
        outputs = watched.outputs
        waited.append([path.name for path in outputs])
        if len(waited) > 1:
            raise KeyboardInterrupt
        outputs[0].unlink()
        return (), (outputs[0],)

    monkeypatch.setattr(watching, "_wait", wait)
    assert main(["watch", "arm.robot.yaml", "-o", "out/", "--format", "folder"]) == INTERRUPTED
    assert waited == [["joints.yaml", "links.txt"]] * 2
    assert Path("out/arm_config/config/joints.yaml").exists()


def test_templates_of_documents_that_are_xml_are_those_of_formats_of_xml():
    own = [one for one in formats.FORMATS if isinstance(one, TemplateFormat)]
    assert set(xml_endings()) == {".xml.j2", *(f"{one.suffix}.j2" for one in own)}
    page = (ROOT / "docs/templates.md").read_text("utf-8")
    assert all(f"`NAME{ending}`" in page for ending in xml_endings())


@pytest.mark.parametrize("one", formats.FORMATS, ids=lambda one: one.name)
def test_the_templates_of_a_format_include_no_others(one: Format):
    for path in format_templates(one.template_folders):
        included = re.findall(r'"([a-z0-9_]+)/[^"]*"', path.read_text("utf-8"))
        assert set(included) <= set(one.template_folders), path
