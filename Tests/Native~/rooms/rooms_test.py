# SPDX-License-Identifier: MIT
"""The rooms of NativePlugin/Source~ include each other one way only.   rooms_test.py PROJECT"""

import os
import re
import shutil
import sys
import tempfile
import unittest

PROJECT = ""
SOURCES = "NativePlugin/Source~"
TESTS = "Tests/Native~"

# A room, and the others that its files may include: only rooms above it, so that there is no way back.
ROOMS = {
    "include": "",
    "cudart": "",
    "process": "",
    "parallel": "include cudart process",
    "surface/geometry": "parallel",
    "surface/memory": "parallel surface/geometry",
    "surface/mesh": "include process parallel surface/geometry surface/memory",
    "surface/stages": "include process parallel surface/geometry surface/memory surface/mesh",
    "surface/methods": "include parallel surface/geometry surface/memory surface/mesh surface/stages",
    "surface/cpu": "parallel surface/geometry surface/memory surface/mesh surface/stages",
    "surface/cuda": "process parallel surface/geometry surface/memory surface/mesh surface/stages",
    "surface": "include process parallel surface/memory surface/mesh surface/stages surface/methods surface/cpu surface/cuda",
    "kept": "include parallel surface/mesh surface/stages",
    "graphics": "include cudart parallel surface/mesh surface/stages kept",
    "jobs": "include parallel surface kept",
    "io": "",
    "capi": "include process parallel surface/cpu surface/stages surface kept graphics jobs io",
    "render": "io",
    "cli": "include io render",
}
# What only the CPU's side may see.
CPU_HEADERS = re.compile(r"thrust/system/cpp/")

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*(?:"([^"]+)"|<([^>]+)>)', re.MULTILINE)


def includes_of(path):
    """[(name, whether in quotes)] of a file."""
    with open(path, encoding="utf-8") as file:
        return [(quoted or angled, bool(quoted)) for quoted, angled in INCLUDE.findall(file.read())]


def source_files(folder):
    """Paths of C, C++ and CUDA files, from the folder on."""
    for at, _, names in os.walk(folder):
        for name in sorted(names):
            if name.endswith((".h", ".c", ".cpp", ".cu", ".cuh")):
                yield os.path.relpath(os.path.join(at, name), folder).replace(os.sep, "/")


def room_of(path):
    """The longest row that the path begins with."""
    return max((room for room in ROOMS if path == room or path.startswith(room + "/")), key=len, default=None)


def find_cycle(graph):
    """The nodes of some cycle, in order; [] if there is none."""
    done, open_nodes = set(), []

    def visit(node):
        if node in open_nodes:
            return open_nodes[open_nodes.index(node):] + [node]
        if node in done:
            return []
        open_nodes.append(node)
        for after in graph.get(node, ()):
            cycle = visit(after)
            if cycle:
                return cycle
        open_nodes.pop()
        done.add(node)
        return []

    return next((cycle for cycle in map(visit, sorted(graph)) if cycle), [])


def reachable(graph, start):
    seen, todo = set(), [start]
    while todo:
        node = todo.pop()
        if node not in seen:
            seen.add(node)
            todo += graph[node]
    return seen


