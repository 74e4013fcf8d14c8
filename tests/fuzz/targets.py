"""What is fuzzed: each target takes any bytes, and raises only where linkforge breaks a promise.

The whole compiler is imported by the targets that need it: what is imported is instrumented first, for many seconds.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING
from xml.parsers import expat

from linkforge_compile.diagnostics import BeyondLimitError, Diagnostic, Diagnostics
from linkforge_compile.expressions import RESERVED_NAMES, Scope, evaluate, parse_template
from linkforge_compile.limits import Budget
from linkforge_compile.schema.json_schema import mapping
from linkforge_compile.schema.registry import definitions
from linkforge_compile.source import SourceFile
from linkforge_compile.syntax import read
from linkforge_compile.units import Dimension, Quantity

if TYPE_CHECKING:
    from linkforge_compile import Compilation

ROOT = Path(__file__).parents[2]

CORPUS = Path(__file__).parent / "corpus"
"""What was kept of former runs: what broke a promise once, and what reaches code that no seed reaches."""

Target = Callable[[bytes], None]

_NAMES = {
    "length": Quantity(0.5, Dimension.LENGTH),
    "count": 3,
    "side": "left",
    "sizes": (4, 2, 7),
    "row": {"mass": 2, "limits": {"effort": 9}},
}


def read_yaml(content: bytes) -> None:
    """A text is a tree whose places lie in it, or is refused at one."""
    text = _text(content)
    sink, source = Diagnostics(), SourceFile("a.robot.yaml", text)
    try:
        tree = read(source, sink, Budget())
    except BeyondLimitError:
        return
    assert tree is not None or sink.has_errors
    _lie_inside(text, sink)


def compute_expression(content: bytes) -> None:
    """A template has a value, or is refused at a place."""
    text = _text(content)
    sink, source = Diagnostics(), SourceFile("a.robot.yaml", text)
    budget = Budget()
    try:
        template = parse_template(text, source.whole, sink)
        if template is not None:
            evaluate(template, Scope(_NAMES, budget=budget), sink)
    except BeyondLimitError:
        return


def import_xml(content: bytes) -> None:
    """A robot is a spec that compiles without a fault of YAML or of the schema, or is refused at a place.

    Behind a zero byte, which no XML has, stands the SRDF of the URDF.
    """
    from linkforge_compile import compile_text, import_urdf

    with tempfile.TemporaryDirectory() as folder:
        files = [Path(folder, name) for name in ("a.urdf", "a.srdf")]
        parts = content.split(b"\0", maxsplit=1)
        for path, part in zip(files, parts, strict=False):
            path.write_bytes(part)
        imported = import_urdf(files[0], srdf=files[1] if len(parts) > 1 else None)
    if imported.text is None:
        assert imported.has_errors
        return
    compilation = compile_text(imported.text)
    misread = [one for one in compilation.diagnostics if one.code.id[:3] in ("LF1", "LF2")]
    assert imported.has_errors or not misread, misread
    _is_whole(compilation)


def compile_spec(content: bytes) -> None:
    """A spec is XML, or is refused at a place."""
    from linkforge_compile import compile_text

    text = _text(content)
    compilation = compile_text(text)
    _lie_inside(text, compilation.diagnostics)
    _is_whole(compilation)


TARGETS: dict[str, Target] = {
    "yaml": read_yaml,
    "expression": compute_expression,
    "import": import_xml,
    "compile": compile_spec,
}


def seeds(name: str, shared: Path) -> Iterator[bytes]:
    """Yield what a target begins with: the examples, our cases, and of real robots those that are small."""
    if name in ("yaml", "compile"):
        files = [*(ROOT / "examples").rglob("*.yaml"), *(ROOT / "tests" / "cases").rglob("*.yaml")]
        # What passes a limit takes its ten seconds, and several times as long where it is watched.
        yield from (path.read_bytes() for path in files if not path.name.startswith("LF33"))
    elif name == "import":
        for urdf in (*(ROOT / "tests" / "cases").rglob("*.urdf"), *shared.glob("corpus/*.urdf")):
            srdf = urdf.with_suffix(".srdf")
            yield urdf.read_bytes() + (b"\0" + srdf.read_bytes() if srdf.exists() else b"")
    else:
        specs = [path.read_text("utf-8") for path in (ROOT / "examples").rglob("*.yaml")]
        yield from (line.partition(": ")[2].encode() for text in specs for line in text.splitlines() if "$(" in line)


def words(name: str) -> Iterator[str]:
    """Yield words that a target knows, to be put together."""
    if name == "expression":
        yield from (*RESERVED_NAMES, *_NAMES, "$(", "$$(", "**", "//", "<=", "==", "['", "')")
    elif name == "import":
        yield from (
            "</link>",
            "<link name='a'/>",
            "<joint",
            "<origin xyz='0 0 1'/>",
            "<![CDATA[",
            "<!--",
            "&#10;",
            "xmlns:",
        )
    else:
        for definition in definitions().values():
            yield from mapping(definition.get("properties", {}))
        yield from (": ", "- ", "{", "}", "[", "]", "&a ", "*a", "<<: *a", "|", ">-", "'", '"', "# ", "$(", "!degrees ")


def _text(content: bytes) -> str:
    return content.decode("utf-8", errors="replace")


def _lie_inside(text: str, diagnostics: Diagnostics | tuple[Diagnostic, ...]) -> None:
    lines = text.count("\n") + text.count("\r") + 1
    for diagnostic in diagnostics:
        assert diagnostic.span, diagnostic
        assert 1 <= diagnostic.span.line <= lines, diagnostic


def _is_whole(compilation: Compilation) -> None:
    if compilation.robot is None:
        assert compilation.has_errors
        return
    from linkforge_compile import render_srdf, render_urdf

    for document in (render_urdf(compilation.robot), render_srdf(compilation.robot)):
        # A parser that knows no namespaces: a prefix that nothing declares comes out as it stands, with a warning.
        expat.ParserCreate().Parse(document.encode(), True)
