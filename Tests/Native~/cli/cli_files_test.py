# SPDX-License-Identifier: MIT
"""Tests of what the quickses program does to files: what it reads of them at most, that it writes over none of its own,
and what is left when it fails or is stopped.

usage: cli_files_test.py PROGRAM [unittest options]      (or QUICKSES_PROGRAM in the environment)
"""
import gzip
import json
import os
import shutil
import signal
import stat
import subprocess
import time
import unittest

import cli_test
from cli_test import CRAMBIN, INPUT, IS_WINDOWS, OK, OUTPUT, USAGE, ProgramTest, is_closed, read_obj

MODELS = 3


class FilesTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("p.pdb", CRAMBIN.read_bytes())
        self.write("radii.txt", "C 1.7\n")
        atoms = "".join(line for line in CRAMBIN.read_text().splitlines(True) if line.startswith("ATOM"))
        self.write("many.pdb", "".join(f"MODEL     {i + 1:4d}\n{atoms}ENDMDL\n" for i in range(MODELS)))

    def content(self):
        return {path.name: path.read_bytes() for path in self.folder.iterdir() if path.is_file()}


class Limits(FilesTest):
    def test_input_is_larger_than_allowed(self):
        text = CRAMBIN.read_bytes()
        self.write("a.pdb", text)
        self.write("a.pdb.gz", gzip.compress(text))
        for name in ("a.pdb", "a.pdb.gz"):
            self.run_cpu(name, "-v", "2", "--max-input", len(text))
            self.assert_fails(INPUT, [name, "--max-input", f"{len(text) - 1} bytes"], name, "-o", "a.obj", "--max-input",
                              len(text) - 1)
        self.assert_fails(INPUT, ["a.pdb"], "bench", "a.pdb", "--max-input", "1K")
        self.assert_fails(USAGE, ["--max-input", "much"], "a.pdb", "--max-input", "much")

    def test_a_small_gzip_holds_very_much(self):
        member = gzip.compress(bytes(64 << 20))
        self.write("bomb.pdb.gz", 5 * member)
        self.assert_fails(INPUT, ["bomb.pdb.gz", "256 MiB", "--max-input"], "bomb.pdb.gz", "-o", "a.obj")

    @unittest.skipIf(IS_WINDOWS, "no such devices")
    def test_devices_and_pipes(self):
        self.assert_fails(INPUT, ["/dev/zero", "8 MiB"], "/dev/zero", "-o", "a.obj", "--max-input", "8M")
        self.assert_fails(INPUT, ["/dev/null", "empty"], "/dev/null")
        for text in (CRAMBIN.read_bytes(), gzip.compress(CRAMBIN.read_bytes())):
            result = subprocess.run([cli_test.PROGRAM, "/dev/stdin", "--backend", "cpu"], input=text, capture_output=True)
            self.assertEqual(result.returncode, OK, result.stderr)
            self.assertIn(b"327 atoms", result.stdout)

    def test_radii_and_trajectories_have_the_limit_too(self):
        self.write("large.txt", "# comment\n" * 20000 + "C 1.7\n")
        self.assert_fails(INPUT, ["large.txt", "--max-input"], "p.pdb", "--radii", "large.txt", "--max-input", "100K")
        self.assert_fails(INPUT, ["many.pdb", "--max-input"], "p.pdb", "--trajectory", "many.pdb", "--max-input", "50K")


