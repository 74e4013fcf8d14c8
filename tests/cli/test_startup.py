"""Start-up is a budget: what a command does not need, it does not import."""

import subprocess
import sys

import pytest

from linkforge_compile import __version__
from tests.conftest import ROOT

HEAVY = {"jinja2", "jsonschema", "networkx", "lxml", "yaml", "difflib", "numpy"}


def modules_after(*words: str) -> set[str]:
    code = (
        "import sys\n"
        "from linkforge_compile.cli.main import main\n"
        "try: main(sys.argv[1:])\n"
        "except SystemExit: pass\n"
        "print(*sys.modules, file=sys.stderr)"
    )
    run = subprocess.run([sys.executable, "-c", code, *words], cwd=ROOT, capture_output=True, text=True, check=True)
    return {module.split(".")[0] for module in run.stderr.split()}


@pytest.mark.parametrize("words", [("--version",), ("--help",), ("compile", "--help"), ("check", "--help")])
def test_help_and_version_import_nothing_heavy(words: tuple[str, ...]):
    assert not modules_after(*words) & HEAVY


def test_the_version_is_answered_before_argparse():
    assert not modules_after("--version") & {"argparse", "dataclasses", "importlib.metadata"}


def test_a_clean_compile_needs_no_networkx_and_no_lxml():
    assert not modules_after("compile", "examples/01_two_link_arm/two_link_arm.robot.yaml") & {
        "networkx",
        "lxml",
        "difflib",
    }


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
