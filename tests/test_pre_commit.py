"""The hooks of `.pre-commit-hooks.yaml` and those that `linkforge init` writes, run by pre-commit itself."""

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
import yaml

from tests.cli.in_process import linkforge
from tests.conftest import ROOT
from tests.programs import program

HAND = "linkforge: 1\nname: hand\nlinks: {palm: }\n"
USING = "linkforge: 1\nname: cell\nlinks: {base: }\nmodules: {hand: {use: hand.yaml, parent: base}}\n"


class Repository:
    """A git repository of a robot that uses a module, with everything committed and a `linkforge` on the PATH."""

    def __init__(self, folder: Path, tools: Path) -> None:
        self.folder = folder
        command = tools / "linkforge"
        command.parent.mkdir()
        command.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m linkforge_compile "$@"\n')
        command.chmod(0o755)
        names = {f"GIT_{who}_{what}": "x" for who in ("AUTHOR", "COMMITTER") for what in ("NAME", "EMAIL")}
        self._environment = {
            **{key: value for key, value in os.environ.items() if not key.startswith("GIT_")},
            **names,
            "PATH": f"{tools}{os.pathsep}{os.environ['PATH']}",
            "PYTHONPATH": str(ROOT),
            "PRE_COMMIT_HOME": str(tools / "cache"),
        }
        (folder / "hand.yaml").write_text(HAND)
        (folder / "cell.robot.yaml").write_text(USING)
        self.git("init", "--quiet")
        self.git("add", "--all")
        self.git("commit", "--quiet", "--message", "Begin")

    def git(self, *words: str) -> None:
        subprocess.run([program("git"), *words], cwd=self.folder, env=self._environment, check=True, timeout=60)

    def run_hooks(self) -> tuple[int, str]:
        """Run the hooks on what is staged, as a commit does; return the exit code and what is printed."""
        run = subprocess.run(
            [program("pre-commit"), "run"],
            cwd=self.folder,
            env=self._environment,
            capture_output=True,
            text=True,
            check=False,
            timeout=120,
        )
        return run.returncode, run.stdout + run.stderr


def write_hooks(folder: Path) -> None:
    """Write a configuration with our hooks; where they come from a repository, pre-commit installs it."""
    hooks = yaml.safe_load((ROOT / ".pre-commit-hooks.yaml").read_text("utf-8"))
    arguments = {"linkforge-check": [], "linkforge-uptodate": ["cell.robot.yaml", "-o", "urdf/"]}
    own = [{**hook, "language": "system", "args": arguments[hook["id"]]} for hook in hooks if hook["id"] in arguments]
    (folder / ".pre-commit-config.yaml").write_text(yaml.safe_dump({"repos": [{"repo": "local", "hooks": own}]}))


def write_hooks_of_init(folder: Path) -> None:
    assert linkforge("init", "arm", "--dir", str(folder), cwd=folder).returncode == 0


@pytest.mark.parametrize(("write", "failures"), [(write_hooks, 2), (write_hooks_of_init, 1)])
def test_a_commit_that_only_deletes_a_module_runs_the_hooks(
    tmp_path: Path, write: Callable[[Path], None], failures: int
):
    folder = tmp_path / "robots"
    folder.mkdir()
    (folder / "cell.robot.yaml").write_text(USING)
    (folder / "hand.yaml").write_text(HAND)
    assert linkforge("compile", "cell.robot.yaml", "-o", "urdf/", cwd=folder).returncode == 0
    write(folder)
    repository = Repository(folder, tmp_path / "bin")
    assert repository.run_hooks()[0] == 0
    repository.git("rm", "--quiet", "hand.yaml")
    code, printed = repository.run_hooks()
    assert code == 1
    assert printed.count("cell.robot.yaml:4:23: error: there is no file 'hand.yaml'") == failures, printed


def test_the_format_hook_formats_the_specs_of_a_commit(tmp_path: Path):
    folder = tmp_path / "robots"
    folder.mkdir()
    hooks = yaml.safe_load((ROOT / ".pre-commit-hooks.yaml").read_text("utf-8"))
    (hook,) = [{**one, "language": "system"} for one in hooks if one["id"] == "linkforge-format"]
    (folder / ".pre-commit-config.yaml").write_text(yaml.safe_dump({"repos": [{"repo": "local", "hooks": [hook]}]}))
    repository = Repository(folder, tmp_path / "bin")
    (folder / "table.yaml").write_text("a:   [ 1 ]\n")
    (folder / "cell.robot.yaml").write_text(USING.replace("{base: }", "{ base:  }"))
    repository.git("add", "--all")
    code, printed = repository.run_hooks()
    assert (code, "formatted cell.robot.yaml" in printed) == (1, True), printed
    assert (folder / "cell.robot.yaml").read_text() == USING
    assert (folder / "table.yaml").read_text() == "a:   [ 1 ]\n"
    repository.git("add", "--all")
    assert repository.run_hooks()[0] == 0
