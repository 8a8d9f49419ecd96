// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;
using System.IO;
using System.Reflection;
using System.Runtime.InteropServices;
using System.Runtime.Loader;
using System.Text.Json;

namespace QuickSes.Tests
{
    /// <summary>
    /// What is said where the native library can't be used. Each case loads the assembly once more, with another
    /// library.
    /// </summary>
    public sealed class SupportTest
    {
        [Test]
        public void ThisLibraryIsSupported()
        {
            Assert.That(SurfaceContext.IsSupported(out string reason), Is.True, reason);
            Assert.That(reason, Is.Empty);
        }

        [Test]
        public void MissingLibraryIsTold() =>
            ExpectUnsupported(() => NativeLibrary.Load("/no/such/folder/libquickses.so"), "can't be loaded");

        [Test]
        public void MissingLibraryIsToldWithTheUrlOfThePackage()
        {
            string manifest = File.ReadAllText(Path.Combine(Repository.Root, "package.json"));
            using JsonDocument document = JsonDocument.Parse(manifest);
            string url = document.RootElement.GetProperty("repository").GetProperty("url").GetString();
            Assert.That(url, Does.StartWith("https://").And.EndsWith(".git"));
            ExpectUnsupported(() => NativeLibrary.Load("/no/such/folder/libquickses.so"),
                $"Add (Unity 6: Install) package from git URL > {url}#upm .");
        }

        [Test]
        public void FileThatIsNoLibraryIsTold() =>
            ExpectUnsupported(() => NativeLibrary.Load(Repository.CrambinPath), "can't be loaded");

        [Test]
        public void OtherArchitectureIsTold() =>
            ExpectUnsupported(() => throw new BadImageFormatException("wrong format"),
                "another processor architecture");

        [Test]
        public void OtherLibraryOfTheSameNameIsTold()
        {
            using var folder = new TemporaryFolder();
            Repository.CompileC("int something_else;\n", folder.File("libquickses.so"), "-shared -fPIC");
            ExpectUnsupported(() => NativeLibrary.Load(folder.File("libquickses.so")), "too old");
        }

        [Test]
        public void OtherAbiVersionIsTold()
        {
            using var folder = new TemporaryFolder();
            Repository.CompileC("#include <stdint.h>\nuint32_t qses_abi_version(void) { return 999; }\n",
                folder.File("libquickses.so"), "-shared -fPIC");
            ExpectUnsupported(() => NativeLibrary.Load(folder.File("libquickses.so")), "ABI version 999");
        }

        [Test]
        public void ContextsAreRefusedAtOnceAndWithoutAThread()
        {
            var copy = new Copy();
            try
            {
                NativeLibrary.SetDllImportResolver(copy.Core,
                    (name, assembly, path) => NativeLibrary.Load("/no/such/folder/libquickses.so"));
                Type slot = copy.LoadFromAssemblyPath(typeof(SupportTest).Assembly.Location).GetType("QuickSes.ContextSlot");
                object one = Activator.CreateInstance(slot,
                    Activator.CreateInstance(copy.Core.GetType("QuickSes.SurfaceContextOptions")));
                slot.GetMethod("CreateInBackground").Invoke(one, null);
                Assert.That(slot.GetProperty("IsReady").GetValue(one), Is.True);
                Assert.That(slot.GetProperty("HasFailed").GetValue(one), Is.True);
                Assert.That(slot.GetProperty("Error").GetValue(one).ToString(), Does.Contain("can't be loaded"));
                slot.GetMethod("DisposeInBackground").Invoke(one, null);
                Assert.That(slot.GetProperty("IsDisposed").GetValue(one), Is.True);
            }
            finally
            {
                copy.Unload();
            }
        }

        /// <summary>The assembly once more, also for those that are loaded beside it and need it.</summary>
        private sealed class Copy : AssemblyLoadContext
        {
            public readonly Assembly Core;

            public Copy() : base(null, isCollectible: true) =>
                Core = LoadFromAssemblyPath(typeof(SurfaceContext).Assembly.Location);

            protected override Assembly Load(AssemblyName name) =>
                name.Name == Core.GetName().Name ? Core : null;
        }

        private static void ExpectUnsupported(Func<IntPtr> load, string sentence)
        {
            var copy = new AssemblyLoadContext(null, isCollectible: true);
            try
            {
                Assembly core = copy.LoadFromAssemblyPath(typeof(SurfaceContext).Assembly.Location);
                NativeLibrary.SetDllImportResolver(core, (name, assembly, path) => load());
                MethodInfo isSupported = core.GetType("QuickSes.SurfaceContext")
                    .GetMethod("IsSupported", new[] { typeof(string).MakeByRefType() });
                var arguments = new object[] { null };
                Assert.That(isSupported.Invoke(null, arguments), Is.False);
                Assert.That(arguments[0], Does.Contain(sentence));

                // Nothing else lets the runtime's exception through either.
                Type options = core.GetType("QuickSes.StructureOptions");
                Type structure = core.GetType("QuickSes.Structure");
                MethodInfo tryOpen = structure.GetMethod("TryOpen", new[]
                {
                    typeof(string), options.MakeByRefType(), structure.MakeByRefType(),
                    core.GetType("QuickSes.QuickSesError").MakeByRefType()
                });
                var opening = new[] { Repository.CrambinPath, Activator.CreateInstance(options), null, null };
                Assert.That(tryOpen.Invoke(null, opening), Is.False);
                Assert.That(opening[3].ToString(), Does.Contain(sentence));
                Type context = core.GetType("QuickSes.SurfaceContext");
                object defaults = Activator.CreateInstance(core.GetType("QuickSes.SurfaceContextOptions"));
                TargetInvocationException thrown =
                    Assert.Throws<TargetInvocationException>(() => Activator.CreateInstance(context, defaults));
                Assert.That(thrown.InnerException.GetType().Name, Is.EqualTo(nameof(QuickSesException)));
                Assert.That(thrown.InnerException.Message, Does.Contain(sentence));
            }
            finally
            {
                copy.Unload();
            }
        }
    }
}
