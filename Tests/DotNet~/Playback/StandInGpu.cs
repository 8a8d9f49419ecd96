// SPDX-License-Identifier: MIT
using QuickSes.EngineDouble;
using QuickSes.Interop;
using System;
using System.Collections.Generic;
using System.Diagnostics;
using System.Numerics;
using System.Runtime.InteropServices;

namespace QuickSes.Tests
{
    /// <summary>
    /// Stands for the library's way from CUDA to the graphics API where there is no CUDA: meshes are kept in host memory
    /// and called on the GPU, events copy them into the double's buffers, and whoever breaks the rules of quickses_gpu.h
    /// finds that in <see cref="Faults"/>. No garbage once it has grown.
    /// </summary>
    internal sealed class StandInGpu : IGpuLibrary, IDisposable
    {
        private const int MostWaiting = 2;
        private static int s_pointers;

        private readonly Dictionary<KeptMesh, SurfaceMeshView> _home = new Dictionary<KeptMesh, SurfaceMeshView>();
        private readonly List<Target> _targets = new List<Target>();
        private readonly List<long> _releasing = new List<long>(); // buffers that CUDA lets go of with the next event
        private readonly uint[] _jobs = new uint[256]; // whose meshes stay on the GPU, by their numbers
        private int _issued;
        private bool _isAnythingNew;

        public StandInGpu()
        {
            EventFunction = (IntPtr)(++s_pointers);
            RenderThread.Declare(EventFunction, RunEvent);
            GraphicsMemory.Deleting += NoteDeletion;
        }

        /// <summary>What was done against the rules.</summary>
        public List<string> Faults { get; } = new List<string>();

        /// <summary>If not null, events fail with this sentence.</summary>
        public string EventFailure { get; set; }

        /// <summary>If not null, the graphics API can't be written to.</summary>
        public string Refusal { get; set; }

        public bool DownloadsFail { get; set; }

        public int Submissions { get; private set; }

        public int LooksSet { get; private set; }

        public int Downloads { get; private set; }

        /// <summary>What it took to stand for a GPU so far: copies.</summary>
        public double Milliseconds { get; private set; }

        public int TargetCount => _targets.Count;

        public GpuGraphics AskedFor { get; private set; }

        /// <summary>Asked when a job is made whose meshes are to stay on the GPU.</summary>
        public MeshDelivery Delivery
        {
            get
            {
                _jobs[SurfaceScheduler.LastJob % _jobs.Length] = SurfaceScheduler.LastJob;
                return MeshDelivery.Host;
            }
        }

        public IntPtr EventFunction { get; }

        public void Dispose() => GraphicsMemory.Deleting -= NoteDeletion;

        /// <summary>As if meshes had waited too long for an event.</summary>
        public void LosePatience()
        {
            foreach (Target target in _targets)
                target.LosePatience();
        }

        public bool IsUsable(GpuGraphics graphics, out string reason)
        {
            AskedFor = graphics;
            reason = Refusal ?? "";
            return Refusal == null;
        }

        public bool WorksWith(SurfaceBackend backend) => true;

        public bool IsOnGpuOnly(KeptMesh mesh) => mesh.View.VertexCount > 0 &&
            _jobs[mesh.View.Tag % _jobs.Length] == mesh.View.Tag &&
            !(_home.TryGetValue(mesh, out SurfaceMeshView home) && home.IsValid);

        public QuickSesError Download(KeptMesh mesh)
        {
            ++Downloads;
            if (DownloadsFail)
                return new QuickSesError(QuickSesStatus.OutOfMemory, "there is no memory");
            _home[mesh] = mesh.View;
            return default;
        }

        public IGpuTarget NewTarget()
        {
            var target = new Target(this);
            _targets.Add(target);
            return target;
        }

        public int NextEvent()
        {
            if (!_isAnythingNew && !_targets.Exists(s_isStopped))
                return 0;
            _isAnythingNew = false;
            _releasing.Clear();
            return ++_issued;
        }

        private static readonly Predicate<Target> s_isStopped = target => target.IsStopped;

        private void NoteTime(long begin) =>
            Milliseconds += (Stopwatch.GetTimestamp() - begin) * 1000.0 / Stopwatch.Frequency;

        private void RunEvent(int number)
        {
            long begin = Stopwatch.GetTimestamp();
            if (number > _issued)
                Faults.Add($"event {number} was never given out");
            foreach (Target target in _targets)
                target.RunEvent(number);
            NoteTime(begin);
        }

        // Of the thread that calls: buffers are deleted in the order of events that were issued before.
        private void NoteDeletion(long identity)
        {
            if (_releasing.Contains(identity))
                Faults.Add("a buffer was deleted before an event let CUDA let go of it");
            foreach (Target target in _targets)
                target.NoteDeletion(identity);
        }

