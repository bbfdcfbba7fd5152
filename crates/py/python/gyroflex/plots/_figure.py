"""What all pictures share: colours, panels, legends."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from .. import _checks
from .._extras import extra

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# Colours that everybody can tell apart (Okabe, Ito), those of `gyroflex --plot`; joints beyond them begin anew.
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#3c3c3c")
GREY = "#9a9a9a"
WIDTH, HEIGHT = 8.0, 2.4
"""Size of a panel [inch]."""


def pyplot() -> Any:
    return extra("matplotlib.pyplot", "plots")


def stacked(panels: int, height: float = HEIGHT) -> list[Axes]:
    """Panels below each other that share their x-axis."""
    _, axes = pyplot().subplots(panels, sharex=True, squeeze=False, figsize=(WIDTH, height * panels), layout="constrained")
    for ax in axes[:, 0]:
        ax.grid(visible=True, alpha=0.3)
    return list(axes[:, 0])


def legend(ax: Axes) -> None:
    ax.legend(loc="upper left", bbox_to_anchor=(1.0, 1.02), frameon=False, fontsize="small")


def known(argument: str, name: str, allowed: Iterable[str]) -> str:
    """Refuses an argument that names something else than what is allowed."""
    if not isinstance(name, str) or name not in allowed:
        raise _checks.refused(argument, f"`{name}` is unknown", f"give one of {', '.join(allowed)}")
    return name


def several(argument: str, names: Iterable[str], allowed: Iterable[str]) -> tuple[str, ...]:
    """Like `known`, of a list that is not empty."""
    listed = tuple(known(argument, name, allowed) for name in _checks.names(argument, names))
    if not listed:
        raise _checks.refused(argument, "it is empty, so that nothing is drawn", f"give some of {', '.join(allowed)}")
    return listed
