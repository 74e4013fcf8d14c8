"""Raw XML that knows where it was written."""

from __future__ import annotations

from linkforge_compile.source import SourceRef


class RawXml(str):
    """A text of `extra_elements`, or the name of an attribute, with its `source`, None if it was not read.

    It compares, hashes and prints as that text. Merging robots puts raw XML of several files into one list, so the
    source of the list's owner would not do. The `source` of an attribute's name is the map that it is in.
    """

    __slots__ = ("source",)

    source: SourceRef | None

    def __new__(cls, text: str, source: SourceRef | None = None) -> RawXml:
        raw = super().__new__(cls, text)
        raw.source = source
        return raw

    def __deepcopy__(self, memo: object) -> RawXml:
        return self

    def __reduce__(self) -> tuple[object, ...]:
        return RawXml, (str(self), self.source)
