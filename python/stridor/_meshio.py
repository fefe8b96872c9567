"""Meshes as objects of meshio."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
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


def _of_number(number: int) -> str:
    return next(name for name, own in _VTK.items() if own == number)


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
    import meshio

    nodes, ends = geometry["element_nodes"].values, geometry["element_offsets"].values
    kinds, parts = geometry["element_kind"].values, geometry["element_part"].values
    cells: list[tuple[str, Any]] = []
    data: list[Any] = []
    # Neighbours of one kind are a block.
    breaks = np.flatnonzero(np.diff(kinds)) + 1
    for first, last in zip([0, *breaks], [*breaks, len(kinds)], strict=True):
        if first == last:
            continue
        rows = nodes[ends[first] : ends[last]].reshape(last - first, -1)
        kind = _of_number(int(kinds[first]))
        cells.append((kind, rows[:, _WEDGE] if kind == "wedge" else rows))
        data.append(parts[first:last])
    names = [str(name) for name in geometry["part_names"].values]
    sets = {name: [np.flatnonzero(own == k) for own in data] for k, name in enumerate(names)}
    return meshio.Mesh(
        np.asarray(geometry["nodes"].values, dtype=float),
        cells,
        point_data=point_data,
        cell_data={"part": data},
        cell_sets=sets,
    )
