// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System.Diagnostics;
using System.IO;

namespace QuickSes.Tests
{
    /// <summary>
    /// What is said on Mono where the native library can't be loaded, of which Mono itself tells nothing. Each in a process
    /// and a folder of its own.
    /// </summary>
    internal sealed class LibraryReasonTest
    {
        private TemporaryFolder _folder;

        private string Library => _folder.File("libquickses.so");

        [SetUp]
        public void SetUp()
        {
            _folder = new TemporaryFolder();
            string built = Path.Combine(Repository.Root, "Tests", "DotNet~", "Mono", "Support", "bin", "Debug", "netstandard2.1");
            foreach (string name in new[] { "QuickSes.Core.dll", "QuickSes.Mono.Support.dll" })
                File.Copy(Path.Combine(built, name), _folder.File(name));
        }

        [TearDown]
        public void TearDown() => _folder.Dispose();

        [Test]
        public void ThatItIsMissingIsTold() =>
            Assert.That(Ask(), Does.Contain("libquickses.so: cannot open shared object file: No such file"));

        [Test]
        public void WhatItNeedsAndIsMissingIsNamed()
        {
            Libraries.MakeOneThatNeeds("quickses_missing", _folder, Library);
            Assert.That(Ask(), Does.Contain("libquickses_missing.so: cannot open shared object file"));
        }

        [Test]
        public void WhatItIsMadeForIsNamed()
        {
            Libraries.MakeOneFor(183, Library);
            Assert.That(Ask(), Does.Contain($"{Library} is made for Arm64"));
        }

        [Test]
        public void TheVersionOfGlibcIsNamed()
        {
            // A library that needs a later glibc than there is: one whose versions are written over.
            Repository.CompileC("#include <stdio.h>\nint qses_abi_version(void) { return puts(\"\"); }\n", Library,
                "-shared -fPIC");
            byte[] bytes = File.ReadAllBytes(Library);
            byte[] version = System.Text.Encoding.ASCII.GetBytes("GLIBC_2.2.5");
            for (int i = 0; i + version.Length < bytes.Length; ++i)
            {
                int k = 0;
                while (k < version.Length && bytes[i + k] == version[k])
                    ++k;
                if (k == version.Length)
                    bytes[i + 6] = (byte)'9'; // GLIBC_9.2.5; found by its hash, which stays, and then compared
            }
            File.WriteAllBytes(Library, bytes);
            Assert.That(Ask(), Does.Contain("GLIBC_9.2.5").And.Contain("not found"));
        }

        [Test]
        public void TheRightOneIsLoaded()
        {
            string built = Path.GetDirectoryName(NativeLibrarySetup.LibraryPath);
            foreach (string file in Directory.GetFiles(built, "*.so"))
                File.Copy(file, _folder.File(Path.GetFileName(file)));
            Assert.That(Ask(), Does.StartWith("supported"));
        }

        private string Ask() => Repository.Run(Process.GetCurrentProcess().MainModule.FileName,
            $"\"{_folder.File("QuickSes.Mono.Support.dll")}\"");
    }
}
