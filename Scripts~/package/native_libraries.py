# SPDX-License-Identifier: MIT
"""What a native library of the package may need and must offer: for check-package. Reads with readelf and objdump."""

import os
import re
import struct
import subprocess

NEWEST_GLIBC = (2, 34)  # Red Hat Enterprise Linux 9; Ubuntu 22.04 has 2.35

# Of the C library (with the names it had before 2.34), and the unwinder, which is in every process that has C++.
LINUX_NEEDS = {"libc.so.6", "libm.so.6", "libdl.so.2", "libpthread.so.0", "librt.so.1", "ld-linux-x86-64.so.2",
               "libgcc_s.so.1"}
WINDOWS_NEEDS = {"kernel32.dll", "msvcrt.dll"}  # Parts of every Windows.
MACHINE_CODE, PTX = 2, 1  # kinds of entries in a fat binary


def declared_functions(headers):
    """The functions that the headers of a folder declare for export."""
    found = set()
    for name in sorted(os.listdir(headers)):
        with open(os.path.join(headers, name), encoding="utf-8") as file:
            found |= set(re.findall(r"QSES_API [^;(]*[ *](qses_[a-z0-9_]+)\(", file.read()))
    return found


def output_of(*command):
    done = subprocess.run(command, capture_output=True, text=True, check=False, env={**os.environ, "LC_ALL": "C"})
    return done.stdout if done.returncode == 0 else ""


def check_exports(exported, headers):
    declared = declared_functions(headers)
    if not declared:
        return [f"no declarations found in {headers}"]
    return ([f"exports {name}, which no header declares" for name in sorted(exported - declared)] +
            [f"doesn't export {name}, which a header declares" for name in sorted(declared - exported)])


def check_glibc(text):
    faults = []
    for version in sorted(set(re.findall(r"Name: GLIBC_(\S+)", text))):
        numbers = tuple(int(word) for word in version.split(".")) if re.fullmatch(r"[0-9.]+", version) else (99,)
        if numbers > NEWEST_GLIBC:
            faults.append(f"needs GLIBC_{version}; {'.'.join(map(str, NEWEST_GLIBC))} is the newest allowed")
    return faults


def fat_binaries(data):
    """Code for GPUs in a library: a set of (kind, architecture) for each fat binary that CUDA's fatbinary has made."""
    found, at = [], data.find(b"\x50\xed\x55\xba\x01\x00\x10\x00")  # its mark, version 1, a header of 16 bytes
    while at >= 0:
        entry, end = at + 16, at + 16 + struct.unpack_from("<Q", data, at + 8)[0]
        found.append(set())
        while entry < end:
            kind, _, header, size = struct.unpack_from("<HHIQ", data, entry)
            found[-1].add((kind, struct.unpack_from("<I", data, entry + 28)[0]))
            entry += max(1, header + size)
        at = data.find(b"\x50\xed\x55\xba\x01\x00\x10\x00", end)
    return found


def released_architectures(cmake_lists):
    """What every fat binary of a release must hold: a set as of fat_binaries."""
    with open(cmake_lists, encoding="utf-8") as file:
        words = re.search(r'QUICKSES_CUDA_ARCHITECTURES "(.*?)"', file.read()).group(1).split(";")
    return ({(MACHINE_CODE, int(re.match(r"\d+", word).group())) for word in words} |
            {(PTX, int(word)) for word in words if word.isdigit()})


def check_gpu_code(path, cmake_lists):
    with open(path, "rb") as file:
        try:
            found = fat_binaries(file.read())
        except struct.error:
            return ["has damaged code for GPUs"]
    missing = released_architectures(cmake_lists) - set.intersection(*found) if found else set()
    return ([] if found else ["has no code for GPUs"]) + [
        f"has no {'machine code' if kind == MACHINE_CODE else 'PTX'} for compute capability {number / 10}"
        for kind, number in sorted(missing)]


def check_elf(path, headers):
    text = output_of("readelf", "-W", "-h", "-d", "-V", path)
    if not re.search(r"Class: +ELF64\n(.*\n)*.*Type: +DYN(.*\n)+.*Machine: +Advanced Micro Devices X86-64", text):
        return ["is no shared library of Linux on x86-64"]
    faults = []
    needed = re.findall(r"\(NEEDED\) +Shared library: \[(.*?)\]", text)
    faults += [f"needs {library}" for library in needed if library not in LINUX_NEEDS]
    soname = re.findall(r"\(SONAME\) +Library soname: \[(.*?)\]", text)
    if soname != [os.path.basename(path)]:
        faults.append(f"has the soname {soname[0] if soname else '(none)'}, not its name")
    for paths in re.findall(r"\((?:RPATH|RUNPATH)\).*\[(.*?)\]", text):
        faults.append(f"looks for libraries in {paths}")
    symbols = output_of("readelf", "-W", "--dyn-syms", path)
    exported = re.findall(r"(?m)^ +\d+: +\S+ +\S+ +\S+ +(?:GLOBAL|WEAK|UNIQUE) +\S+ +(?!UND)\S+ +([^\s@]+)", symbols)
    return faults + check_glibc(text) + check_exports(set(exported), headers)


def check_pe(path, headers):
    text = output_of("objdump", "-p", path)
    if "file format pei-x86-64" not in text:
        return ["is no library of Windows on x86-64"]
    faults = [f"needs {library}" for library in re.findall(r"DLL Name: (\S+)", text)
              if library.lower() not in WINDOWS_NEEDS]
    table = re.search(r"\[Ordinal/Name Pointer\] Table.*\n((?:\s*\[ *\d+\].*\n)*)", text)
    exported = re.findall(r"(?m)([^\s\]]+)$", table.group(1)) if table else []
    return faults + check_exports(set(exported), headers)
