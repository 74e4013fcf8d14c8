"""The class of joints in MJCF: the dynamics and gains that most joints have, written once."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from linkforge_compile.formats.element import leaf_at
from linkforge_compile.formats.xml_text import Spellable, Xml

if TYPE_CHECKING:
    from linkforge_compile.source import SourceRef

Values: TypeAlias = Mapping[str, Spellable | None]
"""Attributes by name; None for none."""

NAME = "joint"


class Settings(NamedTuple):
    """The values of a joint, or of the actuator of one, by its tag, and where they are written."""

    tag: str
    values: Values
    source: SourceRef | None


class JointClass(NamedTuple):
    """By tag, the settings that more than half of its elements have, and two at least."""

    settings: Mapping[str, Settings]

    @classmethod
    def of(cls, all_settings: Sequence[Settings]) -> JointClass:
        elements = Counter(one.tag for one in all_settings)
        sharing = Counter(map(_key, all_settings))
        common: dict[str, Settings] = {}
        for one in all_settings:
            has_values = any(value is not None for value in one.values.values())
            if has_values and sharing[_key(one)] > max(1, elements[one.tag] / 2):
                common.setdefault(one.tag, one)
        return cls(common)

    def attributes(self, tag: str, values: Values) -> dict[str, Spellable | None]:
        """Return the reference to this class for the values that it has, other values themselves."""
        known = self.settings.get(tag)
        return {"class": NAME} if known and known.values == values else dict(values)

    def elements(self) -> Sequence[Xml]:
        """Return what `<default>` contains for this class."""
        return [leaf_at(tag, source, **values) for tag, values, source in self.settings.values()]


def _key(settings: Settings) -> tuple[str, tuple[tuple[str, Spellable | None], ...]]:
    return settings.tag, tuple(settings.values.items())
