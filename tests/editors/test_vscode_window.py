"""VS Code itself with the packed extension, in a browser: what a person sees when a spec is opened.

`LINKFORGE_VSCODE_WINDOW=1 pytest tests/editors/test_vscode_window.py` installs code-server from npm, which takes a
minute and a C++ compiler, and needs the program `chromium`. The screenshot is in the folder of the test.
"""

import json
import os
import shutil
import socket
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from zipfile import ZipFile

import pytest

from tests.conftest import ROOT
from tests.npm import installed_modules
from tests.programs import program

pytestmark = pytest.mark.skipif(
    "LINKFORGE_VSCODE_WINDOW" not in os.environ, reason="LINKFORGE_VSCODE_WINDOW is not set"
)

WINDOW = Path(__file__).with_name("window")
NATIVE = ("@vscode/spdlog", "native-watchdog", "node-pty")
"""The parts of VS Code that are compiled, and without which it does not start."""

SETTINGS = {
    "security.workspace.trust.enabled": False,
    "workbench.startupEditor": "none",
    "telemetry.telemetryLevel": "off",
}


@pytest.fixture(scope="module")
def modules() -> Path:
    """node_modules with a code-server that starts; install scripts are not run, because one downloads ripgrep."""
    modules = installed_modules(WINDOW)
    vscode = modules / "code-server" / "lib" / "vscode"
    if not (vscode / "node_modules.asar").exists():
        npm(vscode, "install", "--omit=dev", "--ignore-scripts", "--no-audit", "--no-fund")
        npm(vscode, "rebuild", "--yes", *NATIVE)
        npm(modules.parent, "rebuild", "argon2")
        (vscode / "node_modules.asar").symlink_to("node_modules")
    return modules


def npm(folder: Path, *arguments: str) -> None:
    run = subprocess.run([program("npm"), *arguments], cwd=folder, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr[-2000:]


@contextmanager
def code_server(modules: Path, extension: ZipFile, folder: Path, linkforge: Sequence[str]) -> Iterator[str]:
    """Run VS Code with the extension, which starts a command, and yield its address."""
    assert extension.filename
    # VS Code ignores a command in the settings of a user whose files are on another machine.
    for name, settings in ("User", SETTINGS), ("Machine", {"linkforge.command": linkforge}):
        (folder / "user" / name).mkdir(parents=True)
        (folder / "user" / name / "settings.json").write_text(json.dumps(settings), "utf-8")
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        address = f"127.0.0.1:{free.getsockname()[1]}"
    command = [program("node"), str(modules / "code-server" / "out" / "node" / "entry.js")]
    command += ["--config", str(folder / "config.yaml"), "--user-data-dir", str(folder / "user")]
    command += ["--extensions-dir", str(folder / "extensions"), "--disable-telemetry", "--disable-update-check"]
    subprocess.run([*command, "--install-extension", extension.filename], check=True, capture_output=True, timeout=60)
    run = [*command, "--auth", "none", "--bind-addr", address]
    environment = {**os.environ, "PATH": "/usr/bin:/bin"}  # with no linkforge
    with subprocess.Popen(run, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as server:
        assert server.stdout
        assert any("HTTP server listening" in line for line in server.stdout)
        yield f"http://{address}/"
        server.terminate()


def look(url: str, modules: Path, picture: Path, *arguments: str) -> Any:
    environment = {**os.environ, "NODE_PATH": str(modules), "CHROMIUM": program("chromium")}
    command = (program("node"), str(WINDOW / "look.js"), url, str(picture), *arguments)
    run = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=180, check=False)
    assert run.returncode == 0, f"{run.stderr}; see {picture}"
    return json.loads(run.stdout)


def test_shows_problems_completions_and_colors(packed: ZipFile, modules: Path, tmp_path: Path) -> None:
    robots = tmp_path / "robots"
    shutil.copytree(ROOT / "examples", robots / "examples")
    (robots / ".git").mkdir()
    folder = robots / "examples" / "09_mobile_manipulator"
    spec = folder / "mobile_manipulator.robot.yaml"
    spec.write_text(spec.read_text("utf-8").replace("parent: torso", "parent: torsso", 1), "utf-8")
    typed = "\njoints:\n  new: {type: fixed, child: tor"
    with code_server(modules, packed, tmp_path / "editor", [sys.executable, "-m", "linkforge_compile"]) as url:
        seen = look(f"{url}?folder={folder}", modules, tmp_path / "window.png", spec.name, "language", typed)
    assert seen["name"] == "LinkForge Robot"
    assert any("no link named 'torsso'; did you mean 'torso'?" in problem for problem in seen["problems"])
    assert any(label.startswith("torso") for label in seen["offered"])
    assert "side" in seen["tokens"], "$(side.name) is highlighted as an expression"


MISSING = "import sys; sys.exit('linkforge: error: the language server needs pygls')"


@pytest.mark.parametrize(
    ("command", "message"),
    [
        ([], "LinkForge's compiler is not installed: pip install 'linkforge-compile[lsp]'"),
        (["/nowhere/linkforge"], "'/nowhere/linkforge lsp' cannot be started: spawn /nowhere/linkforge ENOENT"),
        ([sys.executable, "-c", MISSING], "ended with exit code 1: linkforge: error: the language server needs pygls"),
    ],
    ids=["no compiler", "no such command", "no extra"],
)
def test_says_why_the_server_does_not_start(
    packed: ZipFile, modules: Path, tmp_path: Path, command: Sequence[str], message: str
) -> None:
    (tmp_path / "arm.robot.yaml").write_text("linkforge: 1\nname: arm\n", "utf-8")
    with code_server(modules, packed, tmp_path / "editor", command) as url:
        seen = look(f"{url}?folder={tmp_path}", modules, tmp_path / "window.png", "arm.robot.yaml", "message")
    assert [shown for shown in seen["messages"] if message in shown] == seen["messages"]
