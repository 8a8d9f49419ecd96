# SPDX-License-Identifier: MIT
"""Tests of the quickses program as its users and their scripts see it.

usage: cli_test.py PROGRAM [unittest options]      (or QUICKSES_PROGRAM in the environment)
"""
import collections
import gzip
import json
import math
import os
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest

PROGRAM = os.environ.get("QUICKSES_PROGRAM", "")
DATA = pathlib.Path(os.environ.get("QUICKSES_TEST_DATA_DIR") or pathlib.Path(__file__).resolve().parents[2] / "Data~")
CRAMBIN = DATA / "1CRN.pdb"
# By Wine the program has the habits of Windows, this one has not.
IS_WINDOWS = os.name == "nt" or os.environ.get("QUICKSES_TEST_SYSTEM") == "Windows"

OK, USAGE, INPUT, OUTPUT, COMPUTE, BACKEND, SOME_FAILED = range(7)

PATIENCE = 150  # s: a program that takes longer hangs

# The surface of 1CRN at probe 1.4, by quadrature of the exact patches.
CRAMBIN_AREA = 2319.07
CRAMBIN_VOLUME = 4664.9


def read_obj(path):
    vertices, normals, faces = [], [], []
    for line in path.read_text().splitlines():
        words = line.split()
        if words[0] == "v":
            vertices.append(tuple(map(float, words[1:])))
        elif words[0] == "vn":
            normals.append(tuple(map(float, words[1:])))
        elif words[0] == "f":
            corners = [word.split("//") for word in words[1:]]
            assert all(a == b or int(b) > len(vertices) for a, b in corners)  # a place's normals beyond the first are last
            faces.append(tuple(int(a) - 1 for a, _ in corners))
        else:
            assert words[0] == "#", line
    return vertices, normals, faces


def read_ply(path):
    data = path.read_bytes()
    header, body = data.split(b"end_header\n", 1)
    counts = [int(line.split()[2]) for line in header.decode().splitlines() if line.startswith("element")]
    assert b"format binary_little_endian 1.0" in header and b"property int owner" in header
    vertices, normals, owners, faces = [], [], [], []
    for i in range(counts[0]):
        row = struct.unpack_from("<6fi", body, 28 * i)
        vertices.append(row[:3])
        normals.append(row[3:6])
        owners.append(row[6])
    for i in range(counts[1]):
        row = struct.unpack_from("<B3I", body, 28 * counts[0] + 13 * i)
        assert row[0] == 3
        faces.append(row[1:])
    assert len(body) == 28 * counts[0] + 13 * counts[1]
    return vertices, normals, owners, faces


def is_closed(faces):
    edges = collections.Counter((f[i], f[(i + 1) % 3]) for f in faces for i in range(3))
    return all(count == 1 and edges.get((b, a)) == 1 for (a, b), count in edges.items())


def volume_of(vertices, faces):
    def six_times(a, b, c):
        return (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2])
                + a[2] * (b[0] * c[1] - b[1] * c[0]))
    return sum(six_times(*(vertices[i] for i in face)) for face in faces) / 6


def area_of(vertices, faces):
    area = 0.0
    for face in faces:
        a, b, c = (vertices[i] for i in face)
        u = [b[i] - a[i] for i in range(3)]
        v = [c[i] - a[i] for i in range(3)]
        n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
        area += 0.5 * math.sqrt(sum(x * x for x in n))
    return area



def program_to_test(program, usage):
    """The path of the program: the first argument, which is taken off, or the one known already."""
    if len(sys.argv) > 1 and not sys.argv[1].startswith("-"):
        program = sys.argv.pop(1)
    if not program:
        sys.exit(usage)
    return os.path.abspath(program)


def refuse_threads():
    """In a process to be: threads want more stack than there are addresses."""
    import resource  # Windows has none
    resource.setrlimit(resource.RLIMIT_STACK, (1 << 47, resource.getrlimit(resource.RLIMIT_STACK)[1]))


