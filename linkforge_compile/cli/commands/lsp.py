"""`linkforge lsp`: the language server, which editors start."""

from __future__ import annotations

import argparse
import gc
import os
from typing import NoReturn

from linkforge_compile.cli import OK, UsageError

_EXAMPLES = """\
Editors start it; docs/editors.md describes the set-up of each. It communicates over standard input and output, or with
one client that connects to a local port. It requires pygls: pip install 'linkforge-compile[lsp]'.

examples:
  linkforge lsp
  linkforge lsp --port 2087         for an editor or a debugger that connects by TCP
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = _EXAMPLES
    parser.add_argument("--stdio", action="store_true", help="communicate over standard input and output (default)")
    parser.add_argument("--port", type=int, metavar="PORT", help="listen for one client on 127.0.0.1")


def run(arguments: argparse.Namespace) -> NoReturn:
    try:
        from linkforge_compile.lsp.features import make_server
    except ModuleNotFoundError as error:
        if error.name not in {"pygls", "lsprotocol"}:
            raise
        raise UsageError("the language server needs pygls; run: pip install 'linkforge-compile[lsp]'") from None
    gc.freeze()  # the server collects garbage after each edit, and what is imported is none
    if arguments.port is not None:
        make_server().start_tcp("127.0.0.1", arguments.port)
    else:
        make_server().start_io()
    # Otherwise the process would wait for the analyses that run, whose results nothing reads any more.
    os._exit(OK)
