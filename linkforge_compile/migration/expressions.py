"""Translate the texts and expressions of xacro: each `${…}` is Python, of which the language has a part."""

from __future__ import annotations

import ast
import re
from collections.abc import Mapping

from linkforge_compile.migration.computed import MARK, MATH, Names, computed
from linkforge_compile.migration.constants import constant_of
from linkforge_compile.migration.formulas import with_formula
from linkforge_compile.migration.logic import as_condition, combined, compared, folded, negated
from linkforge_compile.migration.symbols import (
    MAP,
    NUMBER,
    TEXT,
    UNKNOWN,
    VECTOR,
    CannotTranslateError,
    NotConstantError,
    Parts,
    Reference,
    TooLargeError,
    UndefinedError,
    as_expression,
    as_parts,
    call,
    constant,
    joined,
    kind_of,
    literal_of,
)
from linkforge_compile.migration.vectors import is_data

_PIECES = re.compile(
    r"(?P<escaped>\$\$+(?=[{(]))|\$\{(?P<expression>[^}]*)\}|\$\((?P<extension>[^)]*)\)|(?P<text>[^$]+|\$)"
)
_SAME = frozenset(
    (
        *("sin", "cos", "tan", "asin", "acos", "atan2", "sqrt", "floor", "ceil", "radians", "degrees", "abs"),
        *("min", "max", "round", "len", "int", "float", "str"),
    )
)
_NAMESPACES = ("math", "python", "xacro")


def translate_text(text: str, names: Names) -> Parts:
    """Return a text with the expressions in it as expressions of the language."""
    parts: Parts = ()
    pieces: list[Parts] = []
    for found in _PIECES.finditer(text):
        if found["expression"] is not None:
            pieces.append(_whole(translate_expression(found["expression"], names)))
        elif found["extension"] is not None:
            pieces.append(names.extension(found["extension"]))
        else:
            pieces.append((found["escaped"][1:],) if found["escaped"] else (found["text"],))
    if len(pieces) == 1:
        return pieces[0]
    for piece in pieces:
        parts = joined(parts, *(as_parts(one) if isinstance(one, ast.expr) else (one,) for one in piece))
    return parts


def _whole(node: ast.expr) -> Parts:
    return as_parts(node) if kind_of(node) == TEXT else (node,)


_EXTENSION = re.compile(r"\$\(([^)]*)\)")


def translate_expression(text: str, names: Names) -> ast.expr:
    """Return an expression of xacro as one of the language.

    Raises:
        CannotTranslateError: for what has no equivalent in the language.

    """
    extensions: list[Parts] = []

    def mark(found: re.Match[str]) -> str:
        extensions.append(names.extension(found[1]))
        return f"XACRO{len(extensions) - 1}EXTENSION"

    source = _EXTENSION.sub(mark, text).strip()
    try:
        tree = ast.parse(f"({source})", mode="eval").body
        return _translated(tree, names, extensions, text)
    except SyntaxError:
        raise CannotTranslateError(f"'${{{text}}}' is not an expression") from None
    except RecursionError:
        raise TooLargeError("an expression that is nested too deeply") from None


def _translated(tree: ast.expr, names: Names, extensions: list[Parts], text: str) -> ast.expr:
    try:
        return folded(_Translator(names, extensions, text).visit(tree))
    except TooLargeError:
        raise
    except CannotTranslateError:
        known = computed(tree, names, extensions)
        if known is None:
            raise
        return known


