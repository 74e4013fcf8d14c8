"""Is the tree the language? The schemas, the judgement by them in human sentences, and the bundle for editors."""

from linkforge_compile.schema.bundle import bundle, bundle_text
from linkforge_compile.schema.validator import validate, validate_computed

__all__ = ["bundle", "bundle_text", "validate", "validate_computed"]
