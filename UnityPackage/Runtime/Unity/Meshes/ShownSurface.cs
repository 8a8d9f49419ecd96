// SPDX-License-Identifier: MIT
using System;
using UnityEngine;

namespace QuickSes
{
    /// <summary>
    /// The surface a component shows, and the one on its way: both kept by the native library, of which the engine's
    /// meshes are copies. What fits into a frame goes into the mesh that is shown; what does not, into a second one,
    /// which takes its place when it is full. What is kept on the GPU goes another way, as long as that works. Main thread
    /// only; no garbage once both are there.
    /// </summary>
    internal sealed partial class ShownSurface : IDisposable
    {
        private const int FreshCost = 6; // of bytes in new buffers, in bytes in warm ones

        private readonly SurfaceUpload _upload = new SurfaceUpload();
        private readonly SurfacePainter _painter = new SurfacePainter();
        private SurfaceMesh _front = new SurfaceMesh(); // what is shown
        private SurfaceMesh _back = new SurfaceMesh(); // what is being filled
        private KeptMesh _kept; // what is shown; null: nothing ever was
        private KeptMesh _arriving; // what was taken, if any
        private AtomLook _arrivingLook;
        private bool _hasArrival;
        private bool _isArrivalMoving;
        private bool _isArrivalUploaded; // whether the upload under way is of the arrival
        private bool _isResting; // buffers have to be made exact

        /// <summary>What is shown. Another one after surfaces too large for one frame.</summary>
        public Mesh Mesh => IsOnGpu && _gpu.Front.Mesh != null ? _gpu.Front.Mesh : _front.Mesh;

        /// <summary>The same; null if nobody has asked for it.</summary>
        public Mesh MeshIfMade => IsOnGpu || _front.HasMesh ? Mesh : null;

        /// <summary>How surfaces that can be coloured either way are uploaded from now on.</summary>
        public bool UsesTexture { get; set; }

        /// <summary>Whether vertices of what is shown have atoms instead of colours.</summary>
        public bool HasAtoms => IsFilled && (IsOnGpu ? _gpu.Front.Style : _front.Style).HasAtoms;

        public bool IsFilled => IsOnGpu || _front.IsFilled;

        /// <summary>Of the atoms of what is shown; null: nothing is.</summary>
        public AtomLook Look => IsOnGpu ? _gpu.Front.Look : _front.Look;

        public double Area { get; private set; }

        public double Volume { get; private set; }

        /// <summary>
        /// The native mesh of what is shown. What is on the GPU only is brought home; throws if that is not possible.
        /// </summary>
        public SurfaceMeshView View => IsFilled ? BroughtHome(_kept).View : default;

        public bool IsUploading =>
            (_upload.IsUnderWay && _isArrivalUploaded) || (_hasArrival && _isArrivalForGpu && _gpu.IsWaiting);

        public bool HasUpload => (_hasArrival && !_isArrivalForGpu) || _upload.IsUnderWay || MustMove || MustPaint;

        // What is shown has to go into other buffers.
        private bool MustMove => MustLeaveGpu || (_front.IsFilled && (_isResting ||
            !_front.Style.Equals(StyleOf(_kept.View, _front.Look)) ||
            (!_front.Style.HasAtoms && _front.VisibleVersion != _front.Look.VisibleVersion)));

        // Not for a mesh that somebody destroys half painted.
        private bool MustPaint => _front.IsFilled && (_painter.IsUnderWay || SurfacePainter.IsNeeded(_front));

        /// <summary>As of <see cref="ISurfaceHost.Take"/>.</summary>
        public void Take(SurfaceContext context, AtomLook look, bool isMoving)
        {
            if (_upload.IsUnderWay)
                AbandonUpload(); // of the surface before into other buffers
            _arriving ??= new KeptMesh();
            context.Keep(_arriving);
            look.Hold();
            _arrivingLook?.Release();
            _arrivingLook = look;
            _hasArrival = true;
            _isArrivalForGpu = IsForGpu(_arriving);
            _isArrivalMoving = isMoving;
        }

