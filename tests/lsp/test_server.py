"""What a server lives through: cancelled requests, files that do not matter, links, and odd options."""

import time
from pathlib import Path

import pytest
from lsprotocol import types

from tests.lsp.editor import Editor
from tests.lsp.test_diagnostics import ARM

WRONG = ARM.replace("tip: {}", "tip: {nonsense_key: 1}")


def test_a_cancelled_request_loses_no_diagnostics(editor: Editor, tmp_path: Path):
    file = tmp_path / "arm.robot.yaml"
    editor.open(file, ARM)
    assert editor.diagnostics(file) == []
    for number in range(5):
        document = editor.open(file, f"{WRONG}# {number}\n")
        editor.cancel("textDocument/documentSymbol", types.DocumentSymbolParams(document), after=0.02)
        assert [one.code for one in editor.diagnostics(file)] == ["LF2101"]


def test_files_that_no_spec_reads_postpone_nothing(editor: Editor, tmp_path: Path):
    file = tmp_path / "arm.robot.yaml"
    editor.open(file, WRONG)
    begin = time.monotonic()
    while time.monotonic() - begin < 1:
        editor.notify_files([types.FileEvent((tmp_path / "build" / "x.o").as_uri(), types.FileChangeType.Changed)])
        time.sleep(0.03)
    waited = time.monotonic()
    assert editor.diagnostics(file)
    assert time.monotonic() - waited < 0.05


def test_a_file_that_is_open_by_two_paths_has_its_diagnostics_at_both(editor: Editor, tmp_path: Path):
    file, link = tmp_path / "arm.robot.yaml", tmp_path / "link.robot.yaml"
    file.write_text(WRONG)
    link.symlink_to(file)
    editor.open(file)
    assert editor.diagnostics(file)
    editor.open(link)
    assert editor.diagnostics(link)
    assert editor.diagnostics(file)
    editor.close(link)
    editor.open(file, ARM.replace("child: tip", "child: top"))
    assert editor.diagnostics(file)


@pytest.mark.parametrize("options", [{"packages": None}, {"packages": [1]}, {"packages": {"a": 3}}, {"inlayHints": 1}])
def test_odd_options_are_ignored(tmp_path: Path, options: dict[str, object]):
    with Editor(tmp_path, options=options) as editor:
        editor.open(tmp_path / "arm.robot.yaml", ARM)
        assert editor.diagnostics(tmp_path / "arm.robot.yaml") == []


def test_an_unsaved_file_that_a_spec_includes_may_have_any_name(editor: Editor, tmp_path: Path):
    whole, part = tmp_path / "arm.robot.yaml", tmp_path / "links.yaml"
    part.write_text("linkforge: 1\nlinks: {tip: {}}\n")
    editor.open(whole, ARM.replace("  tip: {}\n", "").replace("links:", "include: [links.yaml]\nlinks:"))
    assert editor.diagnostics(whole) == []
    editor.open(part, "linkforge: 1\nlinks: {top: {}}\n")
    assert "LF4102" in [one.code for one in editor.published(whole, bool)]


def test_a_document_that_is_no_file_is_left_alone(editor: Editor):
    for uri in ("untitled:Untitled-1", "file:///tmp/x%00y.robot.yaml"):
        item = types.TextDocumentItem(uri, "yaml", 1, ARM)
        editor.send(lambda client, item=item: client.text_document_did_open(types.DidOpenTextDocumentParams(item)))
        params = types.DocumentSymbolParams(types.TextDocumentIdentifier(uri))
        found = editor.ask(lambda client, params=params: client.text_document_document_symbol_async(params))
        assert not found