class OneFileForTwoThings(FilesTest):
    """Whatever is refused leaves all files as they were."""

    def assert_refused(self, parts, *arguments):
        before = self.content()
        self.assert_fails(USAGE, parts, *arguments)
        self.assertEqual(self.content(), before)

    def ways_to(self, name):
        """Other names of a file that is there, or of one that is not."""
        yield name
        yield f"./{name}"
        yield self.folder / name
        (self.folder / "folder").mkdir(exist_ok=True)
        yield f"folder/../{name}"
        if IS_WINDOWS:
            yield name.upper()
            return
        (self.folder / "same").symlink_to(".")
        yield f"same/{name}"
        (self.folder / "same").unlink()
        extension = os.path.splitext(name)[1]
        (self.folder / f"second{extension}").symlink_to(name)
        (self.folder / f"link{extension}").symlink_to(f"second{extension}")
        yield f"link{extension}"
        (self.folder / f"second{extension}").unlink()
        (self.folder / f"link{extension}").unlink()
        if (self.folder / name).exists():
            os.link(self.folder / name, self.folder / f"hard{extension}")
            yield f"hard{extension}"
            (self.folder / f"hard{extension}").unlink()

    def test_outputs_over_outputs(self):
        for exists in (False, True):
            if exists:
                self.write("j.obj", "old")
                self.write("t.csv", "old")
            for name in self.ways_to("j.obj"):
                self.assert_refused(["--json", name, "--output (-o)"], "p.pdb", "-o", "j.obj", "--json", name)
            for name in self.ways_to("t.csv"):
                self.assert_refused(["--json", name, "--csv"], "p.pdb", "--trajectory", "many.pdb", "--csv", "t.csv",
                                    "--json", name)
                self.assert_refused(["--per-residue", name, "--per-atom"], "p.pdb", "--per-atom", "t.csv",
                                    "--per-residue", name)

    def test_outputs_over_inputs(self):
        shutil.copy(self.folder / "p.pdb", self.folder / "p.obj")  # known by its content
        for name in self.ways_to("p.obj"):
            self.assert_refused(["--output (-o)", name, "input"], "p.obj", "-o", name)
        for name in self.ways_to("p.pdb"):
            self.assert_refused(["--json", name, "input"], "p.pdb", "--json", name)
            self.assert_refused(["--json", name, "input"], "bench", "many.pdb", "p.pdb", "--json", name)
        for name in self.ways_to("radii.txt"):
            self.assert_refused(["--json", name, "--radii"], "p.pdb", "--radii", "radii.txt", "--json", name)
            self.assert_refused(["--json", name, "--radii"], "bench", "p.pdb", "--radii", "radii.txt", "--json", name)
        for name in self.ways_to("many.pdb"):
            self.assert_refused(["--csv", name, "--trajectory"], "p.pdb", "--trajectory", "many.pdb", "--csv", name)

    def test_meshes_of_models_and_frames(self):
        for flag, numbered, arguments in (("--model", "m_0002.ply", ["-o", "m.ply", "--model", "all"]),
                                          ("--trajectory", "m_2.ply", ["-o", "m_%d.ply", "--trajectory", "many.pdb"])):
            for name in self.ways_to(numbered):
                self.assert_refused(["--output (-o)", numbered, "--json"], "many.pdb", *arguments, "--json", name)
            shutil.copy(self.folder / "many.pdb", self.folder / numbered)
            for name in self.ways_to(numbered):
                if str(name).startswith("hard"):  # the mesh takes the place of the other name
                    self.run_cpu(name, *arguments, "-v", "2")
                    self.assertEqual((self.folder / name).read_bytes(), (self.folder / "many.pdb").read_bytes())
                else:
                    self.assert_refused(["--output (-o)", numbered, "input"], name, *arguments)
            (self.folder / numbered).unlink()
        # A frame that is not asked for has no file.
        self.run_cpu("p.pdb", "--trajectory", "many.pdb", "-v", "2", "-o", "m_%d.ply", "--frames", "0", "--csv", "m_2.ply")

    def test_what_is_no_output_may_be_the_same(self):
        (self.folder / "quickses").write_text("a file of this name is no set of radii")
        self.run_cpu("p.pdb", "-v", "2", "--radii", "quickses", "--json", "quickses")
        # Meshes of models have numbers behind the name of the input.
        self.run_cpu("p.pdb", "many.pdb", "--model", "all", "-v", "2", "-o", "%s.ply", "--json", "many.ply")
        self.assertEqual(len((self.folder / "many.ply").read_text().splitlines()), 1 + MODELS)
        if not IS_WINDOWS:
            self.run_cpu("many.pdb", "--trajectory", "many.pdb", "-v", "2", "--csv", "/dev/null", "--json", "/dev/null")

    def test_names_made_of_the_input(self):
        self.assert_refused(["--output (-o)", "p.html", "--csv"], "p.pdb", "--trajectory", "many.pdb", "-o", "%s.html",
                            "--csv", "p.html")
        self.assert_refused(["--output (-o)", "p_1.ply", "--csv"], "p.pdb", "--trajectory", "many.pdb", "-o",
                            "%s_%d.ply", "--csv", "p_1.ply")

    @unittest.skipIf(IS_WINDOWS, "standard output has no name")
    def test_standard_output_is_a_file_too(self):
        with open(self.folder / "a.obj", "w") as file:
            result = subprocess.run([cli_test.PROGRAM, "p.pdb", "-o", "a.obj", "--json", "-"], cwd=self.folder,
                                    stdout=file, stderr=subprocess.PIPE)
        self.assertEqual(result.returncode, USAGE)
        self.assertIn(b"--json", result.stderr)


