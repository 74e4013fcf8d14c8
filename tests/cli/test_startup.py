"""Start-up is a budget: what a command does not need, it does not import."""

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


def modules_after(*words: str) -> set[str]:
    code = (
        "import sys\n"
        "from linkforge_compile.cli.main import main\n"
        "try: main(sys.argv[1:])\n"
        "except SystemExit: pass\n"
        "print(*sys.modules, file=sys.stderr)"
    )
    run = subprocess.run([sys.executable, "-c", code, *words], cwd=ROOT, capture_output=True, text=True, check=True)
    return set(run.stderr.split())


@pytest.mark.parametrize("words", [("--version",), ("--help",), ("compile", "--help"), ("check", "--help")])
def test_help_and_version_import_nothing_heavy(words: tuple[str, ...]):
    assert not modules_after(*words) & HEAVY


def test_the_version_is_answered_before_argparse():
    assert not modules_after("--version") & {"argparse", "dataclasses", "importlib.metadata"}


def test_a_robot_is_compiled_without_what_it_does_not_say(tmp_path: Path):
    spec = tmp_path / "plain.robot.yaml"
    spec.write_text(PLAIN, "utf-8")
    imported = modules_after("compile", str(spec), "-o", f"{tmp_path}/")
    assert (tmp_path / "plain.urdf").is_file()
    assert not imported & {"networkx", "lxml", "difflib", "jsonschema", "fractions", "decimal"}
    ours = {module.removeprefix("linkforge_compile.") for module in imported}
    assert not {module for module in ours if any(f"{module}.".startswith(f"{room}.") for room in UNSAID)}


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
