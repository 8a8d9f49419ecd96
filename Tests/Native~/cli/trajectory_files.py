# SPDX-License-Identifier: MIT
"""Small trajectories for the tests of the program, written by code that shares nothing with its readers."""
import math
import struct


def pdb_text(atoms, positions):
    """A PDB file. atoms: (record, name, residue name, residue number) of each; positions: (x, y, z)."""
    lines = []
    for i, ((record, name, residue, number), (x, y, z)) in enumerate(zip(atoms, positions)):
        lines.append(f"{record:<6}{i + 1:5d}  {name:<3} {residue:>3} A{number:4d}    {x:8.3f}{y:8.3f}{z:8.3f}  1.00  0.00"
                     f"          {name[0]:>2}\n")
    return "".join(lines) + "END\n"


def dcd_bytes(frames, cell=None, announced=None, boxless=()):
    """A CHARMM DCD file. cell: edges a, b, c of an orthogonal box, which is 0 in the frames boxless."""
    def record(content):
        return struct.pack("<i", len(content)) + content + struct.pack("<i", len(content))

    icntrl = [0] * 20
    icntrl[0] = len(frames) if announced is None else announced
    icntrl[2] = 1
    icntrl[10] = 1 if cell else 0
    icntrl[19] = 24
    data = record(b"CORD" + struct.pack("<20i", *icntrl)) + record(struct.pack("<i", 1) + b" " * 80)
    data += record(struct.pack("<i", len(frames[0])))
    for k, frame in enumerate(frames):
        if cell:
            a, b, c = (0, 0, 0) if k in boxless else cell
            data += record(struct.pack("<6d", a, 0.0, b, 0.0, 0.0, c))  # cosines of the angles between the edges
        for axis in range(3):
            data += record(struct.pack(f"<{len(frame)}f", *(position[axis] for position in frame)))
    return data


def chain_of(count):
    """Atoms of a winding chain, and where they are: bonds of 1.5 Å."""
    atoms, positions = [], []
    for i in range(count):
        atoms.append(("ATOM", ("N", "CA", "C")[i % 3], "ALA", i // 3 + 1))
        positions.append((2.0 * math.cos(0.7 * i), 2.0 * math.sin(0.7 * i), 0.62 * i))
    return atoms, rounded(positions)


def rounded(positions):
    """As a PDB file holds them."""
    return [tuple(round(x, 3) for x in position) for position in positions]


def moving(positions, count):
    """Frames in which every atom moves a little in its own way: bonds stay bonds."""
    return [rounded([(x + 0.1 * math.sin(k + i), y + 0.1 * math.cos(2 * k + i), z + 0.1 * math.sin(3 * k + 2 * i))
                     for i, (x, y, z) in enumerate(positions)]) for k in range(count)]


def with_nan(frames, frame, atom):
    """The same, but one coordinate is no number: the frame is damaged."""
    damaged = [list(positions) for positions in frames]
    x, y, _ = damaged[frame][atom]
    damaged[frame][atom] = (x, y, math.nan)
    return damaged
