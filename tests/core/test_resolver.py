"""Where the resolver looks for files, and in which order."""

import pickle
from pathlib import Path

import pytest

from linkforge_compile.core import FileSystemResolver, IResourceResolver, Robot


@pytest.fixture(autouse=True)
def no_ros(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("ROS_PACKAGE_PATH", raising=False)
    monkeypatch.delenv("AMENT_PREFIX_PATH", raising=False)


def mesh_in(folder: Path) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    mesh = folder / "arm.stl"
    mesh.touch()
    return mesh


def test_search_paths_come_before_the_environment(tmp_path, monkeypatch):
    first, second = mesh_in(tmp_path / "one" / "arm"), mesh_in(tmp_path / "two" / "arm")
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path / "two"))
    assert FileSystemResolver().resolve("package://arm/arm.stl") == second
    assert FileSystemResolver([tmp_path / "one"]).resolve("package://arm/arm.stl") == first


def test_a_search_path_may_be_the_package_itself(tmp_path):
    mesh = mesh_in(tmp_path / "arm")
    assert FileSystemResolver([tmp_path / "arm"]).resolve("package://arm/arm.stl") == mesh


def test_a_package_without_the_file_does_not_hide_one_with_it(tmp_path):
    (tmp_path / "one" / "arm").mkdir(parents=True)
    mesh = mesh_in(tmp_path / "two" / "arm")
    assert FileSystemResolver([tmp_path / "one", tmp_path / "two"]).resolve("package://arm/arm.stl") == mesh


def test_ament_keeps_packages_under_share(tmp_path, monkeypatch):
    mesh = mesh_in(tmp_path / "share" / "arm")
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path))
    assert FileSystemResolver().resolve("package://arm/arm.stl") == mesh


def test_a_package_around_the_file_is_found_by_folder_or_by_package_xml(tmp_path):
    by_folder = mesh_in(tmp_path / "arm")
    assert FileSystemResolver().resolve("package://arm/arm.stl", tmp_path / "arm" / "urdf") == by_folder
    by_xml = mesh_in(tmp_path / "checkout")
    (tmp_path / "checkout" / "package.xml").write_text("<package><name> leg </name></package>")
    assert FileSystemResolver().resolve("package://leg/arm.stl", tmp_path / "checkout") == by_xml


def test_paths_are_absolute_or_relative_to_the_given_folder_or_to_the_current_one(tmp_path, monkeypatch):
    here, there = mesh_in(tmp_path / "here"), mesh_in(tmp_path / "there")
    monkeypatch.chdir(tmp_path / "here")
    resolve = FileSystemResolver().resolve
    assert resolve("arm.stl") == here
    assert resolve("arm.stl", tmp_path / "there") == there
    assert resolve(str(there)) == there
    assert resolve(f"file://{there}") == there


@pytest.mark.parametrize("uri", ["package://arm/arm.stl", "file:///nowhere/arm.stl", "arm.stl", "", "package://"])
def test_what_is_not_there_is_not_found(uri, tmp_path):
    with pytest.raises(FileNotFoundError):
        FileSystemResolver().resolve(uri, tmp_path)


def test_a_package_that_is_named_is_looked_for_there_first(tmp_path):
    for folder in ("named", "found/arm"):
        (tmp_path / folder).mkdir(parents=True)
        (tmp_path / folder / "arm.stl").touch()
    (tmp_path / "found" / "arm" / "leg.stl").touch()
    resolver = FileSystemResolver([tmp_path / "found"], packages={"arm": tmp_path / "named"})
    assert resolver.resolve("package://arm/arm.stl") == tmp_path / "named" / "arm.stl"
    assert resolver.resolve("package://arm/leg.stl") == tmp_path / "found" / "arm" / "leg.stl"


class Fixed:
    """A resolver with one answer."""

    def resolve(self, uri: str, relative_to: Path | None = None) -> Path:
        return Path("/meshes") / uri


def test_a_robot_asks_its_own_resolver_which_is_not_compared():
    robot = Robot("r", resource_resolver=Fixed())
    assert isinstance(Fixed(), IResourceResolver)
    assert robot.resolve_resource("arm.stl") == Path("/meshes/arm.stl")
    assert robot == Robot("r")
    assert isinstance(pickle.loads(pickle.dumps(Robot("r"))).resource_resolver, FileSystemResolver)