def faults(project):
    """What is wrong with the includes of a project: one sentence each."""
    sources, found = os.path.join(project, SOURCES), []
    graph, system_headers = {}, {}
    for path in source_files(sources):
        graph[path], system_headers[path] = [], []
        if room_of(path) is None:
            found.append(f"{path} is in no room of the table")
        for name, quoted in includes_of(os.path.join(sources, path)):
            if not quoted:
                system_headers[path].append(name)
                continue
            target = next((t for t in (name, "include/" + name) if os.path.isfile(os.path.join(sources, t))), None)
            if target is None:
                found.append(f"{path} includes {name}, which is not there")
                continue
            graph[path].append(target)
            here, there = room_of(path), room_of(target)
            if here != there and there not in ROOMS.get(here, "").split():
                found.append(f"{path} includes {target}: no arrow from {here} to {there}")
    tests = os.path.join(project, TESTS)
    for path in source_files(tests):
        roots = [os.path.dirname(os.path.join(tests, path)), tests, sources, os.path.join(sources, "include")]
        for name, quoted in includes_of(os.path.join(tests, path)):
            if quoted and not any(os.path.isfile(os.path.join(root, name)) for root in roots):
                found.append(f"{TESTS}/{path} includes {name}, which is not there")
    cycle = find_cycle(graph)
    if cycle:
        found.append("a cycle: " + " -> ".join(cycle))
    for unit in (path for path in graph if path.endswith(".cu")):
        for path in sorted(reachable(graph, unit)):
            found += [f"{unit} sees <{name}>, by {path}" for name in system_headers[path] if CPU_HEADERS.match(name)]
    found += [f"the table's row {room} has no files" for room in ROOMS if not any(room_of(path) == room for path in graph)]
    return found


class Rooms(unittest.TestCase):
    def test_the_table_has_no_way_back(self):
        above = set()
        for room, others in ROOMS.items():
            self.assertEqual(set(others.split()) - above, set(), f"the row of {room} names rooms that are not above it")
            above.add(room)

    def test_the_project_keeps_to_it(self):
        self.assertEqual(faults(PROJECT), [])


class Faults(unittest.TestCase):
    """Each kind of fault is found in a copy that has it."""

    def setUp(self):
        self.copy = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.copy)
        for folder in (SOURCES, TESTS):
            shutil.copytree(os.path.join(PROJECT, folder), os.path.join(self.copy, folder))

    def write(self, path, text):
        with open(os.path.join(self.copy, path), "a", encoding="utf-8") as file:
            file.write(text)

    def test_none_in_a_faithful_copy(self):
        self.assertEqual(faults(self.copy), [])

    def test_an_arrow_that_is_not_in_the_table(self):
        self.write(f"{SOURCES}/parallel/span.h", '#include "surface/geometry/arc.h"\n')
        self.assertIn("parallel/span.h includes surface/geometry/arc.h: no arrow from parallel to surface/geometry",
                      faults(self.copy))

    def test_an_arrow_from_the_program_to_the_library(self):
        self.write(f"{SOURCES}/cli/main.cpp", '#include "parallel/error.h"\n')
        self.assertIn("cli/main.cpp includes parallel/error.h: no arrow from cli to parallel", faults(self.copy))

    def test_a_file_that_is_not_there(self):
        self.write(f"{SOURCES}/io/box.h", '  #  include "io/gone.h"\n')
        self.write(f"{TESTS}/io/io_test.cpp", '#include "io/lost.h"\n')
        self.assertEqual(faults(self.copy), ["io/box.h includes io/gone.h, which is not there",
                                             f"{TESTS}/io/io_test.cpp includes io/lost.h, which is not there"])

    def test_a_cycle_within_a_room(self):
        self.write(f"{SOURCES}/io/box.h", '#include "io/unwrap.h"\n')
        self.assertIn("a cycle: io/box.h -> io/unwrap.h -> io/box.h", faults(self.copy))

    def test_the_cpus_executor_in_the_cuda_unit(self):
        self.write(f"{SOURCES}/surface/stages/components.h", '#include "parallel/cpu_executor.h"\n')
        self.assertTrue(any(fault.startswith("surface/cuda_engine.cu sees <thrust/system/cpp/") for fault in faults(self.copy)))

    def test_a_folder_that_is_no_room(self):
        os.mkdir(os.path.join(self.copy, SOURCES, "misc"))
        self.write(f"{SOURCES}/misc/new.h", "")
        self.assertEqual(faults(self.copy), ["misc/new.h is in no room of the table"])

    def test_a_row_without_files(self):
        shutil.rmtree(os.path.join(self.copy, SOURCES, "jobs"))
        self.assertIn("the table's row jobs has no files", faults(self.copy))


if __name__ == "__main__":
    PROJECT = sys.argv.pop(1)
    unittest.main()
