"""A folder that `linkforge init` wrote, in an editor."""

from pathlib import Path

from tests.cli.test_compile import linkforge
from tests.editor.language_server import LanguageServer


def test_editors_have_its_names_at_once(server: LanguageServer, folder: Path):
    linkforge("init", "fresh", cwd=folder)
    spec = (folder / "fresh/fresh.robot.yaml").read_text()
    assert server.faults(spec, "fresh/fresh.robot.yaml") == []
    document = spec.replace("frames:\n  tool0: {parent: arm,", "frames:\n  tool0: {parent: |,")
    offered = [found.label for found in server.completions(document, "fresh/fresh.robot.yaml")]
    assert offered == ["arm", "base", "base_link", "tool0"]
