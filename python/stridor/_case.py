"""Cases: read, changed, checked and run."""

from __future__ import annotations

import json
import os
import tomllib
import warnings
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from . import _native
from ._errors import CaseWarning, InputError
from ._meshio import gmsh_text, of_mesh
from ._model import Model
from ._progress import Observe, observed
from ._results import Results, open_results

if TYPE_CHECKING:
    import meshio

_LENGTHS = {"m": 1.0, "mm": 1e-3, "cm": 1e-2, "in": 0.0254}


class Scalar(NamedTuple):
    """A number of a case."""

    value: float
    """Its value in SI units."""
    unit: str
    """The SI unit; empty for a pure number."""
    lower: float
    """The least value that it may have, or the bound that it stays above."""
    upper: float
    """The largest value that it may have, or the bound that it stays below."""
    lower_included: bool
    """Whether it may have the lower bound itself."""
    upper_included: bool
    """Whether it may have the upper bound itself."""


class Keys(dict[str, Any]):
    """The keys of a case as nested dicts."""

    def __init__(self, keys: Mapping[str, Any], folder: Path) -> None:
        super().__init__(keys)
        self.folder = folder
        """The folder that relative paths start from."""


class Case:
    """A validated case. It does not change: :meth:`replace` gives another one.

    ``case["contact.rim.friction.mu0"]`` is the number at a path; iterating gives the paths of all numbers.
    """

    def __init__(self, native: _native.Case) -> None:
        self._native = native

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> Case:
        """The case of a TOML file.

        Raises :class:`InputError` with every fault of the file, each with its line and key.
        """
        return cls(_native.Case.read(Path(path)))

    @classmethod
    def new(cls, folder: str | os.PathLike[str], template: str = "rig") -> Case:
        """A case to start from, written into a new folder with the files that it reads.

        Templates are ``"rig"``, ``"pad"``, ``"two-dof"``, ``"imported"``, ``"transient"`` and ``"measured"``.
        """
        return cls(_native.Case.from_template(Path(folder), template))

    @classmethod
    def from_toml(cls, text: str, folder: str | os.PathLike[str] = ".") -> Case:
        """The case of TOML text; relative paths start from ``folder``."""
        return cls(_native.Case.parse(text, Path(folder)))

    @classmethod
    def from_dict(cls, keys: Mapping[str, Any], folder: str | os.PathLike[str] | None = None) -> Case:
        """The case of a mapping with the keys of a case file.

        Quantities are numbers in SI units or texts with a unit (``"1 mm"``); NumPy arrays count as lists. Relative paths start
        from ``folder``: by default that of the case whose :meth:`to_dict` made the mapping, the current one for any other.
        """
        if folder is None:
            folder = keys.folder if isinstance(keys, Keys) else Path()
        return cls(_native.Case.parse_json(json.dumps(keys, default=_plain), Path(folder)))

    @classmethod
    def from_meshio(
        cls,
        mesh: meshio.Mesh,
        keys: Mapping[str, Any],
        folder: str | os.PathLike[str],
        unit: str = "m",
    ) -> Case:
        """The case of a mesh of `meshio <https://github.com/nschloe/meshio>`_ and a mapping with the other keys of a case file.

        The mesh is written to ``mesh.msh`` in ``folder``, which is made where it is not there; ``unit`` is that of its coordinates:
        ``"m"``, ``"mm"``, ``"cm"`` or ``"in"``. Regions are its sets of cells and of points, and the physical groups of Gmsh; without any,
        all cells of the highest dimension are the region ``part``.

        >>> keys = {"material": {...}, "solid": {"part": {"material": "steel"}}, "modes": {"all": {"count": 10}}}
        >>> stridor.Case.from_meshio(meshio.read("disc.vtu"), keys, "disc", unit="mm")
        """
        folder = Path(folder)
        length = _LENGTHS.get(unit)
        if length is None:
            found, expected = f"`{unit}`", f"one of {', '.join(_LENGTHS)}"
            raise InputError(f"unit: found {found}; expected {expected}.", [("unit", found, expected, "")])
        text = gmsh_text(mesh, length)
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "mesh.msh").write_text(text, encoding="utf-8")
        return cls.from_dict({**keys, "mesh": {"file": "mesh.msh", "unit": "m"}}, folder)

    @property
    def title(self) -> str:
        """One line for reports."""
        return self._native.title

    @property
    def folder(self) -> Path:
        """The folder that relative paths start from."""
        return Path(self._native.folder)

    @property
    def scalars(self) -> dict[str, Scalar]:
        """Every number of the case by its path, such as ``contact.rim.friction.mu0``."""
        return {
            path: Scalar(value, unit, low, high, has_low, has_high)
            for path, value, unit, (low, has_low), (high, has_high) in self._native.scalars()
        }

    def __getitem__(self, path: str) -> float:
        return self._native.scalar(path)

    def __iter__(self) -> Iterator[str]:
        return iter(self.scalars)

    def replace(self, values: Mapping[str, float | str]) -> Case:
        """The same case with other numbers at some paths, in SI units or as texts with a unit; validated like a file.

        >>> harder = case.replace({"contact.rim.friction.mu0": 0.4, "shell.disc.thickness": "1.2 mm"})
        """
        given = {path: value if isinstance(value, str) else float(value) for path, value in values.items()}
        return Case(self._native.with_scalars(given))

    def to_toml(self) -> str:
        """The case as TOML in SI units with every default written out."""
        return self._native.to_toml()

    def to_dict(self) -> Keys:
        """The same as nested dicts, which :meth:`from_dict` takes after a change, with the folder of this case."""
        return Keys(tomllib.loads(self.to_toml()), self.folder)

    def check(self) -> list[str]:
        """Reads the mesh and finds every fault that a run would find before it computes.

        Returns sentences that the user should know. Raises :class:`InputError` with all faults.
        """
        return self._native.check()

    def to_meshio(self) -> meshio.Mesh:
        """The mesh [m] as an object of meshio, with the regions as sets of cells and of points."""
        return of_mesh(self._native.mesh())

    def model(self) -> Model:
        """M, C, K, the load, the degrees of freedom and the contact points."""
        return Model._of(self._native.model())

    def run(
        self,
        only: str | None = None,
        *,
        out: str | os.PathLike[str] | None = None,
        resume: bool = False,
        threads: int | None = None,
        progress: bool | Observe | None = None,
    ) -> Results:
        """Runs the analyses of the case.

        Parameters
        ----------
        only
            The name of one analysis, which is run with those that it needs: ``"modes"``, ``"cea"``, ``"sensitivity"``,
            ``"transient"``, ``"sweep"``, ``"uncertainty"``, ``"frf"``, ``"calibrate"`` or ``"compare"``. All that the case lists by default.
        out
            A folder for the results, as the command line writes it, with ``report.html``. Without it results stay in memory,
            with the whole record of a run in time.
        resume
            Whether to resume the maps and the run in time that an interrupted run of the same case left in ``out``.
        threads
            How many threads to use; as many as there are cores by default.
        progress
            Whether to show bars (by default on a terminal and in notebooks), or a function that is called with the name of
            the stage, the steps done and how many there are (``None`` if unknown).

        The global interpreter lock is released. Ctrl-C stops the run at its next step.
        Warnings of the case are issued as :class:`CaseWarning`.
        """
        folder = None if out is None else Path(out)
        with observed(progress) as observe:
            native = _native.Run(self._native, only, folder, resume, threads, observe)
        results = Results._in_memory(native) if folder is None else open_results(folder)
        for sentence in results.warnings:
            warnings.warn(sentence, CaseWarning, stacklevel=2)
        return results

    def __repr__(self) -> str:
        return f"<stridor.Case {self.title!r}>"


