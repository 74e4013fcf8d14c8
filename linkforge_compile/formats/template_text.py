"""What a user's template may write of a value: never the address of an object, nor a whole part of the robot."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

from jinja2 import TemplateRuntimeError
from jinja2.runtime import Undefined

from linkforge_compile.core.models.geometry import Color, Transform, Vector3
from linkforge_compile.formats.environment import describe


def require_text(value: object, count: Callable[[], None]) -> None:
    """Refuse a value without a text of its own, in a list or a map as well, each item of which is counted.

    Raises:
        TemplateRuntimeError: with what to write instead.
        UndefinedError: for an undefined name.

    """
    if isinstance(value, Mapping):
        _require_all((one for pair in value.items() for one in pair), count)
    elif isinstance(value, list | tuple) and not hasattr(value, "_fields"):
        _require_all(value, count)
    elif isinstance(value, Undefined):
        str(value)  # reports the name
    elif not _is_plain(value) and not isinstance(value, Vector3 | Transform | Color) and not hasattr(value, "__html__"):
        raise TemplateRuntimeError(_reason(value))


def _require_all(items: Iterable[object], count: Callable[[], None]) -> None:
    """Refuse what has no text in a list, where Python writes the repr of an object: a vector has none there."""
    for item in items:
        count()
        if isinstance(item, Vector3 | Transform | Color):
            raise TemplateRuntimeError(f"{describe(item)} has no text in a list; write '| join(\", \")'")
        require_text(item, count)


def _is_plain(value: object) -> bool:
    # A number or an array of NumPy has a text as well.
    return value is None or isinstance(value, str | int | float | complex) or hasattr(value, "ndim")


def _reason(value: object) -> str:
    if callable(value):
        name = getattr(value, "__name__", None) or getattr(value, "name", type(value).__name__)
        return f"'{name}' is not called, and has no text; write '{name}()'"
    if isinstance(value, set | frozenset):
        return "a set has no order, so the text would differ from run to run; write '| sort'"
    if isinstance(value, Iterable) and not hasattr(value, "_fields"):
        return f"{describe(value)} has no text; write '| list' or '| join(\", \")'"
    return f"{describe(value)} has no text; write one of its fields{', such as its name' * hasattr(value, 'name')}"
