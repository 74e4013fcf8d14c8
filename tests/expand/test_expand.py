"""Test how the expressions of a tree are computed."""

import pytest

from linkforge_compile import compile_text
from linkforge_compile.diagnostics import BeyondLimitError, Diagnostics
from linkforge_compile.expand import Unset, arguments_from_text, expand
from linkforge_compile.expand.evaluate import Expressions
from linkforge_compile.limits import Budget, Limit
from linkforge_compile.load import Loader
from linkforge_compile.source import SourceFile
from linkforge_compile.syntax import YamlFault, YamlMap, YamlScalar
from linkforge_compile.units import Dimension, Quantity
from tests.expand.assembling import assemble


def test_an_expression_becomes_a_node_of_its_value_in_its_place():
    instance, messages = assemble("""
        variables: {size: [1, 2], limits: {lower: -1}}
        metadata: {list: $(size), map: $(limits), text: wheel_$(len(size)), number: "$(size[1] / 4)"}
    """)
    metadata = instance.tree.get("metadata")
    assert not messages
    assert [(item.value, item.span.line, item.span.column) for item in metadata.get("list")] == [(1, 4, 18), (2, 4, 18)]
    assert metadata.get("map").get("lower").value == -1
    assert metadata.get("text").value == "wheel_2"
    assert (metadata.get("number").value, metadata.get("number").text) == (0.5, "0.5")


def test_a_quantity_stays_one_and_its_text_is_the_si_number():
    instance, _ = assemble("""
        parameters: {reach: 80 cm}
        metadata: {half: $(reach / 2)}
    """)
    half = instance.tree.get("metadata").get("half")
    assert (half.value, half.text) == (Quantity(0.4, Dimension.LENGTH), "0.4")


def test_null_is_as_if_nothing_were_written():
    instance, _ = assemble("metadata: {a: $(null)}")
    metadata = instance.tree.get("metadata")
    assert metadata.get("a") is None
    assert metadata.child("a").text == ""


def test_a_doubled_dollar_is_a_literal_one():
    assert assemble("metadata: {a: $$(x), $$(k): 1}").metadata == {"a": "$(x)", "$(k)": 1}


def test_what_holds_no_expression_is_the_same_object():
    sink = Diagnostics()
    loader = Loader()
    text = "linkforge: 1\nname: a\nmetadata: {kept: {deep: [1, 2]}, made: $(1 + 1)}\n"
    spec = loader.parse(text, "a", None, sink)
    instance = expand(spec, arguments_from_text((), sink), loader, sink)
    written, computed = spec.tree.get("metadata"), instance.tree.get("metadata")
    assert computed is not written
    assert computed.entries["kept"] is written.entries["kept"]


def test_keys_are_computed_and_keep_their_place():
    instance, _ = assemble("""
        parameters: {side: left}
        links: {"$(side)_wheel": }
    """)
    entry = instance.tree.get("links").entries["left_wheel"]
    assert (entry.key.text, entry.key.span.line, entry.key.span.column) == ("left_wheel", 4, 9)


def test_a_faulty_key_keeps_its_text_and_its_value_is_a_fault():
    instance, messages = assemble("links: {$(sid)_wheel: }")
    links = instance.tree.get("links")
    assert isinstance(links.child("$(sid)_wheel"), YamlFault)
    assert len(messages) == 1


def test_what_only_computes_the_robot_is_not_in_its_tree():
    instance, _ = assemble("""
        parameters: {a: 1}
        variables: {b: 1}
        packages: {p: .}
        x-holder: {c: $(unknown)}
        links: {base: }
    """)
    assert list(instance.tree.entries) == ["linkforge", "name", "links"]


def test_free_parts_may_hold_text_that_looks_like_a_number():
    _, messages = assemble("""
        variables: {low: 0.1}
        metadata: {width: $(low) m}
        semantic: {joint_properties: {elbow: {offset: -$(low)}}}
    """)
    assert not messages


def test_name_and_standalone_are_always_in_scope():
    assert assemble("metadata: {a: $(name)_tool, b: $(standalone)}").metadata == {"a": "test_tool", "b": True}


def test_the_name_of_the_file_may_be_computed():
    sink, loader = Diagnostics(), Loader()
    text = "linkforge: 1\nname: $(maker)_arm\nparameters: {maker: acme}\nmetadata: {a: $(name)}\n"
    instance = expand(loader.parse(text, "a", None, sink), arguments_from_text((), sink), loader, sink)
    assert instance.name == "acme_arm"
    assert instance.tree.get("metadata").get("a").value == "acme_arm"