class _Translator:
    def __init__(self, names: Names, extensions: list[Parts], text: str) -> None:
        self._names, self._extensions, self._text = names, extensions, text

    def refuse(self, what: str) -> CannotTranslateError:
        return CannotTranslateError(f"{what} in '${{{self._text}}}'")

    def visit(self, node: ast.expr) -> ast.expr:
        """Return an expression of Python as one of the language."""
        match node:
            case ast.Constant(value=str() as text):
                return self._text_constant(text)
            case ast.Constant(value=value) if value is None or isinstance(value, bool | int | float):
                return constant(value)
            case ast.Name(id=name):
                return self._name(name)
            case ast.Call():
                return with_formula(self._call(node), node, self._names.lookup)
            case ast.Subscript() | ast.Attribute():
                return self._part(node)
        return self._operation(node)

    def _operation(self, node: ast.expr) -> ast.expr:
        match node:
            case ast.UnaryOp(op=ast.Not(), operand=operand):
                return negated(self._condition(operand))
            case ast.UnaryOp(op=ast.USub() | ast.UAdd() as sign, operand=operand):
                value = folded(ast.UnaryOp(op=sign, operand=self.visit(operand)))
                return with_formula(value, node, self._names.lookup)
            case ast.BinOp():
                return with_formula(self._arithmetic(node), node, self._names.lookup)
            case ast.BoolOp(op=operation, values=values):
                return combined(operation, [self._condition(value) for value in values])
            case ast.Compare():
                return self._comparison(node)
            case ast.IfExp(test=test, body=body, orelse=orelse):
                return self._choice(test, body, orelse)
        raise self.refuse(_WHAT.get(type(node), "a form of Python that the language does not have"))

    def _part(self, node: ast.Subscript | ast.Attribute) -> ast.expr:
        match node:
            case ast.Subscript(value=ast.Call(func=ast.Attribute(value=text, attr="split"), args=by), slice=index):
                return self._word(self.visit(text), [literal_of(self.visit(one)) for one in by], self.visit(index))
            case ast.Subscript(value=whole, slice=index) if not isinstance(index, ast.Slice):
                return _item(self.visit(whole), self.visit(index))
            case ast.Attribute(value=ast.Name(id=space), attr=name) if space in _NAMESPACES:
                return self._name(name)
            case ast.Attribute(value=whole, attr=name):
                found = self._names.lookup(ast.unparse(node))
                return found if found is not None else _item(self.visit(whole), constant(name))
        raise self.refuse("a part of a list")

    def _name(self, name: str) -> ast.expr:
        if marked := MARK.fullmatch(name):
            node = as_expression(self._extensions[int(marked[1])])
            text = literal_of(node)
            if isinstance(node, Reference) and str((*(node.symbol.value or ()), "")[0]).startswith(("[", "{", "(")):
                raise self.refuse("an argument that is an expression of Python")
            return self.visit(ast.parse(f"({text})", mode="eval").body) if isinstance(text, str) else node
        found = self._names.lookup(name)
        if found is not None:
            return found
        if name in MATH:
            return constant(MATH[name])
        if name == "pi":
            return ast.Name(id="pi", ctx=ast.Load())
        raise self.refuse(f"'{name}', which is not defined,")

    def _text_constant(self, text: str) -> ast.expr:
        pieces = MARK.split(text)
        parts = [(one,) if number % 2 == 0 else self._extensions[int(one)] for number, one in enumerate(pieces)]
        return as_expression(joined(*parts))

    def _condition(self, node: ast.expr) -> ast.expr:
        return as_condition(self.visit(node), self._text)

    def _word(self, text: ast.expr, by: list[object], index: ast.expr) -> ast.expr:
        """Return a word of a text, which is a component where the text is a vector."""
        place = literal_of(index)
        if by not in ([], [" "]) or type(place) is not int or place < 0:
            raise self.refuse("the call of a method")
        try:
            return constant(str(constant_of(text)).split()[place])
        except (NotConstantError, IndexError):
            pass
        if not isinstance(text, Reference) and not is_data(text):
            raise self.refuse("the call of a method")
        if isinstance(text, Reference) and text.symbol.kind not in (UNKNOWN, TEXT, VECTOR):
            raise self.refuse("the call of a method")
        if isinstance(text, Reference):
            text.symbol.kind = VECTOR
        else:
            text = call("split", text)
        return ast.Subscript(value=text, slice=index, ctx=ast.Load())

    def _arithmetic(self, node: ast.BinOp) -> ast.expr:
        left, right = self.visit(node.left), self.visit(node.right)
        kinds = kind_of(left), kind_of(right)
        if isinstance(node.op, ast.Mod) and kinds[0] == TEXT:
            raise self.refuse("the formatting of a text")
        if not isinstance(node.op, ast.Add | ast.Sub | ast.Mult | ast.Div | ast.FloorDiv | ast.Mod | ast.Pow):
            raise self.refuse("an operator that the language does not have")
        if isinstance(node.op, ast.Add) and TEXT in kinds:
            return as_expression(joined(as_parts(left), as_parts(right)))
        if TEXT in kinds:
            raise self.refuse("arithmetic with a text")
        sign = literal_of(left)
        if isinstance(node.op, ast.Mult) and kinds[1] == NUMBER and type(sign) is int and abs(sign) == 1:
            # A macro multiplies by 1 or -1 for its side.
            return right if sign == 1 else folded(ast.UnaryOp(op=ast.USub(), operand=right))
        return folded(ast.BinOp(left=left, op=node.op, right=right))

    def _comparison(self, node: ast.Compare) -> ast.expr:
        match node:
            case ast.Compare(ops=[ast.In() | ast.NotIn() as among], comparators=[ast.List() | ast.Tuple() as items]):
                return self._one_of(node.left, items.elts, isinstance(among, ast.In))
        sides = [self.visit(side) for side in (node.left, *node.comparators)]
        if any(not isinstance(one, tuple(_COMPARISONS)) for one in node.ops):
            raise self.refuse("a comparison that the language does not have")
        if len(sides) == 2:
            return compared(sides[0], _COMPARISONS[type(node.ops[0])], sides[1])
        operations = [_COMPARISONS[type(one)]() for one in node.ops]
        return folded(ast.Compare(left=sides[0], ops=operations, comparators=sides[1:]))

    def _one_of(self, left: ast.expr, items: list[ast.expr], is_among: bool) -> ast.expr:
        """Return whether a value is one of several, as comparisons with each."""
        operation = ast.Eq if is_among else ast.NotEq
        side = self.visit(left)
        tests = [compared(side, operation, self.visit(item)) for item in items]
        return combined(ast.Or() if is_among else ast.And(), tests) if tests else constant(not is_among)

    def _choice(self, test: ast.expr, body: ast.expr, orelse: ast.expr) -> ast.expr:
        condition = self._condition(test)
        try:
            return self.visit(body if constant_of(condition) else orelse)
        except NotConstantError:
            return ast.IfExp(test=condition, body=self.visit(body), orelse=self.visit(orelse))

    def _call(self, node: ast.Call) -> ast.expr:
        match node.func:
            case ast.Name(id=name):
                pass
            case ast.Attribute(value=ast.Name(id=space), attr=name) if space in _NAMESPACES:
                pass
            case _:
                raise self.refuse("the call of a method")
        if node.keywords or any(isinstance(one, ast.Starred) for one in node.args):
            raise self.refuse("arguments by name")
        arguments = [self.visit(argument) for argument in node.args]
        return self._function(name, arguments)

    def _function(self, name: str, arguments: list[ast.expr]) -> ast.expr:
        match name, arguments:
            case "load_yaml", [path]:
                return self._names.load_data(as_parts(path))
            case "warning" | "error" | "message" | "print_location", _:
                return constant("")  # they print and give an empty text
            case "fatal", _:
                raise UndefinedError(f"fatal() in '${{{self._text}}}'")
            case "arg", [argument] if isinstance(text := literal_of(argument), str):
                return as_expression(self._names.extension(f"arg {text}"))
            case "pow", [base, power]:
                return folded(ast.BinOp(left=base, op=ast.Pow(), right=power))
            case "fabs", [value]:
                return folded(call("abs", value))
            case "atan", [value]:
                return folded(call("atan2", value, constant(1)))
            case "bool", [value]:
                return as_condition(value, self._text)
            case "str", [value] if kind_of(value) == TEXT:
                return value
            case "float" | "int", [value] if kind_of(value) == NUMBER and name == "float":
                return value
        if name in _SAME:
            return folded(call(name, *arguments))
        raise self.refuse(f"the function {name}()")


