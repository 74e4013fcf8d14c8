"""Give the parameters of a macro the values of a call."""

from __future__ import annotations

import ast

from linkforge_compile.migration.evaluate import Called, Context, Evaluator
from linkforge_compile.migration.scopes import Block, Macro, Property, Table, Value, unquoted
from linkforge_compile.migration.symbols import CannotTranslateError, Parts, as_parts, value_of
from linkforge_compile.migration.template import Choice, Content, Element, Use


def bind(called: Called, values: dict[str, str], scope: Table[Property], evaluator: Evaluator) -> None:
    """Give the parameters of a macro their values in a scope."""
    macro, context = called.macro, called.context
    for name, value in values.items():
        if name not in macro.parameters:
            raise CannotTranslateError(f"a parameter '{name}', which the macro '{macro.name}' does not have")
        called.arguments[name] = evaluator.text(value, context)
    content = evaluator.walk(called.element.content, context)
    blocks = [one for one in content if isinstance(one, Element)]
    if any(isinstance(one, Choice | Use) for one in content):
        raise CannotTranslateError(f"a call of '{macro.name}' whose block is not certain")
    for parameter in macro.parameters:
        if parameter.startswith("*"):
            if not blocks:
                raise CannotTranslateError(f"a call of '{macro.name}' whose block is not certain")
            block = blocks.pop(0)
            inside: list[Content] = block.content if parameter.startswith("**") else [block]
            called.blocks[parameter] = inside
            scope.entries[parameter] = Block(content=tuple(inside))
        elif parameter not in called.arguments:
            called.arguments[parameter] = _default(macro, parameter, context, evaluator)
    for name, parts in called.arguments.items():
        scope.entries[name] = Value(value_of(parts))


def _default(macro: Macro, parameter: str, context: Context, evaluator: Evaluator) -> Parts:
    forwarded, default = macro.defaults.get(parameter, (None, None))
    node = None if forwarded is None else evaluator.lookup(forwarded, context)
    entry = context.symbols.get(forwarded) if forwarded else None
    test = entry.test if isinstance(entry, Value) else None
    if node is not None and (test is None or default is None):
        return as_parts(node) or ("",)
    if default is None and parameter not in macro.defaults:
        raise CannotTranslateError(f"a call of '{macro.name}' without '{parameter}'")
    otherwise = evaluator.text(unquoted(default or ""), context)
    if node is None or test is None:
        return otherwise
    return as_parts(ast.IfExp(test=test, body=node, orelse=value_of(otherwise)))
