"""`linkforge compile`, run as a program where that may make a difference."""

import errno
import json
import os
import re
import stat
import subprocess
import sys
from errno import ENOSPC
from io import BytesIO
from pathlib import Path
from types import SimpleNamespace

import pytest
from lxml import etree

from linkforge_compile.cli import UsageError
from linkforge_compile.cli.output import write_to_stdout
from linkforge_compile.formats import FORMATS
from tests.cli.in_process import linkforge

PENDULUM = """\
linkforge: 1
name: pendulum
parameters:
  length: {type: length, default: 0.5 m}
links:
  base:
  rod: {visual: {box: [0.02, 0.02, $(length)]}, inertial: {mass: 1.5}}
joints:
  hinge: {type: continuous, parent: base, child: rod, axis: y}
"""

SEMANTIC = "semantic: {groups: {swing: {joints: [hinge]}}}\n"


def program(*words: str, cwd: Path, stdin: str = "", **env: str) -> subprocess.CompletedProcess[str]:
    """Run `linkforge` in a process of its own."""
    return subprocess.run(
        [sys.executable, "-m", "linkforge_compile", *words],
        cwd=cwd,
        input=stdin,
        capture_output=True,
        text=True,
        check=False,
        timeout=60,
        env={**os.environ, **env},
    )


@pytest.fixture
def pendulum(tmp_path: Path) -> Path:
    (tmp_path / "swing.robot.yaml").write_text(PENDULUM)
    return tmp_path


def box_height(urdf: str) -> str:
    return etree.fromstring(urdf.encode()).find(".//box").get("size").split()[2]


def test_urdf_goes_to_standard_output_and_nothing_else_does(pendulum: Path):
    run = program("compile", "swing.robot.yaml", cwd=pendulum)
    assert (run.returncode, run.stderr) == (0, "")
    robot = etree.fromstring(run.stdout.encode())
    assert robot.get("name") == "pendulum"
    assert [link.get("name") for link in robot.iter("link")] == ["base", "rod"]


def test_a_folder_gets_files_named_after_the_spec(pendulum: Path):
    (pendulum / "swing.robot.yaml").write_text(PENDULUM + SEMANTIC)
    run = linkforge("compile", "swing.robot.yaml", "-o", "build/", cwd=pendulum)
    assert (run.returncode, run.stdout) == (0, "")
    assert sorted(path.name for path in (pendulum / "build").iterdir()) == ["swing.srdf", "swing.urdf"]


def test_no_srdf_is_written_without_a_semantic_part(pendulum: Path):
    linkforge("compile", "swing.robot.yaml", "-o", "build", cwd=pendulum)
    assert [path.name for path in (pendulum / "build").iterdir()] == ["swing.urdf"]


def test_a_request_for_srdf_without_a_semantic_part_is_reported(pendulum: Path):
    run = linkforge("compile", "swing.robot.yaml", "--format", "srdf", cwd=pendulum)
    assert (run.returncode, run.stdout) == (1, "")
    assert "swing.robot.yaml:2:7: error: robot 'pendulum' has no 'semantic' part" in run.stderr
    run = linkforge("compile", "swing.robot.yaml", "--format", "srdf", "--diagnostics", "json", cwd=pendulum)
    assert [one["code"] for one in json.loads(run.stderr)["diagnostics"]] == ["LF7085"]


def test_a_request_for_the_srdf_of_a_urdf_is_reported_in_terms_of_urdf(tmp_path: Path):
    (tmp_path / "arm.urdf").write_text('<robot name="arm"><link name="base"/></robot>')
    run = linkforge("compile", "arm.urdf", "--format", "srdf", cwd=tmp_path)
    assert (run.returncode, run.stdout) == (1, "")
    assert "arm.urdf:1:14: error: a URDF has no planning groups, so there is no SRDF to write of robot" in run.stderr


@pytest.mark.parametrize("words", [("-o", "out.srdf"), ("-o", "out.xml", "--format", "srdf")])
def test_the_format_of_one_file_follows_its_name_or_the_option(pendulum: Path, words: tuple[str, ...]):
    (pendulum / "swing.robot.yaml").write_text(PENDULUM + SEMANTIC)
    assert linkforge("compile", "swing.robot.yaml", *words, cwd=pendulum).returncode == 0
    assert "<group " in (pendulum / words[1]).read_text()


