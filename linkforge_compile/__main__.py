"""`python -m linkforge_compile` is `linkforge`."""

import sys

from linkforge_compile.cli.main import main

sys.exit(main())