class Replacing(FilesTest):
    def test_names_as_long_as_file_systems_allow(self):
        for name in ("x" * 251 + ".obj", "y" * 242 + ".ply"):
            self.run_cpu("p.pdb", "-v", "2", "-o", name)
            self.assertGreater((self.folder / name).stat().st_size, 1000)
        self.assert_fails(OUTPUT, ["z.obj"], "p.pdb", "-v", "2", "-o", "z" * 252 + ".obj")

    @unittest.skipIf(IS_WINDOWS, "no rights as these")
    def test_a_replaced_file_keeps_its_rights(self):
        old = os.umask(0o027)
        self.addCleanup(os.umask, old)
        for rights in (0o600, 0o644, 0o666, 0o755):
            path = self.write("a.obj", "old")
            path.chmod(rights)
            self.run_cpu("p.pdb", "-v", "2", "-o", "a.obj", "--json", "new.json")
            self.assertEqual(stat.S_IMODE(path.stat().st_mode), rights)
            self.assertTrue(is_closed(read_obj(path)[2]))
        self.assertEqual(stat.S_IMODE((self.folder / "new.json").stat().st_mode), 0o640)

    @unittest.skipIf(IS_WINDOWS, "no symbolic links")
    def test_links(self):
        (self.folder / "folder").mkdir()
        (self.folder / "a.obj").symlink_to("folder/real.obj")  # leads to nothing yet
        self.run_cpu("p.pdb", "-v", "2", "-o", "a.obj")
        self.assertTrue((self.folder / "a.obj").is_symlink())
        self.assertTrue(is_closed(read_obj(self.folder / "folder" / "real.obj")[2]))
        (self.folder / "circle.obj").symlink_to("circle.obj")
        self.assert_fails(OUTPUT, ["circle.obj"], "p.pdb", "-v", "2", "-o", "circle.obj")
        self.assertTrue((self.folder / "circle.obj").is_symlink())
        self.assert_fails(INPUT, ["circle.obj"], "circle.obj")
        (self.folder / "lost.obj").symlink_to("nowhere/real.obj")
        self.assert_fails(OUTPUT, ["lost.obj", "no folder", "nowhere"], "p.pdb", "-v", "2", "-o", "lost.obj")
        self.assertEqual(os.readlink(self.folder / "lost.obj"), "nowhere/real.obj")

    @unittest.skipIf(IS_WINDOWS, "no named pipes")
    def test_named_pipes(self):
        self.run_cpu("p.pdb", "-v", "2", "-o", "file.obj")
        self.run_cpu("p.pdb", "--trajectory", "many.pdb", "-v", "2", "--csv", "file.csv")
        for name, arguments in (("pipe.obj", ["-o", "pipe.obj"]), ("pipe.json", ["--json", "pipe.json"]),
                                ("pipe.csv", ["--trajectory", "many.pdb", "--csv", "pipe.csv"])):
            os.mkfifo(self.folder / name)
            with open(self.folder / "read", "wb") as read:
                reader = subprocess.Popen(["cat", self.folder / name], stdout=read)
            self.addCleanup(reader.wait)
            self.addCleanup(reader.kill)
            self.run_cpu("p.pdb", "-v", "2", *arguments)
            reader.wait(timeout=cli_test.PATIENCE)
            content = (self.folder / "read").read_bytes()
            if name == "pipe.json":
                self.assertEqual(json.loads(content)["atoms"], 327)
            else:
                self.assertEqual(content, (self.folder / name.replace("pipe", "file")).read_bytes())
            self.assertTrue((self.folder / name).is_fifo())


    @unittest.skipIf(IS_WINDOWS, "no named pipes")
    def test_two_named_pipes_that_are_read_one_after_the_other(self):
        self.run_cpu("p.pdb", "-v", "2", "-o", "file.vert")
        for name in ("pipe.vert", "pipe.face"):
            os.mkfifo(self.folder / name)
        reader = subprocess.Popen("cat pipe.vert > read.vert && cat pipe.face > read.face", shell=True, cwd=self.folder,
                                  start_new_session=True)
        self.addCleanup(reader.wait)
        self.addCleanup(lambda: reader.poll() is None and os.killpg(reader.pid, signal.SIGKILL))
        self.run_cpu("p.pdb", "-v", "2", "-o", "pipe.vert")
        self.assertEqual(reader.wait(timeout=cli_test.PATIENCE), 0)
        for name in (".vert", ".face"):
            self.assertEqual((self.folder / ("read" + name)).read_bytes(), (self.folder / ("file" + name)).read_bytes())


