"""The program that expands one xacro file with the xacro package, with limits on memory and on what it may do.

It reads a request from standard input, a line of JSON, and answers with one. With a `call` in the request, the result
is what a macro of the file makes, with the materials of the file that it names, and nothing else of it.

In between it sends questions: `{"find": NAME}` for the folder of a package, or null, and `{"may_read": PATH}` for true
or false.

Every element is marked with the index of its file and its index there, because the expanded text has no places, and
so is every comment that follows an element on the same line, because what replaces a call ends on a line of its own.
"""

from __future__ import annotations

import io
import json
import os
import re
import sys
from pathlib import Path
from typing import TYPE_CHECKING, TextIO, TypedDict
from xml.dom import minidom
from xml.dom.minidom import Comment, Element, Text

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from xml.dom.minidom import Document, Node

MARK = "linkforge-place"
_MEMORY = 2 * 1024**3

_ALLOWED_EVENTS = frozenset(
    ("builtins.id", "compile", "exec", "glob.glob", "glob.glob/2", "import", "marshal.loads", "sys._getframe")
)
"""The audit events of Python that xacro needs."""

_READ_EVENTS = frozenset(("open", "os.listdir", "os.scandir"))
_CODE_SUFFIXES = (".py", ".pyc", ".so", ".pyd")
_WRITING = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC | os.O_APPEND
_EXPRESSION = re.compile(r"\s*when evaluating expression '(.*)'", re.DOTALL)
_Answer = dict[str, object]


class _UnknownPackageError(Exception):
    """The compiler does not know where a package is."""


class _RefusedError(Exception):
    """The file does something that no robot description needs."""


