from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest

from linkforge_compile.bytecode import kept


@pytest.fixture(autouse=True)
def _bytecode_below(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "pycache_prefix", str(tmp_path / "cache"))
    monkeypatch.setattr(sys, "dont_write_bytecode", False)
    (tmp_path / "made.py").write_text("")
    (tmp_path / "source.json").write_text("{}")


def _asked(folder: Path, value: object) -> object:
    """Return what a process gets that would make a value."""
    files = [folder / "source.json", folder / "made.py"]
    return kept(str(folder / "made.py"), "value", files, lambda: value)


def test_what_one_process_made_the_next_one_takes(tmp_path: Path) -> None:
    assert [_asked(tmp_path, ["first"]), _asked(tmp_path, ["second"])] == [["first"], ["first"]]


def test_what_was_made_from_other_files_is_made_again(tmp_path: Path) -> None:
    _asked(tmp_path, "first")
    (tmp_path / "source.json").write_text("{ }")
    assert [_asked(tmp_path, "second"), _asked(tmp_path, "third")] == ["second", "second"]


def test_another_text_of_the_same_size_and_time_is_noticed(tmp_path: Path) -> None:
    source = tmp_path / "source.json"
    os.utime(source, (0, 0))
    _asked(tmp_path, "first")
    source.write_text("[]")
    os.utime(source, (0, 0))
    assert _asked(tmp_path, "second") == "second"


def test_what_changes_while_it_is_read_is_made_again(tmp_path: Path) -> None:
    def make_slowly() -> str:
        (tmp_path / "source.json").write_text("{ }")
        return "old"

    kept(str(tmp_path / "made.py"), "value", [tmp_path / "source.json"], make_slowly)
    assert kept(str(tmp_path / "made.py"), "value", [tmp_path / "source.json"], lambda: "new") == "new"


def test_what_is_shared_or_holds_itself_does_so_again(tmp_path: Path) -> None:
    part: dict[str, object] = {"title": "a link"}
    part["inside"] = part
    for _ in range(2):
        first, second = _asked(tmp_path, [part, part])
        assert first is second
        assert first["inside"] is first


def test_a_broken_file_is_made_again(tmp_path: Path) -> None:
    _asked(tmp_path, "first")
    [place] = (tmp_path / "cache").rglob("*.marshal")
    whole = place.read_bytes()
    for broken in (b"", whole[:-3], b"N", b"nothing of that"):
        place.write_bytes(broken)
        assert _asked(tmp_path, "again") == "again"


def test_code_that_is_damaged_anywhere_is_made_again(tmp_path: Path) -> None:
    code = compile("def move(self):\n    self.moved = True\n", "joint.py", "exec")
    _asked(tmp_path, code)
    [place] = (tmp_path / "cache").rglob("*.marshal")
    whole = place.read_bytes()
    for spot in range(0, len(whole), 9):
        place.write_bytes(bytes([*whole[:spot], whole[spot] ^ 1, *whole[spot + 1 :]]))
        assert _asked(tmp_path, code) is code
    place.write_bytes(whole)
    assert _asked(tmp_path, "again") == code


def test_nothing_is_left_where_python_leaves_no_bytecode(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    assert [_asked(tmp_path, "first"), _asked(tmp_path, "second")] == ["first", "second"]
    assert not (tmp_path / "cache").exists()


def test_a_place_that_cannot_be_written_to_is_no_fault(tmp_path: Path) -> None:
    (tmp_path / "cache").write_text("a file where the folder should be")
    assert [_asked(tmp_path, "first"), _asked(tmp_path, "second")] == ["first", "second"]
