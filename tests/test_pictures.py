"""The pictures in the docs: each is of its robot as it is now, small, and shown."""

import importlib.util
import re
from types import ModuleType

import pytest

from tests.cli.in_process import linkforge
from tests.conftest import ROOT


def load_pictures() -> ModuleType:
    spec = importlib.util.spec_from_file_location("pictures", ROOT / "docs" / "pictures.py")
    assert spec
    assert spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


DOCS = load_pictures()
SHOWN = {
    name
    for page in (ROOT / "README.md", ROOT / "examples" / "README.md", *(ROOT / "docs").glob("*.md"))
    for name in re.findall(r"[(\"][\w./]*pictures/([\w.]+)[)\"]", page.read_text("utf-8"))
}


@pytest.mark.parametrize("name", DOCS.PICTURES)
def test_a_picture_is_of_its_robot_as_it_is_now(name: str):
    picture = DOCS.PICTURES[name]
    renew = "run `python docs/pictures.py` and look at the pictures"
    assert DOCS.known_digests().get(name) == DOCS.digest_of(picture), renew
    if name.endswith(".svg"):
        done = linkforge(*picture.words, "--format", "svg", cwd=DOCS.EXAMPLES)
        assert done.stdout == (DOCS.FOLDER / name).read_text("utf-8"), renew


def test_the_folder_has_the_pictures_that_pages_show_and_no_others():
    files = {file.name: file.stat().st_size for file in DOCS.FOLDER.iterdir() if file != DOCS.DIGESTS}
    assert files.keys() == DOCS.PICTURES.keys() == SHOWN
    assert max(files.values()) <= DOCS.MAX_BYTES