@pytest.mark.parametrize("words", [("-p", "length=700 mm"), ("-p", "length:=0.7"), ("length:=0.7m",)])
def test_a_parameter_is_set_in_any_of_the_spellings(pendulum: Path, words: tuple[str, ...]):
    run = linkforge("compile", "swing.robot.yaml", *words, cwd=pendulum)
    assert box_height(run.stdout) == "0.7"


def test_the_option_gives_the_folder_of_a_package(pendulum: Path):
    (pendulum / "vendor" / "robots").mkdir(parents=True)
    (pendulum / "vendor" / "robots" / "arm.robot.yaml").write_text(PENDULUM)
    user = "linkforge: 1\nname: cell\nmodules: {arm: {use: package://vendor_arm/robots/arm.robot.yaml}}\n"
    (pendulum / "cell.robot.yaml").write_text(user)
    assert linkforge("compile", "cell.robot.yaml", cwd=pendulum).returncode == 1
    run = linkforge("compile", "cell.robot.yaml", "--package", "vendor_arm=vendor", cwd=pendulum)
    assert run.returncode == 0
    assert etree.fromstring(run.stdout.encode()).find(".//joint").get("name") == "arm_hinge"


def test_sensors_are_written_as_the_simulator_reads_them(pendulum: Path):
    spec = pendulum / "swing.robot.yaml"
    spec.write_text(PENDULUM + "sensors: {scan: {type: lidar, link: rod, frame: base}}\n")
    for words, kind, expected in (((), "gpu_lidar", ""), (("--gazebo", "classic"), "ray", "[LF7104]")):
        run = linkforge("compile", spec.name, *words, cwd=pendulum)
        assert f'<sensor name="scan" type="{kind}">' in run.stdout
        assert expected in run.stderr
        assert ("LF7104" in linkforge("check", spec.name, *words, cwd=pendulum).stderr) is bool(expected)


def test_meshes_next_to_the_spec_are_reported_if_the_urdf_goes_elsewhere(pendulum: Path):
    """LF7006."""
    (pendulum / "meshes").mkdir()
    (pendulum / "meshes" / "rod.stl").write_bytes(bytes(80) + (1).to_bytes(4, "little") + bytes(50))
    mesh = "  rod: {visual: {mesh: meshes/rod.stl}, collision: visual}\n"
    (pendulum / "rod.robot.yaml").write_text(f"linkforge: 1\nname: rod\nlinks:\n{mesh}")
    stderr = linkforge("compile", "rod.robot.yaml", "-o", "build/", cwd=pendulum).stderr
    expected = (
        "mesh path 'meshes/rod.stl' is relative to this file and cannot be found from 'build', the URDF's folder; "
        "write 'package://NAME/PATH', or the URDF into '.' [LF7006]"
    )
    assert f"rod.robot.yaml:4:24: warning: {expected}" in stderr
    assert "LF7006" not in linkforge("compile", "rod.robot.yaml", "-o", "robot.urdf", cwd=pendulum).stderr
    words = ("compile", "rod.robot.yaml", "-o", "build/", "--installed-in")
    assert "LF7006" not in linkforge(*words, ".", cwd=pendulum).stderr
    assert "cannot be found from 'urdf', the URDF's folder" in linkforge(*words, "urdf", cwd=pendulum).stderr
    stderr = linkforge("compile", "rod.robot.yaml", "-o", "build/rod.mjcf", cwd=pendulum).stderr
    assert "the MJCF's folder; write 'package://NAME/PATH', or the MJCF into '.'" in stderr
    (pendulum / "build" / "meshes").symlink_to(pendulum / "meshes")
    assert "LF7006" not in linkforge("compile", "rod.robot.yaml", "-o", "build/", cwd=pendulum).stderr


