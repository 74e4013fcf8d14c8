"""linkforge as a package of colcon, rosdep and conda, whose own programs read these files."""

import re
import subprocess
import tomllib
from pathlib import Path

import pytest
import yaml
from lxml import etree
from packaging.requirements import Requirement

from linkforge_compile._version import __version__
from tests.conftest import ROOT
from tests.programs import program

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
REQUIRED = {one.name: one for one in map(Requirement, PROJECT["dependencies"])}
MANIFEST = etree.parse(ROOT / "package.xml").getroot()
PACKAGING = ROOT / "docs" / "packaging"
KEYS = yaml.safe_load((PACKAGING / "rosdep.yaml").read_text("utf-8"))

KEYS_OF_ROS = {"argcomplete", "jinja2", "jsonschema", "lxml", "networkx", "yaml"}
"""What distributions package; the names of these keys of rosdep are `python3-` and this."""


def key_of(requirement: str) -> str:
    """Return the key of rosdep for a package on PyPI."""
    name = requirement.removeprefix("py") if requirement == "pyyaml" else requirement
    return f"python3-{name}" if name in KEYS_OF_ROS else f"python3-{name}-pip"


def test_the_manifest_has_the_version_and_every_requirement():
    assert MANIFEST.findtext("version") == __version__
    assert sorted(one.text for one in MANIFEST.findall("exec_depend")) == sorted(map(key_of, REQUIRED))


def test_rosdep_knows_the_keys_that_ros_does_not_have():
    ours = {key for key in map(key_of, REQUIRED) if key.endswith("-pip")}
    assert {*KEYS} == ours | {"python3-linkforge-compile-pip", "linkforge_compile"}
    for key in ours:
        for rule in KEYS[key].values():
            assert rule == {"pip": {"packages": [key.removeprefix("python3-").removesuffix("-pip")]}}


def test_conda_reads_the_recipe_which_has_every_requirement():
    rattler_build = pytest.importorskip("rattler_build")
    recipe = rattler_build.Stage0Recipe.from_file(str(PACKAGING / "conda" / "recipe.yaml"))
    (variant,) = recipe.render(rattler_build.VariantConfig(), rattler_build.RenderConfig())
    rendered = variant.recipe.to_dict()
    assert rendered["package"] == {"name": PROJECT["name"], "version": __version__}
    assert (PACKAGING / "conda" / rendered["source"][0]["path"]).resolve() == ROOT
    needed = {Requirement(one).name: Requirement(one).specifier for one in rendered["requirements"]["run"]}
    assert str(needed.pop("python")) == PROJECT["requires-python"]
    assert needed == {name: one.specifier for name, one in REQUIRED.items()}
    scripts = [f"{name} = {function}" for name, function in PROJECT["scripts"].items()]
    assert rendered["build"]["python"]["entry_points"] == scripts


@pytest.mark.parametrize("options", [[], ["--symlink-install"]], ids=["copied", "linked"])
def test_colcon_builds_the_package_and_its_environment_has_the_command(options: list[str], tmp_path: Path):
    source = tmp_path / "src" / "linkforge"
    source.parent.mkdir()
    source.symlink_to(ROOT)
    build = [program("colcon"), "build", "--base-paths", source, *options]
    built = subprocess.run(build, cwd=tmp_path, capture_output=True, text=True, timeout=300, check=False)
    assert built.returncode == 0, built.stdout + built.stderr
    robot = ROOT / "examples" / "01_two_link_arm" / "two_link_arm.robot.yaml"
    script = f"source install/setup.bash && command -v linkforge && linkforge compile {robot}"
    shell = ["bash", "-c", script]
    compiled = subprocess.run(shell, cwd=tmp_path, capture_output=True, text=True, timeout=60, check=True)
    command, _, urdf = compiled.stdout.partition("\n")
    assert Path(command).is_relative_to(tmp_path / "install")
    assert urdf == robot.with_suffix("").with_suffix(".urdf").read_text("utf-8")
    prefix = tmp_path / "install" / "linkforge_compile"
    assert (prefix / "share/ament_index/resource_index/packages/linkforge_compile").exists()
    assert (prefix / "share/linkforge_compile/cmake/linkforge_compileConfig.cmake").exists()
    warned = re.sub(r"warning: install_lib: byte-compiling is disabled, skipping\.", "", built.stderr)
    assert "WARNING" not in warned
