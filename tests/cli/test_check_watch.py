"""`linkforge check --watch`: it checks again after each change, also of the specs in a folder."""

import os
import shutil
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.cli.in_process import linkforge
from tests.cli.watching import nothing, removes, run_with, sets

CELL = "linkforge: 1\nname: cell\nlinks: {base: }\nmodules: {arm: {use: arm.robot.yaml, parent: base}}\n"
ARM = "linkforge: 1\nname: arm\nlinks: {hand: }\n"
WRONG = ARM.replace("hand: ", "hand: {colision: visual}")
FAULT = "arm.robot.yaml:3:16: error: 'colision' is not a key of a link; did you mean 'collision'? [LF2101]"
WATCHING = "watching cell.robot.yaml and 1 more; Ctrl-C ends"


@pytest.fixture
def cell(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "cell.robot.yaml").write_text(CELL)
    (tmp_path / "arm.robot.yaml").write_text(ARM)
    return tmp_path


@pytest.fixture
def watch(cell: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]) -> Callable[..., list[str]]:
    def run(*deeds: Callable[[Path], object], words: tuple[str, ...] = ("cell.robot.yaml",)) -> list[str]:
        return run_with(deeds, ("check", "--watch", *words), cell, monkeypatch, capfd)

    return run


def test_a_change_of_a_module_is_checked(watch: Callable[..., list[str]]):
    output = watch(nothing, sets("arm.robot.yaml", WRONG), nothing, sets("arm.robot.yaml", ARM), nothing)
    once, again = "checked 1 spec: no errors", "arm.robot.yaml changed"
    assert output[:4] == [once, WATCHING, again, FAULT]
    assert output[-5:] == ["checked 1 spec: 1 error", WATCHING, again, once, WATCHING]


def test_a_spec_that_appears_in_a_folder_is_checked_and_one_that_leaves_it_is_not(watch: Callable[..., list[str]]):
    def makes_a_folder(folder: Path) -> None:
        (folder / "hands").mkdir()
        sets("hands/hand.robot.yaml", ARM)(folder)

    output = watch(
        sets("gripper.robot.yaml", ARM),
        removes("gripper.robot.yaml"),
        makes_a_folder,
        sets("hands/hand.robot.yaml", WRONG),
        words=(),
    )
    assert [line for line in output if line.endswith("changed") or line.startswith("checked")] == [
        "checked 2 specs: no errors",
        "gripper.robot.yaml changed",
        "checked 3 specs: no errors",
        "gripper.robot.yaml changed",
        "checked 2 specs: no errors",
        "hands/hand.robot.yaml changed",
        "checked 3 specs: no errors",
        "hands/hand.robot.yaml changed",
        "checked 3 specs: 1 error",
    ]


def test_another_file_in_a_folder_is_no_reason_to_check(watch: Callable[..., list[str]]):
    output = watch(sets(".arm.robot.yaml.swp", "x"), sets("build.log", "x"), removes("build.log"), words=(".",))
    assert len(output) == 2


def test_a_folder_without_specs_is_watched(cell: Path, watch: Callable[..., list[str]]):
    (cell / "new").mkdir()
    output = watch(sets("new/arm.robot.yaml", ARM), words=("new",))
    assert output[-4:] == [
        "watching new; Ctrl-C ends",
        "new/arm.robot.yaml changed",
        "checked 1 spec: no errors",
        "watching new/arm.robot.yaml; Ctrl-C ends",
    ]


def test_a_file_that_is_missing_is_waited_for(watch: Callable[..., list[str]]):
    output = watch(removes("arm.robot.yaml"), sets("arm.robot.yaml", ARM))
    assert any("there is no file 'arm.robot.yaml'" in line for line in output)
    assert output[-3:] == ["arm.robot.yaml changed", "checked 1 spec: no errors", WATCHING]


def test_a_folder_that_goes_and_comes_back_does_not_end_it(cell: Path, watch: Callable[..., list[str]]):
    (cell / "new").mkdir()
    sets("new/arm.robot.yaml", ARM)(cell)
    output = watch(
        lambda folder: shutil.rmtree(folder / "new"),
        lambda folder: ((folder / "new").mkdir(), sets("new/arm.robot.yaml", ARM)(folder)),
        words=("new",),
    )
    assert output[-2:] == ["checked 1 spec: no errors", "watching new/arm.robot.yaml; Ctrl-C ends"]


def test_a_spec_that_is_saved_while_it_is_checked_is_checked_again(
    watch: Callable[..., list[str]], monkeypatch: pytest.MonkeyPatch
):
    from linkforge_compile.cli.commands import check as check_command

    check_spec, saves = check_command.check_spec, iter([WRONG])

    def check_while_a_person_saves(*words: object) -> object:
        compilation = check_spec(*words)
        for text in saves:
            Path("arm.robot.yaml").write_text(text)
            # The clock of a file system may be some milliseconds behind.
            now = time.time_ns()
            os.utime("arm.robot.yaml", ns=(now, now))
        return compilation

    monkeypatch.setattr(check_command, "check_spec", check_while_a_person_saves)
    output = watch(nothing)
    assert output[:4] == ["checked 1 spec: no errors", WATCHING, "arm.robot.yaml changed", FAULT]


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (("--format", "json"), "--watch prints text for people, not json"),
        (("--fix",), "takes --watch or --fix, not both: a file would change while it is edited"),
        (("-",), "--watch takes files, not standard input"),
        (("--variant", "a", "--all-variants"), "takes --variant or --all-variants, not both"),
    ],
)
def test_what_does_not_go_with_it_is_refused(words: tuple[str, ...], expected: str, cell: Path):
    run = linkforge("check", "--watch", *words, cwd=cell)
    assert (run.returncode, run.stderr) == (2, f"linkforge check: {expected}\n")


def test_quiet_prints_errors_only(watch: Callable[..., list[str]]):
    output = watch(sets("arm.robot.yaml", WRONG), sets("arm.robot.yaml", ARM), words=("-q", "cell.robot.yaml"))
    assert output[0] == FAULT
    assert not [line for line in output if line.startswith(("watching", "checked", "arm.robot.yaml changed"))]
