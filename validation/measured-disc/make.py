"""Writes what a test of the disc would leave behind, from Kirchhoff's closed forms (numpy, scipy, pyuff 2.5.8)."""
import numpy as np
import pyuff
from annulus import Annulus, receptance

DAMPING = 0.02
UNITS = {"type": 164, "units_code": 9, "units_description": "mm", "temp_mode": 1, "length": 1000.0, "force": 1.0, "temp": 1.0,
         "temp_offset": 1.0}

# The frame of the test in the mesh.
ORIGIN = np.array([0.012, 0.03, -0.02])
X = np.array([0.36, 0.48, 0.8])
Y = np.array([0.8, -0.6, 0.0])
FRAME = np.array([X, Y, np.cross(X, Y)])  # rows: its axes

# 36 points, where the mesh has nodes, on 4 mm blocks before and behind the plate; one of them is 5.5 mm away.
ANGLES = np.radians([0, 27, 60, 93, 114, 150, 177, 204, 234, 267, 291, 330])
R, T = np.repeat([0.045, 0.06, 0.075], 12), np.tile(ANGLES, 3)
HEIGHT = np.where(np.arange(36) % 3 == 0, -0.004, 0.004)
HEIGHT[20] = 0.0055
LABELS = 101 + np.arange(36)
PLACES = np.array([HEIGHT, R * np.sin(T), -R * np.cos(T)]).T
SEEN = (PLACES - ORIGIN) @ FRAME.T

ALL = Annulus(0.075, 0.02, 0.001).modes(60e3)


def mode(n, m):
    return [one for one in ALL if one.n == n][m]


# Which modes were found, turned by how much, and how far from the closed form (parts of the frequency), with its damping.
FOUND = [
    (mode(1, 0), 0.35, 1.010, 0.0031),
    (mode(1, 0), 0.35 + np.pi / 2, 1.013, 0.0032),
    (mode(0, 0), 0.0, 0.992, 0.0050),
    (mode(2, 0), 0.20, 1.006, 0.0021),
    (mode(2, 0), 0.20 + np.pi / 4, 1.004, 0.0022),
    (mode(4, 0), 1.10, 0.995, 0.0017),
    (mode(5, 0), 0.50, 1.008, 0.0012),
    (mode(5, 0), 0.50 + np.pi / 10, 1.009, 0.0011),
]
MADE_UP = 1.02 * mode(3, 0).hz


def shape(one, turn):
    return one.motion(R, T, HEIGHT, turn) @ FRAME.T


def shapes_file(path):
    nodes = {"type": 15, "node_nums": LABELS, "x": 1e3 * SEEN[:, 0], "y": 1e3 * SEEN[:, 1], "z": 1e3 * SEEN[:, 2]}
    sets = [UNITS, nodes]

    def dataset(number, motion):
        return {"type": 55, "analysis_type": 2, "data_ch": 2, "spec_data_type": 8, "load_case": 1, "mode_n": number, "node_nums": LABELS,
                "r1": motion[:, 0], "r2": motion[:, 1], "r3": motion[:, 2]}

    for number, (one, turn, factor, ratio) in enumerate(FOUND[:-1], 1):
        scale = (-1) ** number * (0.2 + 0.1 * number)
        sets.append(dataset(number, scale * shape(one, turn)) | {"freq": factor * one.hz, "modal_damp_vis": ratio})
    # The last is a complex mode, its shape with a phase.
    one, turn, factor, ratio = FOUND[-1]
    omega = 2 * np.pi * factor * one.hz
    eig = omega * complex(-ratio, np.sqrt(1 - ratio**2))
    sets.append(dataset(len(FOUND), (0.3 + 0.4j) * shape(one, turn)) | {"analysis_type": 3, "eig": eig})
    # What no mode is: every point on its own.
    noise = np.random.default_rng(7).standard_normal((36, 3))
    sets.append(dataset(len(FOUND) + 1, noise) | {"freq": MADE_UP, "modal_damp_vis": 0.004})
    pyuff.UFF(path).write_sets(sets, "overwrite")


