"""Exceptions, by who can correct them, and warnings."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple


class Fault(NamedTuple):
    """One fault of the input."""

    place: str
    """File with line, key or element."""
    found: str
    """Value found there."""
    expected: str
    """Values accepted there."""
    help: str
    """Corrective action; may be empty."""


class Error(Exception):
    """Base of all errors of stridor."""


class InputError(Error, ValueError):
    """The input is wrong; all faults that were found, at once."""

    def __init__(self, message: str, faults: Sequence[tuple[str, str, str, str]] = ()) -> None:
        super().__init__(message)
        self.faults: list[Fault] = [Fault(*fault) for fault in faults]
        """The faults, each with place, found, expected and help."""


class AnalysisError(Error, RuntimeError):
    """The input is well formed, but the analysis cannot give an answer."""


class MachineError(Error, OSError):
    """The machine refused: a full disk, a folder that is not writable."""


class CaseWarning(UserWarning):
    """A sentence that the user of a case should know."""
