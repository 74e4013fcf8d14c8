"""Walk a xacro as xacro does, and keep what depends on an argument as expressions, conditions and uses of modules."""

from __future__ import annotations

import ast
import copy
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import TypeAlias

from linkforge_compile.migration.constants import constant_of
from linkforge_compile.migration.evaluate import Context, Evaluator
from linkforge_compile.migration.logic import as_condition, combined, negated
from linkforge_compile.migration.scopes import Block, Lazy, Macro, Property, Table, Value
from linkforge_compile.migration.symbols import (
    CannotTranslateError,
    MissingFileError,
    NotConstantError,
    Parts,
    Symbol,
    UndefinedError,
    as_expression,
    is_literal,
    symbols_in,
    value_of,
)
from linkforge_compile.migration.template import Choice, Comment, Content, Element, FileDraft, Text, Use
from linkforge_compile.source.xml_tree import XmlComment, XmlContent, XmlElement

_MOST_DEEP = 60
_MOST_INCLUDED = 50
_MOST_ELEMENTS = 100_000
"""The elements of one expansion; the largest robots have a tenth of them."""

Journal: TypeAlias = "list[tuple[Table[Property], str, Property | None]]"
"""What was set, with what was there before."""


class Expander(Evaluator):
    """Expands one xacro."""

    _documented: Symbol | Lazy | None = None
    """What a comment at the end of the line is about."""

    _walked = 0
    _including: tuple[Path, ...] = ()
    """The files around an element that include one another."""

    def expand(self) -> FileDraft:
        """Return the robot of the main file."""
        path = self.sources.main
        root = self.sources.open(path).root
        self._including = (path.resolve(),)
        context = Context(self.robot, path.parent.absolute(), Table(), Table(file=self.robot))
        self.robot.root = root
        self.robot.content = self.walk(root.content, context)
        attributes = self._attributes(root, context)
        self.robot.robot_name = attributes.pop("name", ())
        self.robot.robot_attributes = attributes
        return self.robot

    def walk(self, content: Iterable[XmlContent], context: Context) -> list[Content]:
        """Return what the content of an element expands to."""
        made: list[Content] = []
        for item in content:
            if isinstance(item, str):
                if item.strip():
                    self._documented = None
                made.append(Text(self.text(item, context) if "$" in item else (item,)))
            elif isinstance(item, XmlComment):
                self._comment(item, made)
            else:
                documented = self._documented
                try:
                    found = self._element(item, context, made)
                    if found and isinstance(found[0], Use):
                        found[0].comment = _comments_before(made)
                    made += found
                except (CannotTranslateError, NotConstantError) as error:
                    error.where = error.where or item.span
                    raise
                if self._documented is documented:
                    self._documented = None
        return made

    # Elements

    def _attributes(self, element: XmlElement, context: Context) -> dict[str, Parts]:
        return {
            name: self.text(value, context)
            for name, value in element.values.items()
            if not name.startswith("xacro:") and name != "xmlns:xacro"
        }

    def _element(self, element: XmlElement, context: Context, before: list[Content]) -> list[Content]:
        self._walked += 1
        if self._walked > _MOST_ELEMENTS:
            raise CannotTranslateError(f"more than {_MOST_ELEMENTS:,} elements")
        if self._walked % 100 == 0:
            self.deadline.check()
        match element.tag:
            case "xacro:include":
                return self._include(element, context)
            case "xacro:property":
                return self._property(element, context, before)
            case "xacro:macro":
                self._macro(element, context, _comments_before(before))
                return []
            case "xacro:arg":
                self._argument(element, context, _comments_before(before))
                return []
            case "xacro:if" | "xacro:unless":
                return self._condition(element, context)
            case "xacro:insert_block":
                return self._insert(element, context)
            case "xacro:element" | "xacro:attribute":
                raise CannotTranslateError(f"<{element.tag}>")
        if element.tag.startswith("xacro:"):
            if len(context.calls) > _MOST_DEEP:
                raise CannotTranslateError("a macro that calls itself without an end")
            return self.calls.call(element, context, self)
        inside = replace(context, is_inside=True)
        attributes = self._attributes(element, context)
        return [Element(element.tag, attributes, self.walk(element.content, inside), element, context.calls)]

    def _include(self, element: XmlElement, context: Context) -> list[Content]:
        path = self.path_text(self.text(element.get("filename") or "", context))
        space = element.get("ns")
        is_optional = self._flag(element.get("optional") or "false", context)
        macros, symbols = context.macros, context.symbols
        if space:
            name = str(constant_of(as_expression(self.text(space, context))))
            macros, symbols = Table(macros, is_namespace=True), Table(symbols, is_namespace=True, file=symbols.file)
            context.macros.namespaces[name], context.symbols.namespaces[name] = macros, symbols
        made: list[Content] = []
        for file in self.sources.included(path, context.folder):
            if not file.is_file():
                if is_optional:
                    continue
                raise MissingFileError(f"the file '{file}', which does not exist")
            around = self._including
            if file.resolve() in around or len(around) == _MOST_INCLUDED:
                raise CannotTranslateError(f"'{file}', which includes itself or is included too deep")
            root = self.sources.open(file).root
            self._including = (*around, file.resolve())
            inside = replace(context, folder=file.parent.absolute(), macros=macros, symbols=symbols)
            made += self.walk(root.content, inside)
            self._including = around
        return made

    def _property(self, element: XmlElement, context: Context, before: list[Content]) -> list[Content]:
        name = self.path_text(self.text(element.get("name") or "", context))
        table, comment = context.symbols, _comments_before(before)
        scope = element.get("scope")
        if scope == "global":
            table = context.symbols.top
        elif scope == "parent":
            table = context.symbols.caller or table
        if self._flag(element.get("remove") or "false", context):
            for scope_around in context.symbols.chain():
                scope_around.entries.pop(name, None)
            return []
        text = element.get("value")
        if (default := element.get("default")) is not None:
            if self.lookup(name, context) is not None:
                return []
            text = default
        if text is None:
            table.set(f"**{name}", Block(element, folder=context.folder))
            return []
        entry = Lazy(text, context.folder, comment, (element.file.name, element.begin))
        if scope or not self._flag(element.get("lazy_eval") or "true", context):
            node = value_of(self.text(text, context))
            file = table.file
            made = self.variable(name, node, file, comment, entry.place) if file else node
            table.set(name, Value(made))
        else:
            table.set(name, entry)
        self._documented = entry
        return []

    def _flag(self, text: str, context: Context) -> bool:
        """Return an attribute of an instruction of xacro that is true or false."""
        return bool(constant_of(as_condition(value_of(self.text(text, context)), text)))

    def _macro(self, element: XmlElement, context: Context, comment: str) -> None:
        from xacro import parse_macro_arg

        name = (element.get("name") or "").removeprefix("xacro:")
        rest = element.get("params") or ""
        parameters: list[str] = []
        defaults: dict[str, tuple[str | None, str | None]] = {}
        while rest and rest.strip():
            parameter, default, rest = parse_macro_arg(rest)
            parameters.append(parameter)
            if default is not None:
                defaults[parameter] = default
        file = element.file.path or Path(element.file.name)
        macro = Macro(name, tuple(parameters), defaults, element, context.folder, file, comment)
        self.calls.define(macro)
        context.macros.set(name, macro)

    def _argument(self, element: XmlElement, context: Context, comment: str) -> None:
        name = element.get("name") or ""
        if name in self.arguments and self.arguments[name].value is not None:
            return
        default = self.text(element.get("default") or "", context)
        self._documented = symbol = self.declare(name, default, comment)
        symbol.where = element.span

    def _condition(self, element: XmlElement, context: Context) -> list[Content]:
        text = element.get("value") or ""
        test = as_condition(value_of(self.text(text, context)), text)
        if element.tag == "xacro:unless":
            test = negated(test)
        try:
            is_true = constant_of(test)
        except NotConstantError:
            pass
        else:
            self.decided += 1
            return self.walk(element.content, context) if is_true else []
        properties, macros = context.symbols.journal, context.macros.journal
        marks = len(properties), len(macros)
        try:
            content = self.walk(element.content, context)
        except MissingFileError as error:  # the specs have only the outcome without it
            raise NotConstantError(symbols_in(test), error.reason) from None
        except UndefinedError:
            content = []  # authors refuse a value by calling a macro that does not exist
        # A condition around this one sees what they were before.
        properties[marks[0] :] = self._merge_definitions(properties[marks[0] :], test, context)
        for table, name, old in macros[marks[1] :]:
            if old is not None and old.body is not table.entries[name].body:
                raise NotConstantError(symbols_in(test))
        del macros[marks[1] :]
        return [Choice(test, content, element)] if content else []

    def _merge_definitions(self, journal: Journal, test: ast.expr, context: Context) -> Journal:
        """Give what a condition defines the value that it has with and without it, and return what was before."""
        first: dict[tuple[int, str], tuple[Table[Property], Property | None]] = {}
        for table, name, old in journal:
            first.setdefault((id(table), name), (table, old))
        for (_, name), (table, old) in first.items():
            new = table.entries.get(name)
            if isinstance(new, Block) or isinstance(old, Block) or new is None:
                raise NotConstantError(symbols_in(test))
            if table in context.symbols.chain():  # else it is of a macro whose call is over
                self._merge_definition(table, name, (new, old), test, context)
        return [(table, name, old) for (_, name), (table, old) in first.items()]

    def _merge_definition(
        self,
        table: Table[Property],
        name: str,
        entries: tuple[Lazy | Value, Lazy | Value | None],
        test: ast.expr,
        context: Context,
    ) -> None:
        new, old = entries
        # The alternatives are no variables, the result is.
        file, table.file = table.file, None
        node = self.resolved(table, name, new, context)
        other = None if old is None else self.resolved(table, name, old, context)
        table.file = file
        if other is None:
            inner = [new.test] if isinstance(new, Value) and new.test is not None else []
            table.entries[name] = Value(node, combined(ast.And(), [test, *inner]) if inner else test)
            return
        known = old.test if isinstance(old, Value) else None
        if known is None or ast.dump(negated(known)) != ast.dump(test):
            node = ast.IfExp(test=test, body=node, orelse=other)
        else:
            node = ast.IfExp(test=known, body=other, orelse=node)
        if file is not None:
            source = new if isinstance(new, Lazy) else new.source
            node = self.variable(name, node, file, "", source.place if source else ("", 0))
        table.entries[name] = Value(node)

    def _insert(self, element: XmlElement, context: Context) -> list[Content]:
        name = element.get("name") or ""
        for key in (f"**{name}", f"*{name}"):
            block = context.symbols.get(key)
            if isinstance(block, Block):
                break
        else:
            block = self.calls.block(name, context)
        if not isinstance(block, Block):
            raise CannotTranslateError(f"the block '{name}', which is not defined")
        if block.elements is None:
            return [copy.copy(one) for one in block.content]
        inside = replace(context, folder=block.folder)
        return self.walk(block.elements.content, inside)

    def _comment(self, comment: XmlComment, made: list[Content]) -> None:
        target = self._documented
        if comment.follows and target is not None:
            target.comment = f"{target.comment}\n{comment.text.strip()}".strip()
        else:
            made.append(Comment(comment.text, comment.follows))


def _comments_before(made: list[Content]) -> str:
    """Remove the comments at the end of a content, with no blank line after them, and return their text."""
    texts: list[str] = []
    end = len(made)
    while end:
        last = made[end - 1]
        if isinstance(last, Text) and is_literal(last.parts) and _is_one_line_end(last.parts):
            end -= 1
            continue
        if not isinstance(last, Comment) or last.follows:
            break
        texts.append(last.text.strip())
        end -= 1
    if texts:
        made[end:] = [Text(("\n",))]
    return "\n".join(reversed(texts))


def _is_one_line_end(parts: Parts) -> bool:
    text = "".join(map(str, parts))
    return not text.strip() and text.count("\n") <= 1
