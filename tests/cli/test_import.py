"""`linkforge import` on the command line."""

import shlex
import sys
from hashlib import sha256
from io import StringIO
from pathlib import Path
from threading import Event

import pytest

from linkforge_compile import Import, compile_file
from linkforge_compile.cli import reports
from linkforge_compile.cli.main import main
from tests.cli.in_process import linkforge

ARM = """<robot name="arm"><link name="base"/>{}</robot>"""


@pytest.fixture
def arm(tmp_path: Path):
    def write(inside: str = "") -> str:
        file = tmp_path / "arm.urdf"
        file.write_text(ARM.format(inside), "utf-8")
        return str(file)

    return write


def test_a_spec_comes_on_standard_output(arm, capfd: pytest.CaptureFixture[str]):
    assert main(["import", arm()]) == 0
    written, stderr = capfd.readouterr()
    assert (written.partition("\n\n")[2], stderr) == ("linkforge: 1\nname: arm\n\nlinks:\n  base: {}\n", "")


def test_a_spec_begins_with_the_command_and_the_digest_of_its_files(tmp_path: Path):
    pytest.importorskip("xacro")
    files = [tmp_path / "urdf" / name for name in ("arm two.urdf.xacro", "links.xacro")]
    files[0].parent.mkdir()
    root = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="arm">{}</robot>'
    arguments = '<xacro:arg name="size" default="1"/><xacro:include filename="links.xacro"/>'
    files[0].write_text(root.format(arguments), "utf-8")
    files[1].write_text(root.format('<link name="base"/>'), "utf-8")
    for folder, path in (("specs", "../urdf/arm two.urdf.xacro"), ("urdf", "arm two.urdf.xacro")):
        output = tmp_path / folder / "arm.robot.yaml"
        run = linkforge("import", "urdf/arm two.urdf.xacro", "size:=2 m", "-o", str(output), cwd=tmp_path)
        assert run.returncode == 0, run.stderr
        command, digest, own, rest = output.read_text("utf-8").split("\n", 3)
        assert command == f"# linkforge import '{path}' 'size:=2 m' -o arm.robot.yaml"
        whole = sha256(b"".join(file.read_bytes() for file in files)).hexdigest()
        assert digest == f"# sha256 of its files: {whole}"
        assert own == f"# sha256 of the rest: {sha256(rest[1:].encode()).hexdigest()}"
        assert rest.startswith("\nlinkforge: 1\n")


def test_the_command_in_a_spec_writes_it_again(tmp_path: Path):
    pytest.importorskip("xacro")
    for file, text in {
        "far/pk/package.xml": "<package format='3'><name>pk2</name></package>",
        "far/pk/base.xacro": '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><link name="base"/></robot>',
        "urdf/arm.urdf.xacro": '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="arm">'
        '<xacro:arg name="size" default="1"/><xacro:include filename="$(find pk2)/base.xacro"/></robot>',
        "urdf/arm.srdf": '<robot name="arm"><group name="all"><link name="base"/></group></robot>',
    }.items():
        (tmp_path / file).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / file).write_text(text, "utf-8")
    spec = tmp_path / "specs" / "arm.robot.yaml"
    given = ("urdf/arm.urdf.xacro", "--srdf", "urdf/arm.srdf", "size:=2", "--package", "pk2=far/pk", "-o", str(spec))
    run = linkforge("import", *given, cwd=tmp_path)
    assert run.returncode == 0, run.stderr
    written = spec.read_text("utf-8")
    spec.unlink()
    program, *words = shlex.split(written.splitlines()[0].removeprefix("# "))
    again = linkforge(*words, cwd=spec.parent)
    assert (program, again.returncode) == ("linkforge", 0), again.stderr
    assert spec.read_text("utf-8") == written


RAW = '<material name="empty"/>'
"""What only raw XML can represent."""


def test_a_spec_is_written_and_compiles(arm, tmp_path: Path, capfd: pytest.CaptureFixture[str]):
    spec = tmp_path / "arm.robot.yaml"
    assert main(["import", arm(), "-o", str(spec)]) == 0
    assert compile_file(spec).result().name == "arm"
    assert main(["import", arm(), "-o", str(spec)]) == 0
    assert capfd.readouterr().err.splitlines() == [f"wrote {spec}", f"{spec} is up to date"]


