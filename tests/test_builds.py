"""What docs/builds.md says to write for other build systems, taken to the letter."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

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
