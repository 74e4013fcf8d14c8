"""One yaml-language-server for the tests of a process, of the version in package-lock.json."""

import hashlib
import os
import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import NoReturn

import pytest

from linkforge_compile.editor.bundle import bundle_text
from tests.editor.language_server import LanguageServer

HERE = Path(__file__).parent
MANIFEST = ("package.json", "package-lock.json")
MAIN = Path("node_modules", "yaml-language-server", "bin", "yaml-language-server")


@pytest.fixture(scope="session")
def server_command() -> list[str]:
    """How to start the server, which is installed into the user's cache, once for each version of the lock file."""
    node, npm = shutil.which("node"), shutil.which("npm")
    if not node or not npm:
        cannot("there is no node and npm")
    digest = hashlib.sha256((HERE / MANIFEST[1]).read_bytes()).hexdigest()[:16]
    cache = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache", "linkforge-compile-tests")
    folder = cache / f"language-server-{digest}"
    if not (folder / MAIN).is_file():
        install(npm, folder)
    return [node, "--require", str(HERE / "without_delay.js"), str(folder / MAIN), "--stdio"]


def install(npm: str, folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=folder) as fresh:
        for name in MANIFEST:
            shutil.copy(HERE / name, fresh)
        command = (npm, "ci", "--ignore-scripts", "--no-audit", "--no-fund")
        run = subprocess.run(command, cwd=fresh, capture_output=True, text=True, timeout=300, check=False)
        if run.returncode:
            cannot(f"npm cannot install yaml-language-server: {run.stderr.strip()[-500:]}")
        with suppress(OSError):  # another process of this run was faster
            Path(fresh, "node_modules").rename(folder / "node_modules")


def cannot(reason: str) -> NoReturn:
    """Skip, or fail where LINKFORGE_REQUIRE_SHARED is set, as in CI."""
    if os.environ.get("LINKFORGE_REQUIRE_SHARED"):
        pytest.fail(reason)
    pytest.skip(reason)


@pytest.fixture(scope="session")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of the documents and of `robot.schema.json`."""
    folder = tmp_path_factory.mktemp("robots")
    (folder / "robot.schema.json").write_text(bundle_text(), "utf-8")
    return folder


@pytest.fixture(scope="session")
def server(server_command: list[str], folder: Path) -> Iterator[LanguageServer]:
    server = LanguageServer(server_command, folder)
    yield server
    server.close()
