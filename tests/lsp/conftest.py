from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.lsp.editor import Editor


@pytest.fixture(scope="session")
def server() -> Iterator[Editor]:
    """A server for all tests, since one takes more than a second to start."""
    with Editor() as editor:
        yield editor


@pytest.fixture
def editor(server: Editor, tmp_path: Path) -> Iterator[Editor]:
    """A server whose workspace is the test's folder."""
    with server.in_workspace(tmp_path):
        yield server
