"""M, C, K and contacts, held against SciPy."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import scipy.linalg
import scipy.sparse.linalg
from conftest import SUITE, TWO_DOF

import stridor


def test_real_modes_are_those_that_scipy_finds_of_m_and_k() -> None:
    case = stridor.Case.read(SUITE / "annulus-02" / "case.toml")
    model = case.model()
    (name,) = case.to_dict()["modes"]
    frequencies = case.run("modes", progress=False)[f"modes/{name}/frequency_hz"].values
    # The disc is clamped, so that K has an inverse.
    count = min(8, len(frequencies))
    squares = scipy.sparse.linalg.eigsh(model.K, count, model.M, sigma=0.0, return_eigenvectors=False)
    assert np.allclose(np.sort(np.sqrt(squares)) / (2 * np.pi), frequencies[:count], rtol=1e-8)


def test_complex_modes_follow_from_the_matrices_and_the_contact(rig: stridor.Case) -> None:
    """Eigenvalues of (λ² M + λ (C + C_c) + K + K_c) u = 0 by a dense linearisation, with the contact matrices from the tangents
    at steady sliding: with E = [g, −t1, −t2] and v = V − tᵀu̇, K_c = Σ E ∂(N, F)/∂δ gᵀ and
    C_c = Σ E (∂(N, F)/∂δ̇ gᵀ − ∂(N, F)/∂v tᵀ).
    """
    case = rig.replace({"damping.modal_ratio": 0.0})
    model, results = case.model(), case.run("cea", progress=False)
    points = results["steady_sliding/points"].to_dataset()
    (contact,) = model.contacts
    g, t1, t2 = (m.toarray() for m in (contact.normal, contact.tangent_1, contact.tangent_2))
    stiffness, damping = model.K.toarray(), model.C.toarray()
    by_delta, by_rate, by_slip = (
        points[f"force_by_{key}"].values for key in ("penetration", "penetration_rate", "slip_velocity")
    )
    for k in range(points.sizes["point"]):
        forces = np.column_stack([g[:, k], -t1[:, k], -t2[:, k]])
        slip = -np.column_stack([t1[:, k], t2[:, k]])
        stiffness += np.outer(forces @ by_delta[k], g[:, k])
        damping += np.outer(forces @ by_rate[k], g[:, k]) + forces @ by_slip[k] @ slip.T
    factor = scipy.linalg.cho_factor(model.M.toarray())
    blocks = [scipy.linalg.cho_solve(factor, matrix) for matrix in (stiffness, damping)]
    n = model.n
    linear = np.block([[np.zeros((n, n)), np.eye(n)], [-blocks[0], -blocks[1]]])
    dense = scipy.linalg.eigvals(linear)
    for eigenvalue in results.eigenvalues:
        assert abs(dense - eigenvalue).min() < 1e-7 * abs(eigenvalue)
    assert results.unstable_modes.sizes["mode"] > 0


def test_loads_nodes_and_damping_have_their_shapes(rig: stridor.Case) -> None:
    model = rig.model()
    n = model.n
    assert model.M.shape == model.C.shape == model.K.shape == (n, n)
    assert abs(model.K - model.K.T).max() <= 1e-12 * abs(model.K).max()
    # Rayleigh damping of all parts: C = α M + β K but for the springs.
    assert model.C.nnz > 0 and model.load.shape == (n,)
    assert dict(model.dofs.sizes) == {"dof": n, "freedom": 6, "axis": 3}
    assert np.allclose(np.linalg.norm(model.dofs["direction"], axis=1), 1.0)
    (contact,) = model.contacts
    assert (contact.name, contact.sliding_velocity) == ("rim", 0.5)
    assert contact.normal.shape == (n, len(contact.gap)) and contact.position.shape == (len(contact.gap), 3)
    assert "degrees of freedom" in repr(model)


def test_a_loss_factor_makes_k_complex() -> None:
    case = stridor.Case.read(SUITE / "annulus-02" / "case.toml")
    model = case.replace({"material.steel.loss_factor": 0.1}).model()
    assert abs(model.K.imag - 0.1 * model.K.real).max() <= 1e-15 * abs(model.K).max()
    assert model.C.nnz == 0


def test_a_model_without_contact_has_none(tmp_path: Path) -> None:
    assert stridor.Case.from_dict(TWO_DOF, tmp_path).model().contacts == ()
