"""The site of the docs: it builds without a warning, so each link leads somewhere, and a search finds every code."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from linkforge_compile.diagnostics.codes import REGISTER
from tests.conftest import ROOT


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("site")
    options = ["-W", "--keep-going", "-n", "-q", "-c", "docs", "-d", str(folder / "doctrees")]
    command = [sys.executable, "-m", "sphinx", *options, ".", str(folder / "html")]
    run = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False, timeout=300)
    assert run.returncode == 0, run.stderr
    return folder / "html"


def test_search_knows_every_code(site: Path):
    index = (site / "searchindex.js").read_text("utf-8").removeprefix("Search.setIndex(").removesuffix(")")
    found = json.loads(index)
    titles = {found["docnames"][page]: title for page, title in enumerate(found["titles"])}
    assert REGISTER.keys() <= {title.partition(":")[0] for title in titles.values()}


def test_every_page_is_in_the_navigation(site: Path):
    first = (site / "index.html").read_text("utf-8")
    for page in (ROOT / "docs").rglob("*.md"):
        name = page.relative_to(ROOT).with_suffix("").as_posix()
        if name != "docs/language.in" and not page.name.startswith("LF"):
            assert f'href="{name}.html"' in first, f"docs/conf.py: no '{name}' in NAVIGATION"


def test_python_reference_has_units(site: Path):
    page = (site / "docs" / "python.html").read_text("utf-8")
    assert "linkforge_compile.compile_file" in page
    assert "[N·m]" in page


def test_a_code_leads_back_and_a_command_is_not_cut_off(site: Path):
    assert (
        'href="../diagnostics.html"'
        in (site / "docs" / "diagnostics" / "LF1001.html").read_text("utf-8").partition("<article")[2]
    )
    commands = (site / "docs" / "commands.html").read_text("utf-8")
    assert "<dl" in commands
    assert "<pre>" not in commands.partition("<article")[2]
