"""``python -m elemental``: the command line without the installed script."""

import sys

from elemental.cli import main

sys.exit(main())
