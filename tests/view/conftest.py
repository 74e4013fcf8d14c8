"""The page, built once, and a browser that shows it."""

import os
import subprocess
from collections.abc import Sequence
from pathlib import Path

import pytest

from linkforge_compile.resources import view_page_file
from linkforge_compile.view.picture import PictureError, find_browser
from tests.npm import installed_modules
from tests.programs import program


@pytest.fixture(scope="session")
def page() -> Path:
    """Return the file of the page, built from what is in the checkout."""
    project = view_page_file().parents[1]
    modules = project / "node_modules"
    if not modules.exists():
        modules.unlink(missing_ok=True)
        modules.symlink_to(installed_modules(project))
    subprocess.run([program("node"), "build.mjs"], cwd=project, check=True, timeout=60)
    return view_page_file()


@pytest.fixture(scope="session")
def browser() -> Sequence[str]:
    try:
        return find_browser()
    except PictureError as error:
        if os.environ.get("LINKFORGE_REQUIRE_SHARED"):
            pytest.fail(str(error))
        pytest.skip(str(error))
