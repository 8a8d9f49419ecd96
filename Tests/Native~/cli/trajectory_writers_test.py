# SPDX-License-Identifier: MIT
"""quickses --trajectory with files that other programs wrote: scipy and netCDF4 (netCDF), MDTraj and MDAnalysis (netCDF, TRR).

usage: trajectory_writers_test.py PROGRAM

Every file has the frames of a DCD file, and must give the same areas. What is not installed is left out with a message. Ends
with 77, which CTest takes as skipped, where none of them is.
"""
import csv
import importlib
import os
import pathlib
import subprocess
import sys
import tempfile
import warnings

from trajectory_files import chain_of, dcd_bytes, moving, pdb_text

ATOMS, FRAMES, EDGES = 24, 7, (30.0, 40.0, 50.0)
TIMES = [0.5 * k for k in range(FRAMES)]


def areas_and_times(program, name):
    result = subprocess.run([program, "measure", "top.pdb", "--trajectory", name, "--csv", "-", "--quiet", "--unwrap",
                             "--backend", "cpu"], capture_output=True, encoding="utf-8")
    if result.returncode != 0 or result.stderr:  # also where the box is not found
        raise AssertionError(f"{name}: {result.returncode} {result.stderr}")
    rows = list(csv.DictReader(result.stdout.splitlines()))
    return [float(row["sas_area_A2"]) for row in rows], [float(row["time_ps"] or -1) for row in rows]


def fill(variables, positions):
    for k in range(FRAMES):
        variables["time"][k] = TIMES[k]
        variables["odd"][k] = [1, 2, 3]
        variables["coordinates"][k] = positions[k]
        variables["cell_lengths"][k] = EDGES
        variables["cell_angles"][k] = (90, 90, 90)


def create(file, fixed, names):
    """Dimensions and variables of AMBER's convention, and one whose values have to be filled up."""
    file.Conventions = "AMBER"
    for name, length in (("frame", FRAMES if fixed else None), ("atom", ATOMS), ("spatial", 3)):
        file.createDimension(name, length)
    for name, kind, dimensions in (("odd", names[0], ("frame", "spatial")), ("time", names[1], ("frame",)),
                                   ("coordinates", names[1], ("frame", "atom", "spatial")),
                                   ("cell_lengths", names[2], ("frame", "spatial")),
                                   ("cell_angles", names[2], ("frame", "spatial"))):
        file.createVariable(name, kind, dimensions)
    file.variables["time"].units = "picosecond"
    file.variables["coordinates"].units = "angstrom"


def scipy_io(module, positions):
    for version in (1, 2):
        name = f"scipy{version}.nc"
        with module.netcdf_file(name, "w", version=version) as file:
            create(file, False, ("b", "f", "d"))
            fill(file.variables, positions)
        yield name, TIMES


def netCDF4(module, positions):
    for kind in ("NETCDF3_CLASSIC", "NETCDF3_64BIT_OFFSET", "NETCDF3_64BIT_DATA"):
        for fixed in (False, True):
            name = f"{kind}{fixed}.nc"
            with module.Dataset(name, "w", format=kind) as file:
                create(file, fixed, ("i1", "f4", "f8"))
                fill(file.variables, positions)
            yield name, TIMES


def mdtraj(module, positions):
    frames = module.load("t.dcd", top="top.pdb")
    frames.time = TIMES
    for name in ("mdtraj.trr", "mdtraj.nc"):
        frames.save(name)
        yield name, TIMES


def MDAnalysis(module, positions):
    universe = module.Universe("top.pdb", "t.dcd")
    for name in ("mdanalysis.trr", "mdanalysis.nc"):
        with module.Writer(name, ATOMS) as writer:
            for _ in universe.trajectory:
                writer.write(universe.atoms)
        yield name, None


def main():
    program = str(pathlib.Path(sys.argv[1]).resolve())
    writers = 0
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        atoms, start = chain_of(ATOMS)
        positions = moving(start, FRAMES)
        pathlib.Path("top.pdb").write_text(pdb_text(atoms, start))
        pathlib.Path("t.dcd").write_bytes(dcd_bytes(positions, EDGES))
        expected, _ = areas_and_times(program, "t.dcd")
        assert len(expected) == FRAMES
        for name, write in (("scipy.io", scipy_io), ("netCDF4", netCDF4), ("mdtraj", mdtraj), ("MDAnalysis", MDAnalysis)):
            try:
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore")
                    module = importlib.import_module(name)
            except ImportError:
                print(f"{name} is not installed")
                continue
            writers += 1
            for file, times in write(module, positions):
                areas, found_times = areas_and_times(program, file)
                assert len(areas) == FRAMES, file
                assert all(abs(a - b) < 0.02 for a, b in zip(areas, expected)), (file, areas, expected)
                assert times is None or found_times == times, (file, found_times)
                print(f"{file}: the same areas")
        os.chdir("/")
    return 0 if writers else 77


if __name__ == "__main__":
    sys.exit(main())