        /// <summary>As of <see cref="ISurfaceHost.Upload"/>.</summary>
        public UploadStep Upload(in UploadShare share, out long bytes)
        {
            bytes = 0;
            try
            {
                if (!_upload.IsUnderWay && ((_hasArrival && !_isArrivalForGpu) || MustMove))
                    Begin(share);
                if (_upload.IsUnderWay)
                    return Fill(share, ref bytes);
                if (!MustPaint)
                    return UploadStep.Painted;
                if (_front.Writer.IsIntact(_front.Mesh))
                    return _painter.Step(_kept, _front, share, out bytes) ? UploadStep.Unfinished : UploadStep.Painted;
                _isResting = true; // somebody else has changed the mesh
                return UploadStep.Unfinished;
            }
            catch
            {
                AbandonUpload();
                GiveUpLook();
                throw;
            }
        }

        /// <summary>What is on its way is not wanted any more.</summary>
        public void DropUpload()
        {
            AbandonUpload();
            _gpu?.Forget();
            _hasArrival = false;
            _arrivingLook?.Release();
            _arrivingLook = null;
            _arriving?.Clear();
        }

        /// <summary>As of <see cref="ISurfaceHost.Rest"/>.</summary>
        public void Rest()
        {
            _isResting = _front.IsFilled && _front.Writer.HasRoom;
            if (!_isResting)
                _back.FreeMesh();
        }

        /// <summary>Shows nothing.</summary>
        public void Clear()
        {
            DropUpload();
            _gpu?.Dispose();
            _gpu = null;
            _front.Clear();
            _back.FreeMesh();
            _kept?.Clear();
            Area = Volume = 0;
            _isResting = false;
        }

        /// <summary>The first triangle that a ray meets; false: none. Hidden atoms let rays through.</summary>
        /// <param name="origin">In the coordinates of the mesh.</param>
        /// <param name="direction">The same; of any length but 0.</param>
        /// <param name="hit">Distance in lengths of the direction.</param>
        public bool TryPick(Vector3 origin, Vector3 direction, out SurfaceHit hit)
        {
            hit = default;
            return IsFilled && IsRay(origin, direction) && BroughtHome(_kept).TryPick((origin.x, origin.y, origin.z),
                (direction.x, direction.y, direction.z), Look.Visible, out hit);
        }

        /// <summary>
        /// Copies what is shown into a mesh of the caller's, which needs no texture and nothing of this package: painted
        /// vertices, exact buffers, no hidden triangles.
        /// </summary>
        public unsafe void CopyTo(Mesh mesh)
        {
            MeshWriter.RequireWritable(mesh);
            SurfaceMeshView view = View;
            int vertices = view.VertexCount;
            mesh.Clear();
            using (var writer = new MeshWriter())
            using (var room = new UnmanagedBuffer<byte>())
            using (var indices = new UnmanagedBuffer<uint>())
            {
                int triangles = CopyVisible(view, indices);
                MeshStyle style = IsFilled ? StyleOf(view, Look, false) : default;
                writer.Reserve(mesh, style, vertices, 3 * triangles, false);
                if (vertices > 0)
                {
                    writer.WriteVertices(
                        MeshStyle.SurfaceStream, style.SurfaceBytes, view.PositionsPointer, 0, vertices);
                    writer.Paint(_kept, Look.Colors, MeshStyle.AtomStream, 0, vertices, room);
                    if (style.HasTexcoords)
                        writer.WriteTexcoords(_kept, Look.Texcoords, 0, vertices, room);
                }
                if (triangles > 0)
                    writer.WriteIndices(indices.Pointer, 0, 3 * triangles);
                writer.Finish(SurfaceMeshUploader.BoundsOf(view), vertices, 3 * triangles);
            }
        }

        /// <summary>Whether not all triangles of what is shown are hidden, and there are some.</summary>
        public bool IsAnyVisible
        {
            get
            {
                using (var indices = new UnmanagedBuffer<uint>())
                    return CopyVisible(View, indices) > 0;
            }
        }

        // How many triangles there are.
        private int CopyVisible(in SurfaceMeshView view, UnmanagedBuffer<uint> indices)
        {
            view.Indices.CopyTo(indices.Resize(3 * view.TriangleCount));
            return IsFilled && !Look.Visible.IsEmpty
                ? _kept.Filter(Look.Visible, 0, view.TriangleCount, indices.Span)
                : view.TriangleCount;
        }