class _Run:
    """One expansion, and the element that it has reached."""

    def __init__(self, answers: TextIO) -> None:
        self._answers = answers
        self.files: list[str] = []
        self.arguments: dict[str, str] = {}
        self.wanted: set[str] = set()
        self._place: str | None = None
        self._places: dict[int, str] = {}
        self._kept: list[Node] = []
        self._call: Element | None = None

    def find(self, name: str) -> str:
        folder = self._ask({"find": name})
        if not isinstance(folder, str):
            raise _UnknownPackageError(name)
        return folder

    def guard(self) -> None:
        """Refuse from now on whatever xacro does not need, and ask before a file is read.

        Expressions can reach anything in Python through attributes of objects. An audit hook sees what they do there:
        start programs, use the network, write or remove files, and get at other code.
        """
        own = tuple(real for folder in sys.path if folder and (real := _real(folder)))

        def refuse(event: str, arguments: tuple[object, ...]) -> None:
            if event in _ALLOWED_EVENTS:
                return
            if event not in _READ_EVENTS:
                raise _RefusedError(f"no robot description needs {event}")
            path, flags = arguments[0], arguments[-1]
            if event == "open" and (not isinstance(flags, int) or flags & _WRITING):
                raise _RefusedError("no robot description writes files")
            if not self._may_read(path, own):
                raise _RefusedError(f"'{path}' is not a file that it may read")

        sys.addaudithook(refuse)

    def _may_read(self, path: object, own: tuple[Path, ...]) -> bool:
        """Whether a file or folder may be read: Python's own code and folders (`own`), and what the compiler allows."""
        if not isinstance(path, str | bytes):
            return False
        # Not normalized: the compiler finds out where `..` leads after a link.
        named = Path.cwd() / os.fsdecode(path)
        # os.path handles paths without access; pathlib raises.
        if named.suffix in _CODE_SUFFIXES or os.path.isdir(named):  # noqa: PTH112
            real = _real(named)
            if real and any(real.is_relative_to(folder) for folder in own):
                return True
        return self._ask({"may_read": str(named)}) is True

    def _ask(self, question: _Answer) -> object:
        self._answers.write(json.dumps(question) + "\n")
        self._answers.flush()
        answer: object = json.loads(sys.stdin.readline())
        return answer

    def mark(self, document: Document, file: str) -> None:
        """Mark every element with its place; those of xacro reject attributes, and are recorded."""
        self.files.append(file)
        for number, element in enumerate(document.getElementsByTagName("*")):
            place = f"{len(self.files) - 1}:{number}"
            if not element.tagName.startswith("xacro:"):
                element.setAttribute(MARK, place)
                continue
            # Kept alive, so that no other object gets its id().
            self._kept.append(element)
            self._places[id(element)] = place
            if element.tagName == "xacro:arg":
                self.arguments.setdefault(element.getAttribute("name"), place)
        for comment in _comments(document):
            if _follows(comment):
                comment.data += f" {MARK}"

    def at(self, element: Element) -> None:
        """Record that xacro has reached an element, or a copy of it."""
        here: Node | None = element
        while isinstance(here, Element):
            if here is self._call:
                self._place = None
                return
            if place := self._places.get(id(here)) or here.getAttribute(MARK):
                self._place = place
                return
            here = here.parentNode

    def answer(self, path: str, arguments: dict[str, str], call: _Call | None) -> _Answer:
        write = Element.writexml
        try:
            import xacro
            from xacro import substitution_args
        except ImportError:
            return {"missing": True}
        # xacro replaces it by one that leaves out the space between tags, and so the lines of raw XML.
        Element.writexml = write  # type: ignore[method-assign]
        output = io.StringIO()
        sys.stdout = sys.stderr = output
        substitution_args._eval_find = self.find
        substitution_args._eval_arg = self._recording_names(substitution_args._eval_arg)
        self._watch(xacro)
        self.guard()
        try:
            root = self._expand(xacro, path, arguments, call)
            answer: _Answer = {"text": root.toxml()}
        except _UnknownPackageError:
            answer = {"error": ""}  # the compiler knows which
        except RecursionError:
            answer = {"error": "it calls itself without an end"}
        except MemoryError:
            answer = {"error": "it takes too much memory"}
        except Exception as error:  # expressions may raise anything
            answer = {**_fault(error), "line": getattr(error, "lineno", None)}
            answer["file"] = xacro.filestack[-1] if xacro.filestack else path
        warnings = [line.removeprefix("warning: ") for line in output.getvalue().splitlines() if line.strip()]
        read = [file for file in xacro.all_includes if file not in self.files]
        return {
            **answer,
            "files": self.files,
            "read": read,
            "arguments": self.arguments,
            "wanted": sorted(self.wanted),
            "warnings": warnings,
            "place": self._place,
        }

    def _expand(self, xacro: _Xacro, path: str, arguments: dict[str, str], call: _Call | None) -> Element:
        xacro.init_stacks(path)
        document = xacro.parse(None, path)
        root = document.documentElement
        assert root is not None, "a parsed document has a root"
        aside = self._call_instead(document, root, call) if call else None
        xacro.process_doc(document, mappings=arguments, verbosity=1)
        if aside:
            root.removeChild(aside)
            used = {one.getAttribute("name") for one in root.getElementsByTagName("material")}
            # Of a file that is included twice, one is enough.
            elements = [one for one in aside.childNodes if isinstance(one, Element)]
            materials = {_without_marks(one): one for one in elements if one.tagName == "material"}
            for material in materials.values():
                if material.getAttribute("name") in used:
                    root.insertBefore(material, root.firstChild)
        return root

    def _call_instead(self, document: Document, root: Element, call: _Call) -> Element:
        """Put all that is in the root aside, where macros and properties are declared, and a call behind it."""
        aside = document.createElement("linkforge-aside")
        for child in list(root.childNodes):
            aside.appendChild(child)
        root.appendChild(aside)
        self._call = document.createElement(f"xacro:{call['macro']}")
        for name, value in call["values"].items():
            self._call.setAttribute(name, value)
        for block in call["blocks"]:
            parsed = minidom.parseString(f'<block xmlns:xacro="http://www.ros.org/wiki/xacro">{block}</block>')
            assert parsed.documentElement is not None, "the compiler has parsed it"
            for child in parsed.documentElement.childNodes:
                self._call.appendChild(document.importNode(child, deep=True))
        root.appendChild(self._call)
        if not root.getAttribute("name"):
            root.setAttribute("name", call["macro"])
        return aside

    def _watch(self, xacro: _Xacro) -> None:
        """Patch xacro so that what it parses is marked, and the element it works on is recorded."""
        parse = xacro.parse

        def parse_marked(text: object, filename: str) -> Document:
            document = parse(text, filename)
            self.mark(document, filename)
            return document

        xacro.parse = parse_marked
        copy = minidom._clone_node  # type: ignore[attr-defined]  # typeshed leaves it out

        def copy_with_place(node: Node, *how: object) -> Node:
            copied: Node = copy(node, *how)
            if place := self._places.get(id(node)):
                self._kept.append(copied)
                self._places[id(copied)] = place
            return copied

        # Macros, and every call of one, are copies of elements.
        minidom._clone_node = copy_with_place  # type: ignore[attr-defined]  # as above
        xacro.print_location = lambda: None
        for name in ("eval_all", "check_attrs", "handle_macro_call", "grab_property"):
            setattr(xacro, name, self._followed(getattr(xacro, name)))

    def _recording_names(self, value_of: Callable[[str, dict[str, str]], str]) -> Callable[[str, dict[str, str]], str]:
        def record(name: str, args: dict[str, str]) -> str:
            self.wanted.add(name)
            return value_of(name, args)

        return record

    def _followed(self, step: Callable[..., object]) -> Callable[..., object]:
        def follow(element: Element, *rest: object) -> object:
            self.at(element)
            return step(element, *rest)

        return follow


