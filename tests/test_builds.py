"""Run the recipes of docs/builds.md for other build systems, and the package of the examples."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import yaml

from linkforge_compile.cli.main import main
from tests.conftest import ROOT
from tests.programs import program

CELL = "linkforge: 1\nname: cell\nlinks: {base: }\n"
USING = f"{CELL}modules: {{hand: {{use: hand.yaml, parent: base}}}}\n"
HAND = "linkforge: 1\nname: hand\nlinks: {palm: }\n"

FILES = {"make": "Makefile", "ninja": "build.ninja"}


class Build:
    """A folder with the lines of the manual for one tool, which counts how often linkforge runs."""

    def __init__(self, folder: Path, tool: str) -> None:
        (text,) = re.findall(rf"```{tool}\n(.*?)```", (ROOT / "docs" / "builds.md").read_text("utf-8"), re.DOTALL)
        (folder / FILES[tool]).write_text(text)
        self.spec, self.module = folder / "robots" / "arm.robot.yaml", folder / "robots" / "hand.yaml"
        self.urdf = folder / "build" / "arm.urdf"
        self.spec.parent.mkdir()
        self.spec.write_text(USING)
        self.module.write_text(HAND)
        self._folder, self._tool, self._runs = folder, program(tool), folder / "runs"
        command = folder / "bin" / "linkforge"
        command.parent.mkdir()
        command.write_text(f'#!/bin/sh\necho >> "{self._runs}"\nexec "{sys.executable}" -m linkforge_compile "$@"\n')
        command.chmod(0o755)
        path = f"{command.parent}{os.pathsep}{os.environ['PATH']}"
        self._environment = {**os.environ, "PATH": path, "PYTHONPATH": str(ROOT)}

    def compiles(self) -> int:
        """Build, and return how often linkforge was run."""
        self._runs.write_text("")
        run = subprocess.run(
            [self._tool],
            cwd=self._folder,
            env=self._environment,
            capture_output=True,
            text=True,
            check=False,
            timeout=60,
        )
        assert run.returncode == 0, run.stdout + run.stderr
        return self._runs.read_text().count("\n")


@pytest.mark.parametrize("tool", FILES)
def test_make_and_ninja_compile_what_has_changed_and_nothing_else(tmp_path: Path, tool: str):
    build = Build(tmp_path, tool)
    assert [build.compiles(), build.compiles()] == [1, 0]
    os.utime(build.module)  # no other byte: the URDF stays, and is not made again and again
    assert [build.compiles(), build.compiles()] == [1, 0]
    build.module.unlink()
    build.spec.write_text(CELL)
    assert [build.compiles(), build.compiles()] == [1, 0]
    assert "palm" not in build.urdf.read_text()


PACKAGE = ROOT / "examples" / "11_ros2_package"


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The working folder, a copy of the package."""
    folder = tmp_path / "package"
    shutil.copytree(PACKAGE, folder)
    monkeypatch.chdir(folder)
    return folder


def commands() -> list[list[str]]:
    """Return what the workflow and the hooks of the package run of ours, without the program's name."""
    workflow = yaml.safe_load((PACKAGE / ".github" / "workflows" / "robots.yml").read_text("utf-8"))
    (job,) = workflow["jobs"].values()
    runs = [step["run"].partition("&&")[0].split() for step in job["steps"] if "run" in step]
    hooks = {hook["id"]: hook for hook in yaml.safe_load((ROOT / ".pre-commit-hooks.yaml").read_text("utf-8"))}
    (repository,) = yaml.safe_load((PACKAGE / ".pre-commit-config.yaml").read_text("utf-8"))["repos"]
    runs += [[*hooks[hook["id"]]["entry"].split(), *hook.get("args", [])] for hook in repository["hooks"]]
    return [words[1:] for words in runs if words[0] == "linkforge"]


def test_the_workflow_and_the_hooks_of_the_package_pass_and_tell_a_fault(
    package: Path, capfd: pytest.CaptureFixture[str]
):
    ours = commands()
    assert [words[0] for words in ours] == ["matcher", "check", "compile", "check", "compile", "compile"]
    assert [main(words) for words in ours] == [0] * len(ours)
    module = package / "robots" / "servo.robot.yaml"
    module.write_text(module.read_text("utf-8").replace("child: horn", "child: hron"))
    capfd.readouterr()
    assert [main(words) for words in ours] == [0, 1, 1, 1, 1, 1]
    (pattern,) = yaml.safe_load((package / "linkforge-matcher.json").read_text())["problemMatcher"][0]["pattern"]
    lines = [found for line in capfd.readouterr().err.splitlines() if (found := re.match(pattern["regexp"], line))]
    assert {found[pattern["file"]] for found in lines} == {"robots/servo.robot.yaml"}
