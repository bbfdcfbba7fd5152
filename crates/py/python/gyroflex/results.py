"""What a run recorded: arrays by name, as tables, logs and pictures."""

from __future__ import annotations

import os
import shutil
import warnings
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _checks, _gyroflex
from ._extras import extra
from .errors import ArgumentError, FileError, RobotWarning

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from ._gyroflex import Record

__all__ = ["ContactImpact", "SimulationResult", "read_mcap"]


@dataclass(frozen=True, eq=False)
class ContactImpact:
    """An impact of a robot with the ground: positions stay, velocities jump. Arrays have a row a contact, in world axes."""

    time: float
    """Simulated time [s]."""
    energy_lost: float
    """Kinetic energy before less that after [J]."""
    contacts: tuple[str, ...]
    """Names of the points that took part, those that were on the ground already among them."""
    impulse: NDArray[np.float64]
    """Impulses of the ground, shape ``(contacts, 3)`` [N s]."""
    velocity_before: NDArray[np.float64]
    """Velocities of the points before, shape ``(contacts, 3)`` [m/s]."""
    velocity_after: NDArray[np.float64]
    """Velocities of the points after, shape ``(contacts, 3)`` [m/s]."""


class SimulationResult(Mapping[str, "NDArray[np.float64]"]):
    """What a simulation recorded: arrays by name, one row a sample, and not to be written to.

    ======================================================  ====================  ==========================================
    name                                                    shape                 meaning
    ======================================================  ====================  ==========================================
    ``time``                                                ``(samples,)``        simulated time [s]
    ``q``, ``qd``, ``qdd``                                  ``(samples, joints)`` links [rad or m, per s, per s²]
    ``theta``, ``thetad``, ``thetadd``                      ``(samples, joints)`` motors, seen from the link side
    ``deflection``                                          ``(samples, joints)`` of the transmissions [rad or m]
    ``tau_j``, ``tau``                                      ``(samples, joints)`` of transmissions and of motors [N m or N]
    ``gyroscopic``, ``friction``                            ``(samples, joints)`` torques on the joints [N m or N]
    ``reference``, ``tracking_error``                       ``(samples, joints)`` [rad or m]
    ``kinetic_energy``, ``gravity_energy``, …               ``(samples,)``        [J]
    ``power_in``, ``dissipation``                           ``(samples,)``        [W]
    ``significance``                                        ``(samples,)``        of the rotors' coupling [-]
    ``eta``, ``etad``, ``etadd``                            ``(samples, modes)``  links that bend, by `Robot.mode_names` [m or rad]
    ``tip``                                                 ``(samples, 6 n)``     displacement and rotation vector of the tips beside
                                                                                  the rigid link [m, rad]
    ``base``                                                ``(samples, 13)``     floating root: ``x y z qx qy qz qw`` in the
                                                                                  world, twist in its own frame, angular first
    ``contact.<name>.force``                                ``(samples, 3)``      of the ground on a contact, world axes [N]; these
                                                                                  and the next only where something holds the robot
    ``contact.<name>.gap``, ``contact.<name>.mode``         ``(samples,)``        height above the ground [m]; 0 off it, 1 held by
                                                                                  it, 2 slipping
    ``center_of_mass``                                      ``(samples, 3)``      of the whole robot in the world [m]
    ``zero_moment_point``                                   ``(samples, 2)``      of the ground's forces, along the ground [m]
    ``constraint_drift``                                    ``(samples,)``        largest error of what is held so far [m or rad]
    ======================================================  ====================  ==========================================

    Joints are those of ``joint_names``, the ones of one degree of freedom in coordinate order. ``units`` has the unit of each
    column of each array, ``columns`` its name in CSV files and in `to_pandas`.
    """

    __slots__ = ("_arrays", "_record", "columns", "impacts", "joint_names", "log", "metadata", "units", "warnings")

    def __init__(
        self,
        arrays: Mapping[str, NDArray[np.float64]],
        units: Mapping[str, tuple[str, ...]],
        columns: Mapping[str, tuple[str, ...]],
        joint_names: tuple[str, ...],
        metadata: Mapping[str, str],
        messages: tuple[str, ...],
        impacts: tuple[ContactImpact, ...],
        log: str | None,
        record: Record | None = None,
    ) -> None:
        self._arrays = dict(arrays)
        for array in self._arrays.values():
            array.setflags(write=False)
        self.units = dict(units)
        """Unit of each column of each array, by the array's name."""
        self.columns = dict(columns)
        """Name of each column of each array, as ``q.joint1``, by the array's name."""
        self.joint_names = joint_names
        """Names of the joints behind the columns."""
        self.metadata = dict(metadata)
        """Parameters and versions of the run."""
        self.warnings = messages
        """What was ignored or assumed, and what speaks against the step size."""
        self.impacts = impacts
        """Impacts with the ground, in order of time."""
        self.log = log
        """Path of the MCAP log, if one was written or read."""
        self._record = record

    @property
    def t(self) -> NDArray[np.float64]:
        """Simulated time, shape ``(samples,)`` [s]."""
        return self._arrays["time"]

    def __getitem__(self, name: str) -> NDArray[np.float64]:
        return self._arrays[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._arrays)

    def __len__(self) -> int:
        return len(self._arrays)

    def __repr__(self) -> str:
        end = f" up to {self.t[-1]:g} s" if self.t.size else ""
        return f"<SimulationResult: {self.t.size} samples of {len(self.joint_names)} joints{end}>"

    def __getstate__(self) -> tuple[None, dict[str, Any]]:
        # Copies for other processes hold the arrays, and not once more what a log is written of.
        return None, {name: getattr(self, name) for name in self.__slots__} | {"_record": None}

    def to_pandas(self) -> pd.DataFrame:
        """All samples as a table: a row a sample, by ``time`` [s], and columns named as in CSV files (``columns``).

        Units are in ``frame.attrs["units"]``, by the column's name. Needs pandas, and
        the frame's own ``plot`` matplotlib: ``pip install "./crates/py[pandas,plots]"``.
        """
        pandas = extra("pandas", "pandas")
        names = [name for name in self if name != "time"]
        columns = {c: column for name in names for c, column in zip(self.columns[name], np.atleast_2d(self[name].T), strict=True)}
        frame: pd.DataFrame = pandas.DataFrame(columns, index=pandas.Index(self.t, name="time"))
        frame.attrs["units"] = {c: unit for name in names for c, unit in zip(self.columns[name], self.units[name], strict=True)}
        return frame

    def to_mcap(self, path: str | os.PathLike[str]) -> None:
        """Writes the run as an MCAP log, the same as ``simulate(..., log=path)`` does.

        Raises
        ------
        FileError
            When the file cannot be written.
        ArgumentError
            Of a result that came from another process without a log: what the log would hold stayed there.
        """
        path = _checks.path("path", path)
        if self._record is not None:
            self._record.write_mcap(path)
        elif self.log is None:
            problem = "the result comes from another process and has no log"
            raise ArgumentError(problem, "method `to_mcap`", "", "give `log` to the call that runs the scenario")
        elif not (os.path.exists(path) and os.path.samefile(self.log, path)):
            try:
                shutil.copyfile(self.log, path)
            except OSError as error:
                raise FileError(str(error), "", path, "give a file that can be written") from error

    def plot(self, panels: Sequence[str] | None = None, joints: Sequence[str] | None = None) -> list[Axes]:
        """Draws the run over time, a panel below the other; see `gyroflex.plots.run`."""
        from . import plots

        return plots.run(self, panels, joints)


def read_mcap(path: str | os.PathLike[str]) -> SimulationResult:
    """Reads a log that `simulate` or the command line has written: the result of the run, number by number.

    A log that was cut short, by a killed process, say, gives what reached the file, and a ``RobotWarning``. What the run itself
    warned of is not in its log.

    Raises
    ------
    FileError
        When the file cannot be read, or is no log of ours.
    """
    name = _checks.path("path", path)
    named, joint_names, metadata, impacts, complete = _gyroflex.read_log(name)
    messages = () if complete else (f"{name}: the log was cut short; what reached the file was read",)
    for message in messages:
        warnings.warn(message, RobotWarning, stacklevel=2)
    struck = tuple(ContactImpact(*impact) for impact in impacts)
    return SimulationResult(*named, joint_names, metadata, messages, struck, name)
