"""One yaml-language-server for the tests of a process, of the version in package-lock.json."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from linkforge_compile.editor.bundle import bundle_text
from tests.editor.language_server import LanguageServer
from tests.npm import installed_modules
from tests.programs import program

HERE = Path(__file__).parent
MAIN = Path("yaml-language-server", "bin", "yaml-language-server")


@pytest.fixture(scope="session")
def server_command() -> list[str]:
    """How to start the server."""
    modules = installed_modules(HERE)
    return [program("node"), "--require", str(HERE / "without_delay.js"), str(modules / MAIN), "--stdio"]


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
