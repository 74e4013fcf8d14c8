"""The set-ups of editors as docs/editors.md has them, and a spec with a mistake to open."""

import os
import re
import sys
from pathlib import Path

from tests.conftest import ROOT

SPEC = """\
linkforge: 1
name: arm
links: {base: , rod: }
joints:
  swing: {type: fixed, parent: base, child: rood}
"""
MESSAGE = "no link named 'rood'; did you mean 'rod'?"
"""What the compiler reports, in line 5."""


def blocks(section: str, language: str) -> list[str]:
    """Return the code in a section of docs/editors.md."""
    text = (ROOT / "docs" / "editors.md").read_text("utf-8")
    body = re.split(rf"^### {section}\n", text, flags=re.MULTILINE)[1].split("\n##")[0]
    return re.findall(rf"^```{language}\n(.*?)^```$", body, flags=re.MULTILINE | re.DOTALL)


def write_spec(folder: Path) -> Path:
    """Write the spec into a repository of its own."""
    (folder / ".git").mkdir()
    spec = folder / "arm.robot.yaml"
    spec.write_text(SPEC, "utf-8")
    return spec


def environment(home: Path) -> dict[str, str]:
    """An environment with `linkforge` on the PATH, and without the settings of who runs the tests."""
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    return {**os.environ, "PATH": path, "HOME": str(home), "XDG_CONFIG_HOME": str(home), "XDG_STATE_HOME": str(home)}
