"""One process of libFuzzer: python -m tests.fuzz.run TARGET WORDS..., of which libFuzzer knows the rest."""

import sys

import atheris

name, *words = sys.argv[1:]

with atheris.instrument_imports(include=["linkforge_compile"]):
    from tests.fuzz.targets import TARGETS

    if name in ("compile", "import"):
        # What is imported when first used is imported now, so that it is instrumented.
        pass

if __name__ == "__main__":
    atheris.Setup([f"fuzz {name}", *words], TARGETS[name])
    atheris.Fuzz()
