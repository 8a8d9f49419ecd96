// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;
using System.Collections;
using System.Reflection;
using System.Runtime.InteropServices;
using System.Runtime.Loader;
using System.Text.RegularExpressions;
using UnityEngine;
using UnityEngine.TestTools;
using Object = UnityEngine.Object;

namespace QuickSes.Tests
{
    /// <summary>Components where there is no native library.</summary>
    internal sealed class NoLibraryTest
    {
        [UnityTest]
        public IEnumerator SourcesAreRefusedAtOnceAndWithoutAThread()
        {
            var copy = new Copy();
            Type type = copy.Unity.GetType("QuickSes.MolecularSurface");
            LogAssert.Expect(LogType.Error, new Regex("surface: .*can't be loaded"));
            var scene = new GameObject("surface");
            dynamic surface = scene.AddComponent(type);
            surface.Source.SetAsset(new TextAsset(TestFrames.Pdb(1)) { name = "small.pdb" });
            yield return null; // one frame
            Assert.That((bool)surface.IsLoading, Is.False);
            Assert.That((bool)surface.IsBusy, Is.False);
            Assert.That(((object)surface.LastError).ToString(), Does.Contain("BackendUnavailable"));
            yield return null;
            Object.DestroyImmediate(scene);
            copy.Unload();
        }

        /// <summary>The package once more, with the same engine.</summary>
        private sealed class Copy : AssemblyLoadContext
        {
            private readonly Assembly _core;

            public Copy() : base(null, isCollectible: true)
            {
                _core = LoadFromAssemblyPath(typeof(SurfaceContext).Assembly.Location);
                NativeLibrary.SetDllImportResolver(_core,
                    (name, assembly, path) => NativeLibrary.Load("/no/such/folder/libquickses.so"));
                Unity = LoadFromAssemblyPath(typeof(MolecularSurface).Assembly.Location);
            }

            public Assembly Unity { get; }

            protected override Assembly Load(AssemblyName name) => name.Name == _core.GetName().Name ? _core : null;
        }
    }
}