def test_a_loss_is_reported_and_fails_if_strict(arm, tmp_path: Path, capfd: pytest.CaptureFixture[str]):
    spec = tmp_path / "arm.robot.yaml"
    urdf = arm(f"some text{RAW}")
    assert main(["import", urdf, "-o", str(spec)]) == 0
    assert "warning: text is not allowed in <robot>; 'some text' is omitted [LF8101]" in capfd.readouterr().err
    spec.unlink()
    assert main(["import", urdf, "-o", str(spec), "--strict"]) == 1
    stderr = capfd.readouterr().err
    assert not spec.exists()
    assert "error: text is not allowed in <robot>; 'some text' is omitted [LF8101]" in stderr
    assert "warning: <material> is kept as raw XML" in stderr
    assert stderr.endswith("\nnothing written: 1 loss (LF8101)\n")


@pytest.mark.parametrize("quieter", [["-q"], ["--ignore", "LF8101"], ["--select", "LF5"]])
def test_a_loss_that_fails_strict_is_reported_even_if_ignored(
    arm, quieter: list[str], capfd: pytest.CaptureFixture[str]
):
    assert main(["import", arm("some text"), "--strict", *quieter]) == 1
    written, stderr = capfd.readouterr()
    assert written == ""
    assert "omitted [LF8101]" in stderr
    assert stderr.endswith("\nnothing written: 1 loss (LF8101)\n")


def test_strict_reports_that_nothing_is_written_if_there_are_errors(arm, capfd: pytest.CaptureFixture[str]):
    assert main(["import", arm('<link name="base"/>'), "--strict", "--werror"]) == 1
    assert capfd.readouterr().err.endswith("\nnothing written: there are errors\n")


def test_what_is_kept_raw_is_no_loss(arm, capfd: pytest.CaptureFixture[str]):
    assert main(["import", arm(RAW), "--strict"]) == 0
    assert "LF8021" in capfd.readouterr().err


def test_a_spec_that_does_not_compile_fails(arm, tmp_path: Path, capfd: pytest.CaptureFixture[str]):
    spec, red = tmp_path / "arm.robot.yaml", '<material name="red"><color rgba="{} 0 0 1"/></material>'
    urdf = arm(red.format(1) + red.format(0.5))
    assert main(["import", urdf, "-o", str(spec), "--strict"]) == 1
    assert capfd.readouterr().err.endswith("\nnothing written: there are errors\n")
    assert main(["import", urdf, "-o", str(spec)]) == 1
    assert "[LF7160]" in capfd.readouterr().err
    assert compile_file(spec).has_errors


def test_a_spec_that_lacks_what_is_raw_is_written_and_fails(arm, capfd: pytest.CaptureFixture[str]):
    joint = '<joint name="j" type="revolute"><parent link="base"/><child link="tip"/>{}<limit effort="1,5"/></joint>'
    assert main(["import", arm('<link name="tip"/>' + joint.format('<axis xyz="0 0"/>'))]) == 1
    written, stderr = capfd.readouterr()
    assert '    child: tip\n    extra: [<axis xyz="0 0"/>, "<limit effort=\\"1,5\\"/>"]\n' in written
    assert stderr.count("error: ") == stderr.count("note: this <joint> needs it") == 2
    assert "warning: " not in stderr


def test_the_version_that_a_capsule_needs_is_no_loss(arm, capfd: pytest.CaptureFixture[str]):
    capsule = '<link name="rod"><visual><geometry><capsule radius="1" length="1"/></geometry></visual></link>'
    joint = '<joint name="j" type="fixed"><parent link="base"/><child link="rod"/></joint>'
    assert main(["import", arm(capsule + joint), "--strict"]) == 0
    assert "LF8131" in capfd.readouterr().err


def test_an_error_of_a_robot_is_reported_in_the_urdf(arm, capfd: pytest.CaptureFixture[str]):
    urdf = arm('<joint name="j" type="fixed"><parent link="base"/><child link="tool"/></joint>')
    assert main(["import", urdf]) == 1
    captured = capfd.readouterr()
    assert f"{urdf}:1:101: error: no link named 'tool'" in captured.err
    assert "child: tool" in captured.out


@pytest.mark.parametrize("folder", ["new/", "new", "there"])
def test_a_folder_gets_a_spec_of_the_robots_file_name(arm, folder: str, tmp_path: Path):
    (tmp_path / "there").mkdir()
    run = linkforge("import", arm(), "-o", folder, cwd=tmp_path)
    written = Path(folder) / "arm.robot.yaml"
    assert (run.returncode, run.stderr.strip()) == (0, f"wrote {written}")
    assert (tmp_path / written).is_file()


def test_a_file_of_another_kind_is_no_spec(arm, tmp_path: Path, capfd: pytest.CaptureFixture[str]):
    assert main(["import", arm(), "-o", str(tmp_path / "arm.xml")]) == 2
    assert "-o takes a folder, or a file that ends in .yaml or .yml; found" in capfd.readouterr().err


