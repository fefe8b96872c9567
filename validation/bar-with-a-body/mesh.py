"""Writes the bar of this folder in the four forms of a Gmsh mesh.  python3 mesh.py

40 elements along x from the `clamp` to the `tip`, 500 mm away. The files differ in their unit and in how nodes are numbered.
"""
import struct

COUNT, LENGTH = 40, 0.5
GROUPS = [(1, 1, "bar"), (0, 2, "clamp"), (0, 3, "tip")]
NAMES = f"$PhysicalNames\n{len(GROUPS)}\n" + "".join(f'{d} {t} "{n}"\n' for d, t, n in GROUPS) + "$EndPhysicalNames\n"


def nodes(tags, metre):
    return [(tags[k], LENGTH * metre * k / COUNT, 0.0, 0.0) for k in range(COUNT + 1)]


def text(version, body):
    return f"$MeshFormat\n{version} 0 8\n$EndMeshFormat\n{NAMES}{body}".encode()


def binary(version, body):
    return f"$MeshFormat\n{version} 1 8\n".encode() + struct.pack("<i", 1) + f"\n$EndMeshFormat\n{NAMES}".encode() + body


def msh41(tags, metre):
    n, l = nodes(tags, metre), LENGTH * metre
    inner = n[1:-1]
    lines = ["$Entities", "2 1 0 0", "1 0 0 0 1 2", f"2 {l!r} 0 0 1 3", f"1 0 0 0 {l!r} 0 0 1 1 2 1 -2", "$EndEntities"]
    lines += ["$Nodes", f"3 {len(n)} {min(tags)} {max(tags)}"]
    for dimension, entity, block in [(0, 1, n[:1]), (0, 2, n[-1:]), (1, 1, inner)]:
        lines += [f"{dimension} {entity} 0 {len(block)}", *(str(t) for t, *_ in block)]
        lines += [f"{x!r} {y!r} {z!r}" for _, x, y, z in block]
    lines += ["$EndNodes", "$Elements", f"3 {COUNT + 2} 1 {COUNT + 2}"]
    lines += ["0 1 15 1", f"1 {tags[0]}", "0 2 15 1", f"2 {tags[-1]}", f"1 1 1 {COUNT}"]
    lines += [f"{k + 3} {tags[k]} {tags[k + 1]}" for k in range(COUNT)] + ["$EndElements", ""]
    return text("4.1", "\n".join(lines))


def msh41_binary(tags, metre):
    n, l = nodes(tags, metre), LENGTH * metre
    out = b"$Entities\n" + struct.pack("<4Q", 2, 1, 0, 0)
    out += struct.pack("<i3dQi", 1, 0, 0, 0, 1, 2) + struct.pack("<i3dQi", 2, l, 0, 0, 1, 3)
    out += struct.pack("<i6dQiQ2i", 1, 0, 0, 0, l, 0, 0, 1, 1, 2, 1, -2) + b"\n$EndEntities\n"
    out += b"$Nodes\n" + struct.pack("<4Q", 3, len(n), min(tags), max(tags))
    for dimension, entity, block in [(0, 1, n[:1]), (0, 2, n[-1:]), (1, 1, n[1:-1])]:
        out += struct.pack("<3iQ", dimension, entity, 0, len(block))
        out += b"".join(struct.pack("<Q", t) for t, *_ in block) + b"".join(struct.pack("<3d", *x) for _, *x in block)
    out += b"\n$EndNodes\n$Elements\n" + struct.pack("<4Q", 3, COUNT + 2, 1, COUNT + 2)
    out += struct.pack("<3iQ2Q", 0, 1, 15, 1, 1, tags[0]) + struct.pack("<3iQ2Q", 0, 2, 15, 1, 2, tags[-1])
    out += struct.pack("<3iQ", 1, 1, 1, COUNT)
    out += b"".join(struct.pack("<3Q", k + 3, tags[k], tags[k + 1]) for k in range(COUNT)) + b"\n$EndElements\n"
    return binary("4.1", out)


def msh22(tags, metre):
    lines = ["$Nodes", str(COUNT + 1), *(f"{t} {x!r} {y!r} {z!r}" for t, x, y, z in nodes(tags, metre)), "$EndNodes"]
    lines += ["$Elements", str(COUNT + 2), f"1 15 2 2 1 {tags[0]}", f"2 15 2 3 2 {tags[-1]}"]
    lines += [f"{k + 3} 1 2 1 1 {tags[k]} {tags[k + 1]}" for k in range(COUNT)] + ["$EndElements", ""]
    return text("2.2", "\n".join(lines))


def msh22_binary(tags, metre):
    out = f"$Nodes\n{COUNT + 1}\n".encode() + b"".join(struct.pack("<i3d", *n) for n in nodes(tags, metre))
    out += f"\n$EndNodes\n$Elements\n{COUNT + 2}\n".encode()
    out += struct.pack("<3i4i", 15, 1, 2, 1, 2, 1, tags[0]) + struct.pack("<3i4i", 15, 1, 2, 2, 3, 2, tags[-1])
    out += struct.pack("<3i", 1, COUNT, 2)
    out += b"".join(struct.pack("<5i", k + 3, 1, 1, tags[k], tags[k + 1]) for k in range(COUNT)) + b"\n$EndElements\n"
    return binary("2.2", out)


ascending = list(range(1, COUNT + 2))
descending_with_gaps = [3 * (COUNT + 1 - k) for k in range(COUNT + 1)]
for name, write, tags, metre in [
    ("bar-41.msh", msh41, ascending, 1000.0),
    ("bar-41-binary.msh", msh41_binary, descending_with_gaps, 1.0),
    ("bar-22.msh", msh22, descending_with_gaps, 100.0),
    ("bar-22-binary.msh", msh22_binary, ascending, 1 / 0.0254),
]:
    open(name, "wb").write(write(tags, metre))
