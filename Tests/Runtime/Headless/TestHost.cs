// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;
using System.Collections.Generic;
using System.Diagnostics;
using System.Numerics;
using System.Threading;

namespace QuickSes.Tests
{
    /// <summary>
    /// A session without a component: a clock that stands unless it is moved, and what was shown and told.
    /// </summary>
    internal sealed class TestHost : ISurfaceHost, IDisposable
    {
        private const double Patience = 150; // s

        public readonly SurfaceSession Session;
        public readonly List<SurfaceLevel> Levels = new List<SurfaceLevel>();
        public readonly List<QuickSesError> Failures = new List<QuickSesError>();
        public int Finished;
        public int Disposed;
        public double Now;
        public float Spacing = 0.5f;
        public float[] CoarserLevels = { 2, 1 };
        public bool SharpCreases;
        public Exception Refusal; // what Upload throws
        public Exception TakeRefusal;
        public int StepsPerUpload = 1;
        public int Taken;
        public int Rests;
        public int ShownVertices;
        public bool IsMoving; // what was taken last
        public Action<SurfaceLevel> Updated;
        public Action AskedWhetherGone;
        private bool _isGone;
        private (float X, float Y, float Z) _low, _high; // of what is shown
        private KeptMesh _taken;
        private bool _hasTaken;
        private int _steps; // of what was taken

        public TestHost()
        {
            Session = new SurfaceSession(this);
        }

        public bool IsGone
        {
            get
            {
                AskedWhetherGone?.Invoke();
                return _isGone;
            }
            set => _isGone = value;
        }

        public SurfaceBackend Backend { get; set; } = SurfaceBackend.Cpu;

        public float FrameBudget { get; set; }

        public float RestDelay { get; set; }

        public static TestHost WithAtom(Vector3 position, float radius)
        {
            var host = new TestHost();
            host.SetAtoms(new[] { position }, new[] { radius });
            return host;
        }

        /// <summary>Of a row of atoms, which takes longer than a single one.</summary>
        public static TestHost WithRow(int count)
        {
            var host = new TestHost();
            host.SetAtoms(Row(count, 0), Radii(count));
            return host;
        }

        public static Vector3[] Row(int count, float y)
        {
            var positions = new Vector3[count];
            for (int i = 0; i < count; ++i)
                positions[i] = new Vector3(2 * i, y, 0);
            return positions;
        }

        public static float[] Radii(int count)
        {
            var radii = new float[count];
            for (int i = 0; i < count; ++i)
                radii[i] = 1.5f;
            return radii;
        }

        public void SetAtoms(Vector3[] positions, float[] radii)
        {
            bool haveMoved = Session.Atoms.SetAtoms(positions, radii);
            Session.Change(haveMoved ? SurfaceChange.Positions : SurfaceChange.Shape, Now);
        }

        public void SetPositions(params Vector3[] positions)
        {
            Session.Atoms.SetPositions(positions);
            Session.Change(SurfaceChange.Positions, Now);
        }

        /// <summary>What a component does once per frame.</summary>
        public void Tick()
        {
            Session.Tick(Now);
            Session.RaiseEvents();
        }

        /// <summary>Frames until nothing is left to do.</summary>
        public void Settle() => Until(() => Session.IsUpToDate, this);

        public static void Until(Func<bool> condition, params TestHost[] hosts) => Until(condition, null, hosts);

        /// <summary>The same, with something that is done at the beginning of each frame.</summary>
        public static void Until(Func<bool> condition, Action before, params TestHost[] hosts)
        {
            Stopwatch clock = Stopwatch.StartNew();
            do
            {
                Assert.That(clock.Elapsed.TotalSeconds, Is.LessThan(Patience), "still waiting");
                Thread.Sleep(1);
                before?.Invoke();
                foreach (TestHost host in hosts)
                    if (!host.Session.IsDisposed)
                        host.Tick();
            } while (!condition());
        }