        public void Dispose()
        {
            DropUpload();
            _gpu?.Dispose();
            _gpu = null;
            _front.Dispose();
            _back.Dispose();
            _upload.Dispose();
            _painter.Dispose();
            _kept?.Dispose();
            _arriving?.Dispose();
            _kept = _arriving = null;
        }

        private void Begin(in UploadShare share)
        {
            _painter.Abandon();
            _isArrivalUploaded = _hasArrival && !_isArrivalForGpu;
            KeptMesh source = BroughtHome(_isArrivalUploaded ? _arriving : _kept);
            AtomLook look = _isArrivalUploaded ? _arrivingLook : Look;
            bool withRoom = _isArrivalUploaded ? _isArrivalMoving : _front.Writer.HasRoom && !_isResting;
            SurfaceMeshView view = source.View;
            MeshStyle style = StyleOf(view, look);
            long cost = SurfaceUpload.BytesOf(view, style);
            if (cost > share.PieceBytes && !_front.Writer.Suffices(
                _front.Mesh, style, view.VertexCount, 3 * view.TriangleCount, withRoom))
                cost *= FreshCost;
            SurfaceMesh target = cost <= share.RestBytes && !IsOnGpu ? _front : _back;
            if (withRoom && cost > UploadQueue.MinPiece)
                _ = _back.Mesh; // now, rather than in the one slow frame of an hour of playback
            _upload.Begin(source, look, target, style, withRoom);
        }

        private UploadStep Fill(in UploadShare share, ref long bytes)
        {
            bool isDirect = _upload.Target == _front;
            while (_upload.Step(share, out long piece))
            {
                bytes += piece;
                if (!isDirect)
                    return UploadStep.Unfinished;
            }
            if (!isDirect)
                (_front, _back) = (_back, _front);
            _back.IsFilled = false;
            _isResting = false;
            if (IsOnGpu || _isArrivalUploaded)
                _gpu?.Hide(); // also what was to be shown, and never was
            if (!_front.Writer.HasRoom)
                _back.FreeMesh(); // at rest: a single mesh will do
            return _isArrivalUploaded ? Arrive() : UploadStep.Moved;
        }

        private UploadStep Arrive()
        {
            (_kept, _arriving) = (_arriving, _kept);
            DropUpload();
            _staysOnGpu = false;
            _kept.TryGetReport(out SurfaceReport report);
            Area = report.Area;
            Volume = report.Volume;
            return UploadStep.Shown;
        }

        private void AbandonUpload()
        {
            _upload.Abandon();
            _painter.Abandon();
        }

        // What could not be shown is not tried again and again, but shown with the next surface or change.
        private void GiveUpLook()
        {
            _isResting = false;
            _staysOnGpu = IsOnGpu;
            if (!_front.IsFilled)
                return;
            _front.Style = StyleOf(_kept.View, _front.Look);
            _front.ColorsVersion = _front.Look.ColorsVersion;
            _front.VisibleVersion = _front.Look.VisibleVersion;
            _front.TexcoordsVersion = _front.Look.TexcoordsVersion;
            _front.Writer.Forget();
        }

        // Transforms of scale 0 make none of what was one.
        private static bool IsRay(Vector3 origin, Vector3 direction)
        {
            float sum = origin.x + origin.y + origin.z + direction.x + direction.y + direction.z;
            return sum - sum == 0 && (direction.x != 0 || direction.y != 0 || direction.z != 0);
        }

        private MeshStyle StyleOf(in SurfaceMeshView view, AtomLook look) => StyleOf(view, look, UsesTexture);

        /// <summary>Whether vertices have texture coordinates: those of their atoms, or else ambient occlusion.</summary>
        public static bool HasTexcoords(in SurfaceMeshView view, AtomLook look) =>
            look.Texcoords.Length > 0 || view.HasTexcoords;

        private static MeshStyle StyleOf(in SurfaceMeshView view, AtomLook look, bool hasAtoms) => new MeshStyle(
            view.VertexLayout == SurfaceVertexLayout.Compact, hasAtoms, HasTexcoords(view, look));
    }
}
