"""Frequency responses."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from .. import _checks
from .._extras import extra
from .._gyroflex import FrequencyResponse
from ._figure import COLOURS, legend, stacked

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray


def frequency_response(responses: FrequencyResponse | Iterable[FrequencyResponse], labels: Sequence[str] | None = None) -> list[Axes]:
    """Draws magnitude and phase of `Robot.frequency_response`: motor and link position per motor torque.

    Parameters
    ----------
    responses
        One or several, of several joints or of several robots, or a batch of poses.
    labels
        What each is called, the joint's name unless given.
    """
    several: list[FrequencyResponse] = []
    known: list[str] = []
    for given in [responses] if isinstance(responses, FrequencyResponse) or not isinstance(responses, Iterable) else responses:
        _checks.of_kind("responses", given, FrequencyResponse)
        single = given.motor.ndim == 1
        several += [given] if single else list(given)
        known += [given.joint] if single else [f"{given.joint}[{k}]" for k in range(len(given))]
    if not several:
        raise _checks.refused("responses", "there is none", "give what `Robot.frequency_response` returned")
    names = tuple(known) if labels is None else _checks.names("labels", labels)
    if len(names) != len(several):
        raise _checks.refused("labels", f"{len(names)} labels for {len(several)} responses", "give one for each")
    axes = stacked(2, height=3.0)
    magnitude, phase = axes
    for i, (response, name) in enumerate(zip(several, names, strict=True)):
        for side, values, style in (("motor", response.motor, "--"), ("link", response.link, "-")):
            look = {"color": COLOURS[i % len(COLOURS)], "linestyle": style}
            magnitude.loglog(response.frequency, np.abs(values), label=f"{name}, {side}", **look)
            phase.semilogx(response.frequency, _phase(values), **look)
    magnitude.set_ylabel("position per torque\n[rad/(N m) or m/N]")
    legend(magnitude)
    phase.set_ylabel("phase [°]")
    phase.yaxis.set_major_locator(extra("matplotlib.ticker", "plots").MultipleLocator(90))
    phase.set_xlabel("frequency [Hz]")
    return axes


def _phase(values: NDArray[np.complex128]) -> NDArray[np.float64]:
    """Phase without jumps, from above -360° to 0 at the first frequency [°]."""
    phase = np.rad2deg(np.unwrap(np.angle(values)))
    # Rounding must not make a turn of zero.
    return phase - 360.0 * np.ceil((phase[0] - 1.0) / 360.0)  # type: ignore[no-any-return]
