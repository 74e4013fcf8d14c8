"""`linkforge doctor`: what is installed, and where packages are looked for."""

from importlib.metadata import version
from pathlib import Path

import pytest

from linkforge_compile import installation
from linkforge_compile.cli.commands import doctor
from linkforge_compile.installation import Requirement, requirements
from tests.cli.in_process import linkforge

NO_PACKAGES = {"AMENT_PREFIX_PATH": "", "ROS_PACKAGE_PATH": ""}


def package(folder: Path, name: str) -> Path:
    folder.mkdir(parents=True)
    (folder / "package.xml").write_text(f"<package><name>{name}</name></package>", "utf-8")
    return folder


def rows(text: str) -> list[tuple[str, str]]:
    """Return the indented lines as their title and the rest."""
    return [
        (title, rest.strip()) for line in text.splitlines() if line[:2] == "  " for title, rest in [line.split(None, 1)]
    ]


def test_lists_the_versions_that_are_installed_and_the_variables(tmp_path: Path):
    done = linkforge("doctor", cwd=tmp_path, ROS_PACKAGE_PATH=str(tmp_path), AMENT_PREFIX_PATH="", LINKFORGE_LIMITS="2")
    assert done.returncode == 0
    found = rows(done.stdout)
    assert ("lxml", version("lxml")) in found
    assert ("lsp", f"pygls {version('pygls')}") in found
    assert ("LINKFORGE_LIMITS", "2") in found
    assert ("ROS_PACKAGE_PATH", str(tmp_path)) in found


def test_a_folder_that_does_not_exist_is_marked(tmp_path: Path):
    environment = {"ROS_PACKAGE_PATH": f"{tmp_path}:{tmp_path / 'nope'}", "AMENT_PREFIX_PATH": ""}
    found = rows(linkforge("doctor", cwd=tmp_path, **environment).stdout)
    assert ("ROS_PACKAGE_PATH", f"{tmp_path}:{tmp_path / 'nope'} (no such folder)") in found


def test_pinocchio_is_known_by_its_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(installation, "requires", lambda _: ["pin; extra == 'collisions'"])
    monkeypatch.setattr(installation, "installed_version", lambda _: None)
    wanted = ("collisions", "no pin (Pinocchio); pip install 'linkforge-compile[collisions]'")
    assert wanted in rows(linkforge("doctor", cwd=tmp_path).stdout)


def test_a_missing_extra_has_the_line_that_installs_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(installation, "requires", lambda _: ["no-such-reader>=2; extra == 'mesh'"])
    assert requirements() == {"": [], "mesh": [Requirement("no-such-reader", ">=2", None)]}
    done = linkforge("doctor", cwd=tmp_path)
    assert ("mesh", "no no-such-reader; pip install 'linkforge-compile[mesh]'") in rows(done.stdout)


def test_an_extra_of_another_extra_has_what_that_needs():
    assert {one.name for one in requirements()["mesh"]} < {one.name for one in requirements()["collisions"]}


def test_a_package_is_looked_for_in_order_and_the_first_is_used(tmp_path: Path):
    package(tmp_path / "ws" / "arm", "arm")
    package(tmp_path / "other" / "arm", "arm")
    (tmp_path / "prefix" / "share" / "arm").mkdir(parents=True)
    environment = {"AMENT_PREFIX_PATH": str(tmp_path / "prefix"), "ROS_PACKAGE_PATH": str(tmp_path / "other")}
    done = linkforge("doctor", "arm", cwd=tmp_path / "ws" / "arm", **environment)
    assert done.returncode == 0
    first, *others = done.stdout.splitlines()
    assert first == f"package arm: {tmp_path / 'ws' / 'arm'}"
    assert [line.split()[0] for line in others] == ["declared", "folders", "AMENT_PREFIX_PATH", "ROS_PACKAGE_PATH"]
    assert [line.endswith("(used)") for line in others] == [False, True, False, False]
    named = linkforge("doctor", "arm", "--package", f"arm={tmp_path}", cwd=tmp_path / "ws" / "arm", **environment)
    assert named.stdout.startswith(f"package arm: {tmp_path}\n  declared           {tmp_path} (used)\n")