def test_variables_are_computed_in_any_order():
    assembled = assemble("""
        variables: {c: "$(b + 1)", b: $(a.size * 2), a: {size: $(n), unit: 3 mm}, n: 4}
        metadata: {c: $(c), unit: $(a.unit)}
    """)
    assert assembled.metadata == {"c": 9, "unit": Quantity(0.003, Dimension.LENGTH)}


def test_a_circle_of_variables_is_reported_once_used_or_not():
    _, messages = assemble("variables: {a: $(b), b: $(a)}")
    assert messages == ["'a' is computed from itself: a → b → a"]


def test_a_variable_that_is_not_used_may_divide_by_zero_but_not_name_what_is_not_there():
    _, messages = assemble("""
        parameters: {gear: 0}
        variables: {ratio: $(1 / gear), other: $(gaer)}
        metadata: {ratio: $(ratio if gear > 0 else 0)}
    """)
    assert messages == ["no parameter, variable or 'for' name 'gaer' here; did you mean 'gear'?"]


def test_names_of_a_section_that_is_at_fault_are_not_reported_again():
    _, messages = assemble("""
        variables: 3
        metadata: {a: $(anything)}
    """)
    assert len(messages) == 1


def test_a_required_parameter_may_be_a_note_and_what_depends_on_it_silent():
    instance, messages = assemble(
        """
        parameters: {reach: {type: length}, side: {type: string}}
        variables: {half: $(reach / 2)}
        metadata: {half: $(half), other: 1}
        """,
        unset=Unset.NOTE,
    )
    assert messages == ["nothing sets 'reach', 'side' here, so parts that depend on them are not checked"]
    assert isinstance(instance.tree.get("metadata").child("half"), YamlFault)


def test_a_thousand_links_are_walked_and_not_copied():
    links = "".join(f"  l{number}: {{inertial: {{mass: 1}}}}\n" for number in range(1000))
    sink, loader = Diagnostics(), Loader()
    spec = loader.parse(
        f"linkforge: 1\nname: a\nlinks:\n{links}  last: {{inertial: {{mass: $(1)}}}}\n", "a", None, sink
    )
    instance = expand(spec, arguments_from_text((), sink), loader, sink)
    written, computed = spec.tree.get("links"), instance.tree.get("links")
    assert isinstance(written, YamlMap)
    changed = [entry.name for entry in computed if entry is not written.entries[entry.name]]
    assert changed == ["last"]
    assert isinstance(computed.child("last").get("inertial").get("mass"), YamlScalar)


def test_the_text_that_expressions_give_is_bounded():
    with pytest.raises(BeyondLimitError, match="more than 16,000,000 characters"):
        assemble(f"""
            variables: {{long: {"a" * 60_000}}}
            semantic: {{groups: {{"g$(i)": {{for: {{i: 300}}, links: [$(long)]}}}}}}
        """)


def test_how_deep_a_computed_value_nests_is_bounded():
    _, messages = assemble(f"""
        variables: {{a: {"[" * 60}1{"]" * 60}, b: {"[" * 60}$(a){"]" * 60}}}
        metadata: {{fits: $(a), list: $(b)}}
    """)
    assert messages == ["the expressions give more than 100 lists and maps inside each other"]


@pytest.mark.parametrize("use", ["$(half)", "$(-half)", "$(half + 1)", "$(min(half, 1))", "$(pose.half)"])
def test_text_that_lacks_its_expression_mark_is_reported_where_it_is_written(use: str):
    compilation = compile_text(f"""linkforge: 1
name: cart
parameters: {{track: 0.4 m}}
variables: {{half: track / 2, pose: {{half: $(half)}}}}
links: {{base: {{visual: {{box: [1, 1, "{use}"]}}}}}}
""")
    (fault,) = compilation.diagnostics
    assert [(note.message, note.span and str(note.span)) for note in fault.notes] == [
        ("the value is written here; write '$(track / 2)'", "<text>:4:19")
    ]


def test_a_quantity_or_name_that_is_no_expression_offers_none():
    compilation = compile_text("""linkforge: 1
name: cart
variables: {side: left}
links: {base: {visual: {box: [1, 1, $(side)]}}}
""")
    (fault,) = compilation.diagnostics
    assert [note.message for note in fault.notes] == ["the value is written here"]


def test_expressions_are_parsed_once_each_and_counted():
    expressions = Expressions(Budget())
    scalars = [YamlScalar(text, text, SourceFile("r", text).whole) for text in ("$(1 + 1)", "$(1 + 2)")]
    left = [expressions.budget.left(Limit.STEPS)]
    for scalar in (scalars[0], scalars[0], scalars[1]):
        assert expressions.template(scalar, Diagnostics()) is not None
        left.append(expressions.budget.left(Limit.STEPS))
    assert left[0] > left[1] == left[2] > left[3]
