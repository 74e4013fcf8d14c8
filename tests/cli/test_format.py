"""`linkforge format` as people, editors and CI call it."""

import stat
from pathlib import Path

import pytest

from tests.cli.in_process import linkforge
from tests.conftest import ROOT

WRITTEN = "linkforge: 1\nname:   arm   # linkforge: ignore LF6003\nlinks: { base: }\n"
FORMATTED = "linkforge: 1\nname: arm   # linkforge: ignore LF6003\nlinks: {base: }\n"
FAULTY = "linkforge: 1\nname: [arm\n"

EXAMPLES = list((ROOT / "examples").rglob("*.robot.yaml"))


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "arm.robot.yaml").write_text(WRITTEN)
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "leg.robot.yaml").write_text(FORMATTED)
    (tmp_path / "build").mkdir()
    (tmp_path / "build" / "arm.robot.yaml").write_text(WRITTEN)
    return tmp_path


def test_the_specs_below_a_folder_are_formatted(folder: Path):
    run = linkforge("format", cwd=folder)
    assert (run.returncode, run.stdout) == (0, "")
    assert run.stderr == "formatted arm.robot.yaml\n1 file formatted, 1 unchanged\n"
    assert (folder / "arm.robot.yaml").read_text() == FORMATTED
    assert (folder / "build" / "arm.robot.yaml").read_text() == WRITTEN
    assert linkforge("format", cwd=folder).stderr == "2 files unchanged\n"


def test_files_with_errors_are_counted(folder: Path):
    (folder / "broken.robot.yaml").write_text("links: {base: \n")
    checked = linkforge("format", "--check", cwd=folder)
    assert checked.stderr.splitlines()[-1] == "1 file would change, 1 unchanged, 1 with errors"
    assert linkforge("format", cwd=folder).stderr.endswith("\n1 file formatted, 1 unchanged, 1 with errors\n")
    run = linkforge("format", cwd=folder)
    assert (run.returncode, run.stderr.splitlines()[-1]) == (1, "2 files unchanged, 1 with errors")


def test_a_file_that_is_formatted_is_not_touched(folder: Path):
    leg = folder / "parts" / "leg.robot.yaml"
    before = leg.stat()
    assert linkforge("format", "parts", cwd=folder).returncode == 0
    assert (leg.stat().st_ino, leg.stat().st_mtime_ns) == (before.st_ino, before.st_mtime_ns)


def test_mode_and_link_stay(folder: Path):
    (folder / "arm.robot.yaml").chmod(0o640)
    (folder / "link.robot.yaml").symlink_to("arm.robot.yaml")
    assert linkforge("format", "link.robot.yaml", cwd=folder).returncode == 0
    assert (folder / "link.robot.yaml").is_symlink()
    assert (folder / "arm.robot.yaml").read_text() == FORMATTED
    assert stat.S_IMODE((folder / "arm.robot.yaml").stat().st_mode) == 0o640


def test_check_fails_and_writes_nothing(folder: Path):
    run = linkforge("format", "--check", cwd=folder)
    assert (run.returncode, run.stdout) == (1, "")
    assert run.stderr == "would format arm.robot.yaml\n1 file would change, 1 unchanged\n"
    assert (folder / "arm.robot.yaml").read_text() == WRITTEN
    assert linkforge("format", "--check", "parts", cwd=folder).returncode == 0
    quiet = linkforge("format", "--check", "-q", cwd=folder)
    assert (quiet.returncode, quiet.stderr) == (1, "would format arm.robot.yaml\n")


def test_a_difference_is_shown_and_not_written(folder: Path):
    run = linkforge("format", "--diff", cwd=folder)
    assert run.returncode == 0
    assert run.stdout.splitlines() == [
        "--- arm.robot.yaml (as written)",
        "+++ arm.robot.yaml (formatted)",
        "@@ -1,3 +1,3 @@",
        " linkforge: 1",
        "-name:   arm   # linkforge: ignore LF6003",
        "-links: { base: }",
        "+name: arm   # linkforge: ignore LF6003",
        "+links: {base: }",
    ]
    assert (folder / "arm.robot.yaml").read_text() == WRITTEN
    assert linkforge("format", "--diff", "--check", cwd=folder).returncode == 1


