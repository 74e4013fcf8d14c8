"""A program: expands one xacro file with the xacro package, under limits of memory and of what it may do.

It reads a request from standard input, a line of JSON, and answers with one. In between it asks where packages are,
`{"find": NAME}`, and reads the folder or null, and whether it may read a file, `{"may_read": PATH}`, and reads true or
false. Every element is marked with the file that it was written in and its number there, for the expanded text has no
places, and every comment that stands behind an element on its line, for xacro leaves the space around elements out.
"""

from __future__ import annotations

import io
import json
import os
import re
import sys
from pathlib import Path
from typing import TYPE_CHECKING, TextIO
from xml.dom import minidom
from xml.dom.minidom import Comment, Element, Text

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from xml.dom.minidom import Document, Node

MARK = "linkforge-place"
_MEMORY = 2 * 1024**3

_HARMLESS = frozenset(
    ("builtins.id", "compile", "exec", "glob.glob", "glob.glob/2", "import", "marshal.loads", "sys._getframe")
)
"""What Python audits and xacro needs."""

_READS = frozenset(("open", "os.listdir", "os.scandir"))
_CODE = (".py", ".pyc", ".so", ".pyd")
_WRITING = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC | os.O_APPEND
_EXPRESSION = re.compile(r"\s*when evaluating expression '(.*)'", re.DOTALL)
_Answer = dict[str, object]


class _UnknownPackageError(Exception):
    """The asker does not know where a package is."""


class _RefusedError(Exception):
    """The file does what a robot description has no need of."""


class _Run:
    """One expansion, and where it stands."""

    def __init__(self, answers: TextIO) -> None:
        self._answers = answers
        self.files: list[str] = []
        self.arguments: dict[str, str] = {}
        self.wanted: set[str] = set()
        self._place: str | None = None
        self._places: dict[int, str] = {}
        self._kept: list[Node] = []

    def find(self, name: str) -> str:
        folder = self._asked({"find": name})
        if not isinstance(folder, str):
            raise _UnknownPackageError(name)
        return folder

    def guard(self) -> None:
        """Refuse from now on whatever xacro has no need of, and ask before a file is read.

        xacro lets expressions reach anything in Python by a detour. What they do there is audited by Python: programs,
        the network, files that are written or removed, and the objects by which one gets at other code.
        """
        own = tuple(real for folder in sys.path if folder and (real := _real(folder)))

        def refuse(event: str, arguments: tuple[object, ...]) -> None:
            if event in _HARMLESS:
                return
            if event not in _READS:
                raise _RefusedError(f"no robot description needs {event}")
            path, flags = arguments[0], arguments[-1]
            if event == "open" and (not isinstance(flags, int) or flags & _WRITING):
                raise _RefusedError("no robot description writes files")
            if not self._may_read(path, own):
                raise _RefusedError(f"'{path}' is no file that it may read")

        sys.addaudithook(refuse)

    def _may_read(self, path: object, own: tuple[Path, ...]) -> bool:
        """Whether a file or folder may be read: code and folders of Python itself, `own`, and what the asker allows."""
        if not isinstance(path, str | bytes):
            return False
        # Joined and no more: where `..` leads behind a link is for the asker to find out.
        named = Path.cwd() / os.fsdecode(path)
        # os.path answers for what may not be looked at as well, where pathlib raises.
        if named.suffix in _CODE or os.path.isdir(named):  # noqa: PTH112
            real = _real(named)
            if real and any(real.is_relative_to(folder) for folder in own):
                return True
        return self._asked({"may_read": str(named)}) is True

    def _asked(self, question: _Answer) -> object:
        self._answers.write(json.dumps(question) + "\n")
        self._answers.flush()
        answer: object = json.loads(sys.stdin.readline())
        return answer

    def mark(self, document: Document, file: str) -> None:
        """Mark every element with its place; those of xacro refuse an attribute, and are remembered."""
        self.files.append(file)
        for number, element in enumerate(document.getElementsByTagName("*")):
            place = f"{len(self.files) - 1}:{number}"
            if not element.tagName.startswith("xacro:"):
                element.setAttribute(MARK, place)
                continue
            # Kept alive, so that nothing else gets its identity.
            self._kept.append(element)
            self._places[id(element)] = place
            if element.tagName == "xacro:arg":
                self.arguments.setdefault(element.getAttribute("name"), place)
        for comment in _comments(document):
            if _follows(comment):
                comment.data += f" {MARK}"

    def at(self, element: Element) -> None:
        """Note that xacro has come to an element, or to a copy of it."""
        here: Node | None = element
        while isinstance(here, Element):
            if place := self._places.get(id(here)) or here.getAttribute(MARK):
                self._place = place
                return
            here = here.parentNode

    def answer(self, path: str, arguments: dict[str, str]) -> _Answer:
        try:
            import xacro
            from xacro import substitution_args
        except ImportError:
            return {"missing": True}
        said = io.StringIO()
        sys.stdout = sys.stderr = said
        substitution_args._eval_find = self.find
        substitution_args._eval_arg = self._noting_names(substitution_args._eval_arg)
        self._watch(xacro)
        self.guard()
        try:
            document = xacro.process_file(path, mappings=arguments, verbosity=1)
            answer: _Answer = {"text": document.documentElement.toxml()}
        except _UnknownPackageError:
            answer = {"error": ""}  # The asker knows.
        except RecursionError:
            answer = {"error": "it calls itself without an end"}
        except MemoryError:
            answer = {"error": "it takes too much memory"}
        except Exception as error:  # Whatever the file's expressions raise.
            answer = {**_fault(error), "line": getattr(error, "lineno", None)}
            answer["file"] = xacro.filestack[-1] if xacro.filestack else path
        warnings = [line.removeprefix("warning: ") for line in said.getvalue().splitlines() if line.strip()]
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

    def _watch(self, xacro: _Xacro) -> None:
        """Mark what xacro parses, and follow it through the elements."""
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

        # A macro is a copy of what stands in it, and so is every use of one.
        minidom._clone_node = copy_with_place  # type: ignore[attr-defined]  # as above
        xacro.print_location = lambda: None
        for name in ("eval_all", "check_attrs", "handle_macro_call", "grab_property"):
            setattr(xacro, name, self._followed(getattr(xacro, name)))

    def _noting_names(self, value_of: Callable[[str, dict[str, str]], str]) -> Callable[[str, dict[str, str]], str]:
        def noted(name: str, args: dict[str, str]) -> str:
            self.wanted.add(name)
            return value_of(name, args)

        return noted

    def _followed(self, step: Callable[..., object]) -> Callable[..., object]:
        def follow(element: Element, *rest: object) -> object:
            self.at(element)
            return step(element, *rest)

        return follow


