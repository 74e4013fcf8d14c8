"""Write entries that are alike but for a part of their name, such as the joints of ros2_control, as one with `for`."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Sequence

from linkforge_compile.migration.nodes import map_of, scalar
from linkforge_compile.syntax import YamlEntry, YamlList, YamlMap, YamlNode, YamlScalar
from linkforge_compile.syntax.writer import write

_FEWEST = 3
_SHORT = 100
"""The most characters of an entry that is as easily read several times."""

_EXPRESSION = re.compile(r"(\$\((?:[^()']|'[^']*'|\((?:[^()]|\([^()]*\))*\))*\))")
_NAME_PARTS = re.compile(r"(?<=_)|(?=_)")
_WORD = re.compile(r"[A-Za-z]\w*")


def with_loops(entries: YamlMap, item: str, taken: Collection[str]) -> tuple[YamlMap, dict[YamlNode, YamlNode]]:
    """Return a map in which entries that follow one another and are alike are one, and its nodes by those replaced.

    `item` is the name that `for` gives, unless it is `taken`.
    """
    if item in taken:
        return entries, {}
    made: dict[str, YamlEntry] = {}
    moved: dict[YamlNode, YamlNode] = {}
    rest = [*entries]
    while rest:
        group, one = _first_group(rest, item, moved)
        made[one.name] = one
        rest = rest[group:]
    return YamlMap(made, entries.span), moved


def _first_group(entries: Sequence[YamlEntry], item: str, moved: dict[YamlNode, YamlNode]) -> tuple[int, YamlEntry]:
    """Return how many of the first entries are alike, and the entry for them."""
    first = entries[0]
    names = [_NAME_PARTS.split(one.name) for one in entries[:_FEWEST]]
    if len(names) < _FEWEST or len(_text_of(first)) < _SHORT:
        return 1, first
    start = _common(names)
    ends = _common([name[start:][::-1] for name in names])
    head, tail = names[0][:start], names[0][len(names[0]) - ends :]
    words: list[str] = []
    copy: dict[YamlNode, YamlNode] = {}
    made: YamlEntry | None = None
    for one in entries:
        name = _NAME_PARTS.split(one.name)
        word = "".join(name[start : len(name) - ends])
        is_like = name[:start] == head and name[len(name) - ends :] == tail and _WORD.fullmatch(word)
        own = _template(one, word, item, {} if made else copy) if is_like and word not in words else None
        if own is None or (made is not None and _text_of(own) != _text_of(made)):
            break
        made = made or own
        words.append(word)
    if made is None or len(words) < _FEWEST:
        return 1, first
    moved |= copy
    where = first.value.span
    values = YamlList(tuple(scalar(word, where) for word in words), where)
    loop = map_of({"for": map_of({item: values}, where)}, where)
    body = made.value.entries if isinstance(made.value, YamlMap) else {}
    return len(words), YamlEntry(made.key, YamlMap({**loop.entries, **body}, where))


def _text_of(entry: YamlEntry) -> str:
    return write(YamlMap({entry.name: entry}, entry.value.span))


def _common(names: Sequence[Sequence[str]]) -> int:
    """Return how many parts all begin with."""
    shortest = min(map(len, names))
    return next((place for place in range(shortest) if len({name[place] for name in names}) > 1), shortest)


def _template(entry: YamlEntry, word: str, item: str, moved: dict[YamlNode, YamlNode]) -> YamlEntry | None:
    """Return an entry with the item of a loop in the place of a word; None if the word is where that cannot be."""
    try:
        return _entry(entry, word, item, moved)
    except ValueError:
        return None


def _entry(entry: YamlEntry, word: str, item: str, moved: dict[YamlNode, YamlNode]) -> YamlEntry:
    key = _scalar(entry.key, word, item)
    moved[entry.key] = key
    return YamlEntry(key, _node(entry.value, word, item, moved))


def _node(node: YamlNode, word: str, item: str, moved: dict[YamlNode, YamlNode]) -> YamlNode:
    made: YamlNode = node
    match node:
        case YamlScalar():
            made = _scalar(node, word, item)
        case YamlList():
            made = YamlList(tuple(_node(one, word, item, moved) for one in node), node.span)
        case YamlMap():
            entries = [_entry(one, word, item, moved) for one in node]
            made = YamlMap({one.name: one for one in entries}, node.span)
    moved[node] = made
    return made


def _scalar(node: YamlScalar, word: str, item: str) -> YamlScalar:
    text = "".join(_replaced(node.text, word, item))
    return node if text == node.text else YamlScalar(text, text, node.span)


def _replaced(text: str, word: str, item: str) -> Iterator[str]:
    whole = rf"(?<![A-Za-z0-9]){re.escape(word)}(?![A-Za-z0-9])"
    for number, piece in enumerate(_EXPRESSION.split(text)):
        if number % 2 == 0:
            yield re.sub(whole, f"$({item})", piece)
            continue
        made = re.sub(rf"\.{re.escape(word)}\b", f"[{item}]", piece).replace(f"'{word}'", item)
        if re.search(whole, made):
            raise ValueError
        yield made