class Names(FilesTest):
    """A user may be called anything, and the system's locale may know nothing of it."""
    def test_they_have_letters_of_all_kinds(self):
        folder = self.folder / "Jürgen Müller 李" / "Ångström 🧬"
        folder.mkdir(parents=True)
        shutil.copy(CRAMBIN, folder / "Krambin ü.pdb")
        shutil.copy(self.folder / "many.pdb", folder / "Läufe.pdb")
        (folder / "rädii.txt").write_text("C 1.7\n* 1.5\n")
        plain = self.folder / "plain.ply"
        self.run_cpu("p.pdb", "-o", plain, "-v", "1")
        # Wine knows the names of files by the locale of its machine.
        for locale in ("C.UTF-8",) if IS_WINDOWS else ("C.UTF-8", "C"):
            with self.subTest(locale=locale):
                environment = {**os.environ, "LC_ALL": locale}
                def run(*arguments):
                    result = subprocess.run([cli_test.PROGRAM, *arguments, "--backend", "cpu", "-v", "1"], cwd=folder,
                                            env=environment, capture_output=True, encoding="utf-8", timeout=cli_test.PATIENCE)
                    self.assertEqual(result.returncode, OK, result.stderr)
                    return result
                run("Krambin ü.pdb", "-o", "Fläche 溶媒.ply")
                self.assertEqual((folder / "Fläche 溶媒.ply").read_bytes(), plain.read_bytes())
                run("Krambin ü.pdb", "--radii", "rädii.txt", "--json", "Bericht ü.json", "-o", "Ü.obj")
                self.assertIn("Krambin ü.pdb", (folder / "Bericht ü.json").read_text(encoding="utf-8"))
                run("Krambin ü.pdb", "--trajectory", "Läufe.pdb", "-o", "ü%d.obj", "--csv", "Läufe.csv")
                self.assertEqual(len(list(folder.glob("ü*.obj"))), MODELS)
                result = subprocess.run([cli_test.PROGRAM, "nicht da ü.pdb"], cwd=folder, env=environment,
                                        capture_output=True, encoding="utf-8", timeout=cli_test.PATIENCE)
                self.assertEqual(result.returncode, INPUT)
                self.assertIn("nicht da ü.pdb", result.stderr)
                for made in folder.iterdir():
                    if made.name not in ("Krambin ü.pdb", "Läufe.pdb", "rädii.txt"):
                        made.unlink()

    @unittest.skipIf(IS_WINDOWS, "names have no such letters there")
    def test_they_neither_begin_lines_nor_steer_the_terminal(self):
        name = "two\nlines \x1b[31m.pdb"
        atoms = "".join(line for line in CRAMBIN.read_text().splitlines(True) if line.startswith("ATOM"))
        self.write(name, (atoms.replace("           C", "            ") + "END\n") * 2 + "HETATM" + atoms[6:81])
        shown = "two?lines ?[31m.pdb"
        said = self.run_cpu("measure", name, "--model", "all").stderr + self.run_cpu(name, "-v", "2").stderr
        said += self.run_cpu(name, name, "nowhere" + name, "-v", "2", code=6).stderr
        said += self.run_cpu(name, "-v", "2", "--view", "x\ny", "-o", "a.png", code=USAGE).stderr
        self.assertGreater(said.count(f"'{shown}'"), 3)
        self.assertIn(f"quickses: nowhere{shown} failed: 'nowhere{shown}': no such file\n", said)
        self.assertIn("quickses: --view: 'x?y' is no direction", said)
        for line in said.splitlines():
            self.assertTrue(line.startswith("quickses: "), line)
        self.assertNotIn("\x1b", said)

    def test_wildcards(self):
        """Windows' shells leave them to programs; elsewhere they are letters of a name like others."""
        (self.folder / "in").mkdir()
        for name in ("b.pdb", "ü.pdb", "a.pdb", "c.pdb1", "d.ent"):
            shutil.copy(CRAMBIN, self.folder / "in" / name)
        self.assert_fails(INPUT, ["in/*.cif", "no such file"], "in/*.cif")
        if not IS_WINDOWS:
            self.assert_fails(INPUT, ["in/*.pdb", "no such file"], "in/*.pdb")
            return
        self.run_cpu("in/*.pdb", "-v", "3", "-o", "out_%s.ply", "--json", "all.jsonl")
        reports = [json.loads(line) for line in (self.folder / "all.jsonl").read_text(encoding="utf-8").splitlines()]
        self.assertEqual([os.path.basename(report["input"]) for report in reports], ["a.pdb", "b.pdb", "ü.pdb"])
        self.run_cpu("p.pdb", "--trajectory", "man?.pdb", "-v", "3", "--csv", "a.csv")
        self.assertEqual(len((self.folder / "a.csv").read_text().splitlines()), 1 + MODELS)

    @unittest.skipIf(IS_WINDOWS, "all names are UTF-16 there")
    def test_of_bytes_that_are_no_letters(self):
        """On Linux any bytes may be a name: reports are UTF-8 all the same, with U+FFFD where a name is not."""
        folder = os.fsencode(self.folder)
        shutil.copy(CRAMBIN, folder + b"/Caf\xe9.pdb")
        result = subprocess.run([cli_test.PROGRAM, b"Caf\xe9.pdb", "--json", b"r\xe9sum\xe9.json", "--backend", "cpu", "-v", "2"],
                                cwd=folder, capture_output=True, timeout=cli_test.PATIENCE)
        self.assertEqual(result.returncode, OK, result.stderr)
        with open(folder + b"/r\xe9sum\xe9.json", encoding="utf-8") as report:
            self.assertEqual(json.load(report)["input"], "Caf\ufffd.pdb")


