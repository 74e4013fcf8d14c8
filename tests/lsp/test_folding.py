"""What an editor can fold in a spec."""

from pathlib import Path

import pytest
from lsprotocol import types

from tests.lsp.editor import Editor

ARM = """\
# An arm
# with comments.
linkforge: 1
name: arm
links:
  base:
    visual: {box: [1, 1, 1],
      origin: [0, 0, 1]}

  # the tip
  tip: {}
modules:
  - not
  - a:
      b: 1
description: >
  of two
  lines
"""


def folded(editor: Editor, path: Path, text: str) -> list[tuple[int, int]]:
    """Return the first and last line of each range, counted from 1."""
    document = editor.open(path, text)
    params = types.FoldingRangeParams(document)
    ranges = editor.ask(lambda client: client.text_document_folding_range_async(params)) or []
    return [(one.start_line + 1, one.end_line + 1) for one in ranges]


def test_entries_items_and_comments_fold(editor: Editor, tmp_path: Path):
    found = folded(editor, tmp_path / "arm.robot.yaml", ARM)
    assert found == [(5, 11), (6, 8), (7, 8), (12, 15), (14, 15), (16, 18), (1, 2)]


@pytest.mark.parametrize("line_end", ["\r\n", "\r"])
def test_line_ends_do_not_matter(editor: Editor, tmp_path: Path, line_end: str):
    usual = folded(editor, tmp_path / "arm.robot.yaml", ARM)
    assert folded(editor, tmp_path / "arm.robot.yaml", ARM.replace("\n", line_end)) == usual


def test_a_text_that_does_not_parse_folds_up_to_the_fault(editor: Editor, tmp_path: Path):
    found = folded(editor, tmp_path / "arm.robot.yaml", ARM + "links: [\n  {a: 1]\n")
    assert found == [(5, 11), (6, 8), (7, 8), (12, 15), (14, 15), (16, 18), (19, 20), (1, 2)]
