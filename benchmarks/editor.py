"""Measure how long the language server takes per keystroke, from the message sent to the answer received.

    python benchmarks/editor.py [--python PYTHON] [--rounds 3] [SPEC]

Types lines into a spec a character at a time, at the end of each of its links. After each character it requests
completions, and every tenth one waits for the diagnostics of that text, whose time includes the server's pause for
further keystrokes. PYTHON runs the server, such as that of an environment with the installed wheel.

    python benchmarks/editor.py --edits 6000

prints the memory of the server after each tenth of as many edits at random, which is to be flat after the first.
"""

from __future__ import annotations

import argparse
import random
import re
import statistics
import sys
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

from lsprotocol import types

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from tests.lsp.editor import Editor  # noqa: E402 the repository is not on the path before
from tests.lsp.test_random_edits import LOOK_EACH, edited  # noqa: E402

SPEC = ROOT / "examples/09_mobile_manipulator/mobile_manipulator.robot.yaml"
LINES = ("    visual:", "      box: [1 m, 2 m, $(2 * pi)]", "    inertial: {mass: 5 kg}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("spec", type=Path, nargs="?", default=SPEC, metavar="SPEC")
    parser.add_argument("--python", default=sys.executable)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--edits", type=int, default=0)
    arguments = parser.parse_args()
    spec = arguments.spec.resolve()
    with Editor(spec.parents[1], python=arguments.python) as editor:
        editor.open(spec)
        editor.diagnostics(spec)
        if arguments.edits:
            report_memory(editor, spec, arguments.edits)
            return
        completions, diagnostics = [], []
        for text, position in arguments.rounds * list(typed(spec.read_text("utf-8"))):
            begin = time.perf_counter()
            document = editor.open(spec, text)
            complete(editor, document, position)
            completions.append(time.perf_counter() - begin)
            if len(completions) % 10 == 0:
                editor.diagnostics(spec)
                diagnostics.append(time.perf_counter() - begin)
    report("completion", completions)
    report("diagnostics", diagnostics)


def report_memory(editor: Editor, spec: Path, edits: int) -> None:
    """Edit a spec at random, and print the memory of the server ten times."""
    text = whole = spec.read_text("utf-8")
    chance = random.Random(22)
    for number in range(edits + 1):
        if number % (edits // 10) == 0:
            print(f"{number} edits: {editor.memory():.1f} MB", flush=True)
        text = edited(text, whole, chance)
        editor.open(spec, text)
        if number % LOOK_EACH == 0:
            editor.diagnostics(spec)


def typed(text: str) -> Iterator[tuple[str, types.Position]]:
    """Yield the text after each character of new lines at the end of `links`, and the position after it."""
    links = re.search(r"^links:\n((?:[ \t#].*\n|\n)*)", text, re.MULTILINE)
    assert links is not None, "the spec has links in block style"
    before, after = f"{text[: links.end()]}  typed:\n", text[links.end() :]
    for line in LINES:
        for length in range(1, len(line) + 1):
            position = types.Position(before.count("\n"), length)
            yield f"{before}{line[:length]}\n{after}", position
        before += f"{line}\n"


def complete(editor: Editor, document: types.TextDocumentIdentifier, position: types.Position) -> None:
    params = types.CompletionParams(document, position)
    editor.ask(lambda client: client.text_document_completion_async(params))


def report(what: str, seconds: Sequence[float]) -> None:
    median, last = statistics.median(seconds), statistics.quantiles(seconds, n=20)[-1]
    print(f"{what}: median {median * 1000:.0f} ms, 95th percentile {last * 1000:.0f} ms, {len(seconds)} times")


if __name__ == "__main__":
    main()
