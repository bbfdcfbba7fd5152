"""Everything this package raises on its own account, and its one warning."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .results import SimulationResult

__all__ = [
    "ArgumentError",
    "DivergedError",
    "Error",
    "FileError",
    "FormatError",
    "MissingExtraError",
    "ModelError",
    "NotFiniteError",
    "RobotWarning",
    "ScenarioError",
    "ShapeError",
]


class Error(Exception):
    """Base of all errors of this package: where, what, and what to do about it.

    Attributes
    ----------
    file
        The file, with the line where it is known (``robot.urdf:12``); empty where no file is concerned.
    element
        The joint, link, key or argument concerned; may be empty.
    problem
        What is wrong.
    remedy
        What the user can do; may be empty.
    """

    def __init__(self, problem: str, element: str = "", file: str = "", remedy: str = "") -> None:
        # Not `super()`: `OSError`, a base of `FileError`, would make an error number of the first argument.
        Exception.__init__(self, problem, element, file, remedy)
        self.problem = problem
        self.element = element
        self.file = file
        self.remedy = remedy

    def __str__(self) -> str:
        text = ": ".join(part for part in (self.file, self.element, self.problem) if part)
        return f"{text}\n  remedy: {self.remedy}" if self.remedy else text


class FileError(Error, OSError):
    """A file cannot be read or written."""


class FormatError(Error, ValueError):
    """A URDF or YAML file is not well formed, or has an entry that is unknown or contradictory."""


class ModelError(Error, ValueError):
    """A file describes no physical robot that can be simulated."""


class ScenarioError(Error, ValueError):
    """A scenario asks for something that cannot be done."""


class DivergedError(Error, ArithmeticError):
    """A simulation or a calculation left the finite numbers.

    Attributes
    ----------
    result
        What a simulation recorded up to there; ``None`` after a calculation.
    """

    result: SimulationResult | None = None


class ArgumentError(Error, ValueError):
    """An argument has a value that is not allowed; its name is in ``element``."""


class ShapeError(ArgumentError):
    """An array argument has the wrong shape."""


class NotFiniteError(ArgumentError):
    """An array argument contains an infinity or NaN."""


class MissingExtraError(Error, ImportError):
    """A function needs a library that is not installed with the package by default."""


class RobotWarning(UserWarning):
    """Something of a robot or scenario file was ignored or assumed."""
