"""The tutorial and the how-to pages do what they show."""

import re
import shutil
from pathlib import Path
from typing import NamedTuple

import pytest

from tests.conftest import ROOT
from tests.test_cmake import Linkforge, Workspace
from tests.walkthrough import Command, follow, renewed

PAGES = [
    page
    for page in (ROOT / "docs" / "tutorial.md", *sorted((ROOT / "docs" / "how-to").glob("*.md")))
    if "```console" in page.read_text("utf-8")
]


class Walk(NamedTuple):
    """A page, the reader's folder after its steps, and the commands."""

    page: Path
    folder: Path
    commands: list[Command]


@pytest.fixture(scope="module", params=PAGES, ids=lambda page: page.stem)
def walk(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Walk:
    folder = tmp_path_factory.mktemp("reader") / "scout"
    vendor = folder / "vendor"
    vendor.mkdir(parents=True)
    for name in ("ur5e_arm.urdf", "ur5e_arm.srdf"):  # which a command of `sh` copies
        shutil.copy(ROOT / "examples" / "02_ur5e" / name, vendor)
    page: Path = request.param
    return Walk(page, folder, follow(page.read_text("utf-8"), folder))


def test_commands_of_a_page_print_what_it_shows(walk: Walk, update_golden: bool):
    """Renew what it shows with --update-golden; read the diff."""
    text = walk.page.read_text("utf-8")
    assert len(walk.commands) == len(re.findall(r"^\$ ", text, re.MULTILINE))
    if update_golden:
        walk.page.write_text(renewed(text, walk.commands), "utf-8")
    else:
        for command in walk.commands:
            assert command.is_as_shown, f"{command.line}\n{command.printed}"


@pytest.mark.parametrize("walk", PAGES[:1], indirect=True, ids=["tutorial"])
def test_package_of_the_tutorial_installs_its_robots(walk: Walk, tmp_path: Path):
    workspace = Workspace(tmp_path, "Ninja", Linkforge.copied(tmp_path / "linkforge"), walk.folder)
    workspace.configure()
    assert workspace.make() == {"scout_sim", "scout_real"}
    workspace.install()
    share = workspace.prefix / "share" / "scout_description"
    assert {path.relative_to(share).as_posix() for path in share.rglob("*.*")} >= {
        "urdf/scout_sim.urdf",
        "urdf/scout_real.urdf",
        "urdf/scout_sim.srdf",
        "config/scout_sim_controllers.yaml",
    }
