"""Is the tree the language? The schemas, and the judgement by them in human sentences."""

from linkforge_compile.schema.validator import validate, validate_computed
