"""`python -m sun2xp_ros` runs the node."""

import sys

from .node import main

sys.exit(main())
