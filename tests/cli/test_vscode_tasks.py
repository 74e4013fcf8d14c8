"""The tasks of VS Code that `init` writes: their problem matchers match what the commands print, and nothing else."""

import json
import re
from pathlib import Path

import pytest

from tests.cli.in_process import linkforge
from tests.cli.watching import nothing, run_with, sets
from tests.conftest import ROOT

ARM = """\
linkforge: 1
name: arm
parameters: {reach: {type: length}}
links: {base: {inertial: {mass: 1}}, hand: {colision: visual}}
joints: {wrist: {parent: base, child: hand, type: fixed, origin: [$(reach), 0, 0]}}
"""


@pytest.fixture
def robot(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    assert linkforge("init", "arm", "--dir", ".", cwd=tmp_path).returncode == 0
    (tmp_path / "arm.robot.yaml").write_text(ARM)
    return tmp_path


def tasks_in(folder: Path) -> dict[str, dict]:
    return {task["label"]: task for task in json.loads((folder / ".vscode/tasks.json").read_text())["tasks"]}


def problems(lines: list[str], matcher: dict) -> list[dict[str, str]]:
    """Return what VS Code finds in the output of a task."""
    pattern = matcher["pattern"]
    groups = {name: place for name, place in pattern.items() if name != "regexp"}
    found = filter(None, (re.search(pattern["regexp"], line) for line in lines))
    return [{name: match[place] for name, place in groups.items()} for match in found]


def test_every_diagnostic_of_a_check_is_a_problem_and_no_note_of_one(robot: Path):
    task = tasks_in(robot)["linkforge check"]
    assert (task["command"], task["args"]) == ("linkforge", ["check"])
    lines = linkforge(*task["args"], cwd=robot).stderr.splitlines()
    document = json.loads(linkforge("check", "--format", "json", cwd=robot).stdout)
    keys = ("file", "line", "column", "severity", "message", "code")
    expected = [{key: str(one[key]) for key in keys} for one in document["diagnostics"]]
    assert problems(lines, task["problemMatcher"]) == expected
    assert {one["severity"] for one in expected} == {"error", "note"}


def test_a_background_task_begins_and_ends_with_each_check(
    robot: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
):
    task = tasks_in(robot)["linkforge check --watch"]
    matcher = task["problemMatcher"]
    assert task["isBackground"]
    deeds = (sets("arm.robot.yaml", ARM.replace("colision", "collision")), nothing, sets("arm.robot.yaml", ARM))
    lines = run_with(deeds, tuple(task["args"]), robot, monkeypatch, capfd)
    background = matcher["background"]
    assert background["activeOnStart"]
    runs: list[list[str]] = [[]]
    marks = ["begins"]
    for line in lines:
        runs[-1].append(line)
        if re.search(background["endsPattern"], line):
            marks.append("ends")
        elif re.search(background["beginsPattern"], line):
            marks.append("begins")
            runs.append([])
    assert marks == ["begins", "ends"] * 3
    codes = [[one["code"] for one in problems(run, matcher)] for run in runs]
    assert codes[0] == codes[2]
    assert "LF2101" in codes[0]
    assert "LF2101" not in codes[1]


def test_both_tasks_and_github_have_one_pattern(robot: Path):
    of_github = json.loads(linkforge("matcher", cwd=robot).stdout)["problemMatcher"][0]["pattern"][0]
    for task in tasks_in(robot).values():
        pattern = task["problemMatcher"]["pattern"]
        # VS Code shows notes as well, and no diagnostic without a place; GitHub has both the other way round.
        same = pattern["regexp"].replace("^(.+?):(\\d+):(\\d+): ", "^(?:(.+?):(\\d+):(\\d+): )?").replace("|note", "")
        assert {**pattern, "regexp": same} == of_github


def test_the_manual_has_the_matcher_of_the_task(robot: Path):
    manual = (ROOT / "docs/editors.md").read_text("utf-8")
    shown = re.search(r"```json\n(\"isBackground\".*?)```", manual, re.DOTALL)[1]
    task = tasks_in(robot)["linkforge check --watch"]
    assert json.loads(f"{{{shown}}}") == {key: task[key] for key in ("isBackground", "problemMatcher")}


def test_tasks_of_the_user_are_kept(tmp_path: Path):
    (tmp_path / ".vscode").mkdir()
    mine = '{"version": "2.0.0", "tasks": []} // mine'
    (tmp_path / ".vscode/tasks.json").write_text(mine)
    run = linkforge("init", "arm", "--dir", ".", cwd=tmp_path)
    assert (tmp_path / ".vscode/tasks.json").read_text() == mine
    assert "put into .vscode/tasks.json:\n  {\n" in run.stderr
