"""A program: expands one xacro file with the xacro package, under limits of memory and of files that it may write.

It reads a request from standard input, a line of JSON, and answers with one. In between it asks where packages are:
`{"find": NAME}`, and reads the folder or null. Every element is marked with the file that it was written in and its
number there, for the expanded text has no places.
"""

from __future__ import annotations

import io
import json
import os
import sys
from typing import TYPE_CHECKING, TextIO
from xml.dom.minidom import Element

if TYPE_CHECKING:
    from collections.abc import Callable
    from xml.dom.minidom import Document, Node

MARK = "linkforge-place"
_MEMORY = 2 * 1024**3
_Answer = dict[str, object]


class _UnknownPackageError(Exception):
    """The asker does not know where a package is."""


class _Run:
    """One expansion, and where it stands."""

    def __init__(self, answers: TextIO) -> None:
        self._answers = answers
        self.files: list[str] = []
        self.arguments: dict[str, str] = {}
        self._place: str | None = None
        self._places: dict[int, str] = {}
        self._kept: list[Element] = []

    def find(self, name: str) -> str:
        self._answers.write(json.dumps({"find": name}) + "\n")
        self._answers.flush()
        folder: str | None = json.loads(sys.stdin.readline())
        if folder is None:
            raise _UnknownPackageError(name)
        return folder

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
        self._watch(xacro)
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
            cause = getattr(error, "exc", None)
            reason = "it takes too much memory" if isinstance(cause, MemoryError) else str(error) or repr(error)
            answer = {"error": reason, "line": getattr(error, "lineno", None)}
            answer["file"] = xacro.filestack[-1] if xacro.filestack else path
        warnings = [line.removeprefix("warning: ") for line in said.getvalue().splitlines() if line.strip()]
        read = [file for file in xacro.all_includes if file not in self.files]
        return {
            **answer,
            "files": self.files,
            "read": read,
            "arguments": self.arguments,
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
        xacro.print_location = lambda: None
        for name in ("eval_all", "check_attrs", "handle_macro_call", "grab_property"):
            setattr(xacro, name, self._followed(getattr(xacro, name)))

    def _followed(self, step: Callable[..., object]) -> Callable[..., object]:
        def follow(element: Element, *rest: object) -> object:
            self.at(element)
            return step(element, *rest)

        return follow


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
    resource.setrlimit(resource.RLIMIT_AS, (_MEMORY, _MEMORY))
    resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0))


def main() -> None:
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    _limit()
    request = json.loads(sys.stdin.readline())
    answers.write(json.dumps(_Run(answers).answer(request["path"], request["arguments"])) + "\n")
    answers.flush()


if __name__ == "__main__":
    main()
