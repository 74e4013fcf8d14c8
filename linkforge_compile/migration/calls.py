"""Calls of macros: written in place, or as the use of a module."""

from __future__ import annotations

import ast
from collections.abc import Callable
from dataclasses import dataclass, field, replace

from linkforge_compile.migration.attachment import (
    find_attachment,
    outer_parts,
    parameters_in_names,
    require_known_blocks,
)
from linkforge_compile.migration.binding import bind
from linkforge_compile.migration.blocks import block_symbol, marker
from linkforge_compile.migration.constants import constant_of
from linkforge_compile.migration.evaluate import Called, Context, Evaluator, MacroCalls
from linkforge_compile.migration.kept import kept_call
from linkforge_compile.migration.scopes import Block, Macro, Property, Table, Value, find_macro, unquoted
from linkforge_compile.migration.symbols import (
    MAP,
    UNKNOWN,
    UNSET,
    CannotTranslateError,
    NoModuleError,
    NotConstantError,
    Parts,
    Reference,
    Symbol,
    UndefinedError,
    as_expression,
    as_given,
    as_parts,
    constant,
    kind_of,
    refer,
    sources_of,
    symbols_in,
    value_of,
)
from linkforge_compile.migration.template import (
    BlockForm,
    Comment,
    Content,
    Element,
    FileDraft,
    Use,
    elements_in,
    split,
)
from linkforge_compile.source.xml_tree import XmlElement


@dataclass(eq=False)
class Module:
    """A macro as a module: its file, and what it needs of the scopes of its callers, by parameter."""

    file: FileDraft
    macro: Macro
    context: Context
    imports: dict[str, Callable[[Context, Evaluator], ast.expr]] = field(default_factory=dict)


@dataclass
class Plan:
    """Which macros become modules, by their bodies, with what is known of the values of their parameters."""

    modules: dict[XmlElement, dict[str, str]] = field(default_factory=dict)
    """The kinds of the parameters, by name."""
    single: frozenset[XmlElement] = frozenset()
    """The macros that are called once."""
    fixed: dict[XmlElement, frozenset[str]] = field(default_factory=dict)
    """Parameters that have the same value in all calls, and are no parameters of the module."""
    outer: dict[XmlElement, frozenset[XmlElement]] = field(default_factory=dict)
    """What of a macro is about other parts, and so belongs to the file that uses it."""
    blocks: dict[XmlElement, dict[str, BlockForm]] = field(default_factory=dict)
    """The blocks that can be parameters."""


