"""Reaching into lists, maps and vectors: `list[0]`, `row['key']`, `row.key`, `xyz.z`."""

from __future__ import annotations

from collections.abc import Mapping

from linkforge_compile.diagnostics.codes import expressions as codes
from linkforge_compile.expressions.types import RefusedError, Value, kind_name

_AXES = {"x": 0, "y": 1, "z": 2}


def item(whole: Value, index: Value) -> Value:
    """Return an item of a list, counted from 0 or back from the end, or what a map has under a key."""
    match whole:
        case tuple():
            return _list_item(whole, index)
        case Mapping():
            key = key_text(index)
            if key is not None:
                return _entry(whole, key)
            found = kind_name(index)
            raise RefusedError(codes.WRONG_KIND, operand=1, taker="a map", expected="a key", found=found)
    expected, found = "a list or a map before it", kind_name(whole)
    raise RefusedError(codes.WRONG_KIND, operand=0, taker="'[...]'", expected=expected, found=found)


def key_text(index: Value) -> str | None:
    """Return the key that a value names, None where it names none; the whole number 1 names the key `1`."""
    if isinstance(index, bool) or not isinstance(index, str | int):
        return None
    return str(index)


def field(whole: Value, key: str) -> Value:
    """Return what a map has under a key, or a vector's component."""
    if isinstance(whole, Mapping):
        return _entry(whole, key)
    if isinstance(whole, tuple) and len(whole) == 3 and key in _AXES:
        return whole[_AXES[key]]
    expected, found = "a map or a vector's x, y, z", kind_name(whole)
    raise RefusedError(codes.WRONG_KIND, taker=f"'.{key}'", expected=expected, found=found)


def _list_item(whole: tuple[Value, ...], index: Value) -> Value:
    if isinstance(index, bool) or not isinstance(index, int):
        expected, found = "a whole number in its brackets", kind_name(index)
        raise RefusedError(codes.WRONG_KIND, operand=1, taker="a list", expected=expected, found=found)
    try:
        return whole[index]
    except IndexError:
        raise RefusedError(codes.NO_SUCH_ITEM, operand=1, index=index, length=len(whole)) from None


def _entry(whole: Mapping[str, Value], key: str) -> Value:
    if key not in whole:
        raise RefusedError(codes.UNKNOWN_KEY, operand=1, near=whole, name=key)
    return whole[key]
