"""Start-up is a budget: what a command does not need, it does not import."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from linkforge_compile import __version__
from tests.conftest import ROOT

HEAVY = {"jinja2", "jsonschema", "networkx", "lxml", "yaml", "difflib", "numpy"}


PLAIN = """
linkforge: 1
name: plain
links: {base: {}, tip: {inertial: {mass: 1, inertia: {ixx: 1, iyy: 1, izz: 1}}}}
joints:
  turn: {type: revolute, parent: base, child: tip, axis: z, limits: {lower: -1, upper: 1, effort: 1, velocity: 1}}
"""

UNSAID = {
    "backends.srdf_view",
    "backends.template_python",
    "checks.groups",
    "checks.semantic",
    "checks.srdf",
    "checks.states",
    "core.models.gazebo",
    "core.models.merging",
    "core.models.ros2_control",
    "core.models.sensor",
    "core.models.srdf",
    "core.models.transmission",
    "diagnostics.ignores",
    "diagnostics.render.text",
    "diagnostics.selection",
    "expressions",
    "importers",
    "lowering.joining",
    "lowering.module_joint",
    "lowering.mount",
    "lowering.positions",
    "modules.evaluate_tree",
    "modules.expansion",
    "modules.includes",
    "modules.listing",
    "modules.names",
    "modules.overrides",
    "modules.packages",
    "modules.places",
    "modules.variants",
    "modules.xacro",
    "schema.explain",
    "schema.faults",
    "schema.meant",
    "schema.shapes",
    "syntax.ignore_comments",
}
"""Rooms and modules that serve something which PLAIN does not say, or a fault that it does not have."""

TWO = """
linkforge: 1
name: two
parameters: {gap: {type: length, default: 1 m}}
links: {stand: {}}
modules:
  left: {use: plain.robot.yaml, parent: stand, origin: [0, $(gap), 0]}
  right: {use: plain.robot.yaml, parent: stand, origin: [0, $(-gap), 0]}
"""

UNSAID_BY_TWO = {
    "core.models.gazebo",
    "core.models.srdf",
    "importers",
    "lowering.positions",
    "modules.data",
    "modules.defaults",
    "modules.includes",
    "modules.listing",
    "modules.module_overrides",
    "modules.overrides",
    "modules.packages",
    "modules.places",
    "modules.semantic",
    "modules.xacro",
    "schema.explain",
    "schema.faults",
    "schema.meant",
    "syntax.ignore_comments",
}

NEEDLESS = {
    *("jinja2", "networkx", "lxml", "difflib", "jsonschema", "yaml"),
    *("copy", "dataclasses", "decimal", "fractions", "inspect", "random", "shutil"),
}
"""Packages that no robot without faults needs."""


def modules_after(*words: str) -> set[str]:
    code = (
        "import sys\n"
        "from linkforge_compile.cli.main import main\n"
        "try: main(sys.argv[1:])\n"
        "except SystemExit: pass\n"
        "print(*sys.modules, file=sys.stderr)"
    )
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    run = subprocess.run(
        [sys.executable, "-c", code, *words], cwd=ROOT, env=environment, capture_output=True, text=True, check=True
    )
    return set(run.stderr.split())


@pytest.mark.parametrize("words", [("--version",), ("--help",), ("compile", "--help"), ("check", "--help")])
def test_help_and_version_import_nothing_heavy(words: tuple[str, ...]):
    assert not modules_after(*words) & HEAVY


def test_the_version_is_answered_before_argparse():
    assert not modules_after("--version") & {"argparse", "dataclasses", "importlib.metadata"}


def modules_after_compiling(spec: Path) -> set[str]:
    """Return the names of the imported modules, of ours behind that of the package."""
    modules_after("compile", str(spec), "-o", f"{spec.parent}/")  # leaves what of ours is the same in every process
    imported = modules_after("compile", str(spec), "-o", f"{spec.parent}/")
    assert spec.with_name(f"{spec.name.partition('.')[0]}.urdf").is_file()
    return {module.removeprefix("linkforge_compile.") for module in imported}


def within(modules: set[str], rooms: set[str]) -> set[str]:
    return {module for module in modules if any(f"{module}.".startswith(f"{room}.") for room in rooms)}


def test_a_robot_is_compiled_without_what_it_does_not_say(tmp_path: Path):
    (tmp_path / "plain.robot.yaml").write_text(PLAIN, "utf-8")
    assert not within(modules_after_compiling(tmp_path / "plain.robot.yaml"), UNSAID | NEEDLESS)


def test_modules_and_expressions_bring_only_what_they_need(tmp_path: Path):
    (tmp_path / "plain.robot.yaml").write_text(PLAIN, "utf-8")
    (tmp_path / "two.robot.yaml").write_text(TWO, "utf-8")
    assert not within(modules_after_compiling(tmp_path / "two.robot.yaml"), UNSAID_BY_TWO | NEEDLESS)


def test_the_version_is_printed():
    run = subprocess.run(
        [sys.executable, "-m", "linkforge_compile", "--version"], capture_output=True, text=True, check=True
    )
    assert run.stdout == f"linkforge {__version__}\n"


def test_as_a_command_ends_python_does_not_look_for_cycles():
    code = (
        "import sys\n"
        "from linkforge_compile.cli.main import main\n"
        "class Told:\n"
        "    def __init__(self): self.cycle = self\n"
        "    def __del__(self): print('looked for')\n"
        "Told()\n"
        "sys.argv[1:] = ['--version']\n"
        "main()"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout == f"linkforge {__version__}\n"