class Calls(MacroCalls):
    """The macros of one expansion and their calls."""

    def __init__(self, plan: Plan) -> None:
        self._plan = plan
        self.defined: dict[XmlElement, Macro] = {}
        self.called: list[Called] = []
        self._first: dict[XmlElement, Called] = {}
        self.modules: dict[XmlElement, Module] = {}
        self.kept: dict[XmlElement, str] = {}
        """Why macros stay macros of their xacro, by their bodies."""
        self._by_file: dict[FileDraft, Module] = {}
        self._callers: list[tuple[FileDraft, Context]] = []

    def define(self, macro: Macro) -> None:
        self.defined[macro.body] = macro

    def call(self, element: XmlElement, context: Context, evaluator: Evaluator) -> list[Content]:
        """Return what a call expands to, or the use of a module."""
        name, values = element.tag.removeprefix("xacro:"), dict(element.values)
        if name == "call":
            name = evaluator.path_text(evaluator.text(values.pop("macro", ""), context))
        macro, macros, symbols = find_macro(name, context.macros, context.symbols)
        if macro is None:
            raise UndefinedError(f"a call of the macro '{name}', which is not defined")
        called = Called(macro, element, context)
        self.called.append(called)
        self._first.setdefault(macro.body, called)
        # Of a macro that is called once, properties are as good as those around it.
        is_single = not context.is_inside and self._plan.single.issuperset(
            (macro.body, *(one.macro.body for one in context.calls))
        )
        scope: Table[Property] = Table(symbols, file=context.file if is_single else None)
        bind(called, values, scope, evaluator)
        inside = replace(context, macros=Table(macros), symbols=scope, calls=(*context.calls, called))
        try:
            called.content = evaluator.walk(macro.body.content, inside)
        except UndefinedError:
            raise
        except CannotTranslateError as error:
            kept = None if context.is_inside else kept_call(called.arguments, macro, scope)
            if kept is None:
                raise
            self.kept[macro.body] = error.reason
            called.content = [kept]
            return called.content
        if macro.body not in self._plan.modules or context.is_inside:
            comment = macro.comment if self._first[macro.body] is called else ""
            return [*([Comment(comment, follows=False)] if comment else []), *called.content]
        return self._used(called, macros, evaluator)

    # Modules

    def _used(self, called: Called, macros: Table[Macro], evaluator: Evaluator) -> list[Content]:
        """Return the use of a module, and what of the macro belongs to the file that uses it."""
        macro = called.macro
        module = self.modules.get(macro.body)
        if module is None:
            module = self._module(called, macros, evaluator)
        use = Use(module.file, dict(called.arguments), called.element, blocks=called.blocks)
        for name, find in module.imports.items():
            use.arguments[name] = as_parts(find(called.context, evaluator)) or ("",)
        use.inline, outer = split(called.content, self._plan.outer.get(macro.body, ()))
        use.attachment = _mount_of(macro, use.inline)
        return [use, *outer]

    def _module(self, called: Called, macros: Table[Macro], evaluator: Evaluator) -> Module:
        macro = called.macro
        file = FileDraft(macro.name, root=macro.body, comment=macro.comment, is_module=True, stem=macro.name)
        scope: Table[Property] = Table(file=file)
        scope.entries |= self._parameters(called, file)
        context = Context(file, called.context.folder, Table(macros), scope, (called,))
        module = self.modules[macro.body] = Module(file, macro, context)
        self._by_file[file] = module
        self._callers.append((file, called.context))
        outer = self._plan.outer.get(macro.body, frozenset())
        self._require_own_ends(called, outer)
        try:
            file.content, _ = split(evaluator.walk(macro.body.content, context), outer)
            file.attachment = find_attachment(file.content)
            require_known_blocks(file)
        except CannotTranslateError as error:
            outer, named = outer_parts(file.content), parameters_in_names(file.content)
            raise NoModuleError(macro.body, error.reason, outer=outer, named=named) from None
        except NotConstantError as error:
            if any(symbol.is_argument for symbol in error.symbols):
                raise
            reason = no_module(file, error)
            raise NoModuleError(macro.body, reason.reason, reason.fixed, outer_parts(file.content)) from None
        finally:
            self._callers.pop()
        return module

    def _parameters(self, called: Called, file: FileDraft) -> dict[str, Property]:
        """Return what the parameters of a macro are in its module, and declare those that it has as well."""
        macro, kinds = called.macro, self._plan.modules[called.macro.body]
        entries: dict[str, Property] = {}
        for parameter in macro.parameters:
            if parameter.startswith("*"):
                entries[parameter] = Block(content=(self._block(macro, parameter, file),))
                continue
            if parameter in self._plan.fixed.get(macro.body, ()):
                entries[parameter] = Value(_own_value(parameter, value_of(called.arguments[parameter]), file))
                continue
            default = macro.defaults.get(parameter, (None, None))[1]
            kind = kinds.get(parameter, UNKNOWN)
            symbol = Symbol(parameter, "parameter", kind=kind)
            if default is not None and "$" not in default:
                symbol.value = as_parts(value_of((unquoted(default),) if default else ("",))) or ("",)
            file.symbols.append(symbol)
            entries[parameter] = Value(refer(symbol))
        return entries

    def _block(self, macro: Macro, parameter: str, file: FileDraft) -> Element:
        """Return what stands for a block in a module."""
        form = self._plan.blocks.get(macro.body, {}).get(parameter)
        if form is None:
            return Element("origin", {}, [], calls=("block", ""))
        symbol = block_symbol(parameter, form)
        file.symbols.append(symbol)
        file.blocks[parameter] = symbol, form
        return marker(symbol, form)

    def _require_own_ends(self, called: Called, outer: frozenset[XmlElement]) -> None:
        """Refuse a module in this one that has the joint of this one, or what this one leaves to its user."""
        inner, moved = split(called.content, outer)
        attached = _mount_of(called.macro, inner)
        for end in (*elements_in(moved), *([attached] if attached else [])):
            for part in end.calls[len(called.context.calls) + 1 :]:
                body = part.macro.body if isinstance(part, Called) else None
                if body in self._plan.modules and end.origin not in self._plan.outer.get(body, ()):
                    reason = "the joint that attaches it is that of the macro around it"
                    raise NoModuleError(body, reason, outer=frozenset((end.origin,)) if end.origin else frozenset())

    def _caller(self, context: Context) -> Context | None:
        return next((caller for file, caller in reversed(self._callers) if file is context.file), None)

    def block(self, name: str, context: Context) -> Block | None:
        """Return the elements that a property of a caller holds, for a module."""
        caller = self._caller(context)
        found = caller.symbols.get(f"**{name}") if caller else None
        if found is None and caller is not None:
            return self.block(name, caller)
        return found if isinstance(found, Block) and found.elements is not None else None

    def imported(self, name: str, context: Context, evaluator: Evaluator) -> ast.expr | None:
        """Return a name of a caller in a module: a constant as a variable of its own, another one as a parameter.

        A parameter of the caller is one here, too, unless the module needs its value.
        """
        caller = self._caller(context)
        if caller is None:
            return None
        found = caller.symbols.find(name)
        node = evaluator.lookup(name, caller)
        if node is None:
            return None
        top = context.symbols.top
        entry = found[1] if found else None
        source = entry.source if isinstance(entry, Value) else None
        if isinstance(entry, Value) and entry.test is not None:
            raise NotConstantError(symbols_in(entry.test))  # a module cannot have it in some cases only
        is_parameter = source is None and any(name in one.arguments for one in caller.calls)
        is_fixed = name in self._plan.fixed.get(self._by_file[context.file].macro.body, ())
        try:
            known = constant_of(node)
        except NotConstantError:
            return self._as_parameter(name, node, context, lambda where, by: _looked_up(name, where, by))
        if is_parameter and not is_fixed:
            return self._as_parameter(name, node, context, lambda where, by: _looked_up(name, where, by))
        if isinstance(node, Reference) and node.symbol.role == "data":
            own = _own_value(name, node, context.file)
            top.entries[name] = Value(own)
            return own
        if isinstance(known, dict | list):
            return self._as_parameter(name, node, context, lambda where, by: _looked_up(name, where, by))
        if source is not None and context.symbols.top.file is context.file:
            top.entries[name] = source
            return evaluator.lookup(name, context)
        symbol = Symbol(name, "variable", as_parts(constant(known)) or ("",), known, kind_of(constant(known)))
        symbol.place = source.place if source else symbol.place
        context.file.symbols.append(symbol)
        top.entries[name] = Value(refer(symbol))
        return refer(symbol)

    def _as_parameter(
        self, name: str, node: ast.expr, context: Context, find: Callable[[Context, Evaluator], ast.expr]
    ) -> ast.expr:
        module = self._by_file[context.file]
        symbol = Symbol(name, "parameter", kind=kind_of(node))
        context.file.symbols.append(symbol)
        module.imports[name] = find
        context.symbols.top.entries[name] = Value(refer(symbol))
        return refer(symbol)

    def require_file(self, parts: Parts, context: Context) -> None:
        """Refuse an argument that names a file of data and is empty: a spec reads its data in any case."""
        if len(parts) != 1 or not isinstance(parts[0], Reference):
            return
        symbol = parts[0].symbol
        called = context.calls[0] if context.calls else None
        if not symbol.is_argument and called is not None and symbol.wish in called.arguments:
            parts = called.arguments[symbol.wish]
            if parts in ((), ("",)):
                raise NotConstantError(frozenset((symbol,)))
            self.require_file(parts, called.context)
        if symbol.is_argument and symbol.constant is UNSET and symbol.value in ((), ("",)):
            raise NotConstantError(frozenset((symbol,)))

    def argument(self, name: str, context: Context, evaluator: Evaluator) -> ast.expr:
        """Return an argument of the robot; in a module, a parameter that gets it."""
        if name not in evaluator.arguments:
            if name not in evaluator.given:
                raise CannotTranslateError(f"the argument '{name}', which is not declared before; pass {name}:=VALUE")
            evaluator.declare(name, None)
        symbol = evaluator.arguments[name]
        if symbol.constant is not UNSET:
            return as_expression((str(evaluator.path_text(symbol.value or ())),))
        module = self._by_file.get(context.file)
        if module is None:
            return as_given(symbol)
        key = f"$(arg {name})"
        top = context.symbols.top
        if isinstance(known := top.entries.get(key), Value):
            return as_given(known.node.symbol) if isinstance(known.node, Reference) else known.node
        taken = {one.wish for one in context.file.symbols}
        own = Symbol(name if name not in taken else f"{name}_argument", "parameter", kind=symbol.kind)
        own.choices = symbol.choices
        context.file.symbols.append(own)
        module.imports[own.wish] = lambda where, by: by.calls.argument(name, where, by)
        top.entries[key] = Value(refer(own))
        return as_given(own)