def test_a_package_nearby_that_nothing_names_is_the_way_out(tmp_path: Path):
    package(tmp_path / "src" / "arm", "arm")
    package(tmp_path / "src" / "robot", "robot")
    done = linkforge("doctor", "arm", cwd=tmp_path / "src" / "robot", **NO_PACKAGES)
    assert done.returncode == 1
    assert "there is one nearby; write --package arm=../arm, or declare it in `packages`" in done.stdout


def test_a_misspelt_package_and_a_misspelt_file_are_suggested(tmp_path: Path):
    arm = package(tmp_path / "src" / "arm_description", "arm_description")
    (arm / "meshes").mkdir()
    (arm / "meshes" / "base.stl").touch()
    wrong = linkforge("doctor", "arm_descripton", cwd=arm, **NO_PACKAGES)
    assert wrong.returncode == 1
    assert "did you mean 'arm_description'?" in wrong.stdout
    wrong = linkforge("doctor", "package://arm_description/meshs/base.stl", cwd=arm, **NO_PACKAGES)
    assert wrong.returncode == 1
    assert wrong.stdout.endswith("there is no 'meshs' in the folder; did you mean 'meshes'?\n")
    right = linkforge("doctor", "package://arm_description/meshes/base.stl", cwd=arm, **NO_PACKAGES)
    assert right.returncode == 0
    assert right.stdout.endswith(f"meshes/base.stl: {arm}/meshes/base.stl\n")


def test_a_common_ending_makes_no_package_a_misspelling_of_another(tmp_path: Path):
    scout = package(tmp_path / "src" / "scout_description", "scout_description")
    done = linkforge("doctor", "ur_description", cwd=scout, **NO_PACKAGES)
    assert done.returncode == 1
    assert "no package.xml nearby has the name 'ur_description'\n" in done.stdout


def test_a_spec_has_the_packages_that_it_names_and_declares(tmp_path: Path):
    package(tmp_path / "vendor", "arm_description")
    (tmp_path / "cell.robot.yaml").write_text(
        "linkforge: 1\nname: cell\npackages: {arm_description: vendor}\nlinks:\n"
        "  base: {visual: {mesh: package://arm_description/base.stl}}\n"
        "  tip: {visual: {mesh: package://tool/tip.stl}}\n",
        "utf-8",
    )
    done = linkforge("doctor", "cell.robot.yaml", cwd=tmp_path, **NO_PACKAGES)
    assert done.returncode == 1
    titles = [line for line in done.stdout.splitlines() if line.startswith("package ")]
    assert titles == [f"package arm_description: {tmp_path / 'vendor'}", "package tool: not found"]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["gone.robot.yaml"], "there is no file 'gone.robot.yaml'"),
        (["package:/arm/base.stl"], "takes a spec, a package or package://NAME/PATH, found 'package:/arm/base.stl'"),
        (["a.yaml", "b.yaml"], "takes one spec, found 2: a.yaml, b.yaml"),
    ],
)
def test_wrong_usage(words: list[str], message: str, tmp_path: Path):
    done = linkforge("doctor", *words, cwd=tmp_path)
    assert done.returncode == 2
    assert message in done.stderr


def test_prints_as_many_names_as_are_read(tmp_path: Path):
    for number in range(doctor._MOST_NAMES + 3):
        package(tmp_path / f"robot_{number:02}", f"robot_{number:02}")
    done = linkforge("doctor", cwd=tmp_path, ROS_PACKAGE_PATH=str(tmp_path), AMENT_PREFIX_PATH="")
    assert f"{doctor._MOST_NAMES + 3}: robot_00, " in done.stdout
    assert "robot_11 and 3 more" in done.stdout
