"""Runs: results in memory and in folders, progress, Ctrl-C, threads."""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from conftest import SUITE, TWO_DOF

import stridor


def leaves(tree: xr.DataTree) -> dict[str, xr.Variable]:
    """Every array by its path."""
    return {
        f"{node.path.rstrip('/')}/{key}": variable
        for node in tree.subtree
        for key, variable in node.to_dataset(inherit=False).variables.items()
    }


def same(a: xr.Variable, b: xr.Variable) -> bool:
    x, y = a.values, b.values
    if x.dtype.kind in "OUS":
        return np.array_equal(x.astype(str), y.astype(str))
    return np.array_equal(x, y, equal_nan=x.dtype.kind in "fc")


# What belongs to the run and not to its results, and what is coded in files.
OF_THE_RUN = ("/timings", "/provenance", "/inputs", "/transient/events/kind")


@pytest.mark.parametrize(
    "name", ["rig-coarse", "two-dof", "rig-limit-cycle", "measured-disc", "rotating-matrices"]
)
def test_results_in_memory_are_those_of_the_folder(name: str, tmp_path: Path) -> None:
    case = stridor.Case.read(SUITE / name / "case.toml")
    if "transient.duration" in case.scalars:
        case = case.replace({"transient.duration": 200 * case["transient.time_step"]})
    memory = case.run(progress=False)
    folder = case.run(out=tmp_path / "out", progress=False)
    own, written = leaves(memory.tree), leaves(folder.tree)
    # Maps say in files where an interrupted run goes on.
    compared = {path for path in own | written if not path.startswith(OF_THE_RUN) and "/trained_" not in path}
    assert compared <= own.keys() & written.keys(), compared - (own.keys() & written.keys())
    for path in compared:
        assert own[path].dims == written[path].dims, path
        assert same(own[path], written[path]), path
    for summary in (memory.summary, folder.summary):
        for key in ("timings", "provenance", "inputs"):
            summary.pop(key)
    assert memory.summary == folder.summary


def test_no_group_inherits_lists_of_sentences(squeal: stridor.Results, tmp_path: Path) -> None:
    folder = stridor.run(TWO_DOF, out=tmp_path / "out", progress=False)
    for tree in (squeal.tree, folder.tree):
        assert not tree.sizes
    own = {"mode", "node", "freedom", "dof", "real_mode", "limit"}
    assert set(squeal["cea/eigenvalues"].sizes) == own


def test_complex_modes_have_names_units_and_dimensions(squeal: stridor.Results) -> None:
    modes = squeal.complex_modes
    assert modes["growth_rate"].attrs["units"] == "1/s"
    assert np.array_equal(squeal.eigenvalues.real, modes["growth_rate"])
    assert np.allclose(squeal.eigenvalues.imag, 2 * np.pi * modes["frequency_hz"])
    unstable = squeal.unstable_modes
    assert unstable.sizes["mode"] == squeal.summary["cea"]["unstable"] > 0
    assert np.all(unstable["growth_rate"] > 0)
    shapes = modes["right"]
    assert shapes.dims == ("mode", "node", "freedom")
    one = shapes.sel(mode=2, freedom="uz")
    assert np.array_equal(one.values, shapes.values[1, :, 2])
    assert np.array_equal(shapes[[3, 1], ::2].values, shapes.values[[3, 1], ::2])
    with pytest.raises(KeyError, match=r"the run had no \[transient\]"):
        squeal.history  # noqa: B018
    with pytest.raises(KeyError, match="cea/eigenvalues"):
        squeal["cea/eigenvaluse"]
    assert "sweeps/friction" in squeal and "sweeps/mu" not in squeal


