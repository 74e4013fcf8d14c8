"""Tests of URDF files with their expected diagnostics as comments on the line, in the form of yaml_case.py."""

import re
from collections.abc import Iterator
from pathlib import Path

from linkforge_compile import check_file, import_urdf
from tests.yaml_case import Finding, expected, findings_of

_COMMENT = re.compile(r"<!-- (\^*[EWN]\[LF\d{4}\]:.*?) -->")


def expected_in_xml(file: str, text: str) -> Iterator[Finding]:
    lines = (" ".join(f"# {found}" for found in _COMMENT.findall(line)) for line in text.split("\n"))
    return expected(file, "\n".join(lines))


def check_urdf_case(path: Path) -> None:
    """Import a URDF file, with the SRDF of its name if any, and compare its diagnostics with the expected ones.

    Compiling a file reports what URDF readers reject, importing it does not.
    """
    is_compiled = path.parent.name == "refused_urdf"
    result = check_file(path) if is_compiled else import_urdf(path, srdf=srdf_of(path))
    assert findings_of(result) == set(expected_in_urdf(path))


def expected_in_urdf(path: Path) -> Iterator[Finding]:
    for file in (path, srdf_of(path)):
        if file is not None:
            yield from expected_in_xml(file.name, file.read_text("utf-8"))


def srdf_of(path: Path) -> Path | None:
    srdf = path.with_suffix(".srdf")
    return srdf if srdf.exists() else None