def can_refuse_threads():
    """Whether that works here: it is tried with another program."""
    if sys.platform != "linux" or os.environ.get("QUICKSES_TEST_SYSTEM") or os.environ.get("QUICKSES_TEST_SANITIZE"):
        return False  # what runs programs of another system, and sanitizers, have their own wishes
    begin_one = "import threading; threading.Thread(target=int).start()"
    try:
        tried = subprocess.run([sys.executable, "-c", begin_one], preexec_fn=refuse_threads, stderr=subprocess.DEVNULL)
    except subprocess.SubprocessError:  # the limit can't be set
        return False
    return tried.returncode != 0


class ProgramTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="quickses_cli_"))
        self.addCleanup(shutil.rmtree, self.folder)

    def run_program(self, *arguments, code=OK, **keywords):
        result = subprocess.run([PROGRAM, *map(str, arguments)], stdin=subprocess.DEVNULL, capture_output=True,
                                cwd=self.folder, encoding="utf-8", timeout=PATIENCE, **keywords)
        if code is not None:
            self.assertEqual(result.returncode, code, result.stderr + result.stdout)
        return result

    def run_cpu(self, *arguments, code=OK, **keywords):
        return self.run_program(*arguments, "--backend", "cpu", code=code, **keywords)

    def assert_fails(self, code, parts, *arguments):
        """The run fails with one line that holds all the parts, prints nothing else and leaves no file behind."""
        before = sorted(self.folder.rglob("*"))
        result = self.run_program(*arguments, code=code)
        self.assertEqual(result.stdout, "")
        lines = [line for line in result.stderr.splitlines() if "the CPU computes" not in line]
        self.assertEqual(len(lines), 1, result.stderr)
        self.assertTrue(lines[0].startswith("quickses: "), lines[0])
        for part in parts:
            self.assertIn(str(part), lines[0])
        self.assertEqual(sorted(self.folder.rglob("*")), before)

    def write(self, name, content):
        path = self.folder / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path


