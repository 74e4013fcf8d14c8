"""How the command ends when linkforge is at fault, or is interrupted."""

import errno
import os
import tempfile
from contextlib import chdir
from pathlib import Path

import pytest

from linkforge_compile import pipeline
from linkforge_compile.cli.main import main

COMMAND = ["compile", "my robots/../any.robot.yaml"]


def plant(monkeypatch: pytest.MonkeyPatch, fault: BaseException) -> None:
    def fail(*_: object, **__: object) -> None:
        raise fault

    monkeypatch.delenv("LINKFORGE_DEBUG", raising=False)
    monkeypatch.setattr(pipeline, "compile_path", fail)


@pytest.fixture
def reports(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    return tmp_path


def test_an_internal_fault_shows_what_to_report(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], reports: Path
):
    plant(monkeypatch, ZeroDivisionError("by zero"))
    assert main(COMMAND) == 70
    stderr = capsys.readouterr().err
    assert "internal fault: ZeroDivisionError" in stderr
    assert "not in your spec" in stderr
    assert "command: linkforge compile 'my robots/../any.robot.yaml'" in stderr
    assert "Traceback" not in stderr
    (report,) = reports.iterdir()
    assert str(report) in stderr
    written = report.read_text("utf-8")
    assert stderr.endswith(written.partition("Traceback")[0])
    assert written.rstrip().endswith("ZeroDivisionError: by zero")


def test_the_traceback_is_shown_on_request(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], reports: Path
):
    plant(monkeypatch, ZeroDivisionError("by zero"))
    monkeypatch.setenv("LINKFORGE_DEBUG", "1")
    assert main(COMMAND) == 70
    assert capsys.readouterr().err.startswith("Traceback (most recent call last):")


def test_too_little_memory_is_no_error_in_the_spec(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]):
    plant(monkeypatch, MemoryError())
    assert main(COMMAND) == 2
    way_out = "free some, or raise the limit (ulimit -v)"
    assert capsys.readouterr().err == f"linkforge {' '.join(COMMAND)}: there is not enough memory; {way_out}\n"


def test_a_report_that_cannot_be_saved_is_offered_otherwise(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
):
    plant(monkeypatch, ZeroDivisionError("by zero"))
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "nowhere"))
    assert main(COMMAND) == 70
    stderr = capsys.readouterr().err
    assert "what LINKFORGE_DEBUG=1 prints" in stderr
    assert "Traceback" not in stderr


def test_an_interruption_is_quiet(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]):
    plant(monkeypatch, KeyboardInterrupt())
    assert main(COMMAND) == 130
    assert capsys.readouterr() == ("", "")


def test_what_is_forbidden_without_a_place_is_a_fault_of_ours(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], reports: Path
):
    plant(monkeypatch, PermissionError(errno.EPERM, "Operation not permitted"))
    assert main(COMMAND) == 70
    assert "internal fault: PermissionError" in capsys.readouterr().err


LONG = "a" * 5000


@pytest.mark.parametrize(
    "words",
    [
        ("init", "arm", "--dir", LONG),
        ("schema", "--workspace", LONG),
        ("check", "any.robot.yaml", "--package", f"arm={LONG}"),
        ("compile", "any.robot.yaml", "-o", LONG),
        ("watch", "any.robot.yaml", "-o", f"{LONG}.urdf"),
        ("where", f"{LONG}.urdf:3"),
    ],
)
def test_a_name_that_no_file_can_have_is_no_fault_of_ours(capsys: pytest.CaptureFixture[str], words: tuple[str, ...]):
    assert main(words) == 2
    (stderr,) = capsys.readouterr().err.splitlines()
    assert stderr.startswith(f"linkforge {words[0]}: '")
    assert stderr.endswith(": File name too long")
    assert len(stderr) < 200


@pytest.mark.skipif(os.name != "posix", reason="Windows removes no folder in which somebody stands")
@pytest.mark.parametrize(
    "words",
    [
        ("check",),
        ("check", "any.robot.yaml"),
        ("compile", "any.robot.yaml", "-o", "."),
        ("import", "any.urdf"),
        ("expand", "any.robot.yaml"),
        ("diff", "any.robot.yaml", "any.urdf"),
        ("explain", "any.robot.yaml", "links/base"),
        ("params", "any.robot.yaml"),
        ("deps", "any.robot.yaml"),
        ("init", "arm"),
    ],
)
def test_a_folder_that_is_gone_is_no_fault_of_ours(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, words: tuple[str, ...]
):
    gone = tmp_path / "gone"
    gone.mkdir()
    with chdir(gone):
        gone.rmdir()
        code = main(words)
    stderr = capsys.readouterr().err
    assert (code, stderr) == (2, f"linkforge {words[0]}: the folder it is called in is gone; enter one that exists\n")
