"""What arguments may be, checked where Python's own errors would not name them."""

from __future__ import annotations

import math
import operator
import os
from collections.abc import Iterable, Mapping, Set
from typing import Any

from .errors import ArgumentError, NotFiniteError, ShapeError


def refused(argument: str, problem: str, remedy: str) -> ArgumentError:
    """An argument whose value is not allowed."""
    return ArgumentError(problem, f"argument `{argument}`", "", remedy)


def shown(value: object) -> str:
    """A value as Python writes it, cut short; it refuses to write integers of thousands of digits."""
    try:
        text = " ".join(repr(value).split())
    except ValueError:
        text = f"an object of type `{type(value).__name__}`"
    return text if len(text) <= 80 else text[:77] + "..."


def name(argument: str, value: object) -> str:
    """A name of something; what cannot be printed is in no file."""
    if not isinstance(value, str) or not value or not value.isprintable():
        raise refused(argument, f"{shown(value)} is no name", "give a text that can be printed")
    return value


def names(argument: str, value: Iterable[str]) -> tuple[str, ...]:
    """A list of names. A text, which Python takes for a list of letters, is not one."""
    if isinstance(value, str | bytes) or not isinstance(value, Iterable):
        raise refused(argument, f"{shown(value)} is no list of names", "give a list, of one name if there is one")
    several = tuple(value)
    for one in several:
        if not isinstance(one, str):
            raise refused(argument, f"{shown(one)} is no name", "give a list of names")
    return several


def of_kind(argument: str, value: object, kind: type) -> None:
    """Refuses what is no object of a class."""
    if not isinstance(value, kind):
        raise refused(argument, f"it is of type `{type(value).__name__}`", f"give a `{kind.__name__}`")


def path(argument: str, value: str | os.PathLike[str]) -> str:
    """The path of a file that can exist."""
    text = os.fspath(value)
    if not isinstance(text, str):
        raise refused(argument, f"{shown(text)} is no text", "give a text or a `pathlib.Path`")
    try:
        possible = b"\0" not in os.fsencode(text)
    except UnicodeEncodeError:
        possible = False
    if not possible:
        raise refused(argument, f"{shown(text)} is no name of a file", "give the path of a file")
    return text


def number(argument: str, value: Any) -> float:
    """A finite number."""
    try:
        if isinstance(value, str | bytes) or getattr(value, "ndim", 0) > 0:
            raise TypeError
        real = float(value)
    except OverflowError:
        raise refused(argument, "it is too large for a floating-point number", "give a smaller number") from None
    except (TypeError, ValueError):
        raise refused(argument, f"{shown(value)} is no number", "give a real number") from None
    if not math.isfinite(real):
        raise NotFiniteError(f"{real} is not a finite number", f"argument `{argument}`", "", "give a finite number")
    return real


def flag(argument: str, value: Any) -> bool:
    """Yes or no; of an array of several NumPy says neither."""
    try:
        return bool(value)
    except ValueError:
        raise refused(argument, "it is neither true nor false", "give `True` or `False`") from None


def positive(argument: str, value: Any) -> float:
    """A finite number above zero."""
    real = number(argument, value)
    if real <= 0:
        raise refused(argument, f"it is {real:g}", "give a number above zero")
    return real


def numbers(argument: str, value: Any, *counts: int) -> tuple[float, ...]:
    """So many finite numbers, or as many as one of several counts."""
    wanted = " or ".join(map(str, counts))
    if isinstance(value, str | bytes | Mapping | Set) or not hasattr(value, "__len__") or getattr(value, "ndim", None) == 0:
        raise refused(argument, f"{shown(value)} is no list of numbers", f"give {wanted} numbers")
    if any(isinstance(x, list | tuple) or getattr(x, "ndim", 0) > 0 for x in value):
        raise ShapeError("its entries are no numbers, but lists", f"argument `{argument}`", "", f"give {wanted} numbers")
    if len(value) not in counts:
        raise ShapeError(f"{len(value)} numbers are given", f"argument `{argument}`", "", f"give {wanted}")
    return tuple(number(argument, x) for x in value)


def count(argument: str, value: Any, least: int, most: int) -> int:
    """A whole number within bounds."""
    try:
        whole = operator.index(value)
    except TypeError:
        raise refused(argument, f"{shown(value)} is no whole number", f"give one from {least} to {most}") from None
    if not least <= whole <= most:
        raise refused(argument, f"it is {shown(whole)}", f"give a number from {least} to {most}")
    return whole