class TwoAtATime(FilesTest):
    def test_in_one_folder(self):
        """Neither notices the other, even where both write the same files: one of the two is there in the end, whole."""
        meshes = set()
        for spacing in ("1", "1.5"):
            self.run_cpu("many.pdb", "--model", "all", "-v", spacing, "-o", f"{spacing}.ply")
            meshes |= {path.read_bytes() for path in self.folder.glob(f"{spacing}_*.ply")}
        self.assertEqual(len(meshes), 2)
        for _ in range(3):
            running = [subprocess.Popen([cli_test.PROGRAM, "many.pdb", "--model", "all", "-v", spacing, "-o", "same.ply",
                                         "--backend", "cpu", "--quiet"], cwd=self.folder, stderr=subprocess.PIPE)
                       for spacing in ("1", "1.5", "1", "1.5")]
            for process in running:
                self.assertEqual((process.communicate()[1], process.returncode), (b"", OK))
            made = sorted(self.folder.glob("same_*.ply"))
            self.assertEqual(len(made), MODELS)
            for mesh in made:
                self.assertIn(mesh.read_bytes(), meshes)
        self.assertEqual(list(self.folder.glob(".*")), [])


STOPPING = ["SIGINT", "SIGTERM", "SIGHUP", "SIGUSR1", "SIGUSR2", "SIGALRM"]  # Windows has not all of them