def test_relative_meshes_are_reported_where_a_format_has_them_at_its_own_folder(pendulum: Path):
    """LF7006: MoveIt's URDF is in `config`; MJCF and SDF may have the full paths of all files."""
    (pendulum / "package.xml").write_text("<package><name>rods</name></package>")
    for name in ("rod.stl", "hand.stl"):
        (pendulum / name).write_bytes(bytes(80) + (2).to_bytes(4, "little") + bytes(100))
    inertial = "inertial: {mass: 1, inertia: {ixx: 1, iyy: 1, izz: 1}}"
    spec = f"linkforge: 1\nname: rod\nlinks:\n  rod: {{visual: {{mesh: rod.stl}}, {inertial}}}\n"
    hand = f"  hand: {{visual: {{mesh: package://rods/hand.stl}}, {inertial}}}\n"
    joints = "joints: {turn: {type: continuous, parent: rod, child: hand, axis: z}}\n"
    (pendulum / "rod.robot.yaml").write_text(f"{spec}{hand}{joints}semantic: {{groups: {{arm: {{joints: [turn]}}}}}}\n")

    def reported(*words: str) -> list[str]:
        lines = linkforge("compile", "rod.robot.yaml", *words, cwd=pendulum).stderr.splitlines()
        return [line.partition("found from ")[2] for line in lines if line.endswith("[LF7006]")]

    of_moveit = "'rod_moveit_config/config', the URDF's folder; write 'package://NAME/PATH' [LF7006]"
    assert reported("-o", ".", "--format", "moveit") == [of_moveit]
    assert reported("-o", ".", "--format", "urdf", "--format", "moveit") == [of_moveit]
    of_urdf = "'build', the URDF's folder; write 'package://NAME/PATH', or the URDF into '.' [LF7006]"
    assert reported("-o", "build/") == reported("-o", "build/", "--format", "urdf", "--format", "sdf") == [of_urdf]
    assert reported("-o", "build/rod.mjcf") == []
    assert f'meshdir="{pendulum}"' in (pendulum / "build" / "rod.mjcf").read_text()
    assert reported("-o", "build/rod.sdf") == [of_urdf.replace("URDF", "SDF")]
    assert reported("-o", "build/rod.sdf", "--meshes", "file") == []


@pytest.mark.parametrize(
    ("installed", "misplaced"),
    [
        (["urdf=urdf", "sdf=sdf"], {"sdf": "SDF"}),
        (["sdf=sdf", "urdf"], {"sdf": "SDF"}),
        (["urdf=sdf", "sdf=urdf"], {"sdf": "URDF"}),
        (["sdf"], {"sdf": "URDF"}),
        ([], {"a": "URDF", "b": "SDF"}),
    ],
)
def test_each_format_is_installed_in_its_folder(pendulum: Path, installed: list[str], misplaced: dict[str, str]):
    """LF7006."""
    for folder in (pendulum, pendulum / "urdf"):
        folder.mkdir(exist_ok=True)
        (folder / "rod.stl").write_bytes(bytes(80) + (1).to_bytes(4, "little") + bytes(50))
    spec = "linkforge: 1\nname: rod\nlinks: {rod: {visual: {mesh: rod.stl}, collision: visual}}\n"
    (pendulum / "rod.robot.yaml").write_text(spec)
    options = [word for folder in installed for word in ("--installed-in", folder)]
    run = linkforge("compile", "rod.robot.yaml", "-o", "a/r.urdf", "-o", "b/r.sdf", *options, cwd=pendulum)
    found = re.findall(r"cannot be found from '(\w+)', the (\w+)'s folder", run.stderr)
    assert dict(found) == misplaced


@pytest.mark.parametrize(
    ("folder", "hint"),
    [("urfd=share", "; did you mean 'urdf'?"), ("a=b", "; there are urdf, srdf"), ("=b", "; there are urdf, srdf")],
)
def test_an_unknown_format_of_installed_in_is_refused(pendulum: Path, folder: str, hint: str):
    words = ("compile", "swing.robot.yaml", "-o", "build/", "--installed-in")
    run = linkforge(*words, folder, cwd=pendulum)
    assert run.returncode == 2
    assert f"--installed-in: there is no format '{folder.partition('=')[0]}'{hint}" in run.stderr
    assert f"write './{folder}'" in run.stderr
    assert linkforge(*words, f"./{folder}", cwd=pendulum).returncode == 0