def test_tables_are_pandas_tables(squeal: stridor.Results) -> None:
    table = squeal.table("cea/eigenvalues")
    assert table.index.name == "mode" and len(table) == squeal.complex_modes.sizes["mode"]
    assert table["growth_rate"].max() == squeal.eigenvalues.real.max()
    assert "right" not in table
    assert list(squeal.table("model")["contact_points"]) == [squeal.summary["model"]["contact_points"]]
    with pytest.raises(KeyError, match="an array"):
        squeal.table("cea/eigenvalues/growth_rate")


def test_a_run_in_time_has_its_whole_history() -> None:
    case = stridor.Case.read(SUITE / "rig-limit-cycle" / "case.toml")
    step = case["transient.time_step"]
    results = case.replace({"transient.duration": 100 * step}).run("transient", progress=False)
    history = results.history
    assert np.allclose(history["time_s"], step * np.arange(101), rtol=0, atol=1e-15)
    assert all(channel.attrs["units"] for channel in history.data_vars.values())


def test_meshes_are_pyvista_objects(squeal: stridor.Results) -> None:
    pyvista = pytest.importorskip("pyvista")
    mesh = squeal.mesh()
    model = squeal.summary["model"]
    assert isinstance(mesh, pyvista.UnstructuredGrid)
    assert (mesh.n_points, mesh.n_cells) == (model["nodes"], model["elements"])
    # The disc has its area, with the rest of the parts left out.
    disc = list(mesh.field_data["part_names"]).index("disc")
    area = mesh.extract_cells(np.flatnonzero(mesh.cell_data["part"] == disc)).area
    assert area == pytest.approx(np.pi * (0.075**2 - 0.05**2), rel=0.02)
    shape = squeal.unstable_modes["right"].isel(mode=0)
    moved = squeal.mesh(shape)
    assert np.array_equal(moved.point_data["displacement_imag"][:, 1], shape.sel(freedom="uy").values.imag)
    assert not np.any(np.isnan(moved.warp_by_vector("displacement").points))


def test_growth_is_drawn_over_frequency(squeal: stridor.Results) -> None:
    pytest.importorskip("matplotlib").use("agg")
    ax = squeal.plot_growth()
    drawn = np.vstack([points.get_offsets() for points in ax.collections])
    assert len(drawn) == squeal.complex_modes.sizes["mode"]
    assert len(ax.texts) == squeal.unstable_modes.sizes["mode"]


def test_progress_reaches_a_function(rig: stridor.Case) -> None:
    seen: list[tuple[str, int, int | None]] = []
    rig.run(progress=lambda *stage: seen.append(stage))
    assert {"steady sliding"} <= {stage for stage, _, _ in seen}
    assert all(total is None or 0 <= done <= total for _, done, total in seen)


def test_an_exception_of_that_function_stops_the_run(rig: stridor.Case) -> None:
    def refuse(stage: str, done: int, total: int | None) -> None:
        raise RuntimeError(stage)

    with pytest.raises(RuntimeError):
        rig.run(progress=refuse)


def long_run() -> stridor.Case:
    """Minutes of a run in time."""
    case = stridor.Case.read(SUITE / "rig-limit-cycle" / "case.toml")
    return case.replace({"transient.duration": 2e6 * case["transient.time_step"]})