        private sealed class Target : IGpuTarget
        {
            private readonly StandInGpu _gpu;
            private readonly List<Submission> _waiting = new List<Submission>();
            private readonly Stack<Submission> _unused = new Stack<Submission>();
            private readonly Registration[] _registrations = new Registration[5];
            private readonly UnmanagedBuffer<uint> _colors = new UnmanagedBuffer<uint>();
            private readonly UnmanagedBuffer<Vector2> _texcoords = new UnmanagedBuffer<Vector2>();
            private readonly UnmanagedBuffer<byte> _visible = new UnmanagedBuffer<byte>();
            private uint _generation;
            private QuickSesError _error;
            private int _submitted;
            private int _done;
            private bool _isDisposed;

            public Target(StandInGpu gpu) => _gpu = gpu;

            public bool IsStopped { get; private set; }

            public QuickSesError SetLook(int atoms, ReadOnlySpan<uint> colors, ReadOnlySpan<Vector2> texcoords,
                ReadOnlySpan<byte> visible)
            {
                ++_gpu.LooksSet;
                if ((colors.Length | texcoords.Length | visible.Length) > atoms)
                    _gpu.Faults.Add("a look of more atoms than there are");
                _colors.CopyFrom(colors);
                _texcoords.CopyFrom(texcoords);
                _visible.CopyFrom(visible);
                return default;
            }

            public QuickSesError Submit(KeptMesh mesh, in NativeGpuBuffers buffers)
            {
                if (_isDisposed)
                    _gpu.Faults.Add("submitted after its end");
                if (IsStopped || _waiting.Count == MostWaiting)
                    return new QuickSesError(QuickSesStatus.Busy, "");
                if (buffers.Graphics != _gpu.AskedFor)
                    _gpu.Faults.Add("buffers of another graphics API");
                if (mesh.View.VertexCount == 0)
                    return new QuickSesError(QuickSesStatus.NoResult, "is not on a device");
                SurfaceMeshView view = mesh.View;
                if ((ulong)view.VertexCount > buffers.VertexCapacity || 3ul * (ulong)view.TriangleCount > buffers.IndexCapacity)
                    return new QuickSesError(QuickSesStatus.InvalidArgument, "buffers too small");
                Submission submission = _unused.Count > 0 ? _unused.Pop() : new Submission();
                submission.Event = _submitted = _gpu._issued + 1;
                submission.Buffers = buffers;
                long begin = Stopwatch.GetTimestamp();
                submission.Take(view, _colors.Span, _texcoords.Span, _visible.Span);
                _gpu.NoteTime(begin);
                _waiting.Add(submission);
                _gpu._isAnythingNew = true;
                ++_gpu.Submissions;
                return default;
            }

            public GpuTargetStatus GetStatus() =>
                new GpuTargetStatus(_error, _submitted, _done, _waiting.Count, IsStopped);

            public void Dispose()
            {
                _isDisposed = true;
                _gpu._targets.Remove(this);
                foreach (Registration registration in _registrations)
                    if (registration.Identity != 0)
                        _gpu._releasing.Add(registration.Identity);
                _gpu._isAnythingNew = true;
            }

            public void LosePatience()
            {
                if (_waiting.Count == 0)
                    return;
                Recycle();
                IsStopped = true;
            }

            public void RunEvent(int number)
            {
                IsStopped = false;
                Submission newest = null;
                foreach (Submission submission in _waiting)
                    if (submission.Event <= number)
                        newest = submission;
                if (newest == null)
                    return;
                _done = number;
                _error = _gpu.EventFailure == null ? default : new QuickSesError(QuickSesStatus.DeviceError, _gpu.EventFailure);
                if (_gpu.EventFailure == null && !newest.IsTargetGone)
                    Write(newest);
                while (_waiting[0] != newest)
                    RecycleFirst();
                RecycleFirst();
            }

            public void NoteDeletion(long identity)
            {
                foreach (Submission submission in _waiting)
                {
                    if (!IsOf(submission.Buffers, identity))
                        continue;
                    if (submission.Event > _gpu._issued)
                        _gpu.Faults.Add("a buffer was deleted before the event that writes it was issued");
                    submission.IsTargetGone = true;
                }
            }