def test_meshes_of_a_spec_on_standard_input_are_looked_for_from_the_output_folder(pendulum: Path):
    """LF7006."""
    (pendulum / "rod.stl").write_bytes(bytes(80) + (1).to_bytes(4, "little") + bytes(50))
    spec = "linkforge: 1\nname: rod\nlinks: {rod: {visual: {mesh: rod.stl}, collision: visual}}\n"
    words = ("compile", "-", "-o", "build/")
    assert "LF7006" in linkforge(*words, cwd=pendulum, stdin=spec).stderr
    assert "LF7006" not in linkforge(*words, "--installed-in", ".", cwd=pendulum, stdin=spec).stderr


def test_a_mesh_is_found_or_not_whether_or_not_the_output_folder_is_there_already(pendulum: Path):
    specs = pendulum / "specs"
    specs.mkdir()
    (pendulum / ".git").mkdir()  # a repository is read as a whole
    for folder in (pendulum, specs):
        (folder / "rod.stl").write_bytes(bytes(80) + (1).to_bytes(4, "little") + bytes(50))
    (specs / "rod.robot.yaml").write_text(
        "linkforge: 1\nname: rod\nlinks: {rod: {visual: {mesh: ../rod.stl}}, grip: {visual: {mesh: rod.stl}}}\n"
        "joints: {glue: {type: fixed, parent: rod, child: grip}}\n"
    )
    words = ("compile", "specs/rod.robot.yaml", "-o", "build/")
    first, again = (linkforge(*words, cwd=pendulum).stderr.splitlines()[:-1] for _ in range(2))
    assert "mesh path 'rod.stl' is relative to this file and cannot be found from 'build'" in "".join(first)
    assert "'../rod.stl'" not in "".join(first)
    assert again == first


def test_an_output_called_by_a_dash_is_standard_output(pendulum: Path):
    words = ("swing.robot.yaml", "-o", "-")
    for command in ("compile", "expand"):
        run = linkforge(command, *words, cwd=pendulum)
        plain = linkforge(command, words[0], cwd=pendulum)
        assert (run.returncode, run.stdout, run.stderr) == (0, plain.stdout, "")
    assert linkforge("schema", "-o", "-", cwd=pendulum).stdout == linkforge("schema", cwd=pendulum).stdout
    assert [file.name for file in pendulum.iterdir()] == ["swing.robot.yaml"]


@pytest.mark.skipif(sys.platform == "win32", reason="devices of POSIX")
@pytest.mark.parametrize("name", ["/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"])
def test_the_device_of_standard_output_is_standard_output(name: str, pendulum: Path):
    plain = linkforge("compile", "swing.robot.yaml", cwd=pendulum).stdout
    piped = program("compile", "swing.robot.yaml", "-o", name, cwd=pendulum)
    assert (piped.returncode, piped.stdout, piped.stderr) == (0, plain, "")
    command = [sys.executable, "-m", "linkforge_compile", "compile", "swing.robot.yaml", "-o", name]
    with (pendulum / "out").open("w") as file:
        file.write("before\n")
        file.flush()
        subprocess.run(command, cwd=pendulum, stdout=file, check=True, timeout=60)
    assert (pendulum / "out").read_text() == f"before\n{plain}"


@pytest.mark.skipif(sys.platform == "win32", reason="devices of POSIX")
def test_a_pipe_that_a_shell_opened_is_written(pendulum: Path):
    plain = linkforge("compile", "swing.robot.yaml", cwd=pendulum).stdout
    read, write = os.pipe()
    with os.fdopen(read) as pipe:
        command = [sys.executable, "-m", "linkforge_compile", "compile", "swing.robot.yaml", "-o", f"/dev/fd/{write}"]
        subprocess.run(command, cwd=pendulum, pass_fds=[write], check=True, timeout=60)
        os.close(write)
        assert pipe.read() == plain
    piped = program("compile", "swing.robot.yaml", "-q", "-o", "/dev/stderr", cwd=pendulum)
    assert (piped.returncode, piped.stderr) == (0, plain)


