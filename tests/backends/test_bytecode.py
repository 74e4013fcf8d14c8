from __future__ import annotations

import sys
from pathlib import Path

import pytest
from jinja2 import Environment, FileSystemLoader
from jinja2.compiler import CodeGenerator

from linkforge_compile.backends.bytecode import TemplateBytecode
from linkforge_compile.backends.environment import _environment
from linkforge_compile.backends.markup import Xml


@pytest.fixture(autouse=True)
def _bytecode_below(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "pycache_prefix", str(tmp_path / "cache"))
    monkeypatch.setattr(sys, "dont_write_bytecode", False)
    (tmp_path / "link.j2").write_text("<link/>")
    (tmp_path / "options.py").write_text("")


class _Counting(Environment):
    """Jinja's environment, which counts the templates that it compiles."""

    def __init__(self, folder: Path) -> None:
        cache = TemplateBytecode(str(folder / "options.py"))
        super().__init__(loader=FileSystemLoader(folder), bytecode_cache=cache, autoescape=True)
        self.compiled = 0

    def _generate(self, *source: object, **options: object) -> str:
        self.compiled += 1
        return super()._generate(*source, **options)  # type: ignore[arg-type]  # whatever Jinja gives it


def _rendered(folder: Path) -> tuple[str, int]:
    """Return the text as a new process would write it, and how many templates that compiled."""
    environment = _Counting(folder)
    return environment.get_template("link.j2").render(), environment.compiled


def test_templates_leave_escaping_to_the_one_place_that_does_it() -> None:
    text = "<link name='a&b'/>"
    template = _environment().from_string(
        "{% macro twice(one) %}{{ one }}{{ one }}{% endmacro %}{{ twice(text) }}{{ xml }}"
    )
    assert template.render(text=text, xml=Xml(text)) == 2 * "&lt;link name='a&amp;b'/&gt;" + text
    python = _environment().compile("{{ robot.name }}", raw=True)
    assert "environment.finalize(environment.getattr(" in python
    assert "escape(" not in python


def test_what_is_escaped_stays_so_where_jinja_looks_at_every_value() -> None:
    looking = _environment().overlay()
    looking.code_generator_class = CodeGenerator
    assert "escape(" in looking.compile("{{ text }}", raw=True)
    assert looking.from_string("{{ text }}").render(text="a&b<c>") == "a&amp;b&lt;c&gt;"


def test_a_template_is_compiled_once_for_all_processes(tmp_path: Path) -> None:
    assert [_rendered(tmp_path), _rendered(tmp_path)] == [("<link/>", 1), ("<link/>", 0)]


def test_a_template_that_says_something_else_is_compiled_again(tmp_path: Path) -> None:
    _rendered(tmp_path)
    (tmp_path / "link.j2").write_text("<joint/>")
    assert _rendered(tmp_path) == ("<joint/>", 1)


def test_other_options_compile_again(tmp_path: Path) -> None:
    _rendered(tmp_path)
    (tmp_path / "options.py").write_text("autoescape = True")
    assert _rendered(tmp_path) == ("<link/>", 1)


def test_a_broken_file_is_none(tmp_path: Path) -> None:
    _rendered(tmp_path)
    [kept] = (tmp_path / "cache").rglob("*.jinja")
    whole = kept.read_bytes()
    for broken in (b"", whole[:20], whole[:40], whole[:-10], whole[:15] + b"\xff" * 60):
        kept.write_bytes(broken)
        assert _rendered(tmp_path) == ("<link/>", 1)


def test_nothing_is_written_where_python_writes_no_bytecode(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    assert _rendered(tmp_path) == ("<link/>", 1)
    assert not (tmp_path / "cache").exists()


def test_a_place_that_cannot_be_written_to_is_no_fault(tmp_path: Path) -> None:
    (tmp_path / "cache").write_text("a file where the folder should be")
    assert [_rendered(tmp_path), _rendered(tmp_path)] == [("<link/>", 1), ("<link/>", 1)]