def _real(path: Path | str) -> Path | None:
    """Resolve links like `roots.real_path`, None without access; this program imports nothing of the package."""
    try:
        return Path(os.path.realpath(path))
    except OSError:
        return None


def _fault(error: BaseException) -> _Answer:
    """Return the message and class of an exception, and the expressions that led to it, the outermost first."""
    expressions: list[str] = []
    cause = error
    while True:
        if quoted := _EXPRESSION.fullmatch(str(getattr(cause, "suffix", None) or "")):
            expressions.append(quoted[1])
        inner = getattr(cause, "exc", None)
        if not isinstance(inner, BaseException):
            break
        cause = inner
    words = "it takes too much memory" if isinstance(cause, MemoryError) else str(cause) or repr(cause)
    missing = cause.filename if isinstance(cause, FileNotFoundError) else None
    return {"error": words, "kind": type(cause).__name__, "missing_file": missing, "expressions": expressions}


def _without_marks(element: Element) -> str:
    return re.sub(rf' {MARK}="[0-9:]*"', "", element.toxml())


def _comments(document: Document) -> Iterator[Comment]:
    waiting: list[Node] = [document]
    while waiting:
        node = waiting.pop()
        if isinstance(node, Comment):
            yield node
        waiting += node.childNodes


def _follows(comment: Comment) -> bool:
    """Whether a comment follows a tag on the line on which that ends."""
    before = comment.previousSibling
    if isinstance(before, Text) and not before.data.strip() and "\n" not in before.data:
        before = before.previousSibling
    return isinstance(before or comment.parentNode, Element)


if TYPE_CHECKING:

    class _Xacro:
        """The attributes of the xacro module that are replaced."""

        init_stacks: Callable[[str], None]
        parse: Callable[..., Document]
        process_doc: Callable[..., None]
        print_location: Callable[[], None]

    class _Call(TypedDict):
        """A call of a macro: its parameters as text, and the XML of its blocks in order."""

        macro: str
        values: dict[str, str]
        blocks: list[str]


def _limit() -> None:
    """Limit memory, and forbid writing files."""
    try:
        import resource
    except ImportError:  # Windows, where only the time limit remains
        return
    hard = resource.getrlimit(resource.RLIMIT_AS)[1]
    most = _MEMORY if hard == resource.RLIM_INFINITY else min(_MEMORY, hard)  # a hard limit cannot be raised
    resource.setrlimit(resource.RLIMIT_AS, (most, most))
    resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0))


def main() -> None:
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    _limit()
    request = json.loads(sys.stdin.readline())
    answer = _Run(answers).answer(request["path"], request["arguments"], request["call"])
    answers.write(json.dumps(answer) + "\n")
    answers.flush()


if __name__ == "__main__":
    main()