def test_a_spec_that_was_changed_is_replaced_by_force_only(arm, tmp_path: Path, capfd: pytest.CaptureFixture[str]):
    spec = tmp_path / "arm.robot.yaml"
    spec.write_text("# mine\n")
    assert main(["import", arm(), "-o", str(tmp_path)]) == 2
    assert f"'{spec}' exists with other content; use --force to replace it" in capfd.readouterr().err
    assert spec.read_text() == "# mine\n"
    assert main(["import", arm(), "-o", str(tmp_path), "--force"]) == 0
    assert "\nlinkforge: 1\n" in spec.read_text()


def test_a_mesh_next_to_the_urdf_but_not_to_the_spec_is_reported(arm, tmp_path: Path):
    (tmp_path / "rod.stl").write_text("solid rod\nendsolid rod\n")
    rod = '<visual><geometry><mesh filename="rod.stl"/></geometry></visual>'
    urdf = arm(
        f'<joint name="j" type="fixed"><parent link="base"/><child link="rod"/></joint><link name="rod">{rod}</link>'
    )
    beside = linkforge("import", urdf, "-o", ".", cwd=tmp_path)
    assert (beside.returncode, "LF8130" in beside.stderr) == (0, False)
    away = linkforge("import", urdf, "-o", "specs", cwd=tmp_path)
    assert away.returncode == 0
    assert "mesh path 'rod.stl' is relative to the URDF and cannot be found from 'specs'" in away.stderr
    assert "or the spec into '.' [LF8130]" in away.stderr


def test_an_srdf_without_its_robot_is_refused(capfd: pytest.CaptureFixture[str]):
    assert main(["import", "arm.srdf.xacro"]) == 2
    assert "pass it with its robot: linkforge import ROBOT.urdf --srdf arm.srdf.xacro" in capfd.readouterr().err


@pytest.mark.parametrize("words", [["reach:=1"], ["-p", "reach=1"], ["-p", "reach:=1"]])
def test_nothing_is_written_for_an_argument_that_a_urdf_does_not_take(arm, words: list[str], tmp_path: Path):
    run = linkforge("import", arm(), *words, "-o", ".", cwd=tmp_path)
    assert (run.returncode, [file.name for file in tmp_path.iterdir()]) == (1, ["arm.urdf"])
    assert "error: no parameter named 'reach'" in run.stderr


def test_nothing_is_written_for_an_argument_that_a_xacro_does_not_take(tmp_path: Path):
    pytest.importorskip("xacro")
    xacro = '<robot name="arm" xmlns:xacro="http://ros.org/wiki/xacro"><xacro:arg name="length" default="1"/></robot>'
    (tmp_path / "arm.urdf.xacro").write_text(xacro.replace("</robot>", '<link name="base"/></robot>'), "utf-8")
    run = linkforge("import", "arm.urdf.xacro", "lenght:=0.7", cwd=tmp_path)
    assert (run.returncode, run.stdout) == (1, "")
    assert "error: no parameter named 'lenght'; did you mean 'length'?" in run.stderr


def test_a_urdf_comes_from_standard_input(tmp_path: Path):
    text = ARM.format("")
    run = linkforge("import", "-", "-o", ".", cwd=tmp_path, stdin=text)
    assert (run.returncode, run.stderr) == (0, "wrote robot.robot.yaml\n")
    assert compile_file(tmp_path / "robot.robot.yaml").result().name == "arm"
    refused = linkforge("import", "-", cwd=tmp_path, stdin=text.replace("base", ""))
    assert refused.stderr.startswith("<stdin>:1:")


def test_a_xacro_on_standard_input_is_refused_with_a_file_name_to_use(tmp_path: Path):
    xacro = '<robot name="arm"><xacro:include filename="x"/></robot>'
    run = linkforge("import", "-", cwd=tmp_path, stdin=xacro)
    assert (run.returncode, run.stdout) == (1, "")
    assert "expanded only in a file named 'NAME.urdf.xacro'" in run.stderr


def test_a_spec_is_named_after_an_xml_file_without_its_ending(tmp_path: Path):
    (tmp_path / "base.xml").write_text(ARM.format(""))
    assert linkforge("import", "base.xml", "-o", ".", cwd=tmp_path).stderr == "wrote base.robot.yaml\n"


def test_an_output_called_by_a_dash_is_standard_output(arm, tmp_path: Path):
    run = linkforge("import", arm(), "-o", "-", cwd=tmp_path)
    assert (run.returncode, run.stdout.split("\n")[5], run.stderr) == (0, "name: arm", "")
    assert [file.name for file in tmp_path.iterdir()] == ["arm.urdf"]


