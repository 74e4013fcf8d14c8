"""What users install: the wheel, with schemas/ and templates/ inside it, away from the repository."""

import os
import shutil
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

import jinja2
import pytest
from jinja2 import ModuleLoader

from linkforge_compile.schema.registry import linked_schema_text
from tests.conftest import ROOT
from tests.programs import program

PIP = (sys.executable, "-m", "pip", "--quiet", "--disable-pip-version-check")


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("wheel")
    build = (*PIP, "wheel", "--no-deps", "--no-build-isolation", "--wheel-dir", str(folder), str(ROOT))
    subprocess.run(build, check=True, capture_output=True, timeout=120)
    (path,) = folder.glob("*.whl")
    return path


@pytest.fixture(scope="module")
def site(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder where the wheel is installed, for `PYTHONPATH`."""
    folder = tmp_path_factory.mktemp("site")
    subprocess.run((*PIP, "install", "--no-deps", "--target", folder, wheel), check=True, timeout=120)
    return folder


def test_the_wheel_is_built_with_the_declared_requirements(wheel: Path, tmp_path: Path):
    build = (*PIP, "wheel", "--no-deps", "--wheel-dir", str(tmp_path), str(ROOT))
    subprocess.run(build, check=True, capture_output=True, timeout=300)
    (isolated,) = tmp_path.glob("*.whl")
    assert set(zipfile.ZipFile(isolated).namelist()) == set(zipfile.ZipFile(wheel).namelist())


def test_every_schema_template_and_page_of_the_manual_is_in_the_wheel(wheel: Path):
    packed = set(zipfile.ZipFile(wheel).namelist())
    for folder, ending in (("schemas", "*.json"), ("templates", "*.j2")):
        files = [path.relative_to(ROOT).as_posix() for path in (ROOT / folder).rglob(ending)]
        assert files
        assert {f"linkforge_compile/_data/{file}" for file in files} <= packed
    manual = {f"linkforge_compile/_data/diagnostics/{path.name}" for path in (ROOT / "docs/diagnostics").glob("LF*.md")}
    assert manual
    assert manual <= packed
    assert "linkforge_compile/_data/linkforge-matcher.json" in packed
    assert not any(name.startswith(("tests/", "examples/", "schemas/")) for name in packed)


def test_every_template_is_in_the_wheel_compiled(wheel: Path):
    packed = set(zipfile.ZipFile(wheel).namelist())
    templates = [path.relative_to(ROOT / "templates").as_posix() for path in (ROOT / "templates").rglob("*.j2")]
    names = {ModuleLoader.get_module_filename(name) for name in templates}
    assert {f"linkforge_compile/_data/compiled_templates/{name}" for name in (*names, "jinja2.txt")} <= packed
    assert not any("_build_hook" in name for name in packed)


def test_the_page_of_the_viewer_is_in_the_wheel_without_its_sources(wheel: Path):
    packed = zipfile.ZipFile(wheel)
    names = packed.namelist()
    page = packed.read("linkforge_compile/_data/view.html").decode()
    assert '<script id="scene" type="application/json">null</script>' in page
    assert "three.js authors" in page  # their licence
    assert not any("node_modules" in name or name.startswith("linkforge_compile/view/page") for name in names)


def built_by_hatchling(source: Path, target: str, folder: Path) -> Path:
    """Return what the build backend makes of a source tree: its wheel or sdist."""
    build = (sys.executable, "-m", "hatchling", "build", "--target", target, "--directory", str(folder))
    subprocess.run(build, cwd=source, check=True, capture_output=True, timeout=120)
    (path,) = folder.iterdir()
    return path


def test_the_sdist_builds_the_same_wheel(wheel: Path, tmp_path: Path):
    sdist = built_by_hatchling(ROOT, "sdist", tmp_path / "sdist")
    with tarfile.open(sdist) as archive:
        archive.extractall(tmp_path / "source", filter="data")
    (source,) = (tmp_path / "source").iterdir()
    assert (source / "linkforge_compile" / "_build_hook.py").is_file()
    page = source / "linkforge_compile" / "view" / "page"
    assert (page / "out" / "view.html").is_file()
    assert not (page / "node_modules").exists()
    assert built_by_hatchling(source, "wheel", tmp_path / "wheel").read_bytes() == wheel.read_bytes()


LOADER = "from linkforge_compile.formats.environment import own_environment as e; print(type(e().loader).__name__)"


def test_an_installed_wheel_uses_its_compiled_templates_as_long_as_they_are_of_this_jinja2(site: Path, tmp_path: Path):
    ours = shutil.copytree(site, tmp_path / "site")

    def run(*words: str) -> str:
        env = {**os.environ, "PYTHONPATH": str(ours), "PYTHONSAFEPATH": "1"}
        command = (sys.executable, *words)
        return subprocess.run(
            command, cwd=tmp_path, env=env, check=True, capture_output=True, timeout=60
        ).stdout.decode()

    example = ROOT / "tests" / "cases" / "good" / "sensors"
    compile_example = ("-m", "linkforge_compile", "compile", str(example / "sensors.robot.yaml"))
    assert run("-c", LOADER) == "ModuleLoader\n"
    by_compiled = run(*compile_example)
    assert by_compiled == (example / "sensors.urdf").read_text("utf-8")
    made_by = ours / "linkforge_compile" / "_data" / "compiled_templates" / "jinja2.txt"
    assert made_by.read_text().strip() == jinja2.__version__
    made_by.write_text("0.0\n")
    assert run("-c", LOADER) == "FileSystemLoader\n"
    assert run(*compile_example) == by_compiled


def test_the_linked_schema_in_the_wheel_is_made_of_the_schemas(wheel: Path):
    with zipfile.ZipFile(wheel) as packed:
        assert packed.read("linkforge_compile/_data/linked_schema.json").decode() == linked_schema_text()


def test_the_installed_command_compiles_and_has_its_schema(site: Path, tmp_path: Path):
    env = {**os.environ, "PYTHONPATH": str(site), "PYTHONSAFEPATH": "1"}
    example = ROOT / "examples" / "01_two_link_arm"

    def run(*words: str) -> str:
        command = (sys.executable, "-m", "linkforge_compile", *words)
        return subprocess.run(
            command, cwd=tmp_path, env=env, check=True, capture_output=True, timeout=60
        ).stdout.decode()

    where = "import linkforge_compile; print(linkforge_compile.__file__)"
    location = subprocess.run((sys.executable, "-c", where), cwd=tmp_path, env=env, check=True, capture_output=True)
    assert str(site) in location.stdout.decode()
    assert run("compile", str(example / "two_link_arm.robot.yaml")) == (example / "two_link_arm.urdf").read_text(
        "utf-8"
    )
    assert '"$schema": "http://json-schema.org/draft-07/schema#"' in run("schema")
    assert run("explain", "LF1002") == (ROOT / "docs/diagnostics/LF1002.md").read_text("utf-8")


def test_cmake_finds_what_pip_installs_and_compiles_with_it(site: Path, tmp_path: Path):
    """As in an environment that is active: its `bin` is on the PATH, and no option names linkforge."""
    source, build = tmp_path / "source", tmp_path / "build"
    source.mkdir()
    (source / "arm.robot.yaml").write_text("linkforge: 1\nname: arm\nlinks: {base: }\n")
    find = "project(arm NONE)\nfind_package(linkforge_compile REQUIRED)\nlinkforge_add_robot(arm.robot.yaml)\n"
    (source / "CMakeLists.txt").write_text(f"cmake_minimum_required(VERSION 3.20)\n{find}")
    path = os.pathsep.join((str(site / "bin"), os.environ["PATH"]))
    env = {**os.environ, "PATH": path, "PYTHONPATH": str(site), "PYTHONSAFEPATH": "1"}
    configure = (program("cmake"), "-S", source, "-B", build, "-G", "Ninja", f"-DCMAKE_MAKE_PROGRAM={program('ninja')}")
    for command in (configure, (program("cmake"), "--build", build)):
        run = subprocess.run(command, env=env, capture_output=True, text=True, check=False, timeout=120)
        assert run.returncode == 0, run.stdout + run.stderr
    assert '<link name="base"/>' in (build / "arm.urdf").read_text("utf-8")
    assert f"LINKFORGE_EXECUTABLE:FILEPATH={site / 'bin' / 'linkforge'}" in (build / "CMakeCache.txt").read_text()
