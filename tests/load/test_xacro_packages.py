"""Test which folder `$(find NAME)` of a xacro is: that of the sourced environment or of the source tree."""

import os
from pathlib import Path

import pytest

from linkforge_compile import compile_file

MAIN = """\
<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:include filename="$(find arm)/urdf/parts.xacro"/>
  <link name="base"/>
</robot>
"""


def parts(link: str) -> str:
    joint = f'<joint name="j" type="fixed"><parent link="base"/><child link="{link}"/></joint>'
    return f'<robot><link name="{link}"/>{joint}</robot>'


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return the source tree of the package `arm`, which is also installed in an environment that is sourced."""
    source, installed = tmp_path / "src" / "arm", tmp_path / "install" / "share" / "arm"
    for folder in (source / "description" / "urdf", source / "urdf", installed / "urdf"):
        folder.mkdir(parents=True)
    for folder in (source, installed):
        (folder / "package.xml").write_text("<package><name>arm</name></package>")
    (source / "description" / "urdf" / "arm.urdf.xacro").write_text(MAIN)
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path / "install"))
    return source


def links(package: Path, **packages: Path) -> set[str]:
    compilation = compile_file(package / "description" / "urdf" / "arm.urdf.xacro", packages=packages)
    return {link.name for link in compilation.result().links} - {"base"}


def in_environment(package: Path) -> Path:
    return package.parents[1] / "install" / "share" / "arm" / "urdf" / "parts.xacro"


def test_the_sourced_environment_comes_first_as_for_xacro(package: Path):
    (package / "urdf" / "parts.xacro").write_text(parts("of_the_source"))
    in_environment(package).write_text(parts("installed"))
    assert links(package) == {"installed"}


def test_what_cmake_installs_elsewhere_is_found_in_the_environment(package: Path):
    in_environment(package).write_text(parts("installed"))
    assert links(package) == {"installed"}


def test_a_file_that_is_not_installed_yet_is_read_from_the_source_tree(package: Path):
    (package / "urdf" / "parts.xacro").write_text(parts("of_the_source"))
    assert links(package) == {"of_the_source"}


def test_the_source_tree_serves_without_an_environment(package: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv("AMENT_PREFIX_PATH", os.devnull)
    (package / "urdf" / "parts.xacro").write_text(parts("of_the_source"))
    assert links(package) == {"of_the_source"}


def test_a_package_that_the_user_names_comes_before_both(package: Path, tmp_path: Path):
    in_environment(package).write_text(parts("installed"))
    own = tmp_path / "own"
    (own / "urdf").mkdir(parents=True)
    (own / "urdf" / "parts.xacro").write_text(parts("named"))
    assert links(package, arm=own) == {"named"}


def test_a_file_that_no_folder_has_is_reported_where_it_is_looked_for_first(package: Path):
    [missing] = compile_file(package / "description" / "urdf" / "arm.urdf.xacro").diagnostics
    assert missing.code.id == "LF8064"
    assert "install/share/arm/urdf/parts.xacro" in Path(missing.message).as_posix()
