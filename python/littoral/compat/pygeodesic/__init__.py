"""pygeodesic's names and arguments (release 0.1.11), computed by littoral.

import littoral.compat.pygeodesic.geodesic as geodesic
"""

from . import geodesic

__all__ = ["__version__", "geodesic"]

__version__ = "0.1.11"  #: the release whose names and arguments these are
