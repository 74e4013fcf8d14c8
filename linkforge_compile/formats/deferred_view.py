"""Views of formats that are made when a template first uses them."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property

from jinja2.runtime import Context


class DeferredView:
    """The view of a format, as a value in the context of templates."""

    def __init__(self, make: Callable[[], object]) -> None:
        self._make = make

    @cached_property
    def view(self) -> object:
        return self._make()


class ViewContext(Context):
    """Resolves the names that templates use, by the hook that Jinja2 has for this."""

    def resolve_or_missing(self, key: str) -> object:
        value = super().resolve_or_missing(key)
        return value.view if isinstance(value, DeferredView) else value
