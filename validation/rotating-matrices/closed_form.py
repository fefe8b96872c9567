"""A chain of rotors: the matrices, and its eigenvalues in closed form.

Each of N rotors moves in x and y, one chain of springs along each axis: with z = x + i y

    m z'' + (c - i g omega) z' + (K z) + (k_geo (omega^2 - 1) - i h / omega) z = 0,

K = tridiag(-k, 2k, -k), whose eigenvalues are 2k (1 - cos(j pi / (N + 1))). So C and K have skew parts of full rank, and

    p(s) = m s^2 + (c - i g omega) s + 2k (1 - cos(j pi / (N + 1))) + k_geo (omega^2 - 1) - i h / omega = 0

gives s, and its conjugate for the conjugate of z. The numbers of reference.toml are what this prints.
"""
import cmath, math

N, m, c, g, k, k_geo, h = 120, 0.3, 6.0, 90.0, 4.0e6, 2.0e4, 3.0e4
LOW, HIGH = 200.0, 500.0


def modes(omega):
    """The eigenvalues with Im s > 0, each with ds/d(omega) = -(dp/d omega) / p'(s)."""
    found = []
    for j in range(1, N + 1):
        stiffness = 2 * k * (1 - math.cos(j * math.pi / (N + 1))) + k_geo * (omega**2 - 1) - 1j * h / omega
        damping = c - 1j * g * omega
        root = cmath.sqrt(damping**2 - 4 * m * stiffness)
        for s in ((-damping + root) / (2 * m), (-damping - root) / (2 * m)):
            rate = -(-1j * g * s + 2 * k_geo * omega + 1j * h / omega**2) / (2 * m * s + damping)
            found.append((s, rate) if s.imag > 0 else (s.conjugate(), rate.conjugate()))
    return sorted(found, key=lambda s: s[0].imag)


def write(name, kind, entries):
    with open(name, "w") as f:
        f.write(f"%%MatrixMarket matrix coordinate real {kind}\n{2 * N} {2 * N} {len(entries)}\n")
        f.writelines(f"{i + 1} {j + 1} {v!r}\n" for i, j, v in entries)


def matrices():
    both = range(2 * N)  # x and y of a rotor stand side by side
    write("m.mtx", "symmetric", [(i, i, m) for i in both])
    write("c.mtx", "symmetric", [(i, i, c) for i in both])
    write("k.mtx", "symmetric", [(i, i, 2 * k) for i in both] + [(i + 2, i, -k) for i in range(2 * N - 2)])
    write("geo.mtx", "symmetric", [(i, i, k_geo) for i in both])
    # -i z is (y, -x).
    write("gyro.mtx", "skew-symmetric", [(2 * n + 1, 2 * n, -g) for n in range(N)])
    write("follower.mtx", "skew-symmetric", [(2 * n + 1, 2 * n, -h) for n in range(N)])


if __name__ == "__main__":
    matrices()
    for omega in (1.0, 2.0):
        band = [s for s in modes(omega) if LOW <= s[0].imag / (2 * math.pi) <= HIGH]
        grows = [s for s, _ in band if s.real > 1e-5 * 2 * math.pi * HIGH]
        fast, rate = max(band, key=lambda s: s[0].real)
        print(f"omega = {omega}: {len(band)} modes, {len(grows)} grow")
        print(f"  the fastest: {fast.imag / (2 * math.pi)!r} Hz, {fast.real!r} 1/s")
        print(f"  per omega: {rate.real!r} 1/s, {rate.imag / (2 * math.pi)!r} Hz")
    target = 2j * math.pi * 300.0
    near = sorted(sorted((s for s, _ in modes(1.0)), key=lambda s: abs(s - target))[:5], key=lambda s: s.imag)
    print("nearest to 300 Hz:", [s.imag / (2 * math.pi) for s in near])