            private void Write(Submission submission)
            {
                NativeGpuBuffers buffers = submission.Buffers;
                bool isNew = buffers.Generation != _generation;
                _generation = buffers.Generation;
                submission.Vertices.Span.CopyTo(Find(0, buffers.Vertices, isNew, 16 * buffers.VertexCapacity));
                if (buffers.Colors != 0)
                    MemoryMarshal.AsBytes(submission.Colors.Span).CopyTo(
                        Find(1, buffers.Colors, isNew, 4 * buffers.VertexCapacity));
                if (buffers.Owners != 0)
                    MemoryMarshal.AsBytes(submission.Owners.Span).CopyTo(
                        Find(2, buffers.Owners, isNew, 4 * buffers.VertexCapacity));
                if (buffers.Texcoords != 0)
                    MemoryMarshal.AsBytes(submission.Texcoords.Span).CopyTo(
                        Find(3, buffers.Texcoords, isNew, 8 * buffers.VertexCapacity));
                Span<byte> indices = Find(4, buffers.Indices, isNew, 4 * buffers.IndexCapacity);
                MemoryMarshal.AsBytes(submission.Indices.Span).CopyTo(indices);
                if (buffers.ClearRest != 0)
                    indices.Slice(4 * submission.Indices.Length, 4 * ((int)buffers.IndexCapacity - submission.Indices.Length))
                        .Clear();
            }

            // The buffer CUDA knows, which is not the one that has the name now if nobody told it of another.
            private Span<byte> Find(int place, ulong name, bool isNew, ulong least)
            {
                if (!GraphicsMemory.TryFind((long)name, out long identity, out Span<byte> bytes))
                    _gpu.Faults.Add($"there is no buffer {name}");
                if ((ulong)bytes.Length < least)
                    _gpu.Faults.Add($"buffer {name} is smaller than was said");
                if (isNew)
                    _registrations[place] = new Registration { Identity = identity };
                else if (_registrations[place].Identity != identity)
                    _gpu.Faults.Add($"buffer {name} is another one than the one of this generation");
                return bytes;
            }

            private static bool IsOf(in NativeGpuBuffers buffers, long identity) => Is(buffers.Vertices, identity) ||
                Is(buffers.Colors, identity) || Is(buffers.Owners, identity) || Is(buffers.Texcoords, identity) ||
                Is(buffers.Indices, identity);

            private static bool Is(ulong name, long identity) =>
                name != 0 && GraphicsMemory.TryFind((long)name, out long found, out _) && found == identity;

            private void Recycle()
            {
                while (_waiting.Count > 0)
                    RecycleFirst();
            }

            private void RecycleFirst()
            {
                _waiting[0].IsTargetGone = false;
                _unused.Push(_waiting[0]);
                _waiting.RemoveAt(0);
            }

            private struct Registration
            {
                public long Identity;
            }
        }

        // A mesh as it is to be in the buffers.
        private sealed class Submission
        {
            public readonly UnmanagedBuffer<byte> Vertices = new UnmanagedBuffer<byte>();
            public readonly UnmanagedBuffer<uint> Colors = new UnmanagedBuffer<uint>();
            public readonly UnmanagedBuffer<uint> Owners = new UnmanagedBuffer<uint>();
            public readonly UnmanagedBuffer<Vector2> Texcoords = new UnmanagedBuffer<Vector2>();
            public readonly UnmanagedBuffer<uint> Indices = new UnmanagedBuffer<uint>();
            public int Event;
            public NativeGpuBuffers Buffers;
            public bool IsTargetGone;

            public void Take(in SurfaceMeshView view, ReadOnlySpan<uint> colors, ReadOnlySpan<Vector2> texcoords,
                ReadOnlySpan<byte> visible)
            {
                Vertices.CopyFrom(view.Vertices);
                Owners.CopyFrom(view.Owners);
                Indices.CopyFrom(view.Indices);
                ReadOnlySpan<uint> owners = Owners.Span;
                ReadOnlySpan<Vector2> own = MemoryMarshal.Cast<float, Vector2>(view.Texcoords);
                Span<uint> painted = Colors.Resize(owners.Length);
                Span<Vector2> mapped = Texcoords.Resize(owners.Length);
                for (int v = 0; v < owners.Length; ++v)
                {
                    painted[v] = colors.IsEmpty ? uint.MaxValue : colors[(int)owners[v]];
                    mapped[v] = !texcoords.IsEmpty ? texcoords[(int)owners[v]] : own.IsEmpty ? default : own[v];
                }
                Span<uint> indices = Indices.Span;
                for (int i = 0; i < indices.Length && !visible.IsEmpty; i += 3)
                {
                    bool isShown = true;
                    for (int k = 0; k < 3; ++k)
                        isShown &= visible[(int)owners[(int)indices[i + k]]] != 0;
                    if (!isShown)
                        indices[i + 1] = indices[i + 2] = indices[i];
                }
            }
        }
    }
}
