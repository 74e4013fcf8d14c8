"""One process of libFuzzer: python -m tests.fuzz.run TARGET WORDS..., of which libFuzzer knows the rest."""

import pkgutil
import sys
from importlib import import_module

import atheris

name, *words = sys.argv[1:]

_NEVER_RUN = ("__main__", "cli", "compare", "editor", "launch")
"""What neither a compile nor an import runs."""


def _import_the_compiler() -> None:
    """Import now what would be imported when first used, and so not be instrumented."""
    import linkforge_compile

    beginning = f"{linkforge_compile.__name__}."
    for module in pkgutil.walk_packages(linkforge_compile.__path__, beginning):
        if not module.name.removeprefix(beginning).startswith(_NEVER_RUN):
            import_module(module.name)


with atheris.instrument_imports(include=["linkforge_compile"]):
    from tests.fuzz.targets import TARGETS

    if name in ("compile", "import"):
        _import_the_compiler()

if __name__ == "__main__":
    atheris.Setup([f"fuzz {name}", *words], TARGETS[name])
    atheris.Fuzz()
