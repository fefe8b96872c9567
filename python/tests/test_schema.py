"""The JSON Schema of case files against a validator of its own.

It takes every case of the validation suite, and refuses what the program refuses of keys and types.
"""

from __future__ import annotations

import copy
import json
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import jsonschema_rs
import pytest
from conftest import SUITE

import stridor

Table = dict[str, Any]


@pytest.fixture(scope="module")
def validator() -> jsonschema_rs.Draft7Validator:
    printed = subprocess.run([sys.executable, "-P", "-m", "stridor", "schema"], capture_output=True, check=True)
    return jsonschema_rs.Draft7Validator(json.loads(printed.stdout))


@pytest.fixture(scope="module")
def cases() -> list[tuple[Path, Table]]:
    """The cases of the suite that the program reads."""
    found = []
    for path in sorted(SUITE.rglob("*.toml")):
        try:
            keys = tomllib.loads(path.read_text())
            stridor.Case.from_dict(keys)
        except (stridor.InputError, tomllib.TOMLDecodeError):
            continue
        found.append((path, keys))
    return found


def test_every_case_is_valid_as_written_and_as_resolved(
    validator: jsonschema_rs.Draft7Validator, cases: list[tuple[Path, Table]]
) -> None:
    assert len(cases) > 60
    for path, keys in cases:
        for document in (keys, tomllib.loads(stridor.Case.from_dict(keys).to_toml())):
            faults = [f"{path}: {e.instance_path}: {e.message}" for e in validator.iter_errors(document)]
            assert not faults


def places(table: Table, at: tuple[str, ...] = ()) -> Iterator[tuple[str, ...]]:
    """Every place of a document with a key."""
    for key, value in table.items():
        yield (*at, key)
        if isinstance(value, dict):
            yield from places(value, (*at, key))


def changed(keys: Table, place: tuple[str, ...]) -> Iterator[Table]:
    """The document with the key at a place misspelt, and with a table that has an odd key there."""
    for misspelt in (True, False):
        wrong = copy.deepcopy(keys)
        table = wrong
        for key in place[:-1]:
            table = table[key]
        if misspelt:
            table[place[-1] + "zz"] = table.pop(place[-1])
        else:
            table[place[-1]] = {"zz": True}
        yield wrong


def test_keys_that_are_misspelt_or_of_another_type_are_refused(
    validator: jsonschema_rs.Draft7Validator, cases: list[tuple[Path, Table]]
) -> None:
    # What the program refuses, the schema refuses, unless it is about names, which no schema knows.
    tried = refused = 0
    for path, keys in cases:
        for place in places(keys):
            for wrong in changed(keys, place):
                valid = validator.is_valid(wrong)
                try:
                    stridor.Case.from_dict(wrong)
                except stridor.InputError as error:
                    tried += 1
                    refused += not valid
                    of_schema = "an unknown key" in str(error) or "found a table" in str(error)
                    assert not (of_schema and valid), (path, place, str(error))
                else:
                    assert valid, (path, place, "is a case")
    assert tried > 1000 and refused > 0.9 * tried, (refused, tried)


def test_wrong_values_are_refused(validator: jsonschema_rs.Draft7Validator) -> None:
    document = tomllib.loads((SUITE / "wrong-files" / "keys.toml").read_text())
    faults = {"/".join(map(str, e.instance_path)) for e in validator.iter_errors(document)}
    for place in ("material/steel/poissons_ratio", "material/steel/density", "shell/strip", "modes/strip/count"):
        assert place in faults
