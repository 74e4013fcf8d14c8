"""What users install: the wheel, with schemas/ and templates/ inside it, away from the repository."""

import os
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from tests.conftest import ROOT

PIP = (sys.executable, "-m", "pip", "--quiet", "--disable-pip-version-check")


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("wheel")
    build = (*PIP, "wheel", "--no-deps", "--no-build-isolation", "--wheel-dir", str(folder), str(ROOT))
    subprocess.run(build, check=True, capture_output=True, timeout=120)
    (path,) = folder.glob("*.whl")
    return path


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


def test_the_installed_command_compiles_and_has_its_schema(wheel: Path, tmp_path: Path):
    subprocess.run((*PIP, "install", "--no-deps", "--target", tmp_path / "site", wheel), check=True, timeout=120)
    env = {**os.environ, "PYTHONPATH": str(tmp_path / "site"), "PYTHONSAFEPATH": "1"}
    example = ROOT / "examples" / "01_two_link_arm"

    def run(*words: str) -> str:
        command = (sys.executable, "-m", "linkforge_compile", *words)
        return subprocess.run(
            command, cwd=tmp_path, env=env, check=True, capture_output=True, timeout=60
        ).stdout.decode()

    where = "import linkforge_compile; print(linkforge_compile.__file__)"
    location = subprocess.run((sys.executable, "-c", where), cwd=tmp_path, env=env, check=True, capture_output=True)
    assert str(tmp_path) in location.stdout.decode()
    assert run("compile", str(example / "two_link_arm.robot.yaml")) == (example / "two_link_arm.urdf").read_text(
        "utf-8"
    )
    assert '"$schema": "http://json-schema.org/draft-07/schema#"' in run("schema")
    assert run("explain", "LF1002") == (ROOT / "docs/diagnostics/LF1002.md").read_text("utf-8")
