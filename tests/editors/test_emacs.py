"""Emacs with the set-ups of docs/editors.md, for eglot and for lsp-mode."""

import shutil
import subprocess
from pathlib import Path

import pytest

from tests.editors.setups import MESSAGE, blocks, environment, write_spec

PROBE = Path(__file__).with_name("probe.el")

START = "(package-initialize)\n(require 'yaml-mode)\n(require '{client})\n"
"""Packages of the system, as the settings of a user would have them."""

WITHOUT_QUESTIONS = "(setq lsp-auto-guess-root t lsp-enable-file-watchers nil lsp-warn-no-matched-clients nil)\n"


@pytest.mark.parametrize(("client", "block"), [("eglot", 1), ("lsp-mode", 2)])
def test_reports(client: str, block: int, tmp_path: Path) -> None:
    emacs = shutil.which("emacs")
    if emacs is None:
        pytest.skip("there is no program 'emacs'")
    code = blocks("Emacs", "elisp")
    settings = tmp_path / "init.el"
    settings.write_text(START.format(client=client) + WITHOUT_QUESTIONS + code[0] + code[block], "utf-8")
    loads = subprocess.run([emacs, "--batch", "--load", settings], capture_output=True, text=True, check=False)
    if "Cannot open load file" in loads.stderr:
        pytest.skip(f"Emacs has no {client} or yaml-mode")
    spec = write_spec(tmp_path)
    command = [emacs, "--batch", "--load", str(settings), "--load", str(PROBE)]
    run = subprocess.run(
        command,
        cwd=tmp_path,
        env={**environment(tmp_path), "SPEC": str(spec)},
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    mode, line, message = run.stdout.split(" ", 2)
    assert (mode, line) == ("linkforge-mode", "5")
    assert MESSAGE in message
