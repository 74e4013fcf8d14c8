"""`linkforge completion`: the script with which a shell completes the commands."""

from __future__ import annotations

import argparse

from linkforge_compile.cli import OK

_EXAMPLES = """\
The shell then completes commands, options and their values, specs, NAME:=VALUE with the parameters of the spec on the
line, --variant with its variants, and the paths and codes of `explain`.

examples:
  linkforge completion bash > linkforge.bash    the script, in a file

once, to enable it in every new shell:
  bash, with its package bash-completion:
    mkdir -p ~/.local/share/bash-completion/completions
    linkforge completion bash > ~/.local/share/bash-completion/completions/linkforge
  zsh, with `fpath+=~/.zfunc` in ~/.zshrc, above the line `compinit`:
    mkdir -p ~/.zfunc
    linkforge completion zsh > ~/.zfunc/_linkforge
  fish:
    mkdir -p ~/.config/fish/completions
    linkforge completion fish > ~/.config/fish/completions/linkforge.fish

only for this shell:
  eval "$(linkforge completion bash)"
  eval "$(linkforge completion zsh)"
  linkforge completion fish | source
"""

_FOR_BASH = ("-o", "nospace")
"""How bash registers the function. Without `-o default`, where nothing fits it does not offer every file."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = _EXAMPLES
    parser.add_argument("shell", choices=("bash", "zsh", "fish"), help="the shell that reads the script")


def run(arguments: argparse.Namespace) -> int:
    from argcomplete.shell_integration import shellcode

    from linkforge_compile.cli.output import write_to_stdout

    write_to_stdout(shellcode(["linkforge"], shell=arguments.shell, complete_arguments=_FOR_BASH))
    return OK
