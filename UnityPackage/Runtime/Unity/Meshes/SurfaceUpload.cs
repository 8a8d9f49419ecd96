// SPDX-License-Identifier: MIT
using System;
using System.Runtime.InteropServices;
using UnityEngine;

namespace QuickSes
{
    /// <summary>
    /// Brings a kept mesh into a <see cref="SurfaceMesh"/>, piece by piece: vertices, triangles, and last what belongs to
    /// atoms, so that it is as new as can be. Main thread only; no garbage.
    /// </summary>
    internal sealed unsafe class SurfaceUpload : IDisposable
    {
        private enum Stage
        {
            None,
            Buffers,
            Vertices,
            Triangles,
            Colors,
            Texcoords
        }

        private const int MostBeginnings = 3;

        private readonly UnmanagedBuffer<byte> _visible = new UnmanagedBuffer<byte>(); // as triangles are left out
        private readonly UnmanagedBuffer<System.Numerics.Vector2> _texcoords =
            new UnmanagedBuffer<System.Numerics.Vector2>(); // as they are being written
        private Stage _stage;
        private KeptMesh _source;
        private SurfaceMesh _target;
        private AtomLook _look;
        private MeshStyle _style;
        private bool _withRoom;
        private int _next; // vertex or triangle of the stage
        private int _indexCount; // so far
        private int _beginnings;

        public bool IsUnderWay => _stage != Stage.None;

        /// <summary>What is being filled; null: nothing.</summary>
        public SurfaceMesh Target => _target;

        /// <summary>Bytes that such an upload writes, if nothing is hidden.</summary>
        public static long BytesOf(in SurfaceMeshView view, MeshStyle style) =>
            (long)view.VertexCount * style.VertexBytes + 12L * view.TriangleCount;

        /// <param name="source">Stays as it is until the upload is over.</param>
        /// <param name="look">Of its atoms.</param>
        /// <param name="target">Is emptied with the first step.</param>
        /// <param name="style">For it.</param>
        /// <param name="withRoom">Whether its buffers are to be larger than needed.</param>
        public void Begin(KeptMesh source, AtomLook look, SurfaceMesh target, MeshStyle style, bool withRoom)
        {
            _source = source;
            _look = look;
            _target = target;
            _withRoom = withRoom;
            _style = style;
            _beginnings = 0;
            _stage = Stage.Buffers;
        }

        public void Abandon()
        {
            _stage = Stage.None;
            _source = null;
            _target = null;
            _look = null;
        }

        public void Dispose()
        {
            Abandon();
            _visible.Dispose();
            _texcoords.Dispose();
        }

        /// <summary>Writes a piece. False: the target is full, the upload over. Throws if the engine refuses.</summary>
        public bool Step(in UploadShare share, out long bytes)
        {
            bytes = 0;
            SurfaceMeshView view = _source.View;
            Stage stage = _stage;
            if (stage != Stage.Buffers && !_target.Writer.IsIntact(_target.Mesh))
                stage = BeginAgain();
            if (stage == Stage.Buffers)
            {
                Reserve(view);
                return true;
            }
            try
            {
                bytes = Write(view, share);
            }
            catch (Exception) when (_beginnings < MostBeginnings)
            {
                BeginAgain(); // the buffers are others than they seem
                return true;
            }
            if (_stage != Stage.None)
                return true;
            _target.Writer.Finish(SurfaceMeshUploader.BoundsOf(view), view.VertexCount, _indexCount);
            _target.IsFilled = true;
            Abandon();
            return false;
        }

        // Somebody else who has the mesh has changed it. Who goes on doing so gets it no more.
        private Stage BeginAgain()
        {
            if (++_beginnings == MostBeginnings)
                _target.FreeMesh();
            else if (_beginnings > MostBeginnings)
                throw new InvalidOperationException("The engine makes other buffers than it is asked for.");
            _target.Writer.Forget();
            return _stage = Stage.Buffers;
        }

        private void Reserve(in SurfaceMeshView view)
        {
            _target.Writer.Reserve(_target.Mesh, _style, view.VertexCount, checked(3 * view.TriangleCount), _withRoom);
            _target.IsFilled = false; // if that has failed, it is still what it was
            _target.Look = _look;
            _target.Style = _style;
            _indexCount = 0;
            Enter(Stage.Vertices);
        }