@pytest.mark.parametrize(("words", "robot"), [(["arm.urdf", "arm.srdf"], "arm.urdf"), (["arm.srdf"], "ROBOT.urdf")])
def test_an_srdf_as_a_positional_argument_is_reported_with_its_option(
    words: list[str], robot: str, capfd: pytest.CaptureFixture[str]
):
    assert main(["import", *words]) == 2
    remedy = f"pass it with its robot: linkforge import {robot} --srdf arm.srdf"
    assert f"'arm.srdf' is an SRDF; {remedy}" in capfd.readouterr().err


def test_only_an_srdf_is_offered_for_an_srdf_that_is_not_there(arm, tmp_path: Path, capfd: pytest.CaptureFixture[str]):
    urdf = arm()
    assert main(["import", urdf, "--srdf", str(tmp_path / "arm1.srdf")]) == 1
    assert "did you mean" not in capfd.readouterr().err
    (tmp_path / "arm_1.srdf").write_text('<robot name="arm"/>')
    assert main(["import", urdf, "--srdf", str(tmp_path / "arm1.srdf")]) == 1
    assert "did you mean 'arm_1.srdf'?" in capfd.readouterr().err


def test_a_spec_is_not_imported(capfd: pytest.CaptureFixture[str]):
    assert main(["import", "arm.robot.yaml"]) == 2
    assert "'arm.robot.yaml' is a spec already; import takes a URDF" in capfd.readouterr().err


def test_a_long_wait_at_a_terminal_is_explained(arm, monkeypatch: pytest.MonkeyPatch):
    class Terminal(StringIO):
        def isatty(self) -> bool:
            return True

    def slow(*_: object, **__: object) -> Import:
        is_reported.wait(5)
        return Import("linkforge: 1\n", ())

    terminal, is_reported = Terminal(), Event()
    print_status = reports.print_status
    monkeypatch.setattr(reports, "print_status", lambda *words: (print_status(*words), is_reported.set()))
    monkeypatch.setattr(reports, "PATIENCE", 0.01)
    monkeypatch.setattr(sys, "stderr", terminal)
    monkeypatch.setattr("linkforge_compile.importing.import_urdf", slow)
    urdf = arm()
    assert main(["import", urdf]) == 0
    assert terminal.getvalue() == f"still reading {urdf}; Ctrl-C ends it\n"


def test_the_robot_itself_is_never_written_over(arm, capfd: pytest.CaptureFixture[str]):
    urdf = arm()
    assert main(["import", urdf, "-o", urdf]) == 2
    assert "would be replaced" in capfd.readouterr().err


def test_a_missing_file_is_reported(tmp_path: Path, capfd: pytest.CaptureFixture[str]):
    assert main(["import", str(tmp_path / "arm.urdf")]) == 1
    assert "LF3001" in capfd.readouterr().err


def test_a_file_in_another_encoding_than_declared_is_reported(tmp_path: Path, capfd: pytest.CaptureFixture[str]):
    urdf = tmp_path / "arm.urdf"
    urdf.write_bytes(b'<?xml version="1.0" encoding="utf-8"?><robot name="\xff"/>')
    assert main(["import", str(urdf)]) == 1
    stderr = capfd.readouterr().err
    assert "line 1 has the byte 0xff, which is not utf-8; save the file as UTF-8, or declare the encoding" in stderr
    assert "arm.urdf:1:52: error" in stderr


def test_standard_input_is_no_srdf(arm, capfd: pytest.CaptureFixture[str]):
    assert main(["import", arm(), "--srdf", "-"]) == 2
    assert main(["diff", arm(), arm(), "--after-srdf", "-"]) == 2
    words = "takes a file; standard input may be the robot"
    assert capfd.readouterr().err == f"linkforge import: --srdf {words}\nlinkforge diff: --after-srdf {words}\n"


def test_a_xacro_finds_its_packages_in_the_given_folders(tmp_path: Path):
    pytest.importorskip("xacro")
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "elsewhere" / "part.xacro").write_text('<robot><link name="part"/></robot>')
    (tmp_path / "a.urdf.xacro").write_text(
        '<robot name="a" xmlns:xacro="http://www.ros.org/wiki/xacro">'
        '<xacro:include filename="$(find parts)/part.xacro"/></robot>'
    )
    run = linkforge("import", "a.urdf.xacro", "--package", "parts=elsewhere", cwd=tmp_path)
    assert (run.returncode, run.stderr) == (0, "")
    assert "part: {}" in run.stdout
