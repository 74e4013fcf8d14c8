from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.lsp.editor import Editor


@pytest.fixture
def editor(tmp_path: Path) -> Iterator[Editor]:
    """A server whose workspace is the test's folder."""
    with Editor(tmp_path) as editor:
        yield editor
