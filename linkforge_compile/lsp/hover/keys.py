"""Show what the schema says of a key, and of the word that is its value."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from linkforge_compile.lsp.cursor import Cursor, Role
from linkforge_compile.lsp.hover.text import bullets, code
from linkforge_compile.schema.descriptions import Described, described_at
from linkforge_compile.schema.json_schema import LONG_FORM
from linkforge_compile.schema.shapes import expected, words_of

_UNMENTIONED = ("an expression", LONG_FORM)


def show_key(cursor: Cursor) -> str:
    """Return the description of the key at a position, or of the key that the value there has; "" for none."""
    word = cursor.word.text or ""
    is_key = cursor.role is Role.KEY
    return describe_key((*cursor.path, word) if is_key else cursor.path, "" if is_key else word)


def describe_key(path: tuple[str | int, ...], word: str = "") -> str:
    """Return the description of the key at a path, and of the word that is its value; "" for none."""
    while path and isinstance(path[-1], int):
        path = path[:-1]
    branches = described_at(path)
    if not branches or not path:
        return ""
    meaning = _meaning(branches, word)
    title = ": ".join(filter(None, (f"**{path[-1]}**", _expected(branches))))
    return "\n\n".join(filter(None, (title, meaning, *_described(branches))))


def _expected(branches: Sequence[Described]) -> str:
    nouns = (
        expected(one.schema)
        for one in branches
        if one.schema.get("title", _UNMENTIONED[0]) not in _UNMENTIONED and not _words(one)
    )
    words = [code(word) for one in branches for word in _words(one)]
    listed = [" | ".join(words)] if words else []
    return " or ".join(dict.fromkeys((*listed, *filter(None, nouns))))


def _words(branch: Described) -> list[str]:
    return words_of(branch.schema) if "enum" in branch.schema else []


def _described(branches: Sequence[Described]) -> Iterator[str]:
    """Yield the descriptions of a schema, each once, and what its words mean."""
    texts = (str(one.schema.get("markdownDescription", one.schema.get("description", ""))) for one in branches)
    yield from dict.fromkeys(filter(None, texts))
    for one in branches:
        yield bullets(f"{code(word)}: {text}" for word, text in _meanings(one))


def _meaning(branches: Sequence[Described], word: str) -> str:
    return next((text for one in branches for known, text in _meanings(one) if known == word), "")


def _meanings(branch: Described) -> list[tuple[str, str]]:
    texts = branch.schema.get("markdownEnumDescriptions", branch.schema.get("enumDescriptions"))
    words = branch.schema.get("enum")
    if not isinstance(texts, list) or not isinstance(words, list):
        return []
    return [(str(word), str(text)) for word, text in zip(words, texts, strict=False) if text]
