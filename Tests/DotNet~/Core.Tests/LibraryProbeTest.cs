// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.Interop;
using System;
using System.IO;
using System.Runtime.InteropServices;

namespace QuickSes.Tests
{
    /// <summary>The loader's own reasons, where the runtime tells none.</summary>
    internal sealed class LibraryProbeTest
    {
        private TemporaryFolder _folder;

        private string Library => _folder.File("libquickses.so");

        [SetUp]
        public void SetUp() => _folder = new TemporaryFolder();

        [TearDown]
        public void TearDown() => _folder.Dispose();

        [Test]
        public void WhatALibraryNeedsAndIsMissingIsNamed()
        {
            Libraries.MakeOneThatNeeds("quickses_missing", _folder, Library);
            Assert.That(LibraryProbe.AskAbout(Library), Does.Contain("libquickses_missing.so"));
        }

        [TestCase(183, "Arm64")]
        [TestCase(3, "X86")]
        public void OtherProcessorsAreNamed(int machine, string name)
        {
            Libraries.MakeOneFor((byte)machine, Library);
            Assert.That(LibraryProbe.OtherArchitecture(Library), Is.EqualTo(name));
            Assert.That(LibraryProbe.AskAbout(Library), Does.Contain($"{Library} is made for {name}"));
        }

        [TestCase(0xaa64, "Arm64")]
        [TestCase(0x14c, "X86")]
        [TestCase(0x8664, "")]
        public void SoTheyAreOnWindows(int machine, string name)
        {
            var file = new byte[512];
            file[0] = (byte)'M';
            file[1] = (byte)'Z';
            file[60] = 128;
            file[132] = (byte)machine;
            file[133] = (byte)(machine >> 8);
            File.WriteAllBytes(Library, file);
            Assert.That(LibraryProbe.OtherArchitecture(Library), Is.EqualTo(name));
        }

        [TestCase(-5)]
        [TestCase(4091)]
        [TestCase(int.MaxValue)]
        public void HeadersThatPointOutOfTheFileTellNothing(int start)
        {
            var file = new byte[4096];
            file[0] = (byte)'M';
            file[1] = (byte)'Z';
            BitConverter.GetBytes(start).CopyTo(file, 60);
            File.WriteAllBytes(Library, file);
            Assert.That(LibraryProbe.OtherArchitecture(Library), Is.Empty);
        }

        [Test]
        public void MissingFilesAreNamed() =>
            Assert.That(LibraryProbe.AskAbout(Library), Does.Contain(Library).And.Contain("No such file"));

        [Test]
        public void FilesThatAreNoLibraryAreNamed()
        {
            foreach (byte[] content in new[] { new byte[0], new byte[3], new byte[5000] })
            {
                File.WriteAllBytes(Library, content);
                Assert.That(LibraryProbe.AskAbout(Library), Does.Contain(Library));
            }
        }

        [Test]
        public void LibrariesThatCanBeLoadedAreToldToBeSo() =>
            Assert.That(LibraryProbe.AskAbout(NativeLibrarySetup.LibraryPath), Does.Contain("itself can be loaded"));

        [Test]
        public void NothingThrows()
        {
            Assert.That(LibraryProbe.AskAbout(null), Is.Not.Null);
            Assert.That(LibraryProbe.AskAbout("a\0b"), Is.Not.Null);
            Assert.That(LibraryProbe.AskAbout(_folder.Path), Is.Not.Null);
            Assert.That(LibraryProbe.Ask("no_such_library"), Does.Contain("no_such_library"));
        }

        [Test]
        public void UsersOfPlayersAreToldNothingOfBuilding()
        {
            string name = RuntimeInformation.OSDescription;
            string text = PlatformText.NotLoaded("because.", false, true, name);
            Assert.That(text, Does.Contain(name).And.Contain("Windows and Linux on x86-64").And.EndsWith("because."));
            Assert.That(text, Does.Not.Contain("building").And.Not.Contain("Package Manager"));
            Assert.That(PlatformText.NotLoaded("because.", true, true, name), Does.Contain("building.md"));
            foreach (bool isForDevelopers in new[] { false, true })
            {
                text = PlatformText.NotLoaded("because.", isForDevelopers, false, "macOS 14");
                Assert.That(text, Does.StartWith("Molecular surfaces can't be computed on macOS 14").And.Contain("because."));
                Assert.That(text, Does.Not.Contain("building").And.Not.Contain("Package Manager"));
            }
            Assert.That(PlatformText.Refusal, Is.Empty, "here the library is looked for");
        }
    }

    /// <summary>Libraries that can't be loaded.</summary>
    internal static class Libraries
    {
        public static void MakeOneThatNeeds(string missing, TemporaryFolder folder, string library)
        {
            string needed = folder.File($"lib{missing}.so");
            Repository.CompileC("int something_needed(void) { return 1; }\n", needed, "-shared -fPIC");
            Repository.CompileC("int something_needed(void);\nint qses_abi_version(void) { return something_needed(); }\n",
                library, $"-shared -fPIC -L \"{folder.Path}\" -Wl,--no-as-needed -l{missing}");
            File.Delete(needed);
        }

        /// <param name="machine">e_machine of ELF.</param>
        /// <param name="library">Where it is written.</param>
        public static void MakeOneFor(byte machine, string library)
        {
            Repository.CompileC("int qses_abi_version(void) { return 0; }\n", library, "-shared -fPIC");
            byte[] bytes = File.ReadAllBytes(library);
            bytes[18] = machine;
            bytes[19] = 0;
            File.WriteAllBytes(library, bytes);
        }
    }
}