def test_standard_output_accepts_one_format(pendulum: Path):
    run = linkforge("compile", "swing.robot.yaml", "-o", "-", "-o", "arm.srdf", cwd=pendulum)
    assert (run.returncode, run.stdout) == (2, "")
    assert "-o - is standard output, which takes one format" in run.stderr


@pytest.mark.parametrize(
    "before", [b"", b"\xef\xbb\xbf", b'<?xml version="1.0" encoding="ISO-8859-1"?>\n<!-- \xe9 -->']
)
def test_a_urdf_is_one_whatever_its_name(tmp_path: Path, before: bytes):
    for name in ("arm.xml", "arm", "arm.yaml"):
        (tmp_path / name).write_bytes(before + b'<robot name="arm"><link name="base"/></robot>')
        run = linkforge("compile", name, cwd=tmp_path)
        assert (run.returncode, etree.fromstring(run.stdout.encode()).get("name"), run.stderr) == (0, "arm", "")


def test_a_urdf_comes_from_standard_input(tmp_path: Path):
    urdf = '\n<robot name="arm"><link name="base"/></robot>'
    run = linkforge("compile", "-", cwd=tmp_path, stdin=urdf)
    assert (run.returncode, etree.fromstring(run.stdout.encode()).get("name")) == (0, "arm")
    assert linkforge("check", "-", cwd=tmp_path, stdin=urdf).stderr == "checked 1 spec: no errors\n"
    wrong = linkforge(
        "check", "-", cwd=tmp_path, stdin=urdf.replace("</robot>", '<xacro:arm xmlns:xacro="x"/></robot>')
    )
    assert "<stdin>:2:38: warning: <xacro:arm> is left over from a xacro" in wrong.stderr


def test_a_merge_key_begins_no_urdf(tmp_path: Path):
    run = linkforge("check", "-", cwd=tmp_path, stdin="<<: {links: {base: }}\nlinkforge: 1\nname: arm\n")
    assert "XML" not in run.stderr


def test_a_spec_comes_from_standard_input(pendulum: Path):
    run = program("compile", "-", cwd=pendulum, stdin=PENDULUM)
    assert run.returncode == 0
    assert box_height(run.stdout) == "0.5"


def test_errors_are_reported_with_line_and_caret_and_leave_the_old_output(pendulum: Path):
    (pendulum / "swing.urdf").write_text("old")
    (pendulum / "swing.robot.yaml").write_text(PENDULUM.replace("child: rod", "child: rodd"))
    run = program("compile", "swing.robot.yaml", "-o", "swing.urdf", cwd=pendulum)
    assert run.returncode == 1
    assert (pendulum / "swing.urdf").read_text() == "old"
    lines = run.stderr.splitlines()
    assert lines[0] == "swing.robot.yaml:9:50: error: no link named 'rodd'; did you mean 'rod'? [LF4102]"
    assert lines[1].endswith("| " + PENDULUM.splitlines()[8].replace("child: rod", "child: rodd"))
    assert lines[2].index("^^^^") - lines[2].index("|") == 51


def test_an_unchanged_file_keeps_its_time_stamp(pendulum: Path):
    linkforge("compile", "swing.robot.yaml", "-o", "swing.urdf", cwd=pendulum)
    os.utime(pendulum / "swing.urdf", ns=(1, 1))
    run = linkforge("compile", "swing.robot.yaml", "-o", "swing.urdf", cwd=pendulum)
    assert (pendulum / "swing.urdf").stat().st_mtime_ns == 1
    assert "up to date" in run.stderr
    linkforge("compile", "swing.robot.yaml", "-o", "swing.urdf", "length:=0.6", cwd=pendulum)
    assert (pendulum / "swing.urdf").stat().st_mtime_ns > 1


@pytest.mark.skipif(os.name == "nt", reason="permissions as POSIX has them")
def test_a_written_file_has_the_permissions_of_any_new_file_and_keeps_those_it_had(pendulum: Path):
    (pendulum / "touched").touch()
    linkforge("compile", "swing.robot.yaml", "-o", "swing.urdf", cwd=pendulum)
    written = pendulum / "swing.urdf"
    assert stat.S_IMODE(written.stat().st_mode) == stat.S_IMODE((pendulum / "touched").stat().st_mode)
    written.chmod(0o640)
    linkforge("compile", "swing.robot.yaml", "-o", "swing.urdf", "length:=1", cwd=pendulum)
    assert stat.S_IMODE(written.stat().st_mode) == 0o640


