"""Cases of the tests."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import stridor

SUITE = Path(__file__).parents[2] / "validation"

TWO_DOF: dict[str, Any] = {
    "title": "mass on a belt",
    "mass": {"block": {"on": "block", "mass": 1.0}},
    "point": {"block": [0.0, 0.0, 0.0]},
    "support": {"line": {"on": "block", "held": ["uy", "uz", "rx", "ry", "rz"]}},
    "spring": {"ground": {"on": "block", "direction": [1, 0, 0], "stiffness": 100.0}},
    "modes": {"all": {"below": 10.0}},
}


@pytest.fixture(scope="session")
def rig() -> stridor.Case:
    """The reference rig on its smallest mesh."""
    return stridor.Case.read(SUITE / "rig-coarse" / "case.toml")


@pytest.fixture(scope="session")
def squeal(rig: stridor.Case) -> stridor.Results:
    return rig.run(progress=False)
