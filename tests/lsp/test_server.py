"""What a server lives through: cancelled requests, files that do not matter, links, and odd options."""

import asyncio
import time
from pathlib import Path

import pytest
from lsprotocol import types

from linkforge_compile.analysis import Analysis, Settings, analyse_path
from linkforge_compile.lsp.features import make_server
from linkforge_compile.lsp.server import SpecServer
from linkforge_compile.lsp.workspace import Workspace
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


def test_what_is_done_of_a_notification_is_forgotten(tmp_path: Path):
    """pygls 2.1 keeps it, 3 kB for each edit."""

    async def edit() -> int:
        server = make_server()
        protocol = server.protocol
        item = types.TextDocumentItem((tmp_path / "arm.robot.yaml").as_uri(), "yaml", 1, ARM)
        protocol.handle_message(types.InitializeRequest("first", types.InitializeParams(types.ClientCapabilities())))
        protocol.handle_message(types.DidOpenTextDocumentNotification(types.DidOpenTextDocumentParams(item)))
        for version in range(2, 10):
            document = types.VersionedTextDocumentIdentifier(version, item.uri)
            change = types.TextDocumentContentChangeWholeDocument(f"{ARM}# {version}\n")
            params = types.DidChangeTextDocumentParams(document, [change])
            protocol.handle_message(types.DidChangeTextDocumentNotification(params))
        await asyncio.sleep(0.05)
        assert server.specs.buffers
        return len(protocol._request_futures)

    assert asyncio.run(edit()) == 0


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


@pytest.mark.parametrize("method", ["foldingRange", "formatting", "semanticTokens/full", "completion"])
def test_a_text_that_is_nested_far_too_deep_is_answered_at_once(editor: Editor, tmp_path: Path, method: str):
    """The parser would need minutes for it."""
    document = editor.open(tmp_path / "arm.robot.yaml", f"a: {'[' * 300_000}{']' * 300_000}\n")
    place = types.Position(0, 300_000)
    params: object = {
        "foldingRange": types.FoldingRangeParams(document),
        "formatting": types.DocumentFormattingParams(document, types.FormattingOptions(2, insert_spaces=True)),
        "semanticTokens/full": types.SemanticTokensParams(document),
        "completion": types.CompletionParams(document, place),
    }[method]
    begin = time.monotonic()
    editor.ask(lambda client: asyncio.wrap_future(client.protocol.send_request(f"textDocument/{method}", params)))
    assert time.monotonic() - begin < 10


def test_cancelled_requests_leave_no_trace_in_the_log(tmp_path: Path):
    with Editor(tmp_path) as editor:
        document = editor.open(tmp_path / "arm.robot.yaml", ARM)
        for number in range(100):
            editor.open(tmp_path / "arm.robot.yaml", f"{ARM}# {number}\n")
            after = number % 5 * 0.005
            editor.cancel("textDocument/documentSymbol", types.DocumentSymbolParams(document), after=after)
    assert editor.log() == ""


def test_the_server_ends_with_its_editor_although_an_analysis_runs(tmp_path: Path):
    links = "".join(f"  l{number}: {{visual: {{box: [1, 1, $({number} + 1)]}}}}\n" for number in range(20_000))
    with Editor(tmp_path) as editor:
        editor.open(tmp_path / "arm.robot.yaml", f"linkforge: 1\nname: arm\nlinks:\n{links}")
        time.sleep(1)
        begin = time.monotonic()
    assert time.monotonic() - begin < 1.5


def test_a_spec_that_is_closed_during_its_analysis_is_forgotten(tmp_path: Path):
    specs, path = Workspace(), tmp_path / "arm.robot.yaml"
    specs.put(path, 1, ARM)
    settings = specs.begin(path)
    specs.close(path)
    specs.keep(path, analyse_path(path, settings))
    assert (specs.analyses, specs.readable, specs.pending()) == ({}, {}, ())


def test_a_fault_of_the_compiler_in_one_spec_leaves_the_others(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    server, good, bad = SpecServer(), tmp_path / "good.robot.yaml", tmp_path / "bad.robot.yaml"
    shown: list[str] = []

    def analyse(path: Path, settings: Settings) -> Analysis:
        if path == bad:
            raise ZeroDivisionError
        return analyse_path(path, settings)

    monkeypatch.setattr("linkforge_compile.lsp.server.analyse_path", analyse)
    monkeypatch.setattr(server, "report_server_error", lambda error, _: shown.append(type(error).__name__))
    monkeypatch.setattr(server, "_publish", lambda: shown.append("published"))

    async def run() -> None:
        for path in (bad, good):
            server.specs.put(path, 1, ARM)
        server.schedule(0)
        while "published" not in shown:
            await asyncio.sleep(0.01)

    asyncio.run(asyncio.wait_for(run(), 60))
    assert shown == ["ZeroDivisionError", "published"]
    assert server.specs.analyses[str(good)].robot is not None
