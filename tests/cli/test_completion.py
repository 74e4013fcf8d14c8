"""`linkforge completion`: what shells offer, as bash, zsh and fish ask for it, and as a person types it."""

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from tests.cli.in_process import linkforge

pexpect = pytest.importorskip("pexpect", reason="pexpect, with which shells are driven, does not exist for Windows")

LINKFORGE = Path(sys.executable).with_name("linkforge")

ARM = """\
linkforge: 1
name: arm
parameters:
  reach: {type: length, default: 0.5 m, minimum: 0.1 m, description: Length of the upper arm.}
  hardware: {type: string, default: none, enum: [none, mock, real]}
  has_gripper: {type: boolean, default: true}
variants: {sim: {hardware: mock}, lab: {hardware: real}}
links: {base: , upper: , "tool/flange": }
joints:
  elbow: {type: revolute, parent: base, child: upper, axis: y, limits: {lower: -1, upper: 1, effort: 5, velocity: 1}}
  wrist: {type: fixed, parent: upper, child: tool/flange, origin: ["$(reach)", 0, 0]}
semantic: {groups: {arm: {joints: [elbow]}}, group_states: {arm: {up: {elbow: 1}}}}
"""

HAND = """\
<robot name="hand" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:arg name="side" default="left"/></robot>
"""


@pytest.fixture(scope="module")
def robots(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("robots")
    (folder / "arm.robot.yaml").write_text(ARM, "utf-8")
    (folder / "broken.robot.yaml").write_text("linkforge: 1\nparameters: {reach: [}\n", "utf-8")
    (folder / "an old one.urdf").write_text('<robot name="old"><link name="base"/></robot>', "utf-8")
    (folder / "hand.xacro").write_text(HAND, "utf-8")
    (folder / "notes.yaml").write_text("", "utf-8")
    (folder / "meshes").mkdir()
    (folder / ".git").mkdir()
    compiled = linkforge("compile", "arm.robot.yaml", "-o", "build/", cwd=folder)
    assert compiled.returncode == 0, compiled.stderr
    return folder


def offered(line: str, folder: Path, command: tuple[str | Path, ...] = (LINKFORGE,)) -> dict[str, str]:
    """Return what the command answers to a shell about the end of a line, with the descriptions."""
    answer = folder.parent / "answer"
    answer.write_text("", "utf-8")
    environment = {
        **os.environ,
        "_ARGCOMPLETE": "1",
        "_ARGCOMPLETE_SHELL": "fish",
        "_ARGCOMPLETE_IFS": "\n",
        "_ARGCOMPLETE_DFS": "\t",
        "_ARGCOMPLETE_SUPPRESS_SPACE": "1",
        "_ARGCOMPLETE_STDOUT_FILENAME": str(answer),
        "COMP_LINE": line,
        "COMP_POINT": str(len(line.encode())),
    }
    subprocess.run(command, cwd=folder, env=environment, stdout=subprocess.DEVNULL, check=False)
    rows = (row.partition("\t") for row in answer.read_text("utf-8").splitlines())
    return {name: about for name, _, about in rows}


FILES = ["an old one.urdf", "arm.robot.yaml", "broken.robot.yaml", "build/", "hand.xacro", "meshes/"]
PARAMETERS = ["reach:=", "hardware:=", "has_gripper:="]


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("linkforge compi", ["compile"]),
        ("linkforge compile ", FILES),
        ("linkforge compile me", ["meshes/"]),
        ("linkforge compile ./a", ["./an old one.urdf", "./arm.robot.yaml"]),
        ("linkforge compile arm.robot.yaml ", [*PARAMETERS, *FILES]),
        ("linkforge compile arm.robot.yaml -o build/ re", ["reach:="]),
        ("linkforge compile arm.robot.yaml reach:=1m ha", ["hardware:=", "has_gripper:=", "hand.xacro"]),
        ("linkforge watch arm.robot.yaml ", PARAMETERS),
        ("linkforge compile arm.robot.yaml hardware:=", ["hardware:=none", "hardware:=mock", "hardware:=real"]),
        ("linkforge compile arm.robot.yaml hardware:=m", ["hardware:=mock"]),
        ("linkforge expand arm.robot.yaml has_gripper:=f", ["has_gripper:=false"]),
        ("linkforge compile arm.robot.yaml reach:=", []),
        ("linkforge compile arm.robot.yaml -p ha", ["hardware=", "has_gripper="]),
        ("linkforge compile arm.robot.yaml -p hardware=r", ["hardware=real"]),
        ("linkforge compile arm.robot.yaml -p hardware=mock h", ["has_gripper:=", "hand.xacro"]),
        ("linkforge import hand.xacro ", ["side:="]),
        ("linkforge check arm.robot.yaml --variant ", ["sim", "lab"]),
        ("linkforge check arm.robot.yaml --variant sim+l", ["sim+lab"]),
        ("linkforge compile arm.robot.yaml --format m", ["mjcf", "moveit"]),
        ("linkforge compile --format=mj", ["--format=mjcf"]),
        ("linkforge check --for mj", ["mjcf"]),
        ("linkforge check --color a", ["auto", "always"]),
        ("linkforge check --ignore LF5001,LF2101", ["LF5001,LF2101"]),
        ("linkforge compile --package arm=m", ["arm=meshes/"]),
        ("linkforge view arm.robot.yaml -o arm.png --pose ", ["arm/up", "elbow="]),
        ("linkforge collisions arm.robot.yaml --pose ", ["arm/up"]),
        ("linkforge view arm.robot.yaml --show frames,ax", ["frames,axes"]),
        ("linkforge init --dir ", ["build/", "meshes/"]),
        ("linkforge formats sd", ["sdf"]),
        ("linkforge explain LF2101", ["LF2101"]),
        ("linkforge explain arm.robot.yaml jo", ["joints/"]),
        ("linkforge explain arm.robot.yaml joints/e", ["joints/elbow/"]),
        ("linkforge explain arm.robot.yaml joints/elbow/limits/e", ["joints/elbow/limits/effort"]),
        ("linkforge explain arm.robot.yaml links/to", ["links/tool/flange/"]),
        ("linkforge explain arm.robot.yaml links/tool/f", ["links/tool/flange/"]),
        ("linkforge explain arm.robot.yaml joints/none/", []),
        ("linkforge where build/arm.urdf e", ["elbow"]),
        ("linkforge completion ", ["bash", "zsh", "fish"]),
        ("linkforge compile broken.robot.yaml re", []),
        ("linkforge explain broken.robot.yaml jo", []),
        ("linkforge compile missing.robot.yaml re", []),
        ("linkforge compile arm.robot.yaml --package nowhere re", []),
        (
            "linkforge format arm.robot.yaml ",
            ["arm.robot.yaml", "broken.robot.yaml", "notes.yaml", "build/", "meshes/"],
        ),
        ("linkforge params arm.robot.yaml ", []),
        ("linkforge nothing ", []),
        ("cd linkforge && linkforge compile arm.robot.yaml rea", ["reach:="]),
        ("linkforge compile ../linkforge rea", []),
    ],
)
def test_a_shell_is_answered(line: str, expected: list[str], robots: Path):
    assert sorted(offered(line, robots)) == sorted(expected)


