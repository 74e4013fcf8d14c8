"""Units in editors: those of a field's dimension, and no other, are no fault."""

import jsonschema_rs
import pytest

from linkforge_compile.core.fields import Number, Vector
from linkforge_compile.editor.bundle import bundle
from linkforge_compile.units import UNITS, Motion
from tests.core.test_schemas import CLASSES, specs_at

BUNDLE = bundle()
OF_ITS_READING = "sensor#noise"
"""A noise has the unit of what its sensor reads."""

FIELDS = [
    (place, spec)
    for place in CLASSES
    for spec in specs_at(place)
    if isinstance(spec, Number | Vector) and place != OF_ITS_READING
]


@pytest.mark.parametrize(("place", "spec"), FIELDS, ids=lambda one: one if isinstance(one, str) else one.key)
def test_a_field_accepts_the_units_that_its_class_says(place: str, spec: Number | Vector):
    file, _, name = place.partition("#")
    definition = BUNDLE["definitions"][name or file]
    forms = [form for form in (definition, *definition.get("anyOf", ())) if "properties" in form]
    field = {**forms[0]["properties"][spec.key], "definitions": BUNDLE["definitions"]}
    editor = jsonschema_rs.Draft7Validator(field)
    is_vector = editor.is_valid([1, 1, 1])
    texts = {unit: f"1.5 {unit}" for unit in UNITS}
    accepted = {unit for unit, text in texts.items() if editor.is_valid([0, 0, text] if is_vector else text)}
    dimensions = spec.unit.dimensions(Motion.UNKNOWN)
    assert accepted == {unit.name for unit in UNITS.values() if unit.dimension in dimensions}


def test_a_noise_has_any_unit():
    noise = BUNDLE["definitions"]["noise"]["properties"]["stddev"]
    editor = jsonschema_rs.Draft7Validator({**noise, "definitions": BUNDLE["definitions"]})
    assert all(editor.is_valid(f"1 {unit}") for unit in UNITS)
