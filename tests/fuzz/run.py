"""One process of libFuzzer: python -m tests.fuzz.run TARGET WORDS..., of which libFuzzer knows the rest."""

import sys

import atheris

with atheris.instrument_imports(include=["linkforge_compile"]):
    # What is imported when first used is imported now, so that it is instrumented.
    from tests.fuzz.targets import TARGETS

if __name__ == "__main__":
    name, *words = sys.argv[1:]
    atheris.Setup([f"fuzz {name}", *words], TARGETS[name])
    atheris.Fuzz()
