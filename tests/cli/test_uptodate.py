"""`linkforge compile --check`, and the hooks of pre-commit that call it."""

from pathlib import Path

import pytest
import yaml

from linkforge_compile.cli.main import main
from tests.conftest import ROOT

SPEC = """\
linkforge: 1
name: arm
parameters: {reach: {type: length, default: 50 cm}}
links: {base: , rod: {visual: {box: [$(reach), 1, 1]}}}
joints: {turn: {type: fixed, parent: base, child: rod}}
semantic: {groups: {arm: {joints: [turn]}}}
"""


@pytest.fixture
def arm(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The working folder, with a spec and what it compiles to."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "arm.robot.yaml").write_text(SPEC)
    assert main(["compile", "arm.robot.yaml", "-o", "urdf/"]) == 0
    return tmp_path


def check(*words: str) -> int:
    return main(["compile", "arm.robot.yaml", "-o", "urdf/", "--check", *words])


def test_files_that_are_up_to_date_pass(arm: Path, capfd: pytest.CaptureFixture[str]):
    capfd.readouterr()
    assert check() == 0
    assert capfd.readouterr().err == "urdf/arm.urdf is up to date\nurdf/arm.srdf is up to date\n"


def test_many_files_that_are_up_to_date_are_counted(arm: Path, capfd: pytest.CaptureFixture[str]):
    words = ["compile", "arm.robot.yaml", "-o", ".", *(f"--format={one}" for one in ("urdf", "srdf", "sdf", "mjcf"))]
    assert main(words) == 0
    (arm / "arm.sdf").unlink()
    capfd.readouterr()
    assert main(words) == 0
    assert capfd.readouterr().err.splitlines()[-4:] == [
        *(f"{name} is up to date" for name in ("arm.urdf", "arm.srdf")),
        "wrote arm.sdf",
        "arm.mjcf is up to date",
    ]
    assert main(words) == 0
    assert capfd.readouterr().err.splitlines()[-1] == "4 files are up to date"


def test_a_changed_spec_is_reported_at_the_first_different_line(arm: Path, capfd: pytest.CaptureFixture[str]):
    before = (arm / "urdf" / "arm.urdf").read_bytes()
    line = before.decode().splitlines().index('        <box size="0.5 1 1"/>') + 1
    assert check("reach:=0.7") == 1
    stderr = capfd.readouterr().err
    assert (
        f"urdf/arm.urdf:{line}:1: error: out of date: 'arm.robot.yaml' now compiles to '<box size=\"0.7 1 1\"/>'; "
        in stderr
    )
    assert "[LF7095]" in stderr
    assert "arm.srdf:" not in stderr
    assert (arm / "urdf" / "arm.urdf").read_bytes() == before


def test_a_missing_file_is_reported_and_not_written(arm: Path, capfd: pytest.CaptureFixture[str]):
    (arm / "urdf" / "arm.srdf").unlink()
    assert check() == 1
    stderr = capfd.readouterr().err
    missed = "there is no 'urdf/arm.srdf', which 'arm.robot.yaml' compiles to; compile it again [LF7096]"
    assert f"arm.robot.yaml:1:1: error: {missed}" in stderr
    assert not (arm / "urdf" / "arm.srdf").exists()


def test_extra_lines_at_the_end_of_a_file_are_reported(arm: Path, capfd: pytest.CaptureFixture[str]):
    with (arm / "urdf" / "arm.urdf").open("a") as urdf:
        urdf.write("<!-- mine -->\n")
    assert check() == 1
    assert "out of date: 'arm.robot.yaml' now compiles to nothing;" in capfd.readouterr().err


def test_the_line_ends_of_windows_are_no_difference(arm: Path):
    urdf = arm / "urdf" / "arm.urdf"
    urdf.write_bytes(urdf.read_bytes().replace(b"\n", b"\r\n"))
    assert check() == 0


def test_a_spec_with_errors_is_reported_before_its_output(arm: Path, capfd: pytest.CaptureFixture[str]):
    (arm / "arm.robot.yaml").write_text(SPEC.replace("child: rod", "child: rood"))
    assert check() == 1
    stderr = capfd.readouterr().err
    assert "[LF4102]" in stderr
    assert "[LF7095]" not in stderr


def test_standard_output_is_nothing_to_compare_with(arm: Path, capfd: pytest.CaptureFixture[str]):
    assert main(["compile", "arm.robot.yaml", "--check"]) == 2
    assert "--check compares with files, so it takes -o" in capfd.readouterr().err


def test_each_format_may_go_into_its_own_file(arm: Path):
    words = ("compile", "arm.robot.yaml", "-o", "robots/a.urdf", "-o", "config/a.srdf")
    assert main(words) == 0
    assert (arm / "robots" / "a.urdf").read_bytes() == (arm / "urdf" / "arm.urdf").read_bytes()
    assert (arm / "config" / "a.srdf").read_bytes() == (arm / "urdf" / "arm.srdf").read_bytes()


@pytest.mark.parametrize(
    "words",
    [
        ("-o", "config/joint_limits.yaml", "-o", "config/robot.urdf"),
        ("--format", "joint_limits", "-o", "config/joint_limits.yaml", "--format", "urdf", "-o", "config/robot.urdf"),
        ("--format", "joint_limits", "--format", "urdf", "-o", "config/joint_limits.yaml", "-o", "config/robot.urdf"),
    ],
)
def test_each_format_may_go_into_a_file_of_its_bare_name(arm: Path, words: tuple[str, ...]):
    turning = "type: continuous, axis: z, limits: {effort: 1, velocity: 1}"
    (arm / "arm.robot.yaml").write_text(SPEC.replace("type: fixed", turning))
    assert main(["compile", "arm.robot.yaml", *words]) == 0
    assert '<joint name="turn" type="continuous">' in (arm / "config" / "robot.urdf").read_text()
    assert "joint_limits:" in (arm / "config" / "joint_limits.yaml").read_text()


def test_an_srdf_requested_by_its_name_is_written(arm: Path, capfd: pytest.CaptureFixture[str]):
    (arm / "arm.robot.yaml").write_text(SPEC.partition("semantic")[0])
    assert main(["compile", "arm.robot.yaml", "-o", "a.urdf", "-o", "a.srdf"]) == 1
    assert "there is no SRDF to write" in capfd.readouterr().err
    assert not (arm / "a.urdf").exists()


@pytest.mark.parametrize(
    ("outputs", "expected"),
    [
        (("a.urdf", "b.urdf"), "'a.urdf' and 'b.urdf' would be the same urdf; name one of them"),
        (("a.urdf", "build/"), "one folder; found the folder 'build/'"),
    ],
)
def test_contradictory_outputs_are_reported(
    arm: Path, capfd: pytest.CaptureFixture[str], outputs: tuple[str, str], expected: str
):
    assert main(["compile", "arm.robot.yaml", "-o", outputs[0], "-o", outputs[1]]) == 2
    assert expected in capfd.readouterr().err


def test_the_hooks_of_pre_commit_are_commands_of_ours(arm: Path):
    check_hook, uptodate_hook, *_ = yaml.safe_load((ROOT / ".pre-commit-hooks.yaml").read_text("utf-8"))
    assert (check_hook["id"], uptodate_hook["id"]) == ("linkforge-check", "linkforge-uptodate")
    program, *words = check_hook["entry"].split()
    assert program == "linkforge"
    assert main(words) == 0
    program, *words = uptodate_hook["entry"].split()
    assert program == "linkforge"
    assert main([*words, "arm.robot.yaml", "-o", "urdf/"]) == 0
    (arm / "urdf" / "arm.urdf").write_text("<robot/>")
    assert main([*words, "arm.robot.yaml", "-o", "urdf/"]) == 1


def test_the_check_hook_finds_what_a_changed_module_breaks(arm: Path, capfd: pytest.CaptureFixture[str]):
    hook, *_ = yaml.safe_load((ROOT / ".pre-commit-hooks.yaml").read_text("utf-8"))
    words = hook["entry"].split()[1:]
    (arm / "parts").mkdir()
    module = arm / "parts" / "hand.yaml"
    module.write_text("linkforge: 1\nname: hand\nlinks: {palm: }\n")
    user = "linkforge: 1\nname: cell\nlinks: {base: }\nmodules: {hand: {use: hand.yaml, parent: base}}\n"
    (arm / "parts" / "cell.robot.yaml").write_text(user)
    assert main(words) == 0
    assert "checked 2 specs" in capfd.readouterr().err
    module.write_text("linkforge: 1\nname: hand\nlinks: {palm: {inertial: {mass: -1}}}\n")
    assert main(words) == 1
    assert "parts/hand.yaml:3" in capfd.readouterr().err