def test_output_through_a_link_keeps_the_link(pendulum: Path):
    (pendulum / "real.urdf").write_text("old")
    (pendulum / "link.urdf").symlink_to("real.urdf")
    linkforge("compile", "swing.robot.yaml", "-o", "link.urdf", cwd=pendulum)
    assert (pendulum / "link.urdf").is_symlink()
    assert "pendulum" in (pendulum / "real.urdf").read_text()


def test_no_other_file_is_left_next_to_the_output(pendulum: Path):
    linkforge("compile", "swing.robot.yaml", "-o", "out/swing.urdf", cwd=pendulum)
    assert [path.name for path in (pendulum / "out").iterdir()] == ["swing.urdf"]


PLANNED = "linkforge: 1\nname: arm\nlinks: {base: }\nsemantic: {no_default_collision_links: [base]}\n"


@pytest.mark.parametrize(
    ("refused", "options", "count"),
    [
        ("out/arm.srdf", (), 2),
        ("out/arm.srdf.map.json", ("--source-map",), 4),
        ("out/arm.d", ("--depfile", "out/arm.d"), 3),
    ],
)
def test_of_outputs_all_are_written_or_none(refused: str, options: tuple[str, ...], count: int, tmp_path: Path):
    (tmp_path / "arm.robot.yaml").write_text(PLANNED)
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "arm.urdf").write_text("old")
    (tmp_path / refused).mkdir()
    build = ("compile", "arm.robot.yaml", "-o", "out/", *options)
    run = linkforge(*build, cwd=tmp_path)
    assert (run.returncode, run.stderr) == (2, f"linkforge compile: cannot write '{refused}': Is a directory\n")
    assert (tmp_path / "out" / "arm.urdf").read_text() == "old"
    assert {path.name for path in (tmp_path / "out").iterdir()} == {"arm.urdf", Path(refused).name}
    (tmp_path / refused).rmdir()
    assert linkforge(*build, cwd=tmp_path).returncode == 0
    assert len([*(tmp_path / "out").iterdir()]) == count


