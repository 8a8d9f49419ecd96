# SPDX-License-Identifier: MIT
"""quickses measure against FreeSASA (https://freesasa.github.io), which cuts atoms into slices (Lee and Richards 1971).

usage: freesasa_test.py PROGRAM [PDB...]

Both get the same radii: the program's own --per-atom table tells them, and FreeSASA reads them from the column of the
occupancy. Of each file (default: Tests/Data~/1CRN.pdb, and a chain that moves), the total, each residue and each atom. Ends with
77, which CTest takes as skipped, where there is no freesasa.
"""
import csv
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

from trajectory_files import chain_of, moving, pdb_text

DATA = pathlib.Path(os.environ.get("QUICKSES_TEST_DATA_DIR") or pathlib.Path(__file__).resolve().parents[2] / "Data~")
SLICES = 1000  # of each atom
# What slicing is wrong by: relative of the total, and Å² of a residue and of an atom.
TOTAL, RESIDUE, ATOM = 2e-5, 0.05, 0.02


def run(*arguments):
    return subprocess.run([str(a) for a in arguments], check=True, capture_output=True, encoding="utf-8").stdout


def table(program, path, rows, *arguments):
    text = run(program, "measure", path, "--surface", "sas", "--backend", "cpu", f"--per-{rows}", "-", *arguments)
    return list(csv.DictReader(text.splitlines()))


def with_radii(path, atoms):
    """The file's atom records, with radii in the place of occupancies."""
    records = [line for line in path.read_text().split("ENDMDL")[0].splitlines() if line[:6] in ("ATOM  ", "HETATM")]
    return "".join(records[int(atom["atom"])][:54] + f"{float(atom['radius_A']):6.3f}" +
                   records[int(atom["atom"])][60:] + "\n" for atom in atoms) + "END\n"


def compare(program, path, folder):
    residues, atoms = table(program, path, "residue"), table(program, path, "atom")
    prepared = folder / "radii.pdb"
    prepared.write_text(with_radii(path, atoms))
    found = json.loads(run("freesasa", "--lee-richards", f"--resolution={SLICES}", "--probe-radius=1.4",
                           "--radius-from-occupancy", "--hetatm", "--hydrogen", "--no-warnings", "--format=json",
                           "--depth=atom", prepared))
    (structure,) = found["results"][0]["structure"]
    expected = [(chain["label"], residue["number"].strip(), residue["name"].strip(), residue["area"]["total"])
                for chain in structure["chains"] for residue in chain["residues"]]
    expected_atoms = [(atom["name"].strip(), atom["area"]) for chain in structure["chains"]
                      for residue in chain["residues"] for atom in residue["atoms"]]
    # FreeSASA lists chain by chain.
    order = {chain["label"]: k for k, chain in enumerate(structure["chains"])}
    residues.sort(key=lambda row: order[row["chain"]])
    atoms.sort(key=lambda row: order[row["chain"]])
    names = [(row["chain"], row["residue_number"] + row["insertion_code"], row["residue_name"]) for row in residues]
    assert names == [residue[:3] for residue in expected], "the residues are not the same"
    assert [row["atom_name"] for row in atoms] == [atom[0] for atom in expected_atoms], "the atoms are not the same"
    area = sum(float(row["sas_area_A2"]) for row in residues)
    differences = [abs(float(row["sas_area_A2"]) - residue[3]) for row, residue in zip(residues, expected)]
    of_atoms = [abs(float(row["sas_area_A2"]) - atom[1]) for row, atom in zip(atoms, expected_atoms)]
    total = structure["area"]["total"]
    print(f"{path.name}: {area:.3f} Å², FreeSASA {total:.3f} ({area / total - 1:+.1e}); residues differ by "
          f"{max(differences):.4f} Å² at most, atoms by {max(of_atoms):.4f} Å²")
    assert abs(area - total) <= TOTAL * total, "the totals differ"
    assert max(differences) <= RESIDUE, "residues differ"
    assert max(of_atoms) <= ATOM, "atoms differ"


def main():
    if not shutil.which("freesasa"):
        print("skipped: freesasa is not installed (Debian: freesasa)")
        sys.exit(77)
    program, *paths = sys.argv[1:]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        paths = [pathlib.Path(path) for path in paths]
        if not paths:
            atoms, positions = chain_of(60)
            for k, frame in enumerate(moving(positions, 3)):
                paths.append(folder / f"chain{k}.pdb")
                paths[-1].write_text(pdb_text(atoms, frame))
            paths.append(DATA / "1CRN.pdb")
        for path in paths:
            compare(os.path.abspath(program), path, folder)


if __name__ == "__main__":
    main()
