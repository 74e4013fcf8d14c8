"""What Python a template becomes: functions that put the lines of a document where they belong.

Jinja reads the templates. The Python that it makes of them itself looks every name up as it runs and knows nothing of
layout, and to import Jinja takes a sixth of a short command. So this is made of them instead, and is kept: whoever has
it imports neither Jinja nor this module.

Of Jinja's language it knows what lays out. Each tag stands on a line of its own, or on one with its text and its end,
and an element ends in the block that begins it: so how deep a line stands is known before there is a robot.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import NamedTuple, TypeAlias

from jinja2 import Environment, nodes

from linkforge_compile.backends.markup import INDENT, is_closing, is_opening

_Names: TypeAlias = Mapping[str, str]
"""The variable of Python that stands for each name of a template in sight."""

_Piece: TypeAlias = str | nodes.Expr
"""What a line of a template says, or a value in it."""

_KNOWN = "'for' and 'if' without 'else', 'set', 'include', 'from … import' and 'macro' without defaults are known"
_KNOWN_VALUES = "names, attributes, constants, tuples, 'or' and 'is not none' are known"
_UNEVEN = "an element ends in the block that begins it"
_SHARED = "a statement shares its line with statements alone, not with text or a value"
_SET_IN_IF = "a name that is set in an 'if' stays set behind it in Jinja, and would not here; set it outside"


class UnknownInTemplateError(Exception):
    """A template says what does not become Python here; the message begins with its name and line."""

    def __init__(self, template: str, line: int, reason: str) -> None:
        self.template, self.line, self.reason = template, line, reason
        super().__init__(f"{template}:{line}: {reason}")


def python_of(template: str, texts: Mapping[str, str], name: str) -> str:
    """Return the text of a module whose `document(lines, robot)` appends the lines that a template makes of a robot.

    `texts` are those of all templates, by the paths that they include each other by; `name` is what they call the
    robot. The module calls `ready`, `lay` and `end`, which are those of `markup`.

    Raises:
        UnknownInTemplateError: for what this does not know.
        jinja2.TemplateSyntaxError: for what is no template.

    """
    environment = Environment(trim_blocks=True, lstrip_blocks=True, keep_trailing_newline=True)
    for path, text in texts.items():
        _require_statements_apart(path, environment.lex(text, path))
    module = _Module({path: environment.parse(text, path) for path, text in texts.items()})
    document = _Function(module, template, "document", [name])
    document.template(template, document.arguments)
    return "\n".join([*document.python, *module.macro_functions(), ""])


def _require_statements_apart(template: str, tokens: Iterable[tuple[int, str, str]]) -> None:
    """Refuse a statement on a line that says something: that would be two lines here, and is one to Jinja."""
    statements: set[int] = set()
    said: set[int] = set()
    for line, kind, token in tokens:
        if kind in ("block_begin", "block_end"):
            statements.add(line)
        elif kind in ("variable_begin", "variable_end"):
            said.add(line)
        elif kind == "data":
            said.update(number for number, text in enumerate(token.split("\n"), start=line) if text.strip())
    for line in sorted(statements & said):
        raise UnknownInTemplateError(template, line, _SHARED)


class _Macro(NamedTuple):
    """A macro of a template, and the name of the function that it becomes."""

    template: str
    node: nodes.Macro
    function: str


class _Module:
    """The templates by their paths, and those of their macros that are called."""

    def __init__(self, trees: Mapping[str, nodes.Template]) -> None:
        self.trees = trees
        self._called: dict[tuple[str, str], _Macro] = {}

    def macro(self, template: str, name: str) -> _Macro | None:
        """Return the macro of that name which a template has or imports."""
        for node in self.trees[template].body if template in self.trees else ():
            match node:
                case nodes.Macro(name=own) if own == name:
                    macro = _Macro(template, node, f"macro_{len(self._called)}_{name}")
                    return self._called.setdefault((template, name), macro)
                case nodes.FromImport(template=nodes.Const(value=path), names=names) if name in names:
                    return self.macro(path, name)
        return None

    def macro_functions(self) -> Iterator[str]:
        """Yield the Python of all macros that are called, by other macros as well."""
        done: list[_Macro] = []
        while macros := [macro for macro in self._called.values() if macro not in done]:
            for template, node, name in macros:
                function = _Function(self, template, name, [one.name for one in node.args], indent="indent")
                function.block(node.body, function.arguments)
                yield from function.python
            done += macros


class _Line(NamedTuple):
    """A line of a template, without the white space around it."""

    number: int
    pieces: Sequence[_Piece]


class _Function:
    """A function in the making; its parameter `indent` is what stands before its lines, empty for nothing."""

    def __init__(
        self, module: _Module, template: str, name: str, arguments: Iterable[str], *, indent: str = ""
    ) -> None:
        self._module = module
        self._template = template
        self._indent = indent
        self._depth = 0  # of elements
        self._blocks = 1  # of Python around a statement
        self._variables = 0
        self.arguments: _Names = {argument: self._variable(argument) for argument in arguments}
        self.python = [f"def {name}({', '.join(filter(None, ['lines', indent, *self.arguments.values()]))}):"]

    def _variable(self, name: str) -> str:
        """Return a variable of its own: a name in a block hides that around it, and leaves it as it was."""
        self._variables += 1
        return f"{name}_{self._variables}"

    def _say(self, statement: str) -> None:
        self.python.append(f"{' ' * self._blocks}{statement}")

    def _fault(self, line: int, reason: str) -> UnknownInTemplateError:
        return UnknownInTemplateError(self._template, line, reason)

    def template(self, template: str, names: _Names) -> None:
        """Say what a template does where these names are in sight."""
        around, self._template = self._template, template
        self.block(self._module.trees[template].body, names)
        self._template = around

    def block(self, body: Sequence[nodes.Node], names: _Names) -> None:
        """Say what stands in a block; what it names is in sight in it alone."""
        own: dict[str, str] = dict(names)
        begun: list[str] = []
        length = len(self.python)
        for node in body:
            match node:
                case nodes.Output():
                    for line in _lines(node):
                        self._line(line, own, begun)
                case nodes.Assign(target=nodes.Name(name=name), node=value):
                    variable = self._variable(name)
                    self._say(f"{variable} = {self._value(value, own)}")
                    own[name] = variable
                case _:
                    self._statement(node, own)
        if begun:
            raise self._fault(body[-1].lineno, _UNEVEN)
        if len(self.python) == length:
            self._say("pass")

    def _statement(self, node: nodes.Node, names: _Names) -> None:
        match node:
            case nodes.If(test=test, body=body, elif_=[], else_=[]):
                for assignment in (one for one in body if isinstance(one, nodes.Assign)):
                    raise self._fault(assignment.lineno, _SET_IN_IF)
                with self._below(f"if {self._value(test, names)}:"):
                    self.block(body, names)
            case nodes.For(target=target, iter=values, body=body, else_=[], test=None, recursive=False):
                own = [target] if isinstance(target, nodes.Name) else target.find_all(nodes.Name)
                inside = {**names, **{name.name: self._variable(name.name) for name in own}}
                with self._below(f"for {self._value(target, inside)} in {self._value(values, names)}:"):
                    self.block(body, inside)
            case nodes.Include(template=path, with_context=True, ignore_missing=False):
                self._include(path, names)
            case nodes.Macro(defaults=[]) | nodes.FromImport(with_context=False):
                pass  # a function where it is called
            case _:
                raise self._fault(node.lineno, f"{_KNOWN}, found '{type(node).__name__}'")

    @contextmanager
    def _below(self, head: str) -> Iterator[None]:
        self._say(head)
        self._blocks += 1
        yield
        self._blocks -= 1

    def _include(self, template: nodes.Expr, names: _Names) -> None:
        match template:
            case nodes.Const(value=path) if path in self._module.trees:
                self.template(path, names)
            case nodes.Concat(nodes=[nodes.Const(value=start), kind, nodes.Const(value=end)]):
                self._include_of_kind(start, self._value(kind, names), end, names)
            case _:
                raise self._fault(template.lineno, "a template is included by its path, or by 'start' ~ value ~ 'end'")

    def _include_of_kind(self, start: str, kind: str, end: str, names: _Names) -> None:
        branch = "if"
        for path in self._module.trees:
            if path.startswith(start) and path.endswith(end):
                with self._below(f"{branch} {kind} == {path.removeprefix(start).removesuffix(end)!r}:"):
                    self.template(path, names)
                branch = "elif"
        self._say(f"{'else' if branch == 'elif' else 'if True'}: raise LookupError({kind})")

    def _line(self, line: _Line, names: _Names, begun: list[str]) -> None:
        """Say what puts a line in its place; `begun` are the variables that know where open elements began."""
        match line.pieces:
            case [nodes.Call() as call]:
                self._call(call, names)
            case [nodes.Expr() as value]:
                self._say(f"lay(lines, {self._placed([''], names)}, {self._value(value, names)})")
            case _:
                self._tag(line, names, begun)

    def _tag(self, line: _Line, names: _Names, begun: list[str]) -> None:
        tag = "".join([piece if isinstance(piece, str) else "value" for piece in line.pieces])
        if not (tag.startswith("<") and tag.endswith(">")):
            raise self._fault(line.number, f"a line is one value, or begins and ends as a tag does, found '{tag}'")
        if is_closing(tag):
            if not begun:
                raise self._fault(line.number, _UNEVEN)
            self._depth -= 1
            self._say(f"end(lines, {begun.pop()}, {self._placed(line.pieces, names)})")
            return
        self._say(f"lines.append({self._placed(line.pieces, names)})")
        if is_opening(tag):
            self._depth += 1
            begun.append(self._variable("begun"))
            self._say(f"{begun[-1]} = len(lines)")

    def _placed(self, pieces: Sequence[_Piece], names: _Names) -> str:
        """Return the expression of a line as deep as it stands; the first of its pieces is text."""
        pieces = [f"{INDENT * self._depth}{pieces[0]}", *pieces[1:]]
        said = [repr(one) if isinstance(one, str) else f"ready({self._value(one, names)})" for one in pieces]
        return " + ".join(filter(None, [self._indent, *said]))

    def _call(self, call: nodes.Call, names: _Names) -> None:
        name = call.node.name if isinstance(call.node, nodes.Name) else ""
        macro = self._module.macro(self._template, name)
        if macro is None or len(call.args) != len(macro.node.args) or call.kwargs or call.dyn_args or call.dyn_kwargs:
            raise self._fault(call.lineno, "a call names a macro of this template or an imported one, and all it takes")
        arguments = [self._value(argument, names) for argument in call.args]
        self._say(f"{macro.function}({', '.join(['lines', self._placed([''], names), *arguments])})")

    def _value(self, node: nodes.Node, names: _Names) -> str:
        """Return the expression of Python for that of a template."""
        match node:
            case nodes.Name(name=name) if name in names:
                return names[name]
            case nodes.Name(name=name):
                raise self._fault(node.lineno, f"no '{name}' is in sight, only {', '.join(map(repr, names))}")
            case nodes.Const(value=value):
                return repr(value)
            case nodes.Getattr(node=owner, attr=attribute):
                return f"{self._value(owner, names)}.{attribute}"
            case nodes.Tuple(items=items):
                return f"({''.join(f'{self._value(item, names)}, ' for item in items)})"
            case nodes.Or(left=left, right=right):
                return f"({self._value(left, names)} or {self._value(right, names)})"
            case nodes.Not(node=nodes.Test(node=inner, name="none")):
                return f"({self._value(inner, names)} is not None)"
            case _:
                raise self._fault(node.lineno, f"{_KNOWN_VALUES}, found '{type(node).__name__}'")


def _lines(output: nodes.Output) -> Iterator[_Line]:
    """Yield the lines of what stands between two blocks, but for those that say nothing."""
    lines: list[tuple[int, list[_Piece]]] = [(output.lineno, [])]
    for node in output.nodes:
        if not isinstance(node, nodes.TemplateData):
            lines[-1][1].append(node)
            continue
        first, *rest = node.data.split("\n")
        lines[-1][1].append(first)
        lines += [(number, [text]) for number, text in enumerate(rest, start=node.lineno + 1)]
    for number, pieces in lines:
        if isinstance(pieces[0], str):
            pieces[0] = pieces[0].lstrip()
        if isinstance(pieces[-1], str):
            pieces[-1] = pieces[-1].rstrip()
        if said := [piece for piece in pieces if piece != ""]:
            yield _Line(number, said)