def test_a_file_that_cannot_be_replaced_is_reported_and_nothing_is_written_in_part(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    replace = Path.replace

    def refuse_srdf(path: Path, target: Path) -> Path:
        if target.suffix == ".srdf":  # as one that is mounted by itself
            raise OSError(errno.EBUSY, "busy")
        return replace(path, target)

    monkeypatch.setattr(Path, "replace", refuse_srdf)
    for name in ("robot.urdf", "robot.srdf"):
        (tmp_path / name).write_text("old")
    run = linkforge("compile", "-", "-o", "./", "--depfile", "-", cwd=tmp_path, stdin=PLANNED)
    mounted = "busy; if only this file is mounted, mount its folder instead, because files are replaced"
    assert (run.returncode, run.stdout) == (2, "")
    assert run.stderr == f"linkforge compile: cannot write 'robot.srdf': {mounted}\n"
    assert {path.name for path in tmp_path.iterdir()} == {"robot.urdf", "robot.srdf"}
    assert (tmp_path / "robot.urdf").read_text().endswith("</robot>\n")
    assert (tmp_path / "robot.srdf").read_text() == "old"


@pytest.mark.parametrize("output", ["loop.urdf", "loop.urdf/arm.urdf"])
def test_a_link_that_leads_to_itself_is_wrong_usage(output: str, pendulum: Path):
    (pendulum / "loop.urdf").symlink_to("loop.urdf")
    run = linkforge("compile", "swing.robot.yaml", "-o", output, cwd=pendulum)
    assert (run.returncode, f"'{output}'" in run.stderr) == (2, True), run.stderr
    assert (pendulum / "loop.urdf").is_symlink()


def test_output_that_cannot_be_written_is_wrong_usage(pendulum: Path):
    (pendulum / "file").touch()
    run = linkforge("compile", "swing.robot.yaml", "-o", "file/swing.urdf", cwd=pendulum)
    assert run.returncode == 2
    assert "cannot write 'file/swing.urdf': 'file' is not a folder" in run.stderr


class _Taking(BytesIO):
    """A stream without a buffer that takes seven bytes at a time, and at the end no more, as a disk that fills up."""

    def __init__(self, room: int) -> None:
        super().__init__()
        self.room = room

    def write(self, chunk: memoryview) -> int:
        if self.tell() >= self.room:
            raise OSError(ENOSPC, "No space left on device")
        return super().write(chunk[:7])


def test_standard_output_gets_everything_or_an_error_is_reported(monkeypatch: pytest.MonkeyPatch):
    text = "# 3 µm\n" * 9
    whole, short = _Taking(len(text.encode())), _Taking(40)
    monkeypatch.setattr(sys, "stdout", SimpleNamespace(buffer=whole, flush=whole.flush))
    write_to_stdout(text)
    assert whole.getvalue() == text.encode()
    monkeypatch.setattr(sys, "stdout", SimpleNamespace(buffer=short, flush=short.flush))
    with pytest.raises(UsageError, match="cannot write to standard output: No space left on device"):
        write_to_stdout(text)


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="Linux's device that is always full")
@pytest.mark.parametrize("output", ["> /dev/full", ">&-", "-o /dev/full"])
def test_standard_output_that_cannot_be_written_is_no_fault_of_ours(pendulum: Path, output: str):
    command = f"{sys.executable} -m linkforge_compile compile swing.robot.yaml {output}"
    run = subprocess.run(command, shell=True, cwd=pendulum, capture_output=True, text=True, check=False, timeout=60)
    assert run.returncode == 2
    assert "cannot write" in run.stderr


def test_a_reader_that_has_enough_is_no_fault(pendulum: Path):
    command = f"{sys.executable} -m linkforge_compile schema | head -c 10"
    run = subprocess.run(command, shell=True, cwd=pendulum, capture_output=True, text=True, check=False, timeout=60)
    assert run.stderr == ""


@pytest.mark.parametrize(("spec", "code"), [("links: 3\n", 1), ("", 0)])
def test_diagnostics_that_nothing_reads_change_no_exit_code(pendulum: Path, spec: str, code: int):
    (pendulum / "swing.robot.yaml").write_text(PENDULUM + spec)
    reads, writes = os.pipe()
    os.close(reads)
    command = [sys.executable, "-m", "linkforge_compile", "compile", "swing.robot.yaml", "-o", "build/"]
    with os.fdopen(writes, "w") as closed:
        run = subprocess.run(command, cwd=pendulum, stderr=closed, check=False, timeout=60)
    assert run.returncode == code


@pytest.mark.parametrize("output", ["swing.robot.yaml", "out.txt", "build.v2"])
def test_an_ending_that_is_no_output_is_refused_and_nothing_is_overwritten(pendulum: Path, output: str):
    run = linkforge("compile", "swing.robot.yaml", "-o", output, cwd=pendulum)
    assert run.returncode == 2
    assert f"ends in {', '.join(one.suffix for one in FORMATS if not one.files)} or .xml" in run.stderr
    assert (pendulum / "swing.robot.yaml").read_text() == PENDULUM


def test_standard_input_that_is_not_text_is_reported(pendulum: Path):
    command = f"printf '\\377\\376' | {sys.executable} -m linkforge_compile compile -"
    run = subprocess.run(command, shell=True, cwd=pendulum, capture_output=True, text=True, check=False, timeout=60)
    assert run.returncode == 2
    assert "standard input cannot be read: it is UTF-16" in run.stderr