        /// <summary>What is shown is a sphere: the surface of a single atom.</summary>
        /// <param name="tolerance">Vertices lie on the sphere, but none at its poles.</param>
        public void AssertShowsAtom(Vector3 position, float radius, float tolerance = 0.02f)
        {
            Assert.That(Session.CurrentLevel.VertexCount, Is.GreaterThan(0));
            AssertSide(_low, position - new Vector3(radius), tolerance);
            AssertSide(_high, position + new Vector3(radius), tolerance);
        }

        public void Dispose() => Session.Dispose();

        SurfaceSettings ISurfaceHost.MakeSettings(out ReadOnlySpan<float> levels)
        {
            SurfaceSettings settings = SurfaceSettings.Default;
            settings.Spacing = Spacing;
            settings.VertexLayout = SurfaceVertexLayout.Interleaved;
            settings.Creases = settings.HardEdges = SharpCreases;
            levels = CoarserLevels;
            return settings;
        }

        int ISurfaceHost.Frame => 0;

        bool ISurfaceHost.IsUploading => _steps > 0;

        bool ISurfaceHost.HasUpload => _hasTaken;

        bool ISurfaceHost.HasDelivery => false;

        bool ISurfaceHost.UsesGpu => false;

        UploadStep ISurfaceHost.Deliver(bool isUrgent) =>
            throw new InvalidOperationException("there is nothing to deliver");

        string ISurfaceHost.GpuRefusal => "";

        void ISurfaceHost.RefuseGpu(string reason) => throw new InvalidOperationException(reason);

        void ISurfaceHost.Take(SurfaceContext context, AtomLook look, bool isMoving)
        {
            Assert.That(_steps, Is.EqualTo(0), "what is being uploaded must not be replaced");
            if (TakeRefusal != null)
                throw TakeRefusal;
            int atoms = AtomsOf(context);
            if (atoms > 0)
                Assert.That(look.Count, Is.EqualTo(atoms));
            _taken ??= new KeptMesh();
            Assert.That(context.Keep(_taken));
            _hasTaken = true;
            IsMoving = isMoving;
            ++Taken;
        }

        UploadStep ISurfaceHost.Upload(in UploadShare share, out long bytes)
        {
            Assert.That(_hasTaken);
            bytes = share.PieceBytes;
            if (Refusal != null)
                throw Refusal;
            if (++_steps < StepsPerUpload)
                return UploadStep.Unfinished;
            SurfaceMeshView mesh = _taken.View;
            _low = mesh.BoundsMin;
            _high = mesh.BoundsMax;
            ShownVertices = mesh.VertexCount;
            Forget();
            return UploadStep.Shown;
        }

        void ISurfaceHost.DropUpload()
        {
            Forget();
            _taken?.Clear();
        }

        void ISurfaceHost.Rest() => ++Rests;

        private void Forget()
        {
            _steps = 0;
            _hasTaken = false;
        }

        // Every atom of these tests owns a vertex, but a lone one that lies between the points of a coarse lattice has none.
        private static int AtomsOf(SurfaceContext context)
        {
            int atoms = 0;
            context.TryGetMesh(out SurfaceMeshView mesh);
            foreach (uint owner in mesh.Owners)
                atoms = Math.Max(atoms, (int)owner + 1);
            return atoms;
        }

        void ISurfaceHost.OnUpdated(in SurfaceLevel level)
        {
            Levels.Add(level);
            Updated?.Invoke(level);
        }

        void ISurfaceHost.OnFinished() => ++Finished;

        void ISurfaceHost.OnFailed(in QuickSesError error) => Failures.Add(error);

        void ISurfaceHost.OnDisposed()
        {
            ++Disposed;
            _taken?.Dispose();
        }

        private static void AssertSide((float X, float Y, float Z) side, Vector3 expected, float tolerance)
        {
            Assert.That(side.X, Is.EqualTo(expected.X).Within(tolerance));
            Assert.That(side.Y, Is.EqualTo(expected.Y).Within(tolerance));
            Assert.That(side.Z, Is.EqualTo(expected.Z).Within(tolerance));
        }
    }
}
