"""The keys that an object of some types has no use for, so that editors do not offer them there."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from typing import TypeAlias

from linkforge_compile.core.fields import field_specs
from linkforge_compile.core.models.joint import HAVE_NO_AXIS, HAVE_NO_LIMITS, Joint
from linkforge_compile.core.models.sensor import INFO_FIELDS, Sensor

KeysByType: TypeAlias = Mapping[tuple[str, ...], tuple[str, ...]]
"""Keys by the types that have no use for them."""


def keys_by_type() -> dict[str, KeysByType]:
    """Return the keys by the definition of their object in the language's schema."""
    joints = {"axis": HAVE_NO_AXIS, "limits": HAVE_NO_LIMITS}
    sensors = {field: [type_ for type_, own in INFO_FIELDS.items() if own != field] for field in INFO_FIELDS.values()}
    of_joints = _by_types(Joint, joints)
    return {"joint": of_joints, "module_joint": of_joints, "sensor": _by_types(Sensor, sensors)}


def _by_types(kind: type, fields: Mapping[str, Sequence[str]]) -> KeysByType:
    """Return the keys of fields of a class by types, for fields with their types."""
    specs = field_specs(kind)
    keys: dict[tuple[str, ...], list[str]] = defaultdict(list)
    for field, types in fields.items():
        keys[tuple(map(str, types))].append(specs[field].key or field)
    return {types: tuple(names) for types, names in keys.items()}
