"""Writes a test of a disc that is known, from Kirchhoff's closed forms (numpy, scipy, pyuff 2.5.8)."""
import sys

import numpy as np
import pyuff

sys.path.insert(0, "../measured-disc")
from annulus import Annulus, receptance  # noqa: E402

# The truth.
HUB, THICKNESS, DAMPING = 0.0214, 0.00097, 0.015
# Standard deviations: of a frequency and of ln |h| at a line.
FREQUENCY, RESPONSE = 0.001, 0.03

random = np.random.default_rng(20)
modes = Annulus(0.075, HUB, THICKNESS).modes(60e3)
# (0, 0) and (2, 0): two frequencies alone for two numbers.
found = [next(one for one in modes if one.n == n) for n in (0, 2)]

# Points on the rim, a quarter, a ninth and nearly half a turn from the force at the lowest one.
PLACES = {1: (0.075, 0.0), 2: (0.075, np.radians(90)), 3: (0.075, np.radians(40)), 4: (0.075, np.radians(170))}
labels = np.array(list(PLACES))
xyz = 1e3 * np.array([(0.0, r * np.sin(t), -r * np.cos(t)) for r, t in PLACES.values()])

hz = np.geomspace(150.0, 1500.0, 120)
sets = [
    {"type": 164, "units_code": 9, "units_description": "mm", "temp_mode": 1, "length": 1000.0, "force": 1.0, "temp": 1.0,
     "temp_offset": 1.0},
    {"type": 15, "node_nums": labels, "x": xyz[:, 0], "y": xyz[:, 1], "z": xyz[:, 2]},
]
total = 0.0
for motion in (2, 3, 4):
    exact = (2j * np.pi * hz) ** 2 * receptance(modes, DAMPING, hz, PLACES[1], PLACES[motion])
    noise = np.exp(RESPONSE * (random.standard_normal(len(hz)) + 1j * random.standard_normal(len(hz))))
    sets.append({"type": 58, "binary": 1, "id1": f"point {motion}", "func_type": 4, "rsp_node": motion, "rsp_dir": 1,
                 "ref_node": 1, "ref_dir": 1, "abscissa_spacing": 0, "abscissa_spec_data_type": 18,
                 "ordinate_spec_data_type": 12, "orddenom_spec_data_type": 13,
                 "x": hz, "data": 1e3 * exact * noise})
    # Dips count no deeper than a twentieth of the median.
    floor = 0.05 * np.sort(np.abs(exact * noise))[len(hz) // 2]
    own = 0.5 * np.log((np.abs(exact * noise) ** 2 + floor**2) / (np.abs(exact) ** 2 + floor**2))
    total += np.sum((own / RESPONSE) ** 2)
    print(f"point {motion}: noise {20 * np.log10(np.e) * np.sqrt(np.mean(own**2)):.4f} dB")
pyuff.UFF("responses.uff").write_sets(sets, "overwrite")
with open("modes.csv", "w") as file:
    file.write("frequency_hz,deviation\n")
    for one in found:
        measured = one.hz * (1 + FREQUENCY * random.standard_normal())
        file.write(f"{measured:.4f},{FREQUENCY}\n")
        total += (np.log(measured / one.hz) / FREQUENCY) ** 2
        print(f"({one.n}, 0) {one.hz:.4f} Hz, as measured {measured:.4f} Hz")
print(f"chi2 of the noise {total:.2f}")