def functions_file(path, binary, wanted):
    """Responses along the x axis of a frame that lies as the mesh does, in mm."""
    used = sorted({p for force, motion, _, _ in wanted for p in (force, motion)})
    nodes = {"type": 15, "node_nums": LABELS[used], "x": 1e3 * PLACES[used, 0], "y": 1e3 * PLACES[used, 1], "z": 1e3 * PLACES[used, 2]}
    sets = [UNITS, nodes]
    for force, motion, power, even in wanted:
        hz = np.arange(100.0, 1600.1, 12.5) if even else 100.0 * 16.0 ** np.linspace(0, 1, 121)
        values = 1e3 * (2j * np.pi * hz) ** power * receptance(ALL, DAMPING, hz, (R[force], T[force]), (R[motion], T[motion]))
        sets.append({"type": 58, "binary": binary, "id1": f"{motion} over {force}", "func_type": 4, "rsp_node": LABELS[motion], "rsp_dir": 1,
                     "ref_node": LABELS[force], "ref_dir": -1, "abscissa_spacing": int(even), "abscissa_spec_data_type": 18,
                     "ordinate_spec_data_type": {0: 8, 1: 11, 2: 12}[power], "orddenom_spec_data_type": 13, "x": hz, "data": -values})
    pyuff.UFF(path).write_sets(sets, "overwrite")


def lists():
    with open("list.csv", "w") as file:
        file.write("frequency_hz,damping_ratio,deviation\n")
        for k, (one, _, factor, ratio) in enumerate(FOUND):
            file.write(f"{factor * one.hz:.4f},{ratio},{0.001 * (k + 1)}\n")
    with open("list.toml", "w") as file:
        for k in range(24, 36):
            file.write(f"point.{LABELS[k]} = [" + ", ".join(f'"{1e3 * x:.5f} mm"' for x in SEEN[k]) + "]\n")
        for k, (one, turn, factor, ratio) in enumerate(FOUND):
            file.write(f"\n[mode.number-{k + 1}]\nfrequency = {factor * one.hz:.4f}\ndamping_ratio = {ratio}\ndeviation = {0.001 * (k + 1)}\n")
            motion = shape(one, turn)
            motion /= np.abs(motion).max()
            for p in range(24, 36):
                file.write(f"shape.{LABELS[p]} = [" + ", ".join(f"{u:.5f}" for u in motion[p]) + "]\n")


if __name__ == "__main__":
    print("modes", [(one.n, round(one.hz, 3)) for one in ALL if one.hz < 1800], len(ALL))
    shapes_file("shapes.uff")
    # The force is at the lowest point of the rim (25th point); at the 29th and 32nd of the rim and the 3rd inside.
    functions_file("text.uff", 0, [(24, 28, 2, True), (24, 2, 1, False)])
    functions_file("binary.uff", 1, [(24, 24, 2, True), (31, 24, 0, False)])
    lists()
    for one, _, factor, ratio in FOUND:
        print(f"({one.n}, 0) closed form {one.hz:.4f} Hz, as measured {factor * one.hz:.4f} Hz, difference {100 * (1 / factor - 1):.4f} %, damping {ratio}")
    levels = [(1, 0), (0, 0), (2, 0), (3, 0), (4, 0), (5, 0)]

    def likeness(motion, level):
        """Squared cosine of the angle between a shape and the two of a level (one without nodal diameters)."""
        turns = [0.0, np.pi / (2 * level[0])] if level[0] else [0.0]
        span = np.linalg.qr(np.array([shape(mode(*level), turn).ravel() for turn in turns]).T)[0]
        return np.sum((span.T @ motion.ravel()) ** 2) / np.sum(motion**2)

    noise = np.random.default_rng(7).standard_normal((36, 3))
    print("MAC of the made-up shape with", {level: round(likeness(noise, level), 6) for level in levels})
    print("MAC of (0, 0) with", {level: round(likeness(shape(mode(0, 0), 0.0), level), 6) for level in levels})
    print("MAC of (4, 0) with", {level: round(likeness(shape(mode(4, 0), 1.1), level), 6) for level in levels})
    print(f"made up {MADE_UP:.4f} Hz, not measured (3, 0) {mode(3, 0).hz:.4f} Hz")
    print(f"distances: largest {1e3 * np.abs(HEIGHT).max()} mm, mean {1e3 * np.abs(HEIGHT).mean()} mm")