def _real(path: Path | str) -> Path | None:
    """Return where links lead, None where one may not be looked at, as `roots.real_path` does: this imports nothing."""
    try:
        return Path(os.path.realpath(path))
    except OSError:
        return None


def _fault(error: BaseException) -> _Answer:
    """Return what went wrong, in whose words, and in which expressions, the outermost first."""
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


def _comments(document: Document) -> Iterator[Comment]:
    waiting: list[Node] = [document]
    while waiting:
        node = waiting.pop()
        if isinstance(node, Comment):
            yield node
        waiting += node.childNodes


def _follows(comment: Comment) -> bool:
    """Whether a comment stands behind a tag on the line on which that ends."""
    before = comment.previousSibling
    if isinstance(before, Text) and not before.data.strip() and "\n" not in before.data:
        before = before.previousSibling
    return isinstance(before or comment.parentNode, Element)


if TYPE_CHECKING:

    class _Xacro:
        """What is replaced of the package."""

        parse: Callable[..., Document]
        print_location: Callable[[], None]


def _limit() -> None:
    """Bound what a hostile file can take; it needs to write none."""
    try:
        import resource
    except ImportError:  # Windows: the asker's limit of time is left.
        return
    hard = resource.getrlimit(resource.RLIMIT_AS)[1]
    most = _MEMORY if hard == resource.RLIM_INFINITY else min(_MEMORY, hard)  # nobody may raise a hard limit
    resource.setrlimit(resource.RLIMIT_AS, (most, most))
    resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0))


def main() -> None:
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    _limit()
    request = json.loads(sys.stdin.readline())
    answers.write(json.dumps(_Run(answers).answer(request["path"], request["arguments"])) + "\n")
    answers.flush()


if __name__ == "__main__":
    main()
