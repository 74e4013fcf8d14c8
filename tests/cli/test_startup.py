"""Start-up is a budget: what a command does not need, it does not import."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from linkforge_compile import __version__
from tests.conftest import ROOT

HEAVY = {"jinja2", "jsonschema", "jsonschema_rs", "networkx", "lxml", "yaml", "difflib", "numpy", "re2", "argcomplete"}


PLAIN = """
linkforge: 1
name: plain
links: {base: {}, tip: {inertial: {mass: 1, inertia: {ixx: 1, iyy: 1, izz: 1}}}}
joints:
  turn: {type: revolute, parent: base, child: tip, axis: z, limits: {lower: -1, upper: 1, effort: 1, velocity: 1}}
"""

TWO = """
linkforge: 1
name: two
parameters: {gap: {type: length, default: 1 m}}
links: {stand: {}}
modules:
  left: {use: plain.robot.yaml, parent: stand, origin: [0, $(gap), 0]}
  right: {use: plain.robot.yaml, parent: stand, origin: [0, $(-gap), 0]}
"""

SEMANTIC = """
linkforge: 1
name: semantic
links: {base: , arm: , hand: {inertial: {mass: 1, inertia: {ixx: 1, iyy: 1, izz: 1}}}, left: , right: }
joints:
  turn: {type: revolute, parent: base, child: arm, axis: z, limits: {lower: -1, upper: 1, effort: 1, velocity: 1}}
  wrist: {type: fixed, parent: arm, child: hand}
  pinch: {type: prismatic, parent: hand, child: left, axis: y, limits: {lower: 0, upper: 1, effort: 1, velocity: 1}}
  follow:
    {type: prismatic, parent: hand, child: right, axis: -y, limits: {lower: 0, upper: 1, effort: 1, velocity: 1},
     mimic: {joint: pinch}}
gazebo: [{static: false}]
semantic:
  groups:
    all: {subgroups: [arm, fingers]}
    arm: {chain: {base_link: base, tip_link: hand}}
    fingers: {joints: [pinch]}
  group_states:
    fingers: {open: {pinch: 1 m}}
    all: {ready: {turn: 1, fingers: open}}
  end_effectors: {gripper: {group: fingers, parent_link: hand, parent_group: arm}}
"""
"""A robot whose chains, groups, states, mimics and massless links are all looked at."""

NEEDLESS = {"networkx", "jsonschema", "difflib", "numpy", "trimesh", "re2"}
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
    assert not modules_after("--version") & {"argparse", "importlib.metadata"}


@pytest.mark.parametrize("spec", [PLAIN, TWO, SEMANTIC], ids=["plain", "modules", "semantic"])
def test_a_robot_without_faults_imports_nothing_needless(spec: str, tmp_path: Path):
    (tmp_path / "plain.robot.yaml").write_text(PLAIN, "utf-8")
    (tmp_path / "robot.robot.yaml").write_text(spec, "utf-8")
    imported = modules_after("compile", str(tmp_path / "robot.robot.yaml"), "-o", str(tmp_path / "robot.urdf"))
    assert (tmp_path / "robot.urdf").is_file()
    assert not imported & NEEDLESS


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
