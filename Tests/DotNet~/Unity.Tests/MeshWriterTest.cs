// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.EngineDouble;
using System;
using System.Linq;
using UnityEngine;
using Object = UnityEngine.Object;

namespace QuickSes.Tests
{
    internal sealed class MeshWriterTest
    {
        [Test]
        public unsafe void BuffersThatWereGivenHalfWayAreGivenAnew([Values] bool withRoom)
        {
            var style = new MeshStyle(false, false, false);
            var mesh = new Mesh();
            using (var writer = new MeshWriter())
            {
                writer.Reserve(mesh, style, 3, 3, withRoom);
                Assert.That(writer.IsIntact(mesh), Is.True);
                MeshRecord.Of(mesh).RefusesIndices = true;
                Assert.Throws<OutOfMemoryException>(() => writer.Reserve(mesh, style, 300, 300, withRoom));
                Assert.That(writer.IsIntact(mesh), Is.False);
                MeshRecord.Of(mesh).RefusesIndices = false;
                writer.Reserve(mesh, style, 300, 300, withRoom);
                uint[] indices = Enumerable.Range(0, 300).Select(k => (uint)k).ToArray();
                fixed (uint* first = indices)
                    writer.WriteIndices(first, 0, indices.Length);
                writer.Finish(default, 300, indices.Length);
                Assert.That(mesh.GetIndices(0).Select(k => (uint)k), Is.EqualTo(indices));
            }
            Object.DestroyImmediate(mesh);
        }
    }
}
