"""What people's editors get of a repository of robots: a schema that knows its names, and a folder to begin with."""

from linkforge_compile.editor.specs import TooManyFilesError, specs_below
from linkforge_compile.editor.vocabulary import Vocabulary, vocabulary_of
from linkforge_compile.editor.workspace import without_parts, workspace_text

__all__ = ["TooManyFilesError", "Vocabulary", "specs_below", "vocabulary_of", "without_parts", "workspace_text"]
