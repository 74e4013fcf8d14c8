"""A format is one object in `formats.FORMATS`: commands, the compiler and source maps learn of it from that."""

import json
from pathlib import Path

import pytest

from linkforge_compile import formats
from linkforge_compile.cli.main import main
from linkforge_compile.diagnostics import Code, Severity
from linkforge_compile.formats import Document, Format, Option
from linkforge_compile.formats.source_map import Segment, SourceMap
from linkforge_compile.source.provenance import Kind, Provenance

SPEC = """\
linkforge: 1
name: arm
links:
  base:
  rod:
joints:
  elbow: {type: fixed, parent: base, child: rod}
"""

LONG_NAME = Code("LF7999", Severity.WARNING, "'{name}' is longer than {length} characters")


class Joints(Format):
    """The joints of a robot, one a line, as text."""

    name = "joints"
    suffix = ".joints"
    description = "the names of the joints"
    keeps = "the names of the joints"
    loses = "all else"
    options = (Option("case", ("lower", "upper"), "lower", "the case of the names"),)

    def render(self, robot, rendering):
        case = getattr(str, self.options[0].value(rendering.options))
        text = "".join(f"{case(joint.name)}\n" for joint in robot.joints)
        places = [Provenance(Kind.WRITTEN, joint.source.span) for joint in robot.joints]
        source_map = SourceMap(tuple((Segment(1, place),) for place in places))
        return (Document(text, map=source_map if rendering.has_map else None),)

    def limits(self, robot, options):
        for joint in robot.joints:
            yield LONG_NAME.at(joint.source, name=joint.name, length=4)


class Folder(Format):
    """Two files for a robot with joints."""

    name = "folder"
    suffix = "_config"
    files = ("config/joints.txt", "links.txt")
    description = "a folder of files"
    keeps = "nothing"
    loses = "everything"

    def render(self, robot, rendering):
        return tuple(Document(f"{name}\n", name) for name in self.files)


@pytest.fixture(autouse=True)
def spec(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(formats, "FORMATS", (*formats.FORMATS, Joints(), Folder()))
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
    assert "{urdf,srdf,mjcf,sdf,joints,folder}" in words
    assert "joints: the names of the joints" in words
    assert "a file that ends in .urdf, .srdf, .mjcf, .sdf, .joints or .xml" in words
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
    assert main(["compile", "arm.robot.yaml", "-o", "a.joints"]) == 0
    assert "arm.robot.yaml:7:3: warning: 'elbow' is longer than 4 characters [LF7999]" in capsys.readouterr().err


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
    assert (config / "config" / "joints.txt").read_text() == "config/joints.txt\n"
    capsys.readouterr()
    assert main(["compile", *arguments, "--check"]) == 0
    (config / "links.txt").write_text("other\n")
    assert main(["compile", *arguments, "--check"]) == 1
    assert main(["compile", "arm.robot.yaml", "--format", "folder"]) == 2
    assert "folder is 2 files, and standard output takes one" in capsys.readouterr().err