_WHAT: Mapping[type[ast.AST], str] = {
    ast.List: "a list in brackets",
    ast.Tuple: "a list of values",
    ast.Dict: "a map in braces",
    ast.ListComp: "a list comprehension",
    ast.DictComp: "a comprehension",
    ast.GeneratorExp: "a generator",
    ast.Lambda: "a lambda",
    ast.JoinedStr: "an f-string",
    ast.Subscript: "a part of a list",
}
_COMPARISONS: Mapping[type[ast.cmpop], type[ast.cmpop]] = {
    **{kind: kind for kind in (ast.Eq, ast.NotEq, ast.Lt, ast.LtE, ast.Gt, ast.GtE, ast.In, ast.NotIn)},
    ast.Is: ast.Eq,
    ast.IsNot: ast.NotEq,
}


def _item(whole: ast.expr, index: ast.expr) -> ast.expr:
    node: ast.expr = ast.Subscript(value=whole, slice=index, ctx=ast.Load())
    key = literal_of(index)
    if isinstance(key, str) and isinstance(whole, Reference) and whole.symbol.kind == UNKNOWN:
        whole.symbol.kind = MAP
    if isinstance(key, str) and key.isidentifier() and key not in _KEYWORDS:
        node = ast.Attribute(value=whole, attr=key, ctx=ast.Load())
    return node


_KEYWORDS = frozenset(("if", "else", "and", "or", "not", "in", "is", "for", "from", "with", "as", "class", "def"))
