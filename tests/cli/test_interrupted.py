"""Output that is interrupted: the old file or the new one, complete, and no other file."""

import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from linkforge_compile.cli.main import main

resource = pytest.importorskip("resource", reason="the limits are those of POSIX")

ROOT = Path(__file__).parents[2]
SPEC = "linkforge: 1\nname: r\nparameters: {n: 1}\nlinks:\n  base:\n  l$(i): {for: {i: $(n)}}\n"
JOINTS = "joints:\n  j$(i): {for: {i: $(n)}, type: fixed, parent: base, child: l$(i)}\n"


def compiler(folder: Path, size: int, **options: object) -> subprocess.Popen[str]:
    (folder / "a.robot.yaml").write_text(SPEC + JOINTS)
    command = [
        sys.executable,
        "-m",
        "linkforge_compile",
        "compile",
        "a.robot.yaml",
        "-p",
        f"n={size}",
        "-o",
        "out.urdf",
    ]
    return subprocess.Popen(command, cwd=folder, stderr=subprocess.PIPE, text=True, **options)


def small_files_only() -> None:
    resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))


def test_a_disk_that_is_full_leaves_the_old_file_and_nothing_else(tmp_path: Path):
    (tmp_path / "out.urdf").write_text("old")
    with compiler(tmp_path, 200, preexec_fn=small_files_only) as run:
        stderr = run.communicate(timeout=120)[1]
    assert run.returncode == 2
    assert "cannot write 'out.urdf'" in stderr
    assert {path.name: path.read_text() for path in tmp_path.glob("*out*")} == {"out.urdf": "old"}


def test_a_folder_removed_before_the_file_is_written_is_reported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """What the spec was read from may be gone as well by then."""
    spec = tmp_path / "a.robot.yaml"
    spec.write_text(SPEC + JOINTS)

    def remove_all(_: int) -> None:
        shutil.rmtree(tmp_path)

    monkeypatch.setattr(os, "fsync", remove_all)
    assert main(["compile", str(spec), "-o", str(tmp_path / "build") + "/"]) == 2
    assert not tmp_path.exists()


def test_a_spec_that_is_gone_once_it_is_read_is_written_all_the_same(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    spec = tmp_path / "a.robot.yaml"
    spec.write_text(SPEC + JOINTS)
    monkeypatch.setattr(os, "fsync", lambda _: spec.unlink())
    assert main(["compile", str(spec), "-o", str(tmp_path / "out.urdf")]) == 0
    assert [path.name for path in tmp_path.iterdir()] == ["out.urdf"]
    assert (tmp_path / "out.urdf").read_text().endswith("</robot>\n")


@pytest.mark.parametrize("letter", ["a", "链"])
def test_a_name_may_be_as_long_as_names_can_be(letter: str, tmp_path: Path):
    (tmp_path / "a.robot.yaml").write_text(SPEC)
    name = letter * ((255 - len(".urdf")) // len(letter.encode())) + ".urdf"
    assert main(["compile", str(tmp_path / "a.robot.yaml"), "-p", "n=0", "-o", str(tmp_path / name)]) == 0
    assert {path.name for path in tmp_path.iterdir()} == {"a.robot.yaml", name}


@pytest.mark.skipif(hasattr(os, "geteuid") and os.geteuid() == 0, reason="root writes everywhere")
def test_an_unwritable_folder_is_reported(tmp_path: Path):
    run = compiler(tmp_path, 2)
    run.communicate(timeout=120)
    tmp_path.chmod(0o500)
    try:
        with compiler(tmp_path, 3) as run:
            stderr = run.communicate(timeout=120)[1]
    finally:
        tmp_path.chmod(0o700)
    assert (run.returncode, "cannot write" in stderr) == (2, True)


def test_two_compiles_into_one_file_give_one_whole_result(tmp_path: Path):
    with compiler(tmp_path, 50) as one, compiler(tmp_path, 60) as other:
        one.communicate(timeout=120)
        other.communicate(timeout=120)
    assert (one.returncode, other.returncode) == (0, 0)
    text = (tmp_path / "out.urdf").read_text()
    assert text.endswith("</robot>\n")
    assert text.count("<joint ") in (50, 60)
    assert [path.name for path in tmp_path.glob("*out*")] == ["out.urdf"]


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="a kill as POSIX has it")
def test_a_kill_at_any_moment_leaves_a_whole_file():
    """Ten of the two hundred kills of the command that the README names."""
    command = [sys.executable, str(ROOT / "benchmarks" / "interrupted.py"), "10"]
    run = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False, timeout=300)
    assert (run.returncode, run.stdout) == (0, "10 kills, 0 torn files\n"), run.stderr
