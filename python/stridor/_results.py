"""Results of a run."""

from __future__ import annotations

import json
import os
import webbrowser
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
import pandas as pd
import xarray as xr

from . import _meshio, _native, _plots
from ._tree import tree_of

if TYPE_CHECKING:
    import meshio
    import pyvista
    from matplotlib.axes import Axes


class Results:
    """Results of a run: a tree of named arrays with units and dimensions.

    ``results["cea/eigenvalues"]`` is a group of the tree, ``results["cea/eigenvalues/growth_rate"]`` an array. Groups and names are
    those of ``results.h5``; the guide lists them.
    """

    def __init__(self, tree: xr.DataTree, summary: dict[str, Any], folder: Path | None) -> None:
        # Lists of sentences are in the summary: as coordinates of the root every group would inherit them.
        tree.dataset = tree.to_dataset().drop_dims(list(tree.sizes))
        self.tree: xr.DataTree = tree
        """All results."""
        self.summary: dict[str, Any] = summary
        """The figures of each analysis, as in ``summary.json``."""
        self.folder: Path | None = folder
        """The results folder; ``None`` of a run in memory."""

    @classmethod
    def _in_memory(cls, run: _native.Run) -> Results:
        return cls(tree_of(run), json.loads(run.summary()), None)

    def __getitem__(self, path: str) -> Any:
        """The group (``DataTree``) or array (``DataArray``) at a path."""
        try:
            return self.tree[path]
        except KeyError:
            raise KeyError(f"no {path!r} in these results, which have {', '.join(self._paths())}") from None

    def __contains__(self, path: str) -> bool:
        try:
            self.tree[path]
        except KeyError:
            return False
        return True

    def _paths(self) -> list[str]:
        return [group.lstrip("/") for group in self.tree.groups if group != "/"]

    def _dataset(self, path: str, table: str) -> xr.Dataset:
        node = self.tree[path] if f"/{path}" in self.tree.groups else None
        if not isinstance(node, xr.DataTree):
            raise KeyError(f"no {path!r} in these results: the run had no [{table}]")
        return node.to_dataset(inherit=False)

    def table(self, path: str) -> pd.DataFrame:
        """A group with one value a row, as a pandas table: ``results.table("cea/eigenvalues")``.

        Columns with several values a row, such as shapes, are left out.
        """
        node = self[path]
        if not isinstance(node, xr.DataTree):
            raise KeyError(f"{path!r} is an array, not a group")
        dataset = node.to_dataset(inherit=False)
        rows = next((variable.dims[:1] for variable in dataset.data_vars.values() if variable.dims), ())
        columns = [key for key, variable in dataset.data_vars.items() if variable.dims == rows]
        return dataset[columns].to_dataframe() if rows else pd.DataFrame({k: [dataset[k].item()] for k in columns})

    @property
    def title(self) -> str:
        """The title of the case."""
        return str(self.summary["title"])

    @property
    def warnings(self) -> list[str]:
        """What the user should know, one sentence each."""
        return list(self.summary["warnings"])

    @property
    def complex_modes(self) -> xr.Dataset:
        """The complex modes at steady sliding: eigenvalues, frequencies, growth rates, verdicts, shapes."""
        return self._dataset("cea/eigenvalues", "cea")

    @property
    def eigenvalues(self) -> npt.NDArray[np.complex128]:
        """The complex eigenvalues λ = σ + iω [1/s], one a mode."""
        return np.asarray(self.complex_modes["eigenvalue"].values, dtype=np.complex128)

    @property
    def unstable_modes(self) -> xr.Dataset:
        """Those of the complex modes that grow."""
        modes = self.complex_modes
        return modes.isel(mode=np.flatnonzero(modes["unstable"].values))

    @property
    def history(self) -> xr.Dataset:
        """Motion and forces of a run in time, at every step."""
        return self._dataset("transient/history", "transient")

    def mesh(self, field: xr.DataArray | None = None) -> pyvista.UnstructuredGrid:
        """The mesh as a PyVista object, with the number of the part of each element.

        ``field`` is a motion of all nodes (dimensions ``node`` and ``freedom``), such as a mode shape. The mesh then has the
        point data ``displacement`` and ``rotation``, and of a complex field their imaginary parts ``displacement_imag`` and
        ``rotation_imag``, too.

        >>> shape = results.complex_modes["right"].sel(mode=3)
        >>> results.mesh(shape).warp_by_vector("displacement", factor=0.01).plot()
        """
        import pyvista

        geometry = self._dataset("geometry", "mesh")
        nodes = geometry["element_nodes"].values
        ends = geometry["element_offsets"].values
        cells = np.insert(nodes, ends[:-1], np.diff(ends))
        types = geometry["element_kind"].values.astype(np.uint8)
        grid = pyvista.UnstructuredGrid(cells, types, np.asarray(geometry["nodes"].values, dtype=float))
        grid.cell_data["part"] = geometry["element_part"].values
        grid.field_data["part_names"] = geometry["part_names"].values.astype(str)
        for name, values in _motion(field).items():
            grid.point_data[name] = values
        return grid

    def to_meshio(self, field: xr.DataArray | None = None) -> meshio.Mesh:
        """The mesh as an object of meshio, with the parts as sets of cells; ``field`` as in :meth:`mesh`.

        >>> results.to_meshio(results.complex_modes["right"].sel(mode=3)).write("squeal.xdmf")
        """
        return _meshio.of_geometry(self._dataset("geometry", "mesh"), _motion(field))

    def plot_growth(self, ax: Axes | None = None) -> Axes:
        """Growth rate over frequency of the complex modes, with the frequencies of those that grow."""
        ax = _plots.growth(self.complex_modes, ax)
        ax.set_title(self.title, wrap=True, fontsize="medium")
        return ax

    def plot_sweep(self, name: str | None = None, axes: Sequence[Axes] | None = None) -> list[Axes]:
        """Frequency and growth rate of each branch over the scalar of a ``[sweep]``: dots where it grows, dashed at the
        critical values.

        ``name`` is that of the sweep, the first by default.
        """
        axes = _plots.sweep(self._study("sweeps", name, "sweep"), axes)
        axes[0].set_title(self.title, wrap=True, fontsize="medium")
        return axes

    def plot_frf(self, name: str | None = None, axes: Sequence[Axes] | None = None) -> list[Axes]:
        """Magnitude and phase over frequency of the responses of an ``[frf]``.

        ``name`` is that of the response, the first by default.
        """
        axes = _plots.frf(self._study("frf", name, "frf"), axes)
        axes[0].set_title(self.title, wrap=True, fontsize="medium")
        return axes

    def plot_history(self, *channels: str, axes: Sequence[Axes] | None = None) -> list[Axes]:
        """Channels of a run in time, one panel a unit; velocities where none is named.

        >>> results.plot_history("rim_velocity", "rim_normal_force")
        """
        axes = _plots.history(self.history, channels, axes)
        axes[0].set_title(self.title, wrap=True, fontsize="medium")
        return axes

    def _study(self, group: str, name: str | None, table: str) -> xr.DataTree:
        names = list(self.tree[group].children) if f"/{group}" in self.tree.groups else []
        if not names:
            raise KeyError(f"no {group!r} in these results: the run had no [{table}]")
        if name is not None and name not in names:
            raise KeyError(f"no {name!r} among the [{table}] of these results, which are {', '.join(names)}")
        study = self.tree[f"{group}/{names[0] if name is None else name}"]
        assert isinstance(study, xr.DataTree)
        return study

    def show_report(self) -> None:
        """Opens ``report.html`` of the results folder in a browser."""
        if self.folder is None:
            raise ValueError("these results are in memory: run the case with out=FOLDER to get its page")
        webbrowser.open((self.folder / "report.html").resolve().as_uri())

    def __repr__(self) -> str:
        place = "in memory" if self.folder is None else os.fspath(self.folder)
        groups = [group for group in self._paths() if "/" not in group]
        return f"<stridor.Results of {self.title!r}, {place}: {', '.join(groups)}>"

    def _repr_html_(self) -> str:
        return str(self.tree._repr_html_())  # type: ignore[no-untyped-call]


def _motion(field: xr.DataArray | None) -> dict[str, npt.NDArray[np.float64]]:
    """Displacements and rotations of the nodes of a field, real and imaginary parts."""
    if field is None:
        return {}
    values = field.transpose("node", "freedom").values
    parts = {"": values.real, "_imag": values.imag} if np.iscomplexobj(values) else {"": values}
    return {
        f"{name}{suffix}": part[:, own]
        for suffix, part in parts.items()
        for name, own in (("displacement", slice(3)), ("rotation", slice(3, 6)))
    }


def open_results(folder: str | os.PathLike[str]) -> Results:
    """The results in a folder that a run has written; arrays are read where they are used."""
    folder = Path(folder)
    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    tree = xr.open_datatree(folder / "results.h5", engine="h5netcdf")
    return Results(tree, summary, folder)
