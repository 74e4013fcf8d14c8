"""The extension for VS Code, packed once for the tests of a process."""

import shutil
import subprocess
from pathlib import Path
from zipfile import ZipFile

import pytest

from tests.conftest import ROOT
from tests.npm import installed_modules
from tests.programs import program

EXTENSION = ROOT / "editors" / "vscode"


@pytest.fixture(scope="session")
def project(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the extension's folder with its packages, as after `npm ci`."""
    folder = tmp_path_factory.mktemp("extension") / "vscode"
    shutil.copytree(EXTENSION, folder, ignore=shutil.ignore_patterns("node_modules", "out", "*.vsix"))
    (folder / "node_modules").symlink_to(installed_modules(EXTENSION))
    return folder


@pytest.fixture(scope="session")
def packed(project: Path) -> ZipFile:
    """The .vsix that `npm run package` makes; that checks the types as well."""
    command = (program("npm"), "run", "package", "--", "--out", "linkforge.vsix")
    run = subprocess.run(command, cwd=project, capture_output=True, text=True, timeout=300, check=False)
    assert run.returncode == 0, run.stdout + run.stderr
    return ZipFile(project / "linkforge.vsix")
