"""The page that lists what is checked: it has every code of a check in the column of its severity."""

import ast
import re
from collections.abc import Iterator
from importlib import import_module

from linkforge_compile.diagnostics.codes import REGISTER
from tests.conftest import ROOT

PAGE = (ROOT / "docs" / "checks.md").read_text("utf-8")
ROWS = [row.split("|")[1:-1] for row in PAGE.splitlines() if row.startswith("| ") and "](diagnostics/" in row]
LINK = re.compile(r"\[(LF\d{4})\]\(diagnostics/(LF\d{4})\.md\)")


def codes_of_checks() -> Iterator[str]:
    """Yield the codes that a check imports."""
    for path in (ROOT / "linkforge_compile" / "checks").glob("*.py"):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith(
                "linkforge_compile.diagnostics.codes"
            ):
                module = import_module(node.module or "")
                yield from (getattr(module, name.name).id for name in node.names)


def test_every_code_of_a_check_is_on_the_page():
    reported = {*codes_of_checks()}
    assert len(reported) > 80
    assert reported <= {code for code, _ in LINK.findall(PAGE)}


def test_each_code_is_in_the_column_of_its_severity():
    for _, *columns in ROWS:
        for severity, cell in zip(("error", "warning", "note"), columns, strict=True):
            for code, page in LINK.findall(cell):
                assert (page, REGISTER[code].severity.value) == (code, severity)
