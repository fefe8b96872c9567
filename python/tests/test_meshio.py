"""Objects of meshio in and out."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import stridor

meshio = pytest.importorskip("meshio")

STEEL = {"youngs_modulus": 210e9, "poissons_ratio": 0.3, "density": 7850.0}
KEYS: dict[str, Any] = {
    "title": "a bar of bricks",
    "material": {"steel": STEEL},
    "solid": {"bar": {"material": "steel"}},
    "support": {"end": {"on": "end"}},
    "modes": {"all": {"count": 3}},
}


def bar(kind: str = "hexahedron", length: float = 0.2) -> Any:
    """Eight cells of square cross-section along x, the nodes at x = 0 as a set."""
    n = 8
    x = np.linspace(0.0, length, n + 1)
    square = length / 10 * np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
    points = np.array([[at, y, z] for at in x for y, z in square])
    low = 4 * np.arange(n)[:, None]
    cells = low + np.array([0, 1, 2, 3, 4, 5, 6, 7])
    if kind == "wedge":
        # Both halves of each brick across its square.
        cells = np.vstack([low + np.array(half) for half in ([0, 1, 2, 4, 5, 6], [0, 2, 3, 4, 6, 7])])
    return meshio.Mesh(
        points,
        [(kind, cells), ("quad", [[0, 1, 2, 3]])],
        cell_sets={"bar": [np.arange(len(cells)), []], "face": [[], [0]]},
        point_sets={"end": np.arange(4)},
    )


def frequencies(case: stridor.Case) -> Any:
    return case.run("modes", progress=False)["modes/all/frequency_hz"].values


def test_a_mesh_of_meshio_runs(tmp_path: Path) -> None:
    case = stridor.Case.from_meshio(bar(), KEYS, tmp_path / "bar")
    found = frequencies(case)
    # Bending of a clamped beam, Euler and Bernoulli: (1.8751/L)² √(E I / ρ A) / 2π, I/A = h²/12.
    h, length = 0.02, 0.2
    beam = (1.87510407 / length) ** 2 * np.sqrt(210e9 / 7850.0 * h**2 / 12) / (2 * np.pi)
    assert found[0] == pytest.approx(beam, rel=0.02)
    assert found[1] == pytest.approx(found[0], rel=1e-6)
    # In millimetres it is the same; on the face instead of its nodes, too.
    scaled = stridor.Case.from_meshio(bar(length=200.0), KEYS, tmp_path / "mm", unit="mm")
    assert frequencies(scaled) == pytest.approx(found, rel=1e-9)
    on_face = {**KEYS, "support": {"end": {"on": "face"}}}
    assert frequencies(stridor.Case.from_meshio(bar(), on_face, tmp_path / "face")) == pytest.approx(found, rel=1e-9)


def test_physical_groups_and_files_have_their_names(tmp_path: Path) -> None:
    mesh = bar()
    data = {"gmsh:physical": [np.full(8, 5), np.array([6])], "gmsh:geometrical": [np.full(8, 1), np.array([1])]}
    names = {"bar": np.array([5, 3]), "end": np.array([6, 2])}
    named = meshio.Mesh(mesh.points, mesh.cells, cell_data=data, field_data=names)
    found = frequencies(stridor.Case.from_meshio(named, KEYS, tmp_path / "names"))
    assert found == pytest.approx(frequencies(stridor.Case.from_meshio(mesh, KEYS, tmp_path / "sets")), rel=1e-9)
    plain = meshio.Mesh(mesh.points, mesh.cells[:1])
    keys = {**KEYS, "solid": {"part": {"material": "steel"}}, "support": {}}
    assert stridor.Case.from_meshio(plain, keys, tmp_path / "plain").model().n == 9 * 4 * 3
    # A file of VTK of the same, as a deck: numbers of parts, which the user gives a material.
    named.write(tmp_path / "bar.vtu")
    with pytest.raises(stridor.InputError, match="gmsh_physical_5"):
        stridor.import_deck(tmp_path / "bar.vtu", "m", tmp_path / "deck")
    case = (tmp_path / "deck/case.toml").read_text()
    assert "[solid.gmsh_physical_5]" in case and "gmsh_physical_6" in (tmp_path / "deck/mesh.msh").read_text()


def test_results_come_back_with_their_parts(tmp_path: Path) -> None:
    keys = {**KEYS, "solid": {"bar": {"material": "steel", "allow_locking": True}}}
    for kind, own in (("hexahedron", KEYS), ("wedge", keys)):
        mesh = bar(kind)
        results = stridor.Case.from_meshio(mesh, own, tmp_path / kind).run("modes", progress=False)
        shape = results["modes/all/shapes"].isel(mode=0)
        back = results.to_meshio(shape)
        assert np.array_equal(back.points, mesh.points)
        solid = next(block for block in back.cells if block.type == kind)
        assert np.array_equal(solid.data, mesh.cells[0].data)
        assert np.array_equal(back.point_data["displacement"], shape.values[:, :3])
        assert np.concatenate(back.cell_sets["bar"]).size == len(solid.data)
        again = stridor.Case.from_meshio(back, {**own, "support": {}}, tmp_path / f"{kind}2")
        assert again.model().n == 3 * len(mesh.points)


@pytest.mark.parametrize("kind", ["hexahedron", "wedge"])
def test_the_mesh_of_a_case_comes_back_with_its_regions(kind: str, tmp_path: Path) -> None:
    mesh = bar(kind)
    solid = {"bar": {"material": "steel", "allow_locking": kind == "wedge"}}
    case = stridor.Case.from_meshio(mesh, {**KEYS, "solid": solid}, tmp_path / "one")
    back = case.to_meshio()
    assert np.array_equal(back.points, mesh.points)
    assert {name: sum(map(len, own)) for name, own in back.cell_sets.items()} == {"bar": len(mesh.cells[0]), "face": 1}
    assert np.array_equal(np.sort(back.point_sets["end"]), np.arange(4))
    again = stridor.Case.from_meshio(back, {**KEYS, "solid": solid}, tmp_path / "two")
    assert frequencies(again) == pytest.approx(frequencies(case), rel=1e-9)


def test_what_stridor_cannot_take_is_an_input_error(tmp_path: Path) -> None:
    mesh = meshio.Mesh(np.zeros((10, 3)), [("triangle10", [np.arange(10)])])
    with pytest.raises(stridor.InputError, match="triangle10"):
        stridor.Case.from_meshio(mesh, KEYS, tmp_path)
    with pytest.raises(stridor.InputError, match="one of m, mm, cm, in"):
        stridor.Case.from_meshio(bar(), KEYS, tmp_path, unit="ft")
    wrong = bar()
    wrong.cells[1].data[0, 0] = 99
    with pytest.raises(stridor.InputError, match="0 to 35"):
        stridor.Case.from_meshio(wrong, KEYS, tmp_path)
    assert not (tmp_path / "mesh.msh").exists()