        private void Enter(Stage stage)
        {
            _stage = stage;
            _next = 0;
            if (stage == Stage.Triangles && !_target.Style.HasAtoms)
            {
                _visible.CopyFrom(_look.Visible);
                _target.VisibleVersion = _look.VisibleVersion;
            }
            else if (stage == Stage.Triangles)
            {
                _visible.Resize(0); // the shader leaves out what is hidden
            }
            else if (stage == Stage.Colors && !_target.Style.HasAtoms)
            {
                _target.Colors.CopyFrom(_look.Colors);
                _target.ColorsVersion = _look.ColorsVersion;
            }
            else if (stage == Stage.Texcoords)
            {
                _texcoords.CopyFrom(_look.Texcoords);
                _target.TexcoordsVersion = _look.TexcoordsVersion;
            }
        }

        private long Write(in SurfaceMeshView view, in UploadShare share)
        {
            long bytes = 0;
            switch (_stage)
            {
                case Stage.Vertices:
                    int stride = _target.Style.SurfaceBytes, count = Count(view.VertexCount, stride, share);
                    if (count > 0)
                        _target.Writer.WriteVertices(MeshStyle.SurfaceStream, stride,
                            (byte*)view.PositionsPointer + (long)stride * _next, _next, count);
                    bytes = (long)stride * count;
                    Go(count, view.VertexCount, Stage.Triangles);
                    break;
                case Stage.Triangles:
                    count = Count(view.TriangleCount, 12, share);
                    if (count > 0)
                        WriteTriangles(view, count, share.Room);
                    bytes = 12L * count;
                    Go(count, view.TriangleCount, Stage.Colors);
                    break;
                case Stage.Colors:
                    count = Count(view.VertexCount, MeshStyle.AtomBytes, share);
                    if (count > 0)
                        WriteAtoms(view, count, share.Room);
                    bytes = (long)MeshStyle.AtomBytes * count;
                    // That there are none any more is another style, which comes next.
                    Go(count, view.VertexCount, _target.Style.HasTexcoords && ShownSurface.HasTexcoords(view, _look)
                        ? Stage.Texcoords
                        : Stage.None);
                    break;
                case Stage.Texcoords:
                    count = Count(view.VertexCount, MeshStyle.TexcoordBytes, share);
                    if (count > 0)
                        _target.Writer.WriteTexcoords(_source, _texcoords.Span, _next, count, share.Room);
                    bytes = (long)MeshStyle.TexcoordBytes * count;
                    Go(count, view.VertexCount, Stage.None);
                    break;
            }
            _target.Writer.Tell();
            return bytes;
        }

        private int Count(int all, int each, in UploadShare share) =>
            (int)Math.Min(all - _next, Math.Max(1, share.PieceBytes / each));

        private void Go(int count, int all, Stage next)
        {
            _next += count;
            if (_next >= all)
                Enter(next);
        }

        private void WriteTriangles(in SurfaceMeshView view, int count, UnmanagedBuffer<byte> room)
        {
            uint* indices = view.IndicesPointer + 3L * _next;
            if (_visible.Length > 0)
            {
                Span<uint> left = MemoryMarshal.Cast<byte, uint>(room.Resize(12 * count));
                count = _source.Filter(_visible.Span, _next, count, left);
                indices = (uint*)room.Pointer;
            }
            if (count > 0)
                _target.Writer.WriteIndices(indices, _indexCount, 3 * count);
            _indexCount += 3 * count;
        }

        private void WriteAtoms(in SurfaceMeshView view, int count, UnmanagedBuffer<byte> room)
        {
            if (_target.Style.HasAtoms)
                fixed (uint* owners = view.Owners)
                    _target.Writer.WriteVertices(
                        MeshStyle.AtomStream, MeshStyle.AtomBytes, owners + _next, _next, count);
            else
                _target.Writer.Paint<uint>(_source, _target.Colors.Span, MeshStyle.AtomStream, _next, count, room);
        }
    }
}
