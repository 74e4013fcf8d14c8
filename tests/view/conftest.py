"""The page, built once, and a browser that shows it."""

import os
import subprocess
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

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


OPTIONS = ("--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--force-color-profile=srgb")
ALLOWED = ("file:", "data:", "blob:", "http://127.0.0.1:")


@pytest.fixture(scope="session")
def chromium(browser: Sequence[str]) -> Iterator[Any]:
    """The browser as Playwright drives it, with graphics by software."""
    playwright = pytest.importorskip("playwright.sync_api")
    with playwright.sync_playwright() as driver:
        program, *words = browser
        yield driver.chromium.launch(executable_path=program, args=[*words, *OPTIONS], chromium_sandbox=False)


@pytest.fixture
def new_tab(chromium: Any) -> Iterator[Callable[[], Any]]:
    """Return a function that opens a tab; the test fails if one asks another machine, or reports an error."""
    context = chromium.new_context(viewport={"width": 800, "height": 600})
    faults: list[str] = []
    context.on("request", lambda request: request.url.startswith(ALLOWED) or faults.append(request.url))
    context.on("weberror", lambda error: faults.append(str(error.error)))
    context.on("console", lambda message: faults.append(message.text) if message.type == "error" else None)
    yield context.new_page
    context.close()
    assert not faults


@pytest.fixture
def show(page: Path, new_tab: Callable[[], Any], tmp_path: Path) -> Callable[[str], Any]:
    """Return a function that shows the HTML of a robot, from a file, in a tab, and waits until it is drawn."""

    def shown(html: str) -> Any:
        file = tmp_path / "robot.html"
        file.write_text(html, "utf-8")
        tab = new_tab()
        tab.goto(file.as_uri())
        tab.evaluate("linkforge.ready")
        return tab

    return shown
