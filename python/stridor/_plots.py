"""Pictures of results, by Matplotlib."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def growth(modes: xr.Dataset, ax: Axes | None) -> Axes:
    """Growth rate over frequency of complex modes."""
    frequency, rate = modes["frequency_hz"].values, modes["growth_rate"].values
    grows = modes["unstable"].values.astype(bool)
    ax = panels(1)[0] if ax is None else ax
    ax.axhline(0.0, color="0.5", linewidth=0.8)
    ax.scatter(frequency[~grows], rate[~grows], s=18, color="C0", label="decays")
    ax.scatter(frequency[grows], rate[grows], s=40, color="C3", marker="D", label="grows: squeal")
    for k, (x, y) in enumerate(zip(frequency[grows], rate[grows], strict=True)):
        # Above and below in turn, so that labels of neighbours do not meet.
        ax.annotate(f"{x:.0f} Hz", (x, y), xytext=(6, (4, -12)[k % 2]), textcoords="offset points")
    ax.set_xlabel("frequency f (Hz)")
    ax.set_ylabel("growth rate σ (1/s)")
    ax.set_yscale("symlog", linthresh=1.0)
    ax.legend()
    return ax


def sweep(study: xr.DataTree, axes: Sequence[Axes] | None) -> list[Axes]:
    """Frequency and growth rate of each branch of a sweep over its scalar, with the critical values; dots where it grows."""
    points = table(study, "points")
    scalar = str(study["parameter"].item())
    unit = str(study["unit"].item())
    axes = panels(2) if axes is None else list(axes)
    for branch in np.unique(points["branch"].values):
        of = points.isel(point=np.flatnonzero(points["branch"].values == branch)).sortby(scalar)
        x = of[scalar].values
        # Less is rounding.
        grows = of["growth_rate"].values > 1e-9 * np.abs(of["eigenvalue"].values)
        for ax, key in zip(axes, ("frequency_hz", "growth_rate"), strict=True):
            line = ax.plot(x, of[key].values, linewidth=1.2, label=f"branch {branch}")[0]
            ax.plot(x[grows], of[key].values[grows], ".", color=line.get_color())
    axes[1].axhline(0.0, color="0.5", linewidth=0.8)
    critical = table(study, "critical")["value"].values if "critical" in study.children else np.empty(0)
    for ax in axes:
        for value in critical:
            ax.axvline(value, color="0.5", linestyle="--", linewidth=0.8)
    axes[0].set_ylabel("frequency f (Hz)")
    axes[1].set_ylabel("growth rate σ (1/s)")
    axes[1].set_xlabel(with_unit(scalar, unit))
    axes[0].legend(fontsize="small")
    return axes


def frf(response: xr.DataTree, axes: Sequence[Axes] | None) -> list[Axes]:
    """Magnitude and phase of a frequency response at each place."""
    lines = table(response, "lines")
    axes = panels(2) if axes is None else list(axes)
    hz = lines["frequency_hz"].values
    for name, values in lines.data_vars.items():
        axes[0].semilogy(hz, np.abs(values.values), linewidth=1.2, label=str(name))
        axes[1].plot(hz, np.degrees(np.angle(values.values)), linewidth=1.2)
    axes[0].set_ylabel(with_unit(str(response["quantity"].item()), str(response["unit"].item())))
    axes[0].legend(fontsize="small")
    axes[1].set_ylabel("phase (°)")
    axes[1].set_yticks([-180, -90, 0, 90, 180])
    axes[1].set_xlabel("frequency f (Hz)")
    return axes


def history(run: xr.Dataset, channels: Sequence[str], axes: Sequence[Axes] | None) -> list[Axes]:
    """Channels over time, a panel a unit."""
    missing = [name for name in channels if name not in run]
    if missing:
        raise KeyError(f"no {missing[0]!r} in this record, which has {', '.join(map(str, run.data_vars))}")
    units = {name: str(run[name].attrs["units"]) for name in run.data_vars}
    chosen = list(channels) or [str(name) for name, unit in units.items() if unit == "m/s"]
    kinds = list(dict.fromkeys(units[name] for name in chosen))
    axes = panels(len(kinds)) if axes is None else list(axes)
    for ax, unit in zip(axes, kinds, strict=True):
        for name in chosen:
            if units[name] == unit:
                ax.plot(run["time_s"].values, run[name].values, linewidth=0.8, label=name)
        ax.set_ylabel(with_unit("", unit))
        ax.legend(fontsize="small", loc="upper right")
    axes[-1].set_xlabel("time t (s)")
    return axes


def panels(count: int) -> list[Axes]:
    """New axes below each other, with the horizontal axis in common."""
    import matplotlib.pyplot as plt

    return list(plt.subplots(count, sharex=True, squeeze=False, layout="constrained")[1][:, 0])


def table(tree: xr.DataTree, name: str) -> xr.Dataset:
    """The arrays of a group of a study."""
    return tree.children[name].to_dataset(inherit=False)


def with_unit(name: str, unit: str) -> str:
    return name if unit in ("", "1") else f"{name} ({unit})".strip()
