// SPDX-License-Identifier: MIT
using System;

namespace QuickSes
{
    /// <summary>
    /// Brings new colours and texture coordinates into the vertices of a surface that is shown, piece by piece, and
    /// only to where they change: nothing is computed and no other buffer touched. Main thread only; no garbage.
    /// </summary>
    internal sealed unsafe class SurfacePainter : IDisposable
    {
        private enum Stage
        {
            None,
            Colors,
            Texcoords
        }

        private readonly UnmanagedBuffer<bool> _isChanged = new UnmanagedBuffer<bool>(); // per atom
        private readonly UnmanagedBuffer<System.Numerics.Vector2> _texcoords =
            new UnmanagedBuffer<System.Numerics.Vector2>();
        private Stage _stage;
        private int _next; // vertex
        private bool _isEverywhere;

        public bool IsUnderWay => _stage != Stage.None;

        /// <summary>Whether a mesh has other colours or texture coordinates than its atoms.</summary>
        public static bool IsNeeded(SurfaceMesh mesh) => HasOtherColors(mesh) || HasOtherTexcoords(mesh);

        public void Abandon() => _stage = Stage.None;

        public void Dispose()
        {
            _isChanged.Dispose();
            _texcoords.Dispose();
        }

        /// <summary>Paints a piece. False: nothing is left to be painted.</summary>
        public bool Step(KeptMesh surface, SurfaceMesh target, in UploadShare share, out long bytes)
        {
            bytes = 0;
            if (_stage == Stage.None)
                Begin(target);
            if (_stage == Stage.None)
                return false;
            int each = _stage == Stage.Colors ? MeshStyle.AtomBytes : MeshStyle.TexcoordBytes;
            SurfaceMeshView view = surface.View;
            int count = (int)Math.Min(EndOfRun(view) - _next, Math.Max(1, share.PieceBytes / each));
            bytes = (long)each * count;
            int first = _next, last = _next + count - 1;
            if (_stage == Stage.Colors && !_isEverywhere)
                Narrow(view.Owners, ref first, ref last);
            if (first <= last)
            {
                if (_stage == Stage.Colors)
                    target.Writer.Paint<uint>(
                        surface, target.Colors.Span, MeshStyle.AtomStream, first, last - first + 1, share.Room);
                else
                    target.Writer.WriteTexcoords(surface, _texcoords.Span, first, last - first + 1, share.Room);
                target.Writer.Tell();
            }
            _next += count;
            if (_next < view.VertexCount)
                return true;
            _stage = Stage.None;
            return IsNeeded(target);
        }

        // Colours that change while others are being painted come with the next round.
        private void Begin(SurfaceMesh target)
        {
            _next = 0;
            AtomLook look = target.Look;
            if (HasOtherColors(target))
            {
                NoteChanges(target.Colors.Span, look.Colors);
                target.Colors.CopyFrom(look.Colors);
                target.ColorsVersion = look.ColorsVersion;
                _stage = Stage.Colors;
            }
            else if (HasOtherTexcoords(target))
            {
                _texcoords.CopyFrom(look.Texcoords);
                target.TexcoordsVersion = look.TexcoordsVersion;
                _stage = Stage.Texcoords;
            }
        }

        private void NoteChanges(ReadOnlySpan<uint> before, ReadOnlySpan<uint> after)
        {
            Span<bool> isChanged = _isChanged.Resize(after.Length);
            int count = 0;
            for (int atom = 0; atom < isChanged.Length; ++atom)
            {
                isChanged[atom] = before[atom] != after[atom];
                count += isChanged[atom] ? 1 : 0;
            }
            _isEverywhere = count > after.Length / 2;
        }

        // Vertices that stand for others on the other side of a crease come last, in the same order once more.
        private int EndOfRun(in SurfaceMeshView view)
        {
            int single = view.VertexCount - view.Repeated.Length;
            return _next < single ? single : view.VertexCount;
        }

        // To the first and the last vertex whose atom has changed; none: first > last.
        private void Narrow(ReadOnlySpan<uint> owners, ref int first, ref int last)
        {
            bool* isChanged = _isChanged.Pointer;
            fixed (uint* owner = owners)
            {
                while (first <= last && !isChanged[owner[first]])
                    ++first;
                while (first <= last && !isChanged[owner[last]])
                    --last;
            }
        }

        private static bool HasOtherColors(SurfaceMesh mesh) =>
            !mesh.Style.HasAtoms && mesh.ColorsVersion != mesh.Look.ColorsVersion;

        private static bool HasOtherTexcoords(SurfaceMesh mesh) =>
            mesh.Style.HasTexcoords && mesh.TexcoordsVersion != mesh.Look.TexcoordsVersion;
    }
}
