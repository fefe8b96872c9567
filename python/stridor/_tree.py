"""Results as an xarray tree, laid out as in ``results.h5``."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import xarray as xr
from xarray.backends import BackendArray
from xarray.core import indexing

from . import _native


def tree_of(run: _native.Run) -> xr.DataTree:
    """The tree of a run that is in memory; fields of all nodes are worked out where they are read."""
    return xr.DataTree.from_dict(dict(_datasets(run, run.tree(), ())))


def _datasets(
    run: _native.Run, group: dict[str, Any], path: tuple[str, ...]
) -> Iterator[tuple[str, xr.Dataset]]:
    """The path and the dataset of a group and of those in it."""
    variables = {
        key: _variable(run, path, key, variable) for key, variable in group["variables"].items()
    }
    attributes = {"description": group["description"]} if group["description"] else {}
    yield "/" + "/".join(path), xr.Dataset(variables, attrs=attributes)
    for key, inner in group["groups"].items():
        yield from _datasets(run, inner, (*path, key))


def _variable(
    run: _native.Run, path: tuple[str, ...], key: str, variable: tuple[Any, ...]
) -> xr.Variable:
    dimensions, shape, values, unit, description = variable
    if isinstance(values, str):
        values = indexing.LazilyIndexedArray(_Field(run, path, key, tuple(shape), np.dtype(values)))
    elif isinstance(values, list):
        values = np.array(values, dtype=str).reshape(shape)
    attributes = {"units": unit, "description": description}
    if unit == "text":
        del attributes["units"]
    return xr.Variable(dimensions, values, attributes)


class _Field(BackendArray):
    """A field that is worked out row by row."""

    def __init__(
        self,
        run: _native.Run,
        path: tuple[str, ...],
        key: str,
        shape: tuple[int, ...],
        dtype: np.dtype[Any],
    ) -> None:
        self.run, self.path, self.key = run, path, key
        self.shape, self.dtype = shape, dtype

    def __getitem__(self, key: indexing.ExplicitIndexer) -> Any:
        basic = indexing.IndexingSupport.BASIC
        return indexing.explicit_indexing_adapter(key, self.shape, basic, self._read)

    def _read(self, key: tuple[int | slice, ...]) -> Any:
        first, *rest = key
        rows = np.arange(self.shape[0])[first]
        values = self.run.rows(self.path, self.key, np.atleast_1d(rows).tolist())
        return values[(slice(None) if rows.ndim else 0, *rest)]