def test_options_are_offered_from_a_dash_on(robots: Path):
    found = offered("linkforge check arm.robot.yaml --", robots)
    assert {"--for", "--strict", "--all-variants", "--variant"} <= set(found)
    assert not [name for name in found if not name.startswith("--")]


def test_completions_have_descriptions(robots: Path):
    assert offered("linkforge compile arm.robot.yaml re", robots) == {"reach:=": "Length of the upper arm."}
    assert offered("linkforge check arm.robot.yaml --variant s", robots) == {"sim": "hardware=mock"}
    assert offered("linkforge compi", robots) == {"compile": "compile a spec to URDF, SRDF and other formats"}


SLOW = """
import sys, time
from linkforge_compile import pipeline
from linkforge_compile.cli import completion
from linkforge_compile.cli.main import main

completion.PATIENCE = 0.1
pipeline.parameters_of = lambda *_, **__: time.sleep(60)
sys.argv[1:] = []
main()
"""


def test_a_spec_that_is_read_slowly_completes_nothing(robots: Path):
    assert offered("linkforge compile ar", robots, (sys.executable, "-c", SLOW)) == {"arm.robot.yaml": ""}
    assert offered("linkforge compile arm.robot.yaml ar", robots, (sys.executable, "-c", SLOW)) == {}


Complete = Callable[[str], str]


