"""Pictures of runs and robots with matplotlib (``pip install "./crates/py[plots]"``).

Functions draw a new figure with ``matplotlib.pyplot`` and return its axes; ``plt.savefig("run.png")`` keeps it, and ``plt.show()``
opens a window.
"""

from .linear import frequency_response
from .runs import PANELS, run
from .significance import significance_map
from .sticks import animate

__all__ = ["PANELS", "animate", "frequency_response", "run", "significance_map"]
