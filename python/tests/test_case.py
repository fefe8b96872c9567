"""Cases: files, dicts, scalars, faults."""

from __future__ import annotations

import copy
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from conftest import TWO_DOF

import stridor


def test_a_dict_is_the_case_of_its_file(rig: stridor.Case) -> None:
    again = stridor.Case.from_dict(rig.to_dict(), rig.folder)
    assert again.to_toml() == rig.to_toml()
    assert again.title == rig.title == "The rig on a mesh that dense algebra can follow"


def test_quantities_may_be_texts_and_numpy_arrays() -> None:
    keys = {**TWO_DOF, "point": {"block": np.zeros(3)}}
    keys["spring"] = {"ground": {"on": "block", "direction": np.array([1, 0, 0]), "stiffness": "0.1 kN/m"}}
    assert stridor.Case.from_dict(keys)["spring.ground.stiffness"] == pytest.approx(100.0, rel=1e-15)


def test_scalars_have_values_units_and_bounds(rig: stridor.Case) -> None:
    thickness = rig.scalars["shell.disc.thickness"]
    assert (thickness.value, thickness.unit) == (1e-3, "m")
    assert (thickness.lower, thickness.lower_included, thickness.upper) == (0.0, False, np.inf)
    assert list(rig) == list(rig.scalars)
    thicker = rig.replace({"shell.disc.thickness": 2e-3, "contact.rim.load": np.float64(20)})
    assert (thicker["shell.disc.thickness"], thicker["contact.rim.load"]) == (2e-3, 20.0)
    assert rig["shell.disc.thickness"] == 1e-3


def test_scalars_take_texts_with_a_unit(rig: stridor.Case) -> None:
    thicker = rig.replace({"shell.disc.thickness": "1.2 mm", "contact.rim.load": "0.02 kN"})
    assert thicker["shell.disc.thickness"] == pytest.approx(1.2e-3, rel=1e-15)
    assert thicker["contact.rim.load"] == pytest.approx(20.0, rel=1e-15)
    for wrong in ["1.2 kg", "1.2", "thick"]:
        with pytest.raises(stridor.InputError, match=r"shell\.disc\.thickness.*a value in m"):
            rig.replace({"shell.disc.thickness": wrong})


def test_changed_keys_keep_the_folder_of_the_case(rig: stridor.Case) -> None:
    keys = copy.deepcopy(rig.to_dict())
    keys["cea"]["band"] = [0, "2 kHz"]
    changed = stridor.Case.from_dict(keys)
    assert changed.folder == rig.folder
    assert changed.to_dict()["cea"]["band"] == [0.0, 2000.0]
    assert changed.check() is not None
    assert stridor.Case.from_dict(dict(keys)).folder == Path()


def test_all_faults_come_at_once_with_the_words_of_the_program(tmp_path: Path) -> None:
    path = tmp_path / "wrong.toml"
    path.write_text('[material.steel]\nyoungs_modulus = "-1 GPa"\ndensity = "1 m"\npoissons_ratio = 0.3\n')
    with pytest.raises(stridor.InputError) as caught:
        stridor.run(path)
    faults = caught.value.faults
    places = [fault.place.rsplit(":", 1)[1] for fault in faults]
    assert {"2 `material.steel.youngs_modulus`", "3 `material.steel.density`"} < set(places)
    command = [sys.executable, "-m", "stridor", "run", str(path)]
    program = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert program.returncode == 2
    assert str(caught.value) in program.stderr
    assert isinstance(caught.value, ValueError)
    assert isinstance(caught.value, stridor.Error)


def test_faults_of_a_dict_name_keys_without_lines() -> None:
    keys = {**TWO_DOF, "mass": {"block": {"on": "nowhere", "mass": 1.0}}}
    with pytest.raises(stridor.InputError) as caught:
        stridor.run(keys)
    assert caught.value.faults[0].place.startswith("`mass.block.on")
    keys = {**TWO_DOF, "mass": {"block": {"on": "block", "mass": None}}, "titel": "x"}
    with pytest.raises(stridor.InputError, match="`mass.block.mass`: found None"):
        stridor.run(keys)
    with pytest.raises(stridor.InputError, match="title"):
        stridor.run({**TWO_DOF, "titel": "x"})


def test_what_cannot_be_is_refused(rig: stridor.Case) -> None:
    with pytest.raises(stridor.InputError, match="Did you mean `shell.disc.thickness`"):
        rig["shell.disk.thickness"]
    with pytest.raises(stridor.InputError, match="thickness"):
        rig.replace({"shell.disc.thickness": -1.0})
    with pytest.raises(stridor.InputError, match="one of modes, cea"):
        rig.run("caes")
    with pytest.raises(TypeError):
        stridor.Case.from_dict({"title": object()})
    with pytest.raises(stridor.InputError, match="no file there"):
        stridor.run("nowhere.toml")
    with pytest.raises(stridor.MachineError):
        rig.run("cea", out="/proc/nothing")


def test_check_gives_what_the_user_should_know(rig: stridor.Case) -> None:
    warnings = rig.check()
    assert any("bending wave" in sentence for sentence in warnings)
    soft = rig.replace({"material.steel.youngs_modulus": 200.0})
    assert any("youngs_modulus" in sentence for sentence in soft.check())


@pytest.mark.parametrize("template", ["rig", "pad", "two-dof", "imported", "transient", "measured"])
def test_templates_are_valid(template: str, tmp_path: Path) -> None:
    case = stridor.Case.new(tmp_path / "new", template)
    assert isinstance(case.check(), list)
    with pytest.raises(stridor.InputError, match="Choose another name"):
        stridor.Case.new(tmp_path / "new", template)


def test_a_deck_of_another_program_becomes_a_case(tmp_path: Path) -> None:
    chapter = (Path(__file__).parents[2] / "guide/src/abaqus.md").read_text()
    deck = chapter.split("```inp,file=rub.inp\n")[1].split("```")[0]
    (tmp_path / "rub.inp").write_text(deck)
    case = stridor.import_deck(tmp_path / "rub.inp", "mm", tmp_path / "rub")
    assert case["contact.Rubbing.friction.mu0"] == 0.5
    assert (tmp_path / "rub/import.md").exists()
    with pytest.raises(stridor.InputError, match="Choose another name"):
        stridor.import_deck(tmp_path / "rub.inp", "mm", tmp_path / "rub")
    (tmp_path / "rub.inp").write_text(deck.replace("*Elastic", "*Connector Section\n*Elastic"))
    with pytest.warns(stridor.CaseWarning, match="connectors"):
        stridor.import_deck(tmp_path / "rub.inp", "mm", tmp_path / "other")


def test_a_template_that_is_not_there_is_refused(tmp_path: Path) -> None:
    with pytest.raises(stridor.InputError, match="two-dof"):
        stridor.Case.new(tmp_path / "new", "disk")
    assert not (tmp_path / "new").exists()