def listen_to_signals():
    """Also where these tests were begun with nohup, say, whose children ignore what it ignores."""
    for name in STOPPING:
        signal.signal(getattr(signal, name), signal.SIG_DFL)


@unittest.skipIf(IS_WINDOWS, "no signals")
class Stopped(FilesTest):
    def start(self, **keywords):
        """A run that takes long, and has files that are not finished."""
        atoms = "".join(line for line in CRAMBIN.read_text().splitlines(True) if line.startswith("ATOM"))
        self.write("long.pdb", 2000 * f"MODEL        1\n{atoms}ENDMDL\n")
        self.write("t.csv", "old")
        keywords.setdefault("preexec_fn", listen_to_signals)
        process = subprocess.Popen(
            [cli_test.PROGRAM, "p.pdb", "--trajectory", "long.pdb", "-v", "0.2", "--backend", "cpu", "--quiet",
             "--csv", "t.csv", "--json", "t.json", "-o", "f%d.obj"], cwd=self.folder, **keywords)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        while not any(self.folder.glob("f*.obj")):
            self.assertIsNone(process.poll())
            time.sleep(0.01)
        self.assertTrue(any(self.folder.glob(".*.tmp")))
        return process

    def test_by_signals(self):
        for number in (getattr(signal, name) for name in STOPPING):
            with self.subTest(signal=number):
                process = self.start(stderr=subprocess.PIPE)
                process.send_signal(number)
                self.assertEqual(process.communicate(timeout=cli_test.PATIENCE), (None, b""))
                self.assertEqual(process.returncode, -number)
                self.assertEqual([path.name for path in self.folder.glob(".*")], [])
                self.assertEqual((self.folder / "t.csv").read_text(), "old")
                self.assertFalse((self.folder / "t.json").exists())
                for mesh in self.folder.glob("f*.obj"):
                    self.assertTrue(is_closed(read_obj(mesh)[2]))
                    mesh.unlink()

    def test_a_signal_that_is_ignored_does_not_stop_it(self):
        process = self.start(preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN))
        process.send_signal(signal.SIGHUP)
        self.wait_for_another_mesh(process)
        self.assertIsNone(process.poll())
        process.send_signal(signal.SIGTERM)
        self.assertEqual(process.wait(timeout=cli_test.PATIENCE), -signal.SIGTERM)
        self.assertEqual([path.name for path in self.folder.glob(".*")], [])

    def wait_for_another_mesh(self, process):
        count = len(list(self.folder.glob("f*.obj")))
        while len(list(self.folder.glob("f*.obj"))) < count + 2:
            self.assertIsNone(process.poll())
            time.sleep(0.01)


if __name__ == "__main__":
    cli_test.PROGRAM = cli_test.program_to_test(cli_test.PROGRAM, __doc__)
    unittest.main()
