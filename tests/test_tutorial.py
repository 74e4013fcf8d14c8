"""The tutorial does what it shows, from its first file to the package."""

import re
import shutil
from pathlib import Path

import pytest

from tests.conftest import ROOT
from tests.test_cmake import Linkforge, Workspace
from tests.walkthrough import Command, follow, renewed

TUTORIAL = ROOT / "docs" / "tutorial.md"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The reader's folder, with the vendor's files that a command of `sh` copies."""
    scout = tmp_path_factory.mktemp("tutorial") / "scout"
    vendor = scout / "vendor"
    vendor.mkdir(parents=True)
    for name in ("ur5e_arm.urdf", "ur5e_arm.srdf"):
        shutil.copy(ROOT / "examples" / "02_ur5e" / name, vendor)
    return scout


@pytest.fixture(scope="module")
def commands(folder: Path) -> list[Command]:
    return follow(TUTORIAL.read_text("utf-8"), folder)


def test_commands_of_the_tutorial_print_what_it_shows(commands: list[Command], update_golden: bool):
    """Renew what it shows with --update-golden; read the diff."""
    page = TUTORIAL.read_text("utf-8")
    assert len(commands) == len(re.findall(r"^\$ ", page, re.MULTILINE))
    if update_golden:
        TUTORIAL.write_text(renewed(page, commands), "utf-8")
    else:
        for command in commands:
            assert command.is_as_shown, f"{command.line}\n{command.printed}"


@pytest.mark.usefixtures("commands")
def test_package_of_the_tutorial_installs_its_robots(folder: Path, tmp_path: Path):
    workspace = Workspace(tmp_path, "Ninja", Linkforge.copied(tmp_path / "linkforge"), folder)
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