@pytest.fixture
def heeds_ctrl_c() -> Iterator[None]:
    """A shell has what it starts in the background ignore Ctrl-C, and Python keeps to that."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.usefixtures("heeds_ctrl_c")
def test_ctrl_c_stops_a_run_which_can_be_resumed(tmp_path: Path) -> None:
    timer = threading.Timer(3.0, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    started = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        long_run().run("transient", out=tmp_path, progress=False)
    assert time.monotonic() - started < 20.0
    assert (tmp_path / "checkpoint.bin").exists() or (tmp_path / "record.bin").exists()
    # What was stopped does not disturb the next run.
    assert stridor.run(TWO_DOF, progress=False)["modes/all/frequency_hz"].values == pytest.approx([10 / (2 * np.pi)])


def test_other_threads_go_on_during_a_run(rig: stridor.Case) -> None:
    """Without the lock released a thread that counts would stand still for as long as the run takes."""
    gaps: list[float] = []
    ended = threading.Event()

    def count() -> None:
        last = time.monotonic()
        while not ended.is_set():
            time.sleep(0.001)
            now = time.monotonic()
            gaps.append(now - last)
            last = now

    counter = threading.Thread(target=count)
    counter.start()
    started = time.monotonic()
    rig.run(progress=False)
    took = time.monotonic() - started
    ended.set()
    counter.join()
    assert took > 0.2 and max(gaps) < 0.5 * took, (took, max(gaps))


def eigenvalues(threads: int) -> Any:
    case = stridor.Case.read(SUITE / "rig-coarse" / "case.toml")
    return case.run("cea", threads=threads, progress=False).eigenvalues


def test_the_number_of_threads_changes_nothing() -> None:
    assert np.array_equal(eigenvalues(1), eigenvalues(2))


def test_processes_forked_after_a_run_can_run_too() -> None:
    own = eigenvalues(2)
    with multiprocessing.get_context("fork").Pool(2) as pool:
        for other in pool.map_async(eigenvalues, [1, 2]).get(timeout=120):
            assert np.array_equal(own, other)


def test_warnings_of_the_case_are_issued(rig: stridor.Case) -> None:
    with pytest.warns(stridor.CaseWarning, match="bending wave") as issued:
        results = rig.run("cea", progress=False)
    assert [str(warning.message) for warning in issued] == results.warnings
    assert {warning.filename for warning in issued} == {__file__}
    with pytest.warns(stridor.CaseWarning) as issued:
        stridor.run(rig, "cea", progress=False)
    assert {warning.filename for warning in issued} == {__file__}


def test_sweeps_responses_and_histories_are_drawn() -> None:
    pytest.importorskip("matplotlib").use("agg")
    import matplotlib.pyplot as plt

    study = stridor.run(SUITE / "sweep-and-map" / "case.toml", "sweep", progress=False)
    frequency, growth = study.plot_sweep()
    points = study["sweeps/friction/points"]
    branches = [line for line in growth.get_lines() if str(line.get_label()).startswith("branch")]
    drawn = np.sort(np.concatenate([np.asarray(line.get_ydata()) for line in branches]))
    assert np.array_equal(drawn, np.sort(points["growth_rate"].values))
    assert (frequency.get_ylabel(), growth.get_xlabel()) == ("frequency f (Hz)", "contact.belt.friction.mu0")
    critical = study["sweeps/stiffness/critical/value"].values
    dashed = [line for line in study.plot_sweep("stiffness")[0].get_lines() if line.get_linestyle() == "--"]
    assert np.array_equal([np.asarray(line.get_xdata())[0] for line in dashed], critical)
    with pytest.raises(KeyError, match="friction, stiffness"):
        study.plot_sweep("nothing")
    with pytest.raises(KeyError, match=r"\[frf\]"):
        study.plot_frf()
    responses = stridor.run(SUITE / "frf-closed-form" / "oscillator.toml", "frf", progress=False)
    magnitude, phase = responses.plot_frf(axes=list(plt.subplots(2)[1]))
    lines = next(iter(responses["frf"].children.values()))["lines"].to_dataset()
    assert [line.get_label() for line in magnitude.get_lines()] == list(lines.data_vars)
    assert phase.get_xlabel() == "frequency f (Hz)"
    case = stridor.Case.read(SUITE / "stick-slip-belt" / "case.toml")
    short = case.replace({"transient.duration": 200 * case["transient.time_step"]}).run("transient", progress=False)
    velocity = short.plot_history()[0]
    assert velocity.get_ylabel() == "(m/s)"
    assert len(short.plot_history("belt_normal_force", "penetration")) == 2
    with pytest.raises(KeyError, match="penetration"):
        short.plot_history("nothing")
    plt.close("all")
