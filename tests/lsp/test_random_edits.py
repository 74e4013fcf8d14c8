"""A thousand edits at random: what is reported in the end is about the text in the end, and memory does not grow."""

import random
import shutil
from pathlib import Path

from linkforge_compile.analysis import Settings, analyse_path
from linkforge_compile.expand import Unset
from linkforge_compile.roots import identity
from tests.lsp.editor import Editor

EXAMPLES = Path(__file__).parents[2] / "examples"

EDITS = 1_000
LOOK_EACH = 20
GROWTH = 10
"""What the server may use at the end beyond what it used after a third of the edits [MB]."""


def edited(text: str, whole: str, chance: random.Random) -> str:
    """Return a text with a piece of it gone, a piece of the whole inserted, or, now and then, the whole again."""
    begin = chance.randrange(len(text) + 1)
    match chance.randrange(10):
        case 0:
            return whole
        case 1 | 2 | 3:
            return text[:begin] + text[begin + chance.randrange(30) :]
        case 4 | 5:
            piece = chance.randrange(len(whole))
            return text[:begin] + whole[piece : piece + chance.randrange(60)] + text[begin:]
        case _:
            return (
                text[:begin]
                + chance.choice(["\n", "  ", ":", "{", "]", "$(", "é", "🦾", "- ", "a", "0", "\t"])
                + text[begin:]
            )


def expected(path: Path, text: str) -> list[tuple[str, int]]:
    analysis = analyse_path(path, Settings(options={"gazebo": "gz"}, unset=Unset.NOTE, buffers={identity(path): text}))
    report = analysis.compilation.diagnostics
    return sorted((one.code.id, one.span.line) for one in report if one.span and one.span.file.path == path)


def test_a_thousand_edits_leave_no_stale_diagnostics_and_no_growth(editor: Editor, tmp_path: Path):
    (tmp_path / ".git").mkdir()  # the example uses those beside it: they are one repository
    folder = shutil.copytree(EXAMPLES, tmp_path / "examples") / "09_mobile_manipulator"
    path, chance = folder / "mobile_manipulator.robot.yaml", random.Random(22)
    text = whole = path.read_text("utf-8")
    memory = 0
    for number in range(EDITS):
        text = edited(text, whole, chance)
        editor.open(path, text)
        if number % LOOK_EACH == 0:
            found = [(str(one.code), one.range.start.line + 1) for one in editor.diagnostics(path)]
            assert sorted(found) == expected(path, text), f"edit {number}"
        if number == EDITS // 3:
            memory = editor.memory()
    editor.open(path, whole)
    assert editor.diagnostics(path) == []
    assert editor.memory() < memory + GROWTH
