"""A folder that `linkforge init` wrote, in an editor."""

import json
from pathlib import Path

import pytest

from tests.cli.in_process import linkforge
from tests.editor.language_server import Fault, LanguageServer

FAULTS = [Fault("visuals", "Property visuals is not allowed.")]


def test_editors_have_its_names_at_once(server: LanguageServer, folder: Path):
    linkforge("init", "fresh", cwd=folder)
    spec = (folder / "fresh/fresh.robot.yaml").read_text()
    assert server.faults(spec, "fresh/fresh.robot.yaml") == []
    document = spec.replace("frames:\n  tool0: {parent: arm,", "frames:\n  tool0: {parent: |,")
    offered = [found.label for found in server.completions(document, "fresh/fresh.robot.yaml")]
    assert offered == ["arm", "base", "base_link", "tool0"]


@pytest.mark.parametrize("folder", [".", "robots"])
def test_the_settings_alone_give_a_second_spec_the_schema(server_command: list[str], tmp_path: Path, folder: str):
    (tmp_path / ".git").mkdir()
    linkforge("init", "arm", "--dir", folder, cwd=tmp_path)
    settings = json.loads((tmp_path / ".vscode/settings.json").read_text())
    server = LanguageServer(server_command, tmp_path, {"schemas": settings["yaml.schemas"]})
    try:
        text = "linkforge: 1\nname: other\nlinks:\n  base: {visuals: {}}\n"
        assert server.faults(text, "beside/other.robot.yaml") == ([] if folder == "robots" else FAULTS)
        assert server.faults(text, f"{folder}/other.robot.yaml") == FAULTS
        assert server.faults(text, f"{folder}/deep/other.robot.yaml") == FAULTS
    finally:
        server.close()
