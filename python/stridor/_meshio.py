"""Meshes as objects of meshio."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from . import _native
from ._errors import InputError

if TYPE_CHECKING:
    import meshio

# Numbers of cell types in VTK, whose order of nodes meshio has but for `wedge`.
_VTK = {
    "vertex": 1,
    "line": 3,
    "triangle": 5,
    "quad": 9,
    "tetra": 10,
    "hexahedron": 12,
    "wedge": 13,
    "pyramid": 14,
    "line3": 21,
    "triangle6": 22,
    "quad8": 23,
    "tetra10": 24,
    "hexahedron20": 25,
    "wedge15": 26,
    "pyramid13": 27,
    "quad9": 28,
    "hexahedron27": 29,
    "wedge18": 32,
}
_WEDGE = [0, 2, 1, 3, 5, 4]


def gmsh_text(mesh: meshio.Mesh, length: float) -> str:
    """The Gmsh file of a mesh whose coordinates are multiples of ``length`` [m]."""
    points = np.zeros((len(mesh.points), 3))
    points[:, : mesh.points.shape[1]] = np.asarray(mesh.points, dtype=float) * length
    unknown = sorted({block.type for block in mesh.cells} - set(_VTK))
    if unknown:
        found, expected = f"cells of type {', '.join(unknown)}", f"types {', '.join(_VTK)}"
        raise InputError(f"mesh.cells: found {found}; expected {expected}.", [("mesh.cells", found, expected, "")])
    blocks = [(_VTK[block.type], np.asarray(block.data, dtype=np.int64)) for block in mesh.cells]
    nodes, regions = _regions(mesh)
    if nodes:
        blocks.append((1, np.array(nodes, dtype=np.int64).reshape(-1, 1)))
    return _native.mesh_text(points, blocks, regions)


def _regions(mesh: meshio.Mesh) -> tuple[list[int], list[tuple[str, int, list[int]]]]:
    """Nodes that become cells behind those of the mesh, and the regions: sets of cells, physical groups, sets of points."""
    starts = np.cumsum([0, *(len(block.data) for block in mesh.cells)])
    dimensions = [block.dim for block in mesh.cells]
    found: dict[tuple[str, int], list[int]] = {}

    def add(name: str, block: int, cells: Any) -> None:
        if len(cells):
            found.setdefault((name, dimensions[block]), []).extend(int(k) for k in starts[block] + np.asarray(cells))

    for name, of_blocks in mesh.cell_sets.items():
        if not name.startswith("gmsh:"):
            for block, cells in enumerate(of_blocks):
                add(name, block, [] if cells is None else cells)
    groups = {name: np.asarray(own) for name, own in mesh.field_data.items() if np.size(own) == 2}
    named = {(int(tag), int(dim)): name for name, (tag, dim) in groups.items() if name not in mesh.cell_sets}
    known = {name for name, _ in found}
    for block, tags in enumerate(mesh.cell_data.get("gmsh:physical", [])):
        for tag in np.unique(tags):
            name = named.get((int(tag), dimensions[block]))
            if name is None and not known and tag > 0:
                name = f"physical_{tag}"
            if name is not None:
                add(name, block, np.flatnonzero(np.asarray(tags) == tag))
    if not found:
        largest = max(dimensions, default=0)
        for block, dimension in enumerate(dimensions):
            if dimension == largest:
                add("part", block, np.arange(starts[block + 1] - starts[block]))
    nodes: list[int] = []
    for name, members in mesh.point_sets.items():
        first = int(starts[-1]) + len(nodes)
        nodes += [int(node) for node in np.asarray(members)]
        if len(members):
            found[(name, 0)] = list(range(first, int(starts[-1]) + len(nodes)))
    # A name of several dimensions is that of the highest.
    highest = {name: max(dim for other, dim in found if other == name) for name, _ in found}
    plain = {key: key[0] if highest[key[0]] == key[1] else f"{key[0]}_{key[1]}d" for key in found}
    return nodes, [(plain[key], key[1], sorted(set(cells))) for key, cells in found.items()]


def of_geometry(geometry: xr.Dataset, point_data: dict[str, Any]) -> meshio.Mesh:
    """The mesh of the geometry of results, with its parts as sets of cells."""
    parts = geometry["element_part"].values
    names = [str(name) for name in geometry["part_names"].values]
    sets = {name: np.flatnonzero(parts == k) for k, name in enumerate(names)}
    keys = ("nodes", "element_kind", "element_nodes", "element_offsets")
    return _mesh({key: geometry[key].values for key in keys}, sets, point_data=point_data, cell_data={"part": parts})


def of_mesh(mesh: dict[str, Any]) -> meshio.Mesh:
    """The mesh of a case, with its regions as sets of cells and, those of points, of points."""
    sets = {name: np.asarray(own) for name, dimension, own in mesh["regions"] if dimension > 0}
    first, nodes = mesh["element_offsets"][:-1], mesh["element_nodes"]
    points = {name: nodes[first[own]] for name, dimension, own in mesh["regions"] if dimension == 0}
    return _mesh(mesh, sets, point_sets=points)


def _mesh(
    mesh: dict[str, Any],
    sets: dict[str, npt.NDArray[np.int64]],
    *,
    point_data: dict[str, Any] | None = None,
    point_sets: dict[str, Any] | None = None,
    cell_data: dict[str, Any] | None = None,
) -> meshio.Mesh:
    """Cells but for points; sets and data are by all cells, neighbours of one kind are a block."""
    import meshio

    nodes, ends, kinds = mesh["element_nodes"], mesh["element_offsets"], mesh["element_kind"]
    bounds = [0, *(np.flatnonzero(np.diff(kinds)) + 1), len(kinds)]
    blocks = [(a, b) for a, b in zip(bounds, bounds[1:], strict=False) if b > a and kinds[a] != _VTK["vertex"]]

    def cells(first: int, last: int) -> tuple[str, Any]:
        rows = nodes[ends[first] : ends[last]].reshape(last - first, -1)
        kind = next(name for name, own in _VTK.items() if own == kinds[first])
        return kind, rows[:, _WEDGE] if kind == "wedge" else rows

    return meshio.Mesh(
        np.asarray(mesh["nodes"], dtype=float).reshape(-1, 3),
        [cells(first, last) for first, last in blocks],
        point_data=point_data,
        point_sets=point_sets,
        cell_data={name: [own[first:last] for first, last in blocks] for name, own in (cell_data or {}).items()},
        cell_sets={
            name: [own[(own >= first) & (own < last)] - first for first, last in blocks] for name, own in sets.items()
        },
    )