class Errors(ProgramTest):
    def test_input_is_missing(self):
        self.assert_fails(INPUT, ["nowhere.pdb", "no such file"], "nowhere.pdb", "-o", "a.obj")

    def test_input_is_a_directory(self):
        (self.folder / "folder.pdb").mkdir()
        self.assert_fails(INPUT, ["folder.pdb", "directory"], "folder.pdb", "-o", "a.obj")

    def test_input_is_empty(self):
        self.write("empty.pdb", "")
        self.assert_fails(INPUT, ["empty.pdb", "empty"], "empty.pdb")

    def test_input_has_no_atoms(self):
        self.write("bare.pdb", "HEADER    NOTHING\nEND\n")
        self.assert_fails(INPUT, ["bare.pdb", "no atoms"], "bare.pdb")

    def test_filters_leave_no_atoms(self):
        self.assert_fails(INPUT, ["1CRN.pdb", "filters"], CRAMBIN, "--select", "//Z")

    def test_selection_can_not_be_parsed(self):
        self.assert_fails(USAGE, ["selection", "//A/[["], CRAMBIN, "--select", "//A/[[")

    def test_input_is_a_truncated_gzip(self):
        packed = gzip.compress(CRAMBIN.read_bytes())
        for size in (len(packed) // 2, len(packed) - 1, len(packed) - 8):
            self.write("cut.pdb.gz", packed[:size])
            self.assert_fails(INPUT, ["cut.pdb.gz", "cut off"], "cut.pdb.gz", "-o", "a.obj")

    def test_input_has_a_broken_record(self):
        text = CRAMBIN.read_text().splitlines()
        line = next(i for i, record in enumerate(text) if record.startswith("ATOM"))
        text[line + 4] = text[line + 4][:30] + "   ****.***" + text[line + 4][41:]
        self.write("broken.pdb", "\n".join(text))
        self.assert_fails(INPUT, ["broken.pdb", f"line {line + 5}", "coordinate"], "broken.pdb")

    def test_input_has_an_unknown_extension(self):
        self.write("notes.txt", "Dear diary\n")
        self.assert_fails(INPUT, ["notes.txt", ".pdb", ".brk", ".cif", ".xyzr", ".xyzrn"], "notes.txt")

    def test_models_are_counted_whatever_their_numbers(self):
        atoms = [line for line in CRAMBIN.read_text().splitlines() if line.startswith("ATOM")]
        self.write("m.pdb", "".join("MODEL     %4d\n%s\nENDMDL\n" % (number, "\n".join(atoms[:number]))
                                    for number in (10, 11, 12)))
        result = self.run_cpu("m.pdb", "--model", "2", "--json", "a.json")
        self.assertEqual(json.loads((self.folder / "a.json").read_text())["atoms"], 11)
        self.assertIn("--model 2 is the model that the file gives the number 11", result.stderr)
        self.assertEqual(self.run_cpu("m.pdb", "--model", "2", "--quiet").stderr, "")
        self.assertEqual(self.run_cpu("m.pdb", "--model", "all").stderr, "")
        self.assert_fails(USAGE, ["3 models", "no model 11", "counted from 1"], "m.pdb", "--model", "11")

    def test_no_surface(self):
        result = self.run_cpu(CRAMBIN, "--surface", "gaussian", "--isovalue", "1000")
        self.assertIn("--isovalue 1000", result.stderr)
        self.assertIn("0 triangles", result.stdout)
        self.write("tiny.xyzr", "0.3 0.3 0.3 0.05\n")
        for surface in ("ses", "vdw"):
            result = self.run_cpu("tiny.xyzr", "--surface", surface, "--spacing", "3")
            self.assertIn("a lattice of --spacing 3", result.stderr)
            self.assertNotIn("--isovalue", result.stderr)

    def test_no_such_model(self):
        self.assert_fails(USAGE, ["1 model", "7"], CRAMBIN, "--model", "7")

    def test_output_has_an_unknown_extension(self):
        for name in ("a.xyz", "a"):
            self.assert_fails(USAGE, ["-o", name, ".obj", ".ply"], CRAMBIN, "-o", name)

    def test_output_can_not_be_written(self):
        # Found before computing: the input would be refused as well.
        for name in ("nowhere/a.obj", "nowhere/deeper/a.ply"):
            self.assert_fails(OUTPUT, [name], "nowhere.pdb", "-o", name)
            self.assert_fails(OUTPUT, [name], "nowhere.pdb", "--json", name)
        (self.folder / "folder.obj").mkdir()
        self.assert_fails(OUTPUT, ["folder.obj", "directory"], CRAMBIN, "-o", "folder.obj")

    @unittest.skipUnless(hasattr(os, "geteuid") and os.geteuid() != 0, "root may write everywhere")
    def test_output_folder_is_write_protected(self):
        folder = self.folder / "protected"
        folder.mkdir()
        folder.chmod(0o500)
        self.addCleanup(folder.chmod, 0o700)
        self.assert_fails(OUTPUT, ["protected/a.obj"], CRAMBIN, "-o", "protected/a.obj")

    def test_spacing_is_out_of_range(self):
        for value in ("0", "-1", "nan", "inf", "abc", "1e9"):
            self.assert_fails(USAGE, ["--spacing", value], CRAMBIN, "-v", value)

    def test_other_values_are_out_of_range(self):
        for flag, value in (("--probe", "-1"), ("--probe", "nan"), ("--steps", "-1"), ("--steps", "1.5"),
                            ("--slice", "0"), ("--threads", "0"), ("--threads", "x"), ("--memory", "0"),
                            ("--memory", "12Q"), ("--memory", "-5M"), ("--memory", "8388608T"),
                            ("--memory", "99999999999G"), ("--model", "0"), ("--model", "some"),
                            ("--device", "-1"), ("--surface", "skin"), ("--method", "fast"), ("--backend", "tpu")):
            with self.subTest(flag=flag, value=value):
                self.assert_fails(USAGE, [flag, value], CRAMBIN, flag, value)

    def test_wrong_flags(self):
        self.assert_fails(USAGE, ["--colour"], CRAMBIN, "--colour")
        self.assert_fails(USAGE, ["input"])
        self.assert_fails(USAGE, ["-o"], CRAMBIN, "-o")
        self.assert_fails(USAGE, ["--device", "cpu"], CRAMBIN, "--device", "0", "--backend", "cpu")
        self.assert_fails(USAGE, ["bench"], "bench")

    def test_values_that_are_nothing(self):
        for flag in ("--output", "--json", "--per-atom", "--per-residue", "--trajectory", "--select", "--radii"):
            with self.subTest(flag=flag):
                self.assert_fails(USAGE, [flag, "'' is given"], CRAMBIN, flag, "")
        self.assert_fails(USAGE, ["--csv", "'' is given"], "cavities", CRAMBIN, "--csv", "")
        self.assert_fails(USAGE, ["--per-atom", "'' is given"], "measure", CRAMBIN, "--per-atom", "")

    def test_the_grid_method_has_one_surface(self):
        self.assert_fails(USAGE, [], CRAMBIN, "--method", "grid", "--surface", "sas", "--backend", "cpu")

    def test_radii_files(self):
        self.write("radii.txt", "C 1.7\nC carbon\n")
        self.assert_fails(INPUT, ["radii.txt", "line 2"], CRAMBIN, "--radii", "radii.txt")
        self.assert_fails(INPUT, ["none.txt", "bondi"], CRAMBIN, "--radii", "none.txt")
        self.write("a.xyzr", "0 0 0 1\n")
        self.assert_fails(USAGE, ["--radii", "a.xyzr"], "a.xyzr", "--radii", "bondi")
        self.assert_fails(USAGE, ["a.xyzr", "names"], "a.xyzr", "--no-water")

    def test_an_atom_is_too_far_away(self):
        self.write("far.xyzr", "0 0 0 1\n1e30 0 0 1\n")
        self.assert_fails(INPUT, ["far.xyzr", "atom 2"], "far.xyzr", "--backend", "cpu")

    def test_the_budget_is_too_small(self):
        self.assert_fails(COMPUTE, ["memory"], CRAMBIN, "-o", "a.obj", "--backend", "cpu", "--memory", "1K")

    def test_the_spacing_is_too_fine_for_the_budget(self):
        self.assert_fails(COMPUTE, ["memory", "spacing"], CRAMBIN, "-o", "a.obj", "--backend", "cpu", "-v", "0.02",
                          "--memory", "4M")

    def test_grid_makes_the_ses_only(self):
        self.assert_fails(USAGE, ["--method grid", "--surface"], CRAMBIN, "--method", "grid", "--surface", "sas")

    def test_the_spacing_is_too_fine_for_the_index_type(self):
        self.assert_fails(COMPUTE, ["triangles", "spacing", "Å would do"], CRAMBIN, "-o", "a.obj", "--backend", "cpu",
                          "-v", "0.001")

    def test_cuda_where_there_is_none(self):
        environment = dict(os.environ, CUDA_VISIBLE_DEVICES="")  # no device on any machine
        result = subprocess.run([PROGRAM, str(CRAMBIN), "--backend", "cuda"], capture_output=True, encoding="utf-8",
                                env=environment)
        self.assertEqual(result.returncode, BACKEND, result.stderr)
        self.assertIn("cuda", result.stderr)
        for command in ([], ["measure"]):  # which is so for all structures, and said once
            many = subprocess.run([PROGRAM, *command, *[str(CRAMBIN)] * 3, "--backend", "cuda"], capture_output=True,
                                  encoding="utf-8", env=environment)
            self.assertEqual((many.returncode, many.stderr), (BACKEND, result.stderr))
        was_built = "no CUDA back end" not in result.stderr
        result = subprocess.run([PROGRAM, str(CRAMBIN)], capture_output=True, encoding="utf-8", env=environment)
        self.assertEqual(result.returncode, OK, result.stderr)
        self.assertRegex(result.stderr, r"^quickses: the CPU computes: \S" if was_built else "^$")
        self.assertEqual(len(result.stderr.splitlines()), 1 if was_built else 0)
        result = subprocess.run([PROGRAM, str(CRAMBIN), "--quiet"], capture_output=True, env=environment)
        self.assertEqual((result.returncode, result.stdout, result.stderr), (OK, b"", b""))

    def test_a_failed_run_leaves_the_old_output(self):
        for arguments in (["nowhere.pdb"], [CRAMBIN, "--select", "//Z"], [CRAMBIN, "--backend", "cpu", "--memory", "1K"]):
            old = self.write("old.obj", "what was here before")
            self.assertNotEqual(subprocess.run([PROGRAM, *map(str, arguments), "-o", "old.obj"], cwd=self.folder,
                                               stderr=subprocess.DEVNULL).returncode, OK)
            self.assertEqual(old.read_text(), "what was here before")
            self.assertEqual([path.name for path in self.folder.iterdir()], ["old.obj"])


class Output(ProgramTest):
    def test_obj_of_crambin(self):
        result = self.run_cpu(CRAMBIN, "-o", "a.obj")
        vertices, normals, faces = read_obj(self.folder / "a.obj")
        self.assertTrue(is_closed(faces))
        self.assertGreaterEqual(len(normals), len(vertices))  # on creases one per side
        self.assertAlmostEqual(volume_of(vertices, faces), CRAMBIN_VOLUME, delta=0.002 * CRAMBIN_VOLUME)
        self.assertAlmostEqual(area_of(vertices, faces), CRAMBIN_AREA, delta=0.012 * CRAMBIN_AREA)
        for normal in normals[::97]:
            self.assertAlmostEqual(math.hypot(*normal), 1, delta=1e-5)
        self.assertEqual(result.stderr, "")
        lines = result.stdout.splitlines()
        self.assertEqual(len(lines), 1)
        for part in ("327 atoms", f"{len(vertices)} vertices", f"{len(faces)} triangles", "cpu", "a.obj"):
            self.assertIn(part, lines[0])

    def test_ply_is_the_same_mesh_with_owners(self):
        for name in ("a.ply", "a.obj"):
            self.run_cpu("-i", CRAMBIN, "-o", name, "--hard-edges", "off")
        vertices, normals, owners, faces = read_ply(self.folder / "a.ply")
        obj_vertices, obj_normals, obj_faces = read_obj(self.folder / "a.obj")
        as_float = struct.Struct("<f")
        self.assertEqual(faces, obj_faces)
        for ours, theirs in ((vertices, obj_vertices), (normals, obj_normals)):
            self.assertEqual([x for row in ours for x in row],
                             [as_float.unpack(as_float.pack(x))[0] for row in theirs for x in row])
        # Vertices are within reach of the atom that owns them: r, and for those of the probe r + 2 p.
        atoms = [tuple(float(line[30 + 8 * i:38 + 8 * i]) for i in range(3))
                 for line in CRAMBIN.read_text().splitlines() if line.startswith(("ATOM", "HETATM"))]
        self.assertEqual(len(atoms), 327)
        for vertex, owner in zip(vertices, owners):
            self.assertLess(math.dist(vertex, atoms[owner]), 1.8 + 2 * 1.4)
        self.assertGreater(len(set(owners)), 100)

    def test_hard_edges(self):
        smooth = self.run_cpu(CRAMBIN, "-o", "smooth.ply", "-v", "0.3", "--hard-edges", "off", "--json", "-")
        smooth = json.loads(smooth.stdout)
        places, _, owners, faces = read_ply(self.folder / "smooth.ply")
        self.assertEqual((smooth["mesh"]["repeated"], smooth["settings"]["hard_edges"]), (0, False))
        self.assertTrue(is_closed(faces))
        reports = {}
        for name in ("hard.ply", "hard.obj"):
            reports[name] = json.loads(self.run_cpu(CRAMBIN, "-o", name, "-v", "0.3", "--json", "-").stdout)
            mesh = reports[name]["mesh"]
            self.assertEqual(reports[name]["settings"]["hard_edges"], True)
            self.assertEqual(mesh["vertices"], len(places))
            self.assertGreater(mesh["repeated"], 0)
        repeated = reports["hard.ply"]["mesh"]["repeated"]
        vertices, normals, hard_owners, hard_faces = read_ply(self.folder / "hard.ply")
        self.assertEqual(len(vertices), len(places) + repeated)
        self.assertEqual((vertices[:len(places)], hard_owners[:len(places)]), (places, owners))
        for face, hard in zip(faces, hard_faces):
            self.assertEqual([places[v] for v in face], [vertices[v] for v in hard])
        # An OBJ file has each place once, and is closed by the numbers of its places.
        obj_places, obj_normals, obj_faces = read_obj(self.folder / "hard.obj")
        self.assertEqual((len(obj_places), len(obj_normals)), (len(places), len(normals)))
        self.assertEqual(obj_faces, faces)
        numbers = [[int(part) - 1 for corner in line.split()[1:] for part in corner.split("//")]
                   for line in (self.folder / "hard.obj").read_text().splitlines() if line.startswith("f ")]
        self.assertEqual([tuple(row[1::2]) for row in numbers], [tuple(face) for face in hard_faces])
        stl = json.loads(self.run_cpu(CRAMBIN, "-o", "a.stl", "-v", "0.3", "--json", "-").stdout)
        self.assertEqual((stl["mesh"]["repeated"], stl["settings"]["hard_edges"]), (0, False))
        for arguments in (["-o", "a.stl"], [], ["-o", "a.ply", "--method", "grid"]):
            self.assert_fails(USAGE, ["--hard-edges on"], CRAMBIN, *arguments, "--hard-edges", "on")
        self.assert_fails(USAGE, ["--hard-edges", "'maybe'"], CRAMBIN, "-o", "b.ply", "--hard-edges", "maybe")

    def test_stl_has_every_triangle(self):
        self.run_cpu(CRAMBIN, "-o", "a.stl", "--json", "a.json")
        data = (self.folder / "a.stl").read_bytes()
        count = json.loads((self.folder / "a.json").read_text())["mesh"]["triangles"]
        self.assertEqual(struct.unpack_from("<I", data, 80)[0], count)
        self.assertEqual(len(data), 84 + 50 * count)

    def test_owners_count_the_atoms_of_the_file(self):
        # Water first, then two atoms far apart; the filter must not shift the owners.
        record = "{:6s}{:5d} {:4s} {:3s} A{:4d}    {:8.3f}{:8.3f}{:8.3f}  1.00  0.00          {:>2s}\n"
        self.write("a.pdb", record.format("HETATM", 1, " O", "HOH", 1, 50, 0, 0, "O") +
                   record.format("ATOM", 2, " N", "GLY", 2, 0, 0, 0, "N") +
                   record.format("HETATM", 3, " O", "HOH", 3, 60, 0, 0, "O") +
                   record.format("ATOM", 4, " C", "GLY", 4, 20, 0, 0, "C"))
        self.run_cpu("a.pdb", "-o", "a.ply", "--no-water")
        vertices, _, owners, faces = read_ply(self.folder / "a.ply")
        self.assertTrue(is_closed(faces))
        self.assertEqual(set(owners), {1, 3})
        for vertex, owner in zip(vertices, owners):
            self.assertAlmostEqual(math.dist(vertex, ((owner - 1) * 10, 0, 0)), 1.55 if owner == 1 else 1.70, delta=1e-3)

    def test_the_same_bytes_every_time_and_in_slices(self):
        self.run_cpu(CRAMBIN, "-o", "a.ply")
        self.run_cpu(CRAMBIN, "-o", "b.ply", "--threads", "1")
        self.run_cpu(CRAMBIN, "-o", "c.ply", "-s", "32")
        first = (self.folder / "a.ply").read_bytes()
        self.assertEqual((self.folder / "b.ply").read_bytes(), first)
        self.assertEqual((self.folder / "c.ply").read_bytes(), first)

    def test_an_existing_file_is_replaced(self):
        self.write("a.obj", "old")
        self.run_cpu(CRAMBIN, "-o", "a.obj", "-v", "1")
        self.assertTrue(is_closed(read_obj(self.folder / "a.obj")[2]))
        self.assertEqual([path.name for path in self.folder.iterdir()], ["a.obj"])

    def test_all_models_make_one_file_each(self):
        text = "".join(line for line in CRAMBIN.read_text().splitlines(True) if line.startswith("ATOM"))
        self.write("two.pdb", "".join(f"MODEL     {i:4d}\n{text}ENDMDL\n" for i in (1, 2)) + "END\n")
        result = self.run_cpu("two.pdb", "-o", "out.ply", "--model", "all", "-v", "1", "--json", "-")
        reports = [json.loads(line) for line in result.stdout.splitlines()]
        self.assertEqual([report["model"] for report in reports], [1, 2])
        self.assertEqual((self.folder / "out_0001.ply").read_bytes(), (self.folder / "out_0002.ply").read_bytes())
        self.assertFalse((self.folder / "out.ply").exists())

    def test_gzip_is_read(self):
        self.write("a.pdb.gz", gzip.compress(CRAMBIN.read_bytes()))
        self.run_cpu("a.pdb.gz", "-o", "a.ply", "-v", "1")
        self.run_cpu(CRAMBIN, "-o", "b.ply", "-v", "1")
        self.assertEqual((self.folder / "a.ply").read_bytes(), (self.folder / "b.ply").read_bytes())

    def test_missing_elements_are_warned_of_once(self):
        lines = [line[:66] for line in CRAMBIN.read_text().splitlines() if line.startswith("ATOM")]
        self.write("bare.pdb", "\n".join(lines))
        result = self.run_cpu("bare.pdb", "-o", "a.ply", "-v", "1")
        self.assertEqual(len(result.stderr.splitlines()), 1)
        self.assertIn("327 atoms", result.stderr)
        self.run_cpu(CRAMBIN, "-o", "b.ply", "-v", "1")
        self.assertEqual((self.folder / "a.ply").read_bytes(), (self.folder / "b.ply").read_bytes())
        self.assertEqual(self.run_cpu("bare.pdb", "--quiet").stderr, "")

    def test_help_and_version(self):
        text = self.run_program("--help").stdout
        for part in ("-i,", "-o,", "-v,", "-l,", "-s,", "--probe", "--surface", "--method", "--backend", "--device",
                     "--threads", "--memory", "--radii", "--no-water", "--no-hetero", "--no-hydrogen", "--select",
                     "--model", "--max-input", "--json", "--quiet", "--version", "bench", "Exit codes", "measure", "cavities",
                     "--outer", "--component-ids", "--per-atom", "--per-residue", "--hard-edges", "--creases"):
            self.assertIn(part, text)
        for command, parts in (("measure", ["--surface", "--per-atom", "--per-residue", "--trajectory", "--csv"]),
                               ("cavities", ["--csv", "--method", "--select"]), ("bench", ["--repeat", "--copies", "--delivery", "--layout", "--stages"])):
            text = self.run_program(command, "--help").stdout
            for part in parts + ["INPUT" if command != "bench" else "FILE", "Exit codes"]:
                self.assertIn(part, text)
        self.assertRegex(self.run_program("--version").stdout, r"^quickses \d+\.\d+\.\d+\S*\n$")


class Report(ProgramTest):
    def report_of(self, *arguments):
        result = self.run_cpu(*arguments, "--json", "-")
        return json.loads(result.stdout)

    def test_fields(self):
        report = self.report_of(CRAMBIN, "-o", "a.obj")
        vertices, _, faces = read_obj(self.folder / "a.obj")
        self.assertEqual(report["input"], str(CRAMBIN))
        self.assertEqual(report["atoms"], 327)
        self.assertEqual(report["backend"], "cpu")
        self.assertTrue(report["device"])
        self.assertRegex(report["version"], r"^\d+\.\d+\.\d+")
        self.assertEqual({key: report["settings"][key] for key in ("surface", "method", "probe", "spacing", "steps", "radii")},
                         {"surface": "ses", "method": "exact", "probe": 1.4, "spacing": 0.5, "steps": 1,
                          "radii": "quickses"})
        mesh = report["mesh"]
        self.assertEqual((mesh["vertices"], mesh["triangles"]), (len(vertices), len(faces)))
        self.assertIs(mesh["closed"], True)
        for axis in range(3):
            for side, extreme in ((0, min), (1, max)):
                self.assertAlmostEqual(mesh["bounds"][side][axis], extreme(v[axis] for v in vertices), delta=1e-4)
        self.assertAlmostEqual(report["triangle_area"], area_of(vertices, faces), delta=1e-4 * report["area"])
        self.assertAlmostEqual(report["triangle_volume"], volume_of(vertices, faces), delta=1e-4 * report["volume"])
        self.assertEqual(report["measured_by"], "normals")
        self.assertAlmostEqual(report["area"], CRAMBIN_AREA, delta=1e-3 * CRAMBIN_AREA)
        self.assertAlmostEqual(report["volume"], CRAMBIN_VOLUME, delta=5e-4 * CRAMBIN_VOLUME)
        for surface, by in (("sas", "atoms"), ("vdw", "atoms")):
            self.assertEqual(self.report_of(CRAMBIN, "--surface", surface)["measured_by"], by)
        grid = self.report_of(CRAMBIN, "--method", "grid")
        self.assertEqual((grid["measured_by"], grid["area"]), ("triangles", grid["triangle_area"]))
        for key in ("read", "compute", "write"):
            self.assertGreater(report["time_ms"][key], 0)
        self.assertTrue(report["time_ms"]["stages"])
        for milliseconds in report["time_ms"]["stages"].values():
            self.assertGreaterEqual(milliseconds, 0)
        self.assertGreater(report["memory"]["peak_host"], 12 * len(faces))

    def test_components_add_up(self):
        report = self.report_of(CRAMBIN)
        pieces = report["components"]
        self.assertEqual(sum(piece["triangles"] for piece in pieces), report["mesh"]["triangles"])
        self.assertAlmostEqual(sum(piece["area"] for piece in pieces), report["area"], delta=1e-4 * report["area"])
        self.assertAlmostEqual(sum(piece["volume"] for piece in pieces), report["volume"], delta=1e-4 * report["volume"])
        for piece in pieces:
            for axis in range(3):
                self.assertLessEqual(piece["bounds"][0][axis], piece["center"][axis])
                self.assertLessEqual(piece["center"][axis], piece["bounds"][1][axis])

    def test_a_sphere_a_cavity_and_their_signs(self):
        self.write("one.xyzr", "0 0 0 2\n")
        report = self.report_of("one.xyzr", "--surface", "vdw", "-v", "0.2")
        self.assertEqual(len(report["components"]), 1)
        self.assertAlmostEqual(report["volume"], 32 / 3 * math.pi, delta=0.01 * 32 / 3 * math.pi)
        self.assertEqual(report["settings"]["radii"], "file")
        # Atoms all over a sphere of 8 angstrom leave a hole in the middle.
        count, radius = 400, 8.0
        points = []
        for i in range(count):
            z = 1 - (2 * i + 1) / count
            turn = math.pi * (3 - math.sqrt(5)) * i
            points.append((radius * math.sqrt(1 - z * z) * math.cos(turn), radius * math.sqrt(1 - z * z) * math.sin(turn),
                           radius * z))
        self.write("shell.xyzr", "".join("%.4f %.4f %.4f 1.7\n" % point for point in points))
        report = self.report_of("shell.xyzr")
        self.assertEqual([piece["cavity"] for piece in report["components"]], [False, True])
        self.assertGreater(report["components"][0]["volume"], 0)
        # Lower bound: the ball of radius 8 - 1.7; upper: the sphere through the atoms.
        self.assertGreater(-report["components"][1]["volume"], 4 / 3 * math.pi * 6.3 ** 3 * 0.99)
        self.assertLess(-report["components"][1]["volume"], 4 / 3 * math.pi * 8 ** 3)

    def test_settings_reach_the_library(self):
        plain = self.report_of(CRAMBIN, "-v", "1")
        self.write("radii.txt", "C 1.9\n")
        for arguments in (["--probe", "2"], ["--surface", "sas"], ["--surface", "vdw"], ["--radii", "radii.txt"],
                          ["-l", "0"], ["--select", "//A/1-20"], ["-v", "0.8"]):
            with self.subTest(arguments=arguments):
                spacing = [] if "-v" in arguments else ["-v", "1"]
                other = self.report_of(CRAMBIN, *spacing, *arguments)
                self.assertTrue(other["mesh"]["closed"])
                self.assertNotEqual(other["area"], plain["area"])
        self.assertEqual(self.report_of(CRAMBIN, "--memory", "512M", "-v", "1")["settings"]["memory"], 512 << 20)

    def test_the_grid_method_is_closed(self):
        report = self.report_of(CRAMBIN, "--method", "grid")
        self.assertTrue(report["mesh"]["closed"])
        self.assertEqual(report["settings"]["method"], "grid")

    def test_a_file_takes_the_report_and_standard_output_the_summary(self):
        result = self.run_cpu(CRAMBIN, "--json", "a.json")
        self.assertEqual(json.loads((self.folder / "a.json").read_text())["atoms"], 327)
        self.assertEqual(len(result.stdout.splitlines()), 1)


if __name__ == "__main__":
    PROGRAM = program_to_test(PROGRAM, __doc__)
    unittest.main()
