"""The examples of the manual: wrong ones are reported with the code of the page, right ones compile."""

import re
from pathlib import Path

import pytest

from linkforge_compile.cli.main import main
from linkforge_compile.cli.reports import heading
from linkforge_compile.diagnostics.codes import REGISTER
from linkforge_compile.expressions.functions import SIGNATURES
from linkforge_compile.resources import manual_folder
from tests.diagnostics.manual_page import Example, Page

PAGES = sorted(manual_folder().glob("LF*.md"))

SHOWN = [path for path in PAGES if "Wrong" in Page.read(path).sections]


def run(example: Example, folder: Path, capfd: pytest.CaptureFixture[str]) -> tuple[int, str]:
    """Return the exit code of the example's command and what it printed."""
    folder.mkdir()
    example.write(folder)
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        exit_code = main(example.command)
    return exit_code, "".join(capfd.readouterr())


@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.stem)
def test_a_page_begins_with_its_code_and_message(path: Path):
    page = Page.read(path)
    assert page.heading == f"# {heading(REGISTER[path.stem])}"
    assert len(page.paragraphs) >= 2, "a paragraph of what it says and when, and one of why it matters"
    assert list(page.sections) in (["Wrong", "Right"], ["What to do"])


@pytest.mark.parametrize("path", SHOWN, ids=lambda path: path.stem)
def test_a_wrong_example_is_reported_and_the_right_one_is_not(
    path: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
):
    sections = Page.read(path).sections
    sign = f"[{path.stem}]"
    _, wrong_output = run(Example.read(sections["Wrong"]), tmp_path / "wrong", capfd)
    assert sign in wrong_output
    exit_code, right_output = run(Example.read(sections["Right"]), tmp_path / "right", capfd)
    assert exit_code == 0, right_output
    assert sign not in right_output


def test_every_code_has_a_page_and_every_page_a_code():
    """Write docs/diagnostics/CODE.md, as docs/diagnostics/README.md describes."""
    assert {path.stem for path in PAGES} == set(REGISTER)


def test_the_page_of_an_unknown_function_lists_all_functions():
    page = (manual_folder() / "LF3108.md").read_text("utf-8")
    listed = [names.split() for names in re.findall(r"`([a-z0-9 \n]+)`", page)]
    assert {name for names in listed if len(names) > 1 for name in names} == {*SIGNATURES}
