"""Files for editors: the schema of a repository, with completions for its names, and those of a new robot's folder."""

from linkforge_compile.editor.folders import TooManyFilesError, find_specs
from linkforge_compile.editor.vocabulary import Vocabulary, read_vocabulary
from linkforge_compile.editor.workspace_schema import without_parts, workspace_text
