"""A mapping that hashes, pickles, and equals any mapping of the same items."""

import copy
import json
import pickle

import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkforge_compile.core.part import FrozenMap

dicts = st.dictionaries(st.text(max_size=3), st.integers())


@given(dicts)
def test_it_reads_as_the_dict_it_was_made_of(items):
    frozen = FrozenMap(items)
    assert frozen == items
    assert items == frozen
    assert list(frozen.items()) == list(items.items())
    assert repr(frozen) == repr(items)
    assert pickle.loads(pickle.dumps(frozen)) == copy.deepcopy(frozen) == frozen


def test_order_matters_to_readers_and_not_to_equality():
    forth, back = FrozenMap({"a": 1, "b": 2}), FrozenMap({"b": 2, "a": 1})
    assert forth == back
    assert hash(forth) == hash(back)
    assert list(forth) == ["a", "b"]
    assert forth != {"a": 1}
    assert forth != "ab"


def test_it_keeps_nothing_of_the_dict_it_was_made_of():
    items = {"a": 1}
    frozen = FrozenMap(items)
    items["a"] = 2
    frozen.copy()["a"] = 3
    assert frozen["a"] == 1


def test_it_joins_with_dicts_on_either_side():
    assert FrozenMap({"a": 1}) | {"a": 2, "b": 3} == {"a": 2, "b": 3}
    assert {"a": 2, "b": 3} | FrozenMap({"a": 1}) == {"a": 1, "b": 3}


@pytest.mark.parametrize(
    "change",
    [
        lambda frozen: frozen.__setitem__("a", 2),
        lambda frozen: frozen.__delitem__("a"),
        lambda frozen: frozen.__ior__({"b": 1}),
        lambda frozen: frozen.update(b=1),
        lambda frozen: frozen.setdefault("b", 1),
        lambda frozen: frozen.pop("a"),
        lambda frozen: frozen.popitem(),
        lambda frozen: frozen.clear(),
    ],
)
def test_it_cannot_be_changed(change):
    frozen = FrozenMap({"a": 1})
    with pytest.raises(TypeError, match="cannot be changed"):
        change(frozen)
    assert frozen == {"a": 1}


def test_it_is_an_instance_of_dict():
    frozen = FrozenMap({"a": 1, "b": FrozenMap({"c": 2})})
    assert isinstance(frozen, dict)
    assert json.dumps(frozen) == '{"a": 1, "b": {"c": 2}}'
    assert list(reversed(frozen)) == ["b", "a"]