def no_module(file: FileDraft, error: NotConstantError) -> NoModuleError:
    """Return the reason why a module cannot be written, with the parameters that need one value."""
    fixed = {one.wish for one in sources_of(error.symbols) if one in file.symbols and one.role == "parameter"}
    assert file.root is not None, "a module is a macro"
    return NoModuleError(file.root, f"something in it depends on {error}", frozenset(fixed))


def _own_value(name: str, node: ast.expr, file: FileDraft) -> ast.expr:
    """Return a value that is the same everywhere as one of a file: data as its own, other values as literals."""
    if not symbols_in(node):
        return node
    known = constant_of(node)
    if not isinstance(node, Reference) or not isinstance(known, dict | list):
        return constant(known)
    same = (one for one in file.symbols if one.wish == name and one.role == node.symbol.role)
    symbol = next(same, None)
    if symbol is None:
        symbol = Symbol(name, node.symbol.role, node.symbol.value, known, MAP, node.symbol.comment)
        file.symbols.append(symbol)
    return refer(symbol)


def _mount_of(macro: Macro, content: list[Content]) -> Element | None:
    try:
        return find_attachment(content, may_be_nested=True)
    except CannotTranslateError as error:
        raise NoModuleError(macro.body, error.reason, outer=outer_parts(content)) from None


def _looked_up(name: str, context: Context, evaluator: Evaluator) -> ast.expr:
    node = evaluator.lookup(name, context)
    if node is None:
        raise CannotTranslateError(f"the property '{name}', which is not defined")
    return node