def import_deck(
    file: str | os.PathLike[str],
    unit: str,
    folder: str | os.PathLike[str],
    format: str | None = None,
) -> Case:
    """The case of a model of another program (Abaqus, CalculiX, NASTRAN, ANSYS, UNV, VTU), made in a new folder with its mesh.

    ``unit`` says which units its numbers are in: ``"m"``, ``"mm"`` (t, N, MPa), ``"mm-kg"``, ``"mm-kg-ms"``, ``"cm"`` or ``"in"``. What was
    read is in ``folder / "import.md"``; what was not and matters is a :class:`CaseWarning`.

    Raises :class:`InputError` with every fault of the file; of the case, too, where it is not complete.
    """
    native, sentences = _native.Case.from_deck(Path(file), unit, Path(folder), format)
    for sentence in sentences:
        warnings.warn(sentence, CaseWarning, stacklevel=2)
    return Case(native)


def run(
    case: Case | Mapping[str, Any] | str | os.PathLike[str],
    only: str | None = None,
    *,
    out: str | os.PathLike[str] | None = None,
    resume: bool = False,
    threads: int | None = None,
    progress: bool | Observe | None = None,
) -> Results:
    """Runs the analyses of a case: a :class:`Case`, the path of its file, or a mapping. See :meth:`Case.run`."""
    if isinstance(case, Mapping):
        case = Case.from_dict(case)
    elif not isinstance(case, Case):
        case = Case.read(case)
    with warnings.catch_warnings(record=True) as issued:
        warnings.simplefilter("always")
        results = case.run(only, out=out, resume=resume, threads=threads, progress=progress)
    for warning in issued:
        warnings.warn(warning.message, warning.category, stacklevel=2)
    return results


def _plain(value: Any) -> Any:
    """A value that JSON does not have."""
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    raise TypeError(f"a case has no value of type {type(value).__name__}")