def test_a_difference_at_the_end_of_the_file_is_shown(tmp_path: Path):
    (tmp_path / "arm.robot.yaml").write_text("name: arm")
    run = linkforge("format", "--diff", cwd=tmp_path)
    assert run.stdout.splitlines()[-3:] == ["-name: arm", "\\ No newline at end of file", "+name: arm"]


def test_standard_input_is_formatted_to_standard_output(tmp_path: Path):
    run = linkforge("format", "-", cwd=tmp_path, stdin=WRITTEN)
    assert (run.returncode, run.stdout, run.stderr) == (0, FORMATTED, "")
    assert linkforge("format", "-", cwd=tmp_path, stdin=FORMATTED).stdout == FORMATTED
    check = linkforge("format", "--check", "-", cwd=tmp_path, stdin=WRITTEN)
    assert (check.returncode, check.stdout, check.stderr) == (1, "", "would format <stdin>\n")


def test_what_is_not_yaml_is_reported_as_by_check_and_not_written(folder: Path):
    (folder / "faulty.robot.yaml").write_text(FAULTY)
    run = linkforge("format", cwd=folder)
    assert run.returncode == 1
    check = linkforge("check", "faulty.robot.yaml", cwd=folder)
    assert check.stderr.splitlines()[0] in run.stderr.splitlines()
    assert (folder / "faulty.robot.yaml").read_text() == FAULTY
    assert (folder / "arm.robot.yaml").read_text() == FORMATTED, "others are formatted"
    stdin = linkforge("format", "-", cwd=folder, stdin=FAULTY)
    assert (stdin.returncode, stdin.stdout) == (1, "")
    assert "<stdin>:3:1: error: expected ',' or ']' before this [LF1009]" in stdin.stderr


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (["-", "arm.robot.yaml"], "takes - alone, for standard input, or files and folders"),
        (["arm.urdf"], "takes specs in YAML, and 'arm.urdf' is XML"),
        (["/dev/null"], "takes files and folders, found '/dev/null'; use - for standard input"),
    ],
)
def test_other_words_are_refused(folder: Path, words: list[str], expected: str):
    (folder / "arm.urdf").write_text("<robot/>")
    run = linkforge("format", *words, cwd=folder)
    assert run.returncode == 2
    assert expected in run.stderr
    assert (folder / "arm.robot.yaml").read_text() == WRITTEN


def test_a_missing_file_and_a_folder_without_specs_are_reported(folder: Path):
    (folder / "empty").mkdir()
    assert "there is no file 'arn.robot.yaml'" in linkforge("format", "arn.robot.yaml", cwd=folder).stderr
    run = linkforge("format", "empty", cwd=folder)
    assert run.returncode == 1
    assert "LF3067" in run.stderr


def test_all_examples_are_formatted():
    assert linkforge("format", "--check", "examples", cwd=ROOT).stderr == f"{len(EXAMPLES)} files unchanged\n"


def test_the_specs_that_commands_write_are_formatted(tmp_path: Path):
    assert linkforge("init", "arm", "--dir", str(tmp_path), cwd=tmp_path).returncode == 0
    assert linkforge("compile", "arm.robot.yaml", "-o", "arm.urdf", cwd=tmp_path).returncode == 0
    assert linkforge("import", "arm.urdf", "-o", "imported.robot.yaml", cwd=tmp_path).returncode == 0
    rover = ROOT / "examples" / "06_rover" / "rover.robot.yaml"
    assert linkforge("expand", str(rover), "-o", str(tmp_path / "flat.robot.yaml"), cwd=tmp_path).returncode == 0
    assert linkforge("format", "--check", cwd=tmp_path).stderr == "3 files unchanged\n"
