"""M, C, K and the contacts of a case as arrays."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp
import xarray as xr


@dataclass(frozen=True)
class Contact:
    """A contact pair with its p points, on the n degrees of freedom of a model."""

    name: str
    """The name that the case gives it."""
    sliding_velocity: float
    """V [m/s]: velocity of the counter-body relative to the body along t1, without vibration."""
    position: npt.NDArray[np.float64]
    """Where the points are [m], p × 3."""
    gap: npt.NDArray[np.float64]
    """Initial gaps [m], p."""
    weight: npt.NDArray[np.float64]
    """Contact length [m] or area [m²] of each point, or its share of one, p."""
    normal: sp.csc_array
    """Columns g, n × p: the penetration of a point grows by gᵀu."""
    tangent_1: sp.csc_array
    """Columns t1, n × p: t1ᵀu is the displacement relative to the counter-body along the sliding direction."""
    tangent_2: sp.csc_array
    """Columns t2, n × p: the same across it."""


@dataclass(frozen=True)
class Model:
    """M ü + C u̇ + K u + Σ [g N − t1 F1 − t2 F2] = f on n degrees of freedom, as SciPy sparse arrays, both triangles stored.

    Modal damping and the geometric stiffness of the preload, which follow from other analyses, are not part of C and K.
    """

    M: sp.csc_array
    """Mass [kg, kg m²]."""
    C: sp.csc_array
    """Damping [N s/m, N m s]: Rayleigh damping, dashpots, imported parts."""
    K: sp.csc_array
    """Stiffness [N/m, N m]; complex where a part has a loss factor."""
    load: npt.NDArray[np.float64]
    """External force f [N, N m]."""
    dofs: xr.Dataset
    """For every degree of freedom its node, the motion of the node (``direction``) and where it is (``position`` [m])."""
    contacts: tuple[Contact, ...]
    """The contact pairs."""

    @property
    def n(self) -> int:
        """The number of degrees of freedom."""
        return int(self.M.shape[0])

    @classmethod
    def _of(cls, parts: dict[str, Any]) -> Model:
        mass = _matrix(parts["mass"])
        stiffness = _matrix(parts["stiffness"])
        if parts["loss"] is not None:
            stiffness = sp.csc_array(stiffness + 1j * _matrix(parts["loss"]))
        damping = sp.csc_array(mass.shape) if parts["damping"] is None else _matrix(parts["damping"])
        dofs = xr.Dataset(
            {
                "node": ("dof", parts["node"], {"description": "index of the node"}),
                "direction": (
                    ("dof", "freedom"),
                    parts["direction"].reshape(-1, 6),
                    {"description": "motion of the node when the degree of freedom is one"},
                ),
                "position": (("dof", "axis"), parts["position"].reshape(-1, 3), {"units": "m"}),
            },
            coords={"freedom": ["ux", "uy", "uz", "rx", "ry", "rz"], "axis": ["x", "y", "z"]},
        )
        return cls(
            M=mass,
            C=damping,
            K=stiffness,
            load=parts["load"],
            dofs=dofs,
            contacts=tuple(_contact(pair) for pair in parts["contacts"]),
        )

    def __repr__(self) -> str:
        points = sum(len(contact.gap) for contact in self.contacts)
        return f"<stridor.Model: {self.n} degrees of freedom, {points} contact points>"


def _contact(pair: dict[str, Any]) -> Contact:
    matrices = {key: _matrix(pair[key]) for key in ("normal", "tangent_1", "tangent_2")}
    return Contact(**{**pair, **matrices, "position": pair["position"].reshape(-1, 3)})


def _matrix(columns: tuple[Any, Any, Any, tuple[int, int]]) -> sp.csc_array:
    values, rows, starts, shape = columns
    return sp.csc_array((values, rows, starts), shape=shape)