def lines_of_help(shell: str) -> list[str]:
    """Return the commands with which `--help` sets a shell up."""
    shown = linkforge("completion", "--help", cwd=Path()).stdout
    return re.findall(
        r"^    (.*)$", re.search(rf"^  {shell}.*:\n((?:    .*\n)+)", shown, re.MULTILINE)[1], re.MULTILINE
    )


START = {"bash": "bash --norc --noprofile -i", "zsh": "zsh -f -i", "fish": "fish -i"}
READ_CONFIGURATION = {
    "bash": "test -e {package} && . {package} || . {script}; bind 'set bell-style none'",
    "zsh": "unsetopt zle_bracketed_paste; bindkey -e; fpath+=~/.zfunc; autoload -U compinit; compinit -u -D",
    "fish": "set -g fish_autosuggestion_enabled 0",
}
FOR_BASH = {
    "package": "/usr/share/bash-completion/bash_completion",
    "script": "~/.local/share/bash-completion/completions/linkforge",
}


@pytest.fixture(scope="module", params=["bash", "zsh", "fish"])
def complete(
    request: pytest.FixtureRequest, robots: Path, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Complete]:
    """Yield a function that types a line and a tab into a shell, and returns the line that is then there.

    The shell is set up by the commands that `--help` prints.
    """
    name = request.param
    if shutil.which(name) is None:
        pytest.skip(f"{name} is not installed")
    path = f"{LINKFORGE.parent}{os.pathsep}{os.environ['PATH']}"
    home = tmp_path_factory.mktemp("home")
    environment = {**os.environ, "PATH": path, "HOME": str(home), "TERM": "dumb"}
    for variable in ("XDG_DATA_HOME", "XDG_CONFIG_HOME", "ZDOTDIR"):
        environment.pop(variable, None)
    for line in lines_of_help(name):
        subprocess.run([name, "-c", line], env=environment, check=True)
    shell = pexpect.spawn(
        START[name], cwd=str(robots), env=environment, encoding="utf-8", dimensions=(50, 500), timeout=20
    )
    shell.send(f"{READ_CONFIGURATION[name].format_map(FOR_BASH)}; echo is' 'ready\r")
    shell.expect_exact("is ready")

    def typed(line: str) -> str:
        # Ctrl-A and Ctrl-E lead to both ends of the line, to have it printed instead of run. The `@` is where the
        # cursor is; without a further letter zsh removes the space before it again.
        shell.send(f"{line}\t@\x01echo '[\x05]'\r")
        shell.expect(r"\n(?:\x1b\[\?2004l)?\[(.*?)\]\s")
        return re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", shell.match[1])

    yield typed
    shell.close(force=True)


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("linkforge expl", "linkforge explain @"),
        ("linkforge check --all-v", "linkforge check --all-variants @"),
        ("linkforge compile ar", "linkforge compile arm.robot.yaml @"),
        ("linkforge compile me", "linkforge compile meshes/@"),
        ("linkforge compile an", "linkforge compile an\\ old\\ one.urdf @"),
        ("linkforge compile note", "linkforge compile note@"),
        ("linkforge compile arm.robot.yaml rea", "linkforge compile arm.robot.yaml reach:=@"),
        ("linkforge compile arm.robot.yaml -o build rea", "linkforge compile arm.robot.yaml -o build reach:=@"),
        ("linkforge compile arm.robot.yaml hardware:=m", "linkforge compile arm.robot.yaml hardware:=mock @"),
        ("linkforge compile arm.robot.yaml -p hardware=m", "linkforge compile arm.robot.yaml -p hardware=mock @"),
        ("linkforge check --for mj", "linkforge check --for mjcf @"),
        ("linkforge explain arm.robot.yaml joints/el", "linkforge explain arm.robot.yaml joints/elbow/@"),
        ("linkforge compile broken.robot.yaml rea", "linkforge compile broken.robot.yaml rea@"),
    ],
)
def test_a_shell_completes_what_is_typed(complete: Complete, line: str, expected: str):
    assert complete(line) == expected


@pytest.mark.parametrize(
    ("shell", "line"), [("bash", 'eval "$({})"'), ("zsh", 'eval "$({})"'), ("fish", "{} | source")]
)
def test_help_has_the_line_for_the_present_shell(shell: str, line: str, tmp_path: Path):
    shown = linkforge("completion", "--help", cwd=tmp_path).stdout
    assert f"  {line.format(f'linkforge completion {shell}')}\n" in shown
