"""`python -m brace` is the `brace` command."""

import sys

from brace.cli import main

sys.exit(main())
