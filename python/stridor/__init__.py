"""Finite-element squeal analysis: when a disc squeals, at which frequency, how loud, and what to change.

>>> import stridor
>>> results = stridor.run("case.toml")
>>> results.plot_growth()

A case is a TOML file (:meth:`Case.read`) or a mapping with the same keys (:meth:`Case.from_dict`). All quantities are in SI
units: m, kg, s, N, rad.
"""

from . import _native
from ._case import Case, Scalar, import_deck, run
from ._errors import AnalysisError, CaseWarning, Error, Fault, InputError, MachineError
from ._model import Contact, Model
from ._results import Results, open_results

__version__, __commit__ = _native.version()

__all__ = [
    "AnalysisError",
    "Case",
    "CaseWarning",
    "Contact",
    "Error",
    "Fault",
    "InputError",
    "MachineError",
    "Model",
    "Results",
    "Scalar",
    "import_deck",
    "open_results",
    "run",
]