def test_the_bytes_are_the_same_wherever_and_however_it_runs(pendulum: Path, tmp_path_factory: pytest.TempPathFactory):
    elsewhere = tmp_path_factory.mktemp("elsewhere")
    here = program("compile", "swing.robot.yaml", cwd=pendulum, PYTHONHASHSEED="1")
    there = program("compile", str(pendulum / "swing.robot.yaml"), cwd=elsewhere, PYTHONHASHSEED="2")
    assert here.stdout == there.stdout


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (("compile",), "required: SPEC"),
        (
            ("compile", "a.robot.yaml", "b.robot.yaml"),
            "-o takes one folder for the outputs of several specs, found none",
        ),
        (("compile", ""), "takes one spec, found '': is a variable of the shell empty?"),
        (("compile", "a.robot.yaml", "-o", ""), "-o takes a file or a folder, found '': is a variable of the shell"),
        (("compile", "swing.robot.yaml", "--package", "arm"), "--package takes NAME=PATH"),
        (("compile", "swing.robot.yaml", "--package", "arm=nowhere"), "there is no folder 'nowhere'"),
        (("compile", "swing.robot.yaml", "--format", "usd"), "there is no format 'usd'; there are urdf, srdf, "),
        (("compile", "swing.robot.yaml", "--format", "movit"), "there is no format 'movit'; did you mean 'moveit'?"),
        (("check", "--for", "mjfc"), "there is no format 'mjfc'; did you mean 'mjcf'?"),
        (
            ("compile", "swing.robot.yaml", "-o", ".", "--format", "urdf", "srdf"),
            "--format takes one format; repeat it for others: write '--format srdf'",
        ),
        (("check", "--for", "sdf", "mjcf"), "repeat it for others: write '--for mjcf'"),
        (("deps", "swing.robot.yaml", "--for", "sdf", "mjcf"), "write '--for mjcf'"),
        (
            ("compile", "swing.robot.yaml", "--format", "srdf", "-o", "a.urdf"),
            "--format srdf does not go into 'a.urdf'",
        ),
        (("compile", "swing.robot.yaml", "length=1"), "write '-p length=1' to set a parameter"),
        (("complie", "swing.robot.yaml"), "'complie' is not a command; did you mean 'compile'?"),
        (("--verbose",), "'--verbose' is not a command"),
        (("check", "--a\x1b]0;title\x07\n.robot.yaml"), r"unrecognized arguments: --a\x1b]0;title\x07\n.robot.yaml"),
        (
            ("compile", "swing.robot.yaml", "--gazebo", "gz", "--gazebo", "classic"),
            "argument --gazebo: may be given once, found 'gz' and 'classic'",
        ),
        (
            ("compile", "swing.robot.yaml", "-o", ".", "--base", "free"),
            "--base is an option of mjcf, found urdf and srdf; add --format mjcf, or leave it out",
        ),
        (
            ("compile", "swing.robot.yaml", "-o", "swing.sdf", "--gazebo", "classic"),
            "--gazebo is an option of urdf or moveit, found sdf; add --format urdf, or leave it out",
        ),
        (("watch", "swing.robot.yaml", "-o", "a.mjcf", "--nested"), "--nested is an option of sdf, found mjcf"),
        (
            ("check", "swing.robot.yaml", "--for", "mjcf", "--nested"),
            "--nested is an option of sdf, found mjcf; add --for sdf, or leave it out",
        ),
        (
            ("check", "swing.robot.yaml", "--base", "free"),
            "--base is an option of mjcf, found urdf and srdf; add --for",
        ),
        (("check", "--format", "json", "--diagnostics", "json"), "may be given once"),
        (("schema", "-o", "a.json", "-o", "b.json"), "argument -o/--output: may be given once"),
        (("init", "arm", "--dir", "a", "--dir", "b"), "argument --dir: may be given once, found 'a' and 'b'"),
    ],
)
def test_wrong_usage_is_reported(pendulum: Path, words: tuple[str, ...], expected: str):
    run = linkforge(*words, cwd=pendulum)
    assert run.returncode == 2
    assert expected in run.stderr


@pytest.mark.parametrize("factor", ["abc", "-1", "0", "1e300"])
def test_an_invalid_factor_of_the_limits_is_reported(pendulum: Path, factor: str, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv("LINKFORGE_LIMITS", factor)
    run = linkforge("compile", "swing.robot.yaml", cwd=pendulum)
    assert run.returncode == 2
    assert f"LINKFORGE_LIMITS takes a whole number from 1 to 999999999, found '{factor}'" in run.stderr
