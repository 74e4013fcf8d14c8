"""Samples small robots for tests."""

import json
from pathlib import Path

from tests.cli.in_process import linkforge

HEAD = "linkforge: 1\nname: robot\n"


def reasons_of(spec: str, folder: Path, *options: str) -> dict[tuple[str, str], str]:
    """Return the pairs of a spec that need no check, with their reasons, and 'checked' for the others."""
    (folder / "robot.robot.yaml").write_text(HEAD + spec, "utf-8")
    words = ("robot.robot.yaml", "--json", "--jobs", "1", "--samples", "2000", *options)
    done = linkforge("collisions", *words, cwd=folder)
    assert done.returncode == 0, done.stderr
    document = json.loads(done.stdout)
    found = {(pair["link1"], pair["link2"]): pair["reason"] for pair in document["disabled"]}
    return found | {(pair["link1"], pair["link2"]): "checked" for pair in document["checked"]}
